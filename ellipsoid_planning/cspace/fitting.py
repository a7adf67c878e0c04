"""Fitting orientations: those at which a robot is narrowest along a direction.

The width of a robot along u is h(u) + h(−u), h being the support function of the union of its
parts: the least distance of two parallel walls of normal ±u that the robot fits between. As a
function of the direction in the robot's own frame it depends on nothing but the robot; its local
minimisers v give the fitting orientations R for a gap of normal u by R v = ±u.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.robots.rigid import RigidRobot, check_rigid

Array = NDArray[np.float64]

_HEADINGS = 720
_BISECTIONS = 60
_DIRECTIONS = 32
_SMALLEST_STEP = 1e-9
_ROUNDS = 25
_MORE_ROUNDS = 120
# How steps grow and shrink, and how their sides turn from one round to the next [rad].
_LONGER, _SHORTER = 1.5, 0.7
_GOLDEN = 0.25 * math.pi * (math.sqrt(5.0) - 1.0) / 2.0
# Local minimisers nearer to each other than this are one [rad].
_SAME = 1e-3
_ROUGHLY_SAME = 0.05


def width(robot: RigidRobot, directions: ArrayLike) -> Array:
    """Widths (m,) of the robot along unit ``directions`` (m, n) of its base frame.

    Raises:
        GeometryError: if the robot is not rigid.
    """
    check_rigid(robot)
    u = np.atleast_2d(np.asarray(directions, dtype=float))
    supports = np.array([[part.support(u), part.support(-u)] for part in robot.parts])
    return np.asarray(supports.max(axis=0).sum(axis=0))


@lru_cache(maxsize=64)
def narrowest_directions(robot: RigidRobot) -> Array:
    """Directions (m, n) in the base frame of the local minima of the robot's width.

    One of each pair ±v, the narrowest first. In 2-D they are all of them, to rounding; in 3-D
    those that a descent from 32 directions and the parts' axes finds.
    """
    found = _planar(robot) if robot.dimension == 2 else _spatial(robot)
    return found[np.argsort(width(robot, found), kind="stable")]


def _slope(robot: RigidRobot, angles: Array) -> Array:
    """Derivative of the planar width by the direction's angle, one-sided at kinks."""
    u = np.column_stack([np.cos(angles), np.sin(angles)])
    tangent = np.column_stack([-np.sin(angles), np.cos(angles)])
    slopes = np.zeros(len(angles))
    for sign in (1.0, -1.0):
        supports = np.array([part.support(sign * u) for part in robot.parts])
        points = np.array([part.support_points(sign * u) for part in robot.parts])
        farthest = points[np.argmax(supports, axis=0), np.arange(len(u))]
        slopes += np.sum(farthest * sign * tangent, axis=1)
    return slopes


def _planar(robot: RigidRobot) -> Array:
    angles = np.linspace(0.0, math.pi, _HEADINGS + 1)
    slopes = _slope(robot, angles)
    # Half a turn on it is the same direction, up to rounding.
    slopes[-1] = slopes[0]
    rising = np.flatnonzero((slopes[:-1] < 0.0) & (slopes[1:] >= 0.0))
    if len(rising) == 0:
        # A disc: every direction is as good as any other.
        return np.array([[1.0, 0.0]])
    low, high = angles[rising], angles[rising + 1]
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        falls = _slope(robot, middle) < 0.0
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    return np.column_stack([np.cos(low), np.sin(low)])


def _spatial(robot: RigidRobot) -> Array:
    axes = np.vstack([part.rotation.T for part in robot.parts])
    half_sphere = unit_directions(3, 2 * _DIRECTIONS)[:_DIRECTIONS]
    v = _descended(robot, np.vstack([axes, half_sphere]), 0.2, _ROUNDS)
    v = _distinct(v[np.argsort(width(robot, v), kind="stable")], _ROUGHLY_SAME)
    v = _descended(robot, v, 0.1, _MORE_ROUNDS)
    return _distinct(v[np.argsort(width(robot, v), kind="stable")], _SAME)


def _descended(robot: RigidRobot, v: Array, step: float, rounds: int) -> Array:
    """Directions (m, 3) moved downhill, by steps to eight sides that turn from round to round.

    Valleys are narrow, along creases and between the axes of long parts: none of a few fixed
    steps would lead down them.
    """
    values, steps = width(robot, v), np.full(len(v), step)
    sides = np.linspace(0.0, 2.0 * math.pi, 8, endpoint=False)
    rows = np.arange(len(v))
    for k in range(rounds):
        turns = sides + _GOLDEN * k
        first = np.cross(v, np.eye(3)[np.argmin(np.abs(v), axis=1)])
        first /= np.linalg.norm(first, axis=1, keepdims=True)
        second = np.cross(v, first)
        aside = np.cos(turns)[:, None] * first[:, None] + np.sin(turns)[:, None] * second[:, None]
        trials = v[:, None] + steps[:, None, None] * aside
        trials /= np.linalg.norm(trials, axis=2, keepdims=True)
        widths = width(robot, trials.reshape(-1, 3)).reshape(len(v), -1)
        best = np.argmin(widths, axis=1)
        better = widths[rows, best] < values
        v = np.where(better[:, None], trials[rows, best], v)
        values = np.where(better, widths[rows, best], values)
        steps = np.clip(np.where(better, _LONGER * steps, _SHORTER * steps), _SMALLEST_STEP, step)
    return v


def _distinct(directions: Array, same: float) -> Array:
    kept: list[Array] = []
    for v in directions:
        if all(1.0 - abs(float(v @ w)) > 0.5 * same**2 for w in kept):
            kept.append(v)
    return np.array(kept)
