"""Start and goal as they are kept: headings wrapped, quaternions of unit length, within limits."""

from __future__ import annotations

import math

from numpy.typing import ArrayLike

from ellipsoid_planning.errors import GeometryError, RobotError
from ellipsoid_planning.geometry.orientation import normalised_heading
from ellipsoid_planning.orientation_forms import unit_quaternion
from ellipsoid_planning.robots.configurations import Array, checked_configuration
from ellipsoid_planning.robots.coordinates import headings, quaternions
from ellipsoid_planning.robots.joint import LIMITED, REVOLUTE
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.scenario_joints import keyed_joints, limits_text
from ellipsoid_planning.scenario_origin import Origin
from ellipsoid_planning.sizes import check_coordinates

# A value beyond a limit by less [rad or the unit of length] is rounding, and put on the limit.
LIMIT_ROUNDING = 1e-9


def normalised_configuration(
    robot: Robot, configuration: ArrayLike, which: str, origin: Origin
) -> Array:
    """Return a configuration (d,) with what is equivalent made one.

    Args:
        robot: whose configuration it is.
        configuration: d finite numbers.
        which: start or goal, for messages.
        origin: where the scenario came from, for messages.

    Raises:
        ScenarioError: if the size is another, a quaternion far from unit length, or a joint's
            value out of its limits; if two joints' values would have one key in a file.
    """
    try:
        values = checked_configuration(configuration, robot.configuration_size)
    except GeometryError as error:
        raise origin.error((which,), str(error)) from None
    base = 0 if robot.base_size == 0 else robot.dimension
    try:
        check_coordinates(values[:base], "position")
    except GeometryError as error:
        raise origin.error((which, "position"), str(error)) from None
    for index in headings(robot):
        values[index] = normalised_heading(float(values[index]))
    _keep_limits(robot, values, which, origin)
    try:
        for place in quaternions(robot):
            values[place] = unit_quaternion(values[place])
    except GeometryError as error:
        raise origin.error((which,), str(error)) from None
    return values


def _keep_limits(robot: Robot, values: Array, which: str, origin: Origin) -> None:
    try:
        keyed = keyed_joints(robot)
    except RobotError as error:
        raise origin.error(("robot", *error.path), str(error)) from None
    for key, joint in keyed.items():
        if joint.type not in LIMITED:
            continue
        place = robot.joint_slices[joint.name]
        value = float(values[place][0])
        kept = min(max(value, joint.lower), joint.upper)
        if abs(value - kept) > LIMIT_ROUNDING:
            got = f"{math.degrees(value) if joint.type == REVOLUTE else value:.10g}"
            raise origin.error(
                (which, "joints", key),
                f"expected joint {joint.name!r} within its limits {limits_text(joint)}, got "
                f"{got}; change the value or the limits",
            )
        values[place] = kept
