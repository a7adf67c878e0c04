"""What the numbers of a robot's configuration are: lengths, headings, quaternions; their limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, LIMITED
from ellipsoid_planning.robots.robot import Robot

Array = NDArray[np.float64]


def headings(robot: Robot) -> tuple[int, ...]:
    """Places of the angles [rad] that are the same modulo a full turn."""
    base = (2,) if robot.rotates and robot.dimension == 2 else ()
    return base + tuple(place.start for place in _places(robot, CONTINUOUS))


def quaternions(robot: Robot) -> tuple[slice, ...]:
    """Places of the quaternions (x, y, z, w)."""
    base = (slice(3, 7),) if robot.rotates and robot.dimension == 3 else ()
    return base + _places(robot, BALL)


def _places(robot: Robot, kind: str) -> tuple[slice, ...]:
    return tuple(robot.joint_slices[joint.name] for joint in robot.joints if joint.type == kind)


def limits(robot: Robot) -> tuple[Array, Array]:
    """Least and greatest value of each number (d,), infinite where its joint has no limit."""
    high = np.full(robot.configuration_size, np.inf)
    low = -high
    for joint in robot.joints:
        if joint.type in LIMITED:
            place = robot.joint_slices[joint.name]
            low[place], high[place] = joint.lower, joint.upper
    return low, high
