"""Asks of a result everything that a path must keep and everything that the result states."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.scenario import Scenario
from planners.verify.coordinates import Turn, coordinates
from planners.verify.fcl_agreement import fcl_contacts
from planners.verify.motion import lengths
from planners.verify.report import Check, VerificationReport
from planners.verify.sampling import SampledPath, sample_path, sample_path_itself

Array = NDArray[np.float64]

SAME_STATE = 1e-9
"""How far states may differ that should be the same, as a fraction of the scene's size."""

SAME_LENGTH = 1e-6
ROUNDING = 1e-12


def verify_result(result: PlanResult) -> VerificationReport:
    """Check a result's path against its scenario, independently of the kernels.

    The path is sampled as `sampling.sample_path` describes. A contact, a lost clearance or an
    overstated one fails only when it is certain beyond rounding; so does everything else.
    """
    if result.path is None:
        missing = Check("path", passed=False, detail=f"there is none, status {result.status!r}")
        return VerificationReport((missing,))
    scenario, path = result.scenario, result.path.configurations
    size = _size(scenario)
    stated = [*_state_checks(scenario, path, size), _length_check(scenario, result.path)]
    sampled = sample_path(scenario, path)
    tested, contacts = fcl_contacts(scenario, sampled.configurations, sampled.lower, size)
    samples, resolved, apart = len(sampled.configurations), sampled.resolved, []
    itself = sample_path_itself(scenario, path)
    if itself is not None:
        rows, lower = itself.configurations, itself.lower
        more, found = fcl_contacts(scenario, rows, lower, size, itself=True)
        tested, contacts = tested + more, contacts + found
        samples, resolved = samples + len(rows), min(resolved, itself.resolved)
        apart = [_self_check(itself)]
    agreement = Check("FCL", contacts == 0, f"sees {contacts} contacts in {tested} configurations")
    bodies = _body_checks(scenario, result.path, sampled, size)
    return VerificationReport(
        (*stated, *bodies, *apart, agreement),
        samples=samples,
        sampled_clearance=sampled.smallest,
        resolved=resolved,
        fcl_samples=tested,
    )


def _size(scenario: Scenario) -> float:
    """The length that tolerances refer to: the longest extent of anything in the scene."""
    bodies = (*scenario.world.arenas, *scenario.world.obstacles)
    reaches = [float(np.max(np.abs(body.centre)) + np.max(body.semi_axes)) for body in bodies]
    return max([float(np.max(scenario.world.high - scenario.world.low)), *reaches])


def _state_checks(scenario: Scenario, path: Array, size: float) -> Iterator[Check]:
    for which, state, wanted in (
        ("start", path[0], scenario.start),
        ("goal", path[-1], scenario.goal),
    ):
        apart = _apart(scenario, state, wanted)
        yield Check(which, apart <= SAME_STATE * size, f"{apart:.3g} from the scenario's")
    known = coordinates(scenario.robot)
    if known.quaternions:
        norms = [np.linalg.norm(path[:, turn.place], axis=1) for turn in known.quaternions]
        error = float(np.max(np.abs(np.array(norms) - 1.0)))
        yield Check("quaternions", error <= SAME_STATE, f"of unit length within {error:.3g}")
    base = path[:, : known.position]
    low, high = scenario.world.low[: known.position], scenario.world.high[: known.position]
    worst = float(np.max(np.maximum(low - base, base - high), initial=-np.inf))
    passed = worst <= ROUNDING * size
    yield Check("bounds", passed, f"beyond them by {worst:.6g}" if not passed else "kept")
    joints = [turn for turn in (*known.numbers, *known.angles) if turn.joint]
    if joints:
        yield _limit_check(path, joints)


def _limit_check(path: Array, joints: list[Turn]) -> Check:
    """Joints move between their values at states, so that states tell it all."""
    worst, name = -np.inf, ""
    for joint in joints:
        values = path[:, joint.place]
        beyond = float(np.max(np.maximum(joint.lower - values, values - joint.upper)))
        if beyond > worst:
            worst, name = beyond, joint.joint
    passed = worst <= SAME_STATE
    detail = "kept" if passed else f"joint {name!r} is beyond its own by {worst:.6g}"
    return Check("limits", passed, detail)


def _self_check(itself: SampledPath) -> Check:
    where = f"in motion {itself.place[0]} at {itself.place[1]:.6g}"
    worst = itself.worst
    if worst is None:
        detail = f"no part meets another, at least {2.0 * itself.smallest:.6g} {where}"
        return Check("self-collision", passed=True, detail=detail)
    detail = f"part {worst.part!r} meets {worst.body!r}, about {worst.depth:.3g} deep, {where}"
    return Check("self-collision", passed=False, detail=detail)


def _apart(scenario: Scenario, one: Array, other: Array) -> float:
    """How far apart two configurations are, with turns in radians."""
    return lengths(scenario.robot, np.array([one, other]))[0]


def _length_check(scenario: Scenario, path: PathResult) -> Check:
    length, travel = lengths(scenario.robot, path.configurations)
    error = max(abs(path.length - length), abs(path.base_travel - travel))
    detail = f"stated {path.length:.9g}, measured {length:.9g}"
    return Check("length", error <= SAME_LENGTH * (1.0 + length), detail)


def _body_checks(
    scenario: Scenario, path: PathResult, sampled: SampledPath, size: float
) -> Iterator[Check]:
    place = f"in motion {sampled.place[0]} at {sampled.place[1]:.6g}"
    worst = sampled.worst
    for kind, verb in (("obstacle", "hits"), ("arena", "leaves")):
        passed = worst is None or worst.kind != kind
        detail = "none is hit" if kind == "obstacle" else "the robot stays inside"
        if worst is not None and not passed:
            about = f"{kind} {worst.body!r}, about {worst.depth:.3g} deep"
            detail = f"part {worst.part!r} {verb} {about}, {place}"
        yield Check(f"{kind}s", passed, detail)
    smallest, doubt = sampled.smallest, ROUNDING * size
    kept = smallest >= scenario.clearance - doubt
    detail = f"{smallest:.9g} {place}, required {scenario.clearance:g}"
    yield Check("clearance", kept, detail)
    honest = path.min_clearance <= smallest + doubt
    detail = f"stated at least {path.min_clearance:.9g}, sampled {smallest:.9g}"
    yield Check("stated clearance", honest, detail)
