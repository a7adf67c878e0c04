"""OMPL's interpolation, and where it puts the robot, for many configurations at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.rigid import RigidRobot

Array = NDArray[np.float64]

# OMPL takes quaternions for equal whose product is this close to 1, and keeps the first.
_SAME_QUATERNION = 1e-9


def interpolate(robot: RigidRobot, first: Array, second: Array, s: Array) -> Array:
    """Configurations (k, d) at s (k,) in [0, 1] of the motions from first to second (k, d)."""
    n = robot.dimension
    out = first + s[:, None] * (second - first)
    if not robot.rotates:
        return out
    if n == 2:
        out[:, 2] = first[:, 2] + s * _turn(first[:, 2], second[:, 2])
        return out
    angle, sign = _arc(first[:, 3:], second[:, 3:])
    same = angle == 0.0
    sine = np.where(same, 1.0, np.sin(angle))
    begin = np.where(same, 1.0, np.sin((1.0 - s) * angle) / sine)
    end = np.where(same, 0.0, sign * np.sin(s * angle) / sine)
    out[:, 3:] = begin[:, None] * first[:, 3:] + end[:, None] * second[:, 3:]
    return out


def _turn(first: Array, second: Array) -> Array:
    """The shortest turn between headings; a half-turn goes the direct way, as in OMPL."""
    turn = second - first
    around = np.where(turn > 0.0, turn - 2.0 * np.pi, turn + 2.0 * np.pi)
    return np.where(np.abs(turn) <= np.pi, turn, around)


def _arc(first: Array, second: Array) -> tuple[Array, Array]:
    """OMPL's arc length between unit quaternions (k, 4), half the rotation, and the sign."""
    product = np.sum(first * second, axis=1)
    length = np.abs(product)
    apart = length <= 1.0 - _SAME_QUATERNION
    return np.where(apart, np.arccos(np.minimum(length, 1.0)), 0.0), np.where(product < 0, -1.0, 1)


def speeds(robot: RigidRobot, first: Array, second: Array) -> Array:
    """A bound (k,) of how far any point of the robot travels in the motions first to second."""
    n = robot.dimension
    travel = np.linalg.norm(second[:, :n] - first[:, :n], axis=1)
    if not robot.rotates:
        return travel
    if n == 2:
        turn = np.abs(_turn(first[:, 2], second[:, 2]))
    else:
        turn = 2.0 * _arc(first[:, 3:], second[:, 3:])[0]
    reach = max(np.linalg.norm(p.centre) + np.max(p.semi_axes) for p in robot.parts)
    return travel + turn * float(reach)


def lengths(robot: RigidRobot, path: Array) -> tuple[float, float]:
    """OMPL's length of a path (m, d), and how far its base travels."""
    first, second = path[:-1], path[1:]
    n = robot.dimension
    travel = float(np.sum(np.linalg.norm(second[:, :n] - first[:, :n], axis=1)))
    if not robot.rotates:
        return travel, travel
    if n == 2:
        return travel + 0.5 * float(np.sum(np.abs(_turn(first[:, 2], second[:, 2])))), travel
    return travel + float(np.sum(_arc(first[:, 3:], second[:, 3:])[0])), travel


def placements(robot: RigidRobot, configurations: Array) -> tuple[Array, Array]:
    """Base positions (k, n) and rotations (k, n, n) of configurations (k, d)."""
    n = robot.dimension
    positions = configurations[:, :n]
    if robot.orientation is not None:
        shape = (len(configurations), n, n)
        return positions, np.broadcast_to(robot.orientation, shape)
    if n == 2:
        cosine, sine = np.cos(configurations[:, 2]), np.sin(configurations[:, 2])
        rows = [[cosine, -sine], [sine, cosine]]
        return positions, np.moveaxis(np.array(rows), -1, 0)
    unit = configurations[:, 3:] / np.linalg.norm(configurations[:, 3:], axis=1, keepdims=True)
    return positions, _rotations(unit)


def _rotations(quaternions: Array) -> Array:
    x, y, z, w = quaternions.T
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
