"""Rotations of the families' scenes, in two and three dimensions alike."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.orientation import (
    quaternion_from_rotation,
    rotation_from_quaternion,
    rotation_from_yaw,
    yaw_from_rotation,
)

Array = NDArray[np.float64]


def turn(dimension: int, yaw_deg: float, tilt_deg: float = 0.0, roll_deg: float = 0.0) -> Array:
    """Rz(yaw) Ry(tilt) Rx(roll), shape (n, n); in the plane the rotation by yaw alone."""
    yaw = math.radians(yaw_deg)
    if dimension == 2:
        return rotation_from_yaw(yaw)
    return about(2, yaw) @ about(1, math.radians(tilt_deg)) @ about(0, math.radians(roll_deg))


def about(axis: int, angle: float) -> Array:
    """The (3, 3) rotation by an angle [rad] about a coordinate axis."""
    quaternion = np.zeros(4)
    quaternion[axis], quaternion[3] = math.sin(angle / 2.0), math.cos(angle / 2.0)
    return rotation_from_quaternion(quaternion)


def axis_angle_between(first: Array, second: Array) -> float:
    """The angle [rad] between two lines, from 0 to a quarter turn, of unit vectors (n,)."""
    return math.acos(min(1.0, abs(float(first @ second))))


def configuration(position: Array, rotation: Array) -> Array:
    """The configuration (d,) of a base position (n,) and a rotation (n, n), base to world."""
    if len(position) == 2:
        return np.append(position, yaw_from_rotation(rotation))
    return np.concatenate([position, quaternion_from_rotation(rotation)])
