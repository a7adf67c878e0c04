"""Joint values in a scenario's start and goal: keys, units, limits; read and written."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import RobotError
from ellipsoid_planning.orientation_forms import (
    degrees_from_radians,
    form_of_heading,
    heading_from_degrees,
)
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, FIXED, LIMITED, REVOLUTE, Joint
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.scenario_blocks import Orientation
from ellipsoid_planning.scenario_entries import Entries
from ellipsoid_planning.scenario_origin import Path

IN_DEGREES = (REVOLUTE, CONTINUOUS)
SUFFIX = "_deg"


def joint_key(joint: Joint) -> str:
    """The key of a joint's value in a scenario: its name, with ``_deg`` for an angle."""
    return joint.name + SUFFIX if joint.type in IN_DEGREES else joint.name


def keyed_joints(robot: Robot) -> dict[str, Joint]:
    """The moving joints by the keys of their values.

    Raises:
        RobotError: if two joints have the same key.
    """
    keyed: dict[str, Joint] = {}
    for joint in robot.joints:
        if joint.type == FIXED:
            continue
        key = joint_key(joint)
        if key in keyed:
            raise RobotError(
                f"the values of joints {keyed[key].name!r} and {joint.name!r} would both be "
                f"called {key} in start and goal; rename one of them",
                ("joints", robot.joints.index(joint), "name"),
            )
        keyed[key] = joint
    return keyed


def joint_values(
    entries: Entries,
    robot: RigidRobot | ArticulatedRobot,
    given: Mapping[str, float | Orientation],
    which: str,
) -> list[float]:
    """The joints' part of a configuration; joints that are not given stand at zero.

    Raises:
        ScenarioError: at an unknown key, a value of the wrong kind, or a zero out of limits.
    """
    path = (which, "joints")
    if not isinstance(robot, ArticulatedRobot):
        if given:
            problem = "a robot of parts is rigid and has no joints; remove them, or give it links"
            raise entries.error(path, problem, at_key=True)
        return []
    keyed = keyed_joints(robot)
    for key in given:
        if key not in keyed and not _is_held(robot, key):
            raise entries.error((*path, key), _unknown(key, robot, keyed), at_key=True)
    values: list[float] = []
    for key, joint in keyed.items():
        if key in given:
            values += _value(entries, joint, given[key], (*path, key))
        else:
            values += _zero(entries, joint, path)
    return values


def _is_held(robot: ArticulatedRobot, key: str) -> bool:
    """Whether a key is that of a joint whose limits leave one value, which it keeps to."""
    named = {joint.name: joint for joint in robot.joints if joint.type == FIXED and joint.notice}
    return key in named or key.removesuffix(SUFFIX) in named


def _unknown(key: str, robot: ArticulatedRobot, keyed: Mapping[str, Joint]) -> str:
    named = {joint.name: joint for joint in robot.joints}
    joint = named.get(key) or named.get(key.removesuffix(SUFFIX))
    if joint is None:
        close = difflib.get_close_matches(key, keyed, n=1)
        hint = f"did you mean {close[0]}?" if close else "correct its name or remove it"
        return f"unknown joint; expected one of {', '.join(keyed) or 'none'}; {hint}"
    if joint.type == FIXED:
        return f"joint {joint.name!r} is fixed and has no value; remove it"
    unit = {BALL: "an orientation such as {rpy_deg: [0, 0, 30]}"}.get(joint.type, "a length")
    unit = "an angle in degrees" if joint.type in IN_DEGREES else unit
    return f"joint {joint.name!r} is of type {joint.type}; write {joint_key(joint)} and {unit}"


def _value(entries: Entries, joint: Joint, value: float | Orientation, path: Path) -> list[float]:
    if joint.type == BALL:
        if not isinstance(value, Orientation):
            raise entries.error(
                path,
                f"joint {joint.name!r} is a ball joint; expected an orientation, got {value:g}; "
                "write it such as {quaternion: [x, y, z, w]}",
            )
        return entries.quaternion(value, path)
    if isinstance(value, Orientation):
        unit = "angle in degrees" if joint.type in IN_DEGREES else "length"
        raise entries.error(
            path,
            f"joint {joint.name!r} is {joint.type}; expected a number, got a mapping; "
            f"write one {unit}",
        )
    if joint.type == CONTINUOUS:
        return [heading_from_degrees(value)]
    return [math.radians(value) if joint.type == REVOLUTE else float(value)]


def _zero(entries: Entries, joint: Joint, path: Path) -> list[float]:
    if joint.type == BALL:
        return [0.0, 0.0, 0.0, 1.0]
    if joint.type in LIMITED and not joint.lower <= 0.0 <= joint.upper:
        raise entries.error(
            path,
            f"joint {joint.name!r} is not named and would stand at 0, outside its limits "
            f"{limits_text(joint)}; add {joint_key(joint)}",
        )
    return [0.0]


def limits_text(joint: Joint) -> str:
    """A joint's limits as messages show them, in degrees for an angle."""
    if joint.type in IN_DEGREES:
        return f"[{math.degrees(joint.lower):.10g}, {math.degrees(joint.upper):.10g}] deg"
    return f"[{joint.lower:.10g}, {joint.upper:.10g}]"


def written_values(robot: ArticulatedRobot, configuration: NDArray[np.float64]) -> dict[str, Any]:
    """The joints' values of a configuration (d,) as a scenario's ``joints``, complete."""
    return {
        key: _written(joint, configuration[robot.joint_slices[joint.name]])
        for key, joint in keyed_joints(robot).items()
    }


def _written(joint: Joint, values: NDArray[np.float64]) -> Any:
    if joint.type == BALL:
        return {"quaternion": values.tolist()}
    value = float(values[0])
    if joint.type == CONTINUOUS:
        return form_of_heading(value)["yaw_deg"]
    return degrees_from_radians(value) if joint.type == REVOLUTE else value
