"""Configurations as spatial poses, and OMPL's interpolation and distance between them.

A configuration is a flat array: [x, y, yaw], [x, y, z, qx, qy, qz, qw], or a position only. A
pose is (x, y, z, qx, qy, qz, qw): planar configurations are embedded in the plane z = 0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.orientation import (
    normalised_heading,
    quaternion_from_rotation,
    yaw_from_rotation,
)
from ellipsoid_planning.robots.configurations import (
    checked_configuration,
    checked_configurations,
)
from ellipsoid_planning.robots.rigid import RigidRobot, check_rigid

Array = NDArray[np.float64]

# Beyond this product OMPL takes two quaternions for equal and keeps the first.
SAME_QUATERNION = 1.0 - 1e-9


def poses(robot: RigidRobot, configurations: ArrayLike) -> Array:
    """Poses (m, 7) of configurations (m, d) or (d,).

    Raises:
        GeometryError: if they are no configurations of finite numbers, or the robot is not rigid.
    """
    check_rigid(robot)
    values = checked_configurations(configurations, robot.configuration_size)
    n = robot.dimension
    out = np.zeros((len(values), 7))
    out[:, :n] = values[:, :n]
    if robot.orientation is not None:
        out[:, 3:] = rotation_quaternion(robot.orientation)
    elif n == 2:
        out[:, 5], out[:, 6] = np.sin(0.5 * values[:, 2]), np.cos(0.5 * values[:, 2])
    else:
        out[:, 3:] = values[:, 3:]
    return out


def configurations_from_poses(robot: RigidRobot, rows: Array) -> Array:
    """Configurations (m, d) of poses (m, 7).

    Raises:
        GeometryError: if the robot is not rigid.
    """
    check_rigid(robot)
    n = robot.dimension
    if not robot.rotates:
        return rows[:, :n].copy()
    if n == 3:
        return rows.copy()
    yaw = [normalised_heading(2.0 * math.atan2(row[5], row[6])) for row in rows]
    return np.column_stack([rows[:, :2], yaw])


def rotation_quaternion(rotation: ArrayLike) -> Array:
    """Quaternion (4,) of a rotation (2, 2) or (3, 3)."""
    matrix = np.asarray(rotation, dtype=float)
    if matrix.shape == (3, 3):
        return quaternion_from_rotation(matrix)
    half = 0.5 * yaw_from_rotation(matrix)
    return np.array([0.0, 0.0, math.sin(half), math.cos(half)])


def interpolate(robot: RigidRobot, first: ArrayLike, second: ArrayLike, s: float) -> Array:
    """The configuration (d,) at ``s`` in [0, 1], as OMPL interpolates.

    Position is linear, headings take the shortest way, quaternions the shortest arc; below a
    rotation of about 9e-5 rad OMPL keeps the first orientation.

    Raises:
        GeometryError: as :func:`poses`, and for more than one configuration.
    """
    check_rigid(robot)
    a = checked_configuration(first, robot.configuration_size)
    b = checked_configuration(second, robot.configuration_size)
    n = robot.dimension
    out = a + s * (b - a)
    if not robot.rotates:
        return out
    if n == 2:
        out[2] = heading_between(a[2], b[2], s)
    else:
        out[3:] = rotation_between(a[3:], b[3:], s)
    return out


def heading_between(first: float, second: float, s: float) -> float:
    """The heading [rad] at ``s`` in [0, 1] of the shorter way, as SO2StateSpace interpolates."""
    return normalised_heading(first + s * math.remainder(second - first, 2.0 * math.pi))


def rotation_between(first: Array, second: Array, s: float) -> Array:
    """The quaternion (4,) at ``s`` in [0, 1] of the shorter arc, as SO3StateSpace interpolates."""
    product = float(first @ second)
    if abs(product) > SAME_QUATERNION:
        return first
    angle = math.acos(abs(product))
    sign = -1.0 if product < 0.0 else 1.0
    mixed = math.sin((1.0 - s) * angle) * first + sign * math.sin(s * angle) * second
    return np.asarray(mixed / math.sin(angle))
