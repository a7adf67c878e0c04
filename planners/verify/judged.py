"""Which scenario a result was judged against, so that nobody has to take the result's own."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.scenario_write import robot_document

_DIGITS = 12  # of numbers that are compared: orientations are computed, by each machine's own sine


def digest(scenario: Scenario) -> str:
    """Twelve hexadecimal digits that change with everything a verdict depends on."""
    text = "".join(_entries(scenario).values())
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def described(scenario: Scenario) -> str:
    """A scenario's name, what it consists of, and its digest."""
    world = scenario.world
    counts = [(len(world.obstacles), "obstacle"), (len(world.arenas), "arena")]
    counts.append((len(scenario.robot.parts), "part"))
    listed = ", ".join(f"{count} {noun}{'' if count == 1 else 's'}" for count, noun in counts)
    return f"{scenario.name!r}, {listed}, digest {digest(scenario)}"


def differences(one: Scenario, other: Scenario) -> list[str]:
    """The entries, of those that a verdict depends on, in which two scenarios differ."""
    first, second = _entries(one), _entries(other)
    return [name for name in first if first[name] != second[name]]


def mismatch(one: Scenario, other: Scenario) -> str | None:
    """Why a path of one scenario's robot means nothing to the other's; None if it does."""
    robots = one.robot, other.robot
    sizes = [robot.configuration_size for robot in robots]
    if one.dimension != other.dimension or sizes[0] != sizes[1]:
        return (
            f"the path has {sizes[0]} numbers a state, in {one.dimension}-D; "
            f"this scenario's robot has {sizes[1]}, in {other.dimension}-D"
        )
    slices = [dict(robot.joint_slices) for robot in robots]
    types = [{joint.name: joint.type for joint in robot.joints} for robot in robots]
    if slices[0] != slices[1] or any(types[0][name] != types[1][name] for name in slices[0]):
        names = [", ".join(of) or "none" for of in slices]
        return f"the path's joints are {names[0]}; this scenario's robot has {names[1]}"
    return None


def _entries(scenario: Scenario) -> dict[str, str]:
    """Everything that a verdict depends on, as text, by the names of a scenario's entries."""
    world, robot = scenario.world, scenario.robot
    parts = json.dumps(robot_document(robot), sort_keys=True)
    return {
        "bounds": _numbers(world.low, world.high),
        "arena": _bodies(world.arenas),
        "obstacles": _bodies(world.obstacles),
        "robot": f"{parts} {_bodies(robot.parts)}",
        "start": _numbers(scenario.start),
        "goal": _numbers(scenario.goal),
        "clearance": _numbers(np.array([scenario.clearance])),
    }


def _bodies(bodies: Sequence[Ellipsoid]) -> str:
    rows = [np.concatenate([b.centre, b.semi_axes, b.rotation.ravel()]) for b in bodies]
    return json.dumps([body.name for body in bodies]) + _numbers(*rows)


def _numbers(*rows: NDArray[np.float64]) -> str:
    numbers = np.concatenate(rows).tolist() if rows else []
    return json.dumps([float(f"{x:.{_DIGITS}g}") for x in numbers])
