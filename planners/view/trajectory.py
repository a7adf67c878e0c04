"""A path followed at constant speed, sampled for drawing and animation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, REVOLUTE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.robots import Robot

MOST_TURN = 0.3  # of a joint between two samples [rad]


class InterpolatedSpace(Protocol):
    """What a trajectory needs of a `CSpace`: OMPL's metric and OMPL's interpolation."""

    @property
    def robot(self) -> Robot:
        """The robot that moves."""
        ...

    def distance(self, first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
        """Return OMPL's distance of two configurations (d,)."""
        ...

    def interpolate(
        self, first: NDArray[np.float64], second: NDArray[np.float64], s: float
    ) -> NDArray[np.float64]:
        """Return the configuration (d,) at the fraction s of the motion."""
        ...


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Samples along a path.

    Attributes:
        configurations: (m, d); every corner of the path is among them.
        travelled: (m,), the length from the start in OMPL's metric, non-decreasing.
    """

    configurations: NDArray[np.float64]
    travelled: NDArray[np.float64]

    @property
    def fractions(self) -> NDArray[np.float64]:
        """The travelled length as a fraction of the whole, (m,); zeros for a path of length 0."""
        length = self.travelled[-1]
        return self.travelled / length if length > 0.0 else np.zeros_like(self.travelled)

    def evenly(self, count: int) -> NDArray[np.float64]:
        """Return up to `count` of the samples, evenly spaced in the metric, both ends included."""
        wanted = np.linspace(0.0, 1.0, count)
        return self.configurations[nearest_indices(self.fractions, wanted)]


def nearest_indices(
    ascending: NDArray[np.float64], wanted: NDArray[np.float64]
) -> NDArray[np.intp]:
    """Return the distinct indices of the entries of `ascending` (m,) nearest to `wanted` (k,)."""
    right = np.clip(np.searchsorted(ascending, wanted), 1, max(len(ascending) - 1, 1))
    right = np.minimum(right, len(ascending) - 1)
    left = np.maximum(right - 1, 0)
    closer_left = wanted - ascending[left] <= ascending[right] - wanted
    return np.unique(np.where(closer_left, left, right))


def follow(
    space: InterpolatedSpace, configurations: Sequence[ArrayLike] | ArrayLike, samples: int = 400
) -> Trajectory:
    """Follow a path (k, d), interpolating exactly as OMPL does.

    Each motion gets its share of about `samples` samples by its length in OMPL's metric, and
    more where a joint turns far in it.
    """
    corners = np.atleast_2d(np.asarray(configurations, dtype=float))
    lengths = [space.distance(first, second) for first, second in pairwise(corners)]
    total = sum(lengths)
    points, travelled = [corners[0]], [0.0]
    for (first, second), length in zip(pairwise(corners), lengths, strict=True):
        steps = max(1, round(samples * length / total)) if total > 0.0 else 1
        steps = max(steps, math.ceil(_most_turn(space.robot, second - first) / MOST_TURN))
        begin = travelled[-1]
        for step in range(1, steps):
            points.append(np.asarray(space.interpolate(first, second, step / steps)))
            travelled.append(begin + length * step / steps)
        points.append(second)
        travelled.append(begin + length)
    return Trajectory(np.array(points), np.array(travelled))


def _most_turn(robot: Robot, difference: NDArray[np.float64]) -> float:
    """The farthest that a joint about an axis may turn between configurations so different.

    A joint with limits can go more than half a turn the long way, which a drawing that takes
    the shortest way from sample to sample would not follow.
    """
    turning = {joint.name for joint in robot.joints if joint.type in (REVOLUTE, CONTINUOUS)}
    turns = [abs(difference[robot.joint_slices[name]][0]) for name in turning]
    return float(max(turns, default=0.0))


def unwound(robot: Robot, configurations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return configurations (m, d) without jumps from row to row.

    Headings and continuous joints go on beyond ±pi, and quaternions keep the sign that is nearer
    to the row before.
    """
    rows = np.array(configurations, dtype=float)
    for where in _turning(robot):
        if where.stop - where.start == 1:
            rows[:, where] = np.unwrap(rows[:, where], axis=0)
            continue
        products = np.sum(rows[1:, where] * rows[:-1, where], axis=1)
        rows[1:, where] *= np.cumprod(np.where(products < 0.0, -1.0, 1.0))[:, None]
    return rows


def _turning(robot: Robot) -> list[slice]:
    """Where headings, continuous joints and quaternions stand in a configuration."""
    n, joints = robot.dimension, {joint.name: joint.type for joint in robot.joints}
    base = [slice(n, robot.base_size)] if robot.rotates and robot.base_size > n else []
    turning = (CONTINUOUS, BALL)
    return base + [at for name, at in robot.joint_slices.items() if joints[name] in turning]
