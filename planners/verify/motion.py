"""OMPL's interpolation, and how far it moves a robot, for many configurations at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.robot import Robot
from planners.verify.coordinates import coordinates

Array = NDArray[np.float64]

SAME_QUATERNION = 1e-9
"""OMPL takes quaternions for equal whose product is this close to 1, and keeps the first."""


def interpolate(robot: Robot, first: Array, second: Array, s: Array) -> Array:
    """Configurations (k, d) at s (k,) in [0, 1] of the motions from first to second (k, d)."""
    known = coordinates(robot)
    out = first + s[:, None] * (second - first)
    for angle in known.angles:
        at = angle.place.start
        out[:, at] = first[:, at] + s * turn_between(first[:, at], second[:, at])
    for quaternion in known.quaternions:
        out[:, quaternion.place] = _slerp(
            first[:, quaternion.place], second[:, quaternion.place], s
        )
    return out


def _slerp(first: Array, second: Array, s: Array) -> Array:
    angle, sign = _arc(first, second)
    same = angle == 0.0
    sine = np.where(same, 1.0, np.sin(angle))
    begin = np.where(same, 1.0, np.sin((1.0 - s) * angle) / sine)
    end = np.where(same, 0.0, sign * np.sin(s * angle) / sine)
    return begin[:, None] * first + end[:, None] * second


def turn_between(first: Array, second: Array) -> Array:
    """The shortest turn between headings; a half-turn goes the direct way, as in OMPL."""
    turn = second - first
    around = np.where(turn > 0.0, turn - 2.0 * np.pi, turn + 2.0 * np.pi)
    return np.where(np.abs(turn) <= np.pi, turn, around)


def _arc(first: Array, second: Array) -> tuple[Array, Array]:
    """OMPL's arc length between unit quaternions (k, 4), half the rotation, and the sign."""
    product = np.sum(first * second, axis=1)
    length = np.abs(product)
    apart = length <= 1.0 - SAME_QUATERNION
    return np.where(apart, np.arccos(np.minimum(length, 1.0)), 0.0), np.where(product < 0, -1.0, 1)


def speeds(robot: Robot, first: Array, second: Array) -> Array:
    """A bound (k,) of how far any point of the robot travels in the motions first to second."""
    known = coordinates(robot)
    own = np.zeros(len(first))
    for turn in (*known.angles, *known.quaternions):
        if not turn.joint:
            own += turn.reach * _turned(first[:, turn.place], second[:, turn.place])
    return _travel(robot, first, second) + own + joint_speeds(robot, first, second)


def joint_speeds(robot: Robot, first: Array, second: Array) -> Array:
    """A bound (k,) of how far any point of the robot travels as its base sees it."""
    known = coordinates(robot)
    bound = np.zeros(len(first))
    for joint in known.numbers:
        at = joint.place.start
        bound += joint.reach * np.abs(second[:, at] - first[:, at])
    for turn in (*known.angles, *known.quaternions):
        if turn.joint:
            bound += turn.reach * _turned(first[:, turn.place], second[:, turn.place])
    return bound


def _turned(first: Array, second: Array) -> Array:
    """The angles (k,) between headings (k, 1) or quaternions (k, 4)."""
    if first.shape[1] == 1:
        return np.abs(turn_between(first[:, 0], second[:, 0]))
    return 2.0 * _arc(first, second)[0]


def _travel(robot: Robot, first: Array, second: Array) -> Array:
    n = coordinates(robot).position
    return np.asarray(np.linalg.norm(second[:, :n] - first[:, :n], axis=1))


def lengths(robot: Robot, path: Array) -> tuple[float, float]:
    """OMPL's length of a path (m, d), and how far its base travels."""
    first, second = path[:-1], path[1:]
    known = coordinates(robot)
    steps = _travel(robot, first, second)
    travel = float(np.sum(steps))
    for joint in known.numbers:
        at = joint.place.start
        steps = steps + joint.weight * np.abs(second[:, at] - first[:, at])
    for angle in known.angles:
        steps = steps + angle.weight * _turned(first[:, angle.place], second[:, angle.place])
    for turn in known.quaternions:
        steps = steps + turn.weight * _arc(first[:, turn.place], second[:, turn.place])[0]
    return float(np.sum(steps)), travel
