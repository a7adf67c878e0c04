"""Intervals of motions, where the robot's parts are at their ends and in the middle, and pairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.verify.placement import part_placements
from planners.verify.unrolled import Motions

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Intervals:
    """Intervals (I,) of motions, and parts there: centres (I, P, n), matrices (I, P, n, n).

    Attributes:
        motion: (I,), rows of the motions.
        begin, end: (I,), fractions of the motion.
        centres, matrices: at the begin, the middle and the end.
    """

    motion: Indices
    begin: Array
    end: Array
    centres: tuple[Array, ...]
    matrices: tuple[Array, ...]

    @property
    def width(self) -> Array:
        """How long (I,) they are."""
        return self.end - self.begin

    @property
    def middle(self) -> Array:
        """Where (I,) they are halved."""
        return 0.5 * (self.begin + self.end)


@dataclass(frozen=True, eq=False)
class Pairs:
    """Questions (k,): does a part keep away from another body throughout an interval?

    Attributes:
        interval: rows of the intervals.
        part: parts of the robot.
        other: obstacles, arenas or other parts.
        proposal: (k, n), directions that may answer it; zero where none is known.
    """

    interval: Indices
    part: Indices
    other: Indices
    proposal: Array

    def __len__(self) -> int:
        return len(self.interval)

    def taken(self, chosen: Mask | Indices | slice) -> Pairs:
        """Some of the pairs."""
        own = self.interval[chosen], self.part[chosen], self.other[chosen]
        return Pairs(*own, self.proposal[chosen])


class Places:
    """Where parts are, for a robot's motions in the world, or as their base sees them."""

    def __init__(self, motions: Motions, *, from_base: bool = False) -> None:
        """Take the ``motions``; bases stay where they are if seen ``from_base``."""
        self._motions = motions
        self._from_base = from_base

    def whole(self) -> Intervals:
        """One interval a motion."""
        rows = np.arange(len(self._motions.index))
        begin, end = np.zeros(len(rows)), np.ones(len(rows))
        places = [self._at(rows, s) for s in (begin, 0.5 * (begin + end), end)]
        return Intervals(rows, begin, end, *_transposed(places))

    def halves(self, intervals: Intervals, chosen: Indices) -> Intervals:
        """The first halves of the chosen intervals, then the second halves."""
        motion, middle = intervals.motion[chosen], intervals.middle[chosen]
        begin, end = intervals.begin[chosen], intervals.end[chosen]
        known = [(intervals.centres[k][chosen], intervals.matrices[k][chosen]) for k in range(3)]
        first = self._at(motion, 0.5 * (begin + middle))
        second = self._at(motion, 0.5 * (middle + end))
        places = [_both(known[0], known[1]), _both(first, second), _both(known[1], known[2])]
        return Intervals(
            np.concatenate([motion, motion]),
            np.concatenate([begin, middle]),
            np.concatenate([middle, end]),
            *_transposed(places),
        )

    def _at(self, rows: Indices, s: Array) -> tuple[Array, Array]:
        robot = self._motions.robot
        configurations = self._motions.at(rows, s)
        if self._from_base and robot.base_size:
            configurations[:, : robot.base_size] = _resting_base(robot.base_size, robot.dimension)
        return part_placements(robot, configurations)


def _resting_base(size: int, dimension: int) -> Array:
    base = np.zeros(size)
    if dimension == 3 and size == 7:
        base[6] = 1.0
    return base


def _both(one: tuple[Array, Array], two: tuple[Array, Array]) -> tuple[Array, Array]:
    return np.concatenate([one[0], two[0]]), np.concatenate([one[1], two[1]])


def _transposed(places: list[tuple[Array, Array]]) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    return tuple(centres for centres, _ in places), tuple(matrices for _, matrices in places)
