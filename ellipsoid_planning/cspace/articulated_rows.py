"""Between configurations of articulated robots and the rows that kernels take.

A row is the base's pose (x, y, z, q_x, q_y, q_z, q_w), planar ones embedded in z = 0, followed by
the joint values of the configuration.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.poses import heading_between, rotation_between, rotation_quaternion
from ellipsoid_planning.geometry.orientation import normalised_heading
from ellipsoid_planning.robots.articulated import (
    FIXED_BASE,
    ArticulatedRobot,
    check_articulated,
)
from ellipsoid_planning.robots.configurations import (
    checked_configuration,
    checked_configurations,
)
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS

Array = NDArray[np.float64]


def rows_of(robot: ArticulatedRobot, configurations: ArrayLike) -> Array:
    """Rows (m, 7 + V) of configurations (m, d) or (d,).

    Raises:
        GeometryError: if they are no configurations of finite numbers, or the robot is rigid.
    """
    check_articulated(robot)
    values = checked_configurations(configurations, robot.configuration_size)
    n, base = robot.dimension, robot.base_size
    out = np.zeros((len(values), 7 + values.shape[1] - base))
    out[:, 7:] = values[:, base:]
    if robot.base == FIXED_BASE:
        out[:, :n] = robot.position
    else:
        out[:, :n] = values[:, :n]
    if robot.orientation is not None:
        out[:, 3:7] = rotation_quaternion(robot.orientation)
    elif n == 2:
        out[:, 5], out[:, 6] = np.sin(0.5 * values[:, 2]), np.cos(0.5 * values[:, 2])
    else:
        out[:, 3:7] = values[:, 3:7]
    return out


def configurations_of_rows(robot: ArticulatedRobot, rows: Array) -> Array:
    """Configurations (m, d) of rows (m, 7 + V); continuous joints are brought into [-pi, pi).

    Raises:
        GeometryError: if the robot is rigid.
    """
    check_articulated(robot)
    n, base = robot.dimension, robot.base_size
    out = np.empty((len(rows), robot.configuration_size))
    out[:, base:] = rows[:, 7:]
    if base:
        out[:, :n] = rows[:, :n]
    if robot.rotates and n == 3:
        out[:, 3:7] = rows[:, 3:7]
    elif robot.rotates:
        out[:, 2] = [normalised_heading(2.0 * math.atan2(row[5], row[6])) for row in rows]
    for joint in robot.moving_joints:
        if joint.type == CONTINUOUS:
            at = robot.joint_slices[joint.name].start
            out[:, at] = [normalised_heading(float(value)) for value in out[:, at]]
    return out


def interpolated(robot: ArticulatedRobot, first: ArrayLike, second: ArrayLike, s: float) -> Array:
    """The configuration (d,) at ``s`` in [0, 1], as OMPL interpolates the compound space.

    Raises:
        GeometryError: as :func:`rows_of`, and for more than one configuration.
    """
    check_articulated(robot)
    a = checked_configuration(first, robot.configuration_size)
    b = checked_configuration(second, robot.configuration_size)
    out = a + s * (b - a)
    if robot.rotates and robot.dimension == 2:
        out[2] = heading_between(a[2], b[2], s)
    elif robot.rotates:
        out[3:7] = rotation_between(a[3:7], b[3:7], s)
    for joint in robot.moving_joints:
        at = robot.joint_slices[joint.name]
        if joint.type == CONTINUOUS:
            out[at] = heading_between(a[at.start], b[at.start], s)
        elif joint.type == BALL:
            out[at] = rotation_between(a[at], b[at], s)
    return out
