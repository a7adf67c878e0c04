"""What a robot must keep away from throughout its motions: obstacles and itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from planners.verify.bends import bends, robot_extent
from planners.verify.intervals import Intervals, Pairs
from planners.verify.proof_of_gaps import Answer, Question, Setting, answer, spheres_apart
from planners.verify.unrolled import Motions

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_LARGEST_BATCH = 500_000
ROUNDING = 32.0 * np.finfo(float).eps


@dataclass(frozen=True, eq=False)
class Bodies:
    """Bodies (B,) that rest: centres (B, n), matrices (B, n, n), largest semi-axes (B,), names."""

    centres: Array
    matrices: Array
    radii: Array
    names: tuple[str, ...]

    @classmethod
    def of(cls, bodies: tuple[Ellipsoid, ...], dimension: int) -> Bodies:
        """Take the numbers out of ``bodies``."""
        return cls(
            np.array([body.centre for body in bodies]).reshape(-1, dimension),
            np.array([body.matrix for body in bodies]).reshape(-1, dimension, dimension),
            np.array([np.max(body.semi_axes) for body in bodies]),
            tuple(body.name for body in bodies),
        )


class Moving:
    """A robot's parts in motions: their sizes, and how far they bend and are uncertain."""

    def __init__(self, motions: Motions, *, from_base: bool = False) -> None:
        """Bound the ``motions``, in the world or as the base sees them."""
        robot = motions.robot
        self.names = tuple(part.name for part in robot.parts)
        self.radii = np.array([np.max(part.semi_axes) for part in robot.parts])
        self._bends = bends(motions)[1 if from_base else 0]
        self._extent = robot_extent(robot, motions)
        # Every joint multiplies and adds once more.
        self._rounding = ROUNDING * (1.0 + len(robot.joints))

    def bend(self, intervals: Intervals, interval: Indices, part: Indices) -> Array:
        """How far (k,) points of parts depart from straight lines in intervals."""
        width = intervals.width[interval]
        return self._bends[intervals.motion[interval], part] * width * width / 8.0

    def doubt(self, intervals: Intervals, interval: Indices, part: Indices) -> Array:
        """Rounding (k,) of parts' places, as a length."""
        far = [np.linalg.norm(intervals.centres[k][interval, part], axis=1) for k in (0, 2)]
        return self._rounding * (np.maximum(*far) + self._extent)


class FromObstacles:
    """Gaps between a robot's parts and obstacles."""

    def __init__(self, motions: Motions, obstacles: Bodies, needed: float) -> None:
        """Ask for gaps larger than ``needed``."""
        self._moving, self._obstacles, self._needed = Moving(motions), obstacles, needed

    def names(self, part: int, other: int) -> tuple[str, str, str]:
        """The kind and the names."""
        return "obstacle", self._moving.names[part], self._obstacles.names[other]

    def pairs(self, intervals: Intervals) -> Pairs:
        """Parts and obstacles whose bounding spheres could meet."""
        found = [np.zeros((3, 0), dtype=np.intp)]
        parts, count = np.arange(len(self._moving.names)), len(intervals.motion)
        at_once = max(1, _LARGEST_BATCH // max(1, len(parts) * len(self._obstacles.names)))
        for i in range(0, count, at_once):
            rows = np.arange(i, min(i + at_once, count))
            near = self._near(intervals, np.repeat(rows, len(parts)), np.tile(parts, len(rows)))
            found.append(near)
        interval, part, other = np.concatenate(found, axis=1)
        return Pairs(
            interval, part, other, np.zeros((len(interval), intervals.centres[0].shape[2]))
        )

    def _near(self, intervals: Intervals, interval: Indices, part: Indices) -> Indices:
        begin, end = (
            self._obstacles.centres - intervals.centres[k][interval, part][:, None] for k in (0, 2)
        )
        own = self._moving.radii[part] + self._moving.bend(intervals, interval, part)
        own += self._moving.doubt(intervals, interval, part) + self._needed
        around = self._obstacles.radii + ROUNDING * np.linalg.norm(self._obstacles.centres, axis=1)
        row, other = np.nonzero(~spheres_apart(begin, end, own[:, None] + around))
        return np.array([interval[row], part[row], other])

    def answer(self, intervals: Intervals, pairs: Pairs) -> Answer:
        """Which of them keep apart."""
        obstacles, moving = self._obstacles, self._moving
        second, at = obstacles.matrices[pairs.other], obstacles.centres[pairs.other]
        settings = tuple(
            Setting(
                intervals.matrices[k][pairs.interval, pairs.part],
                second,
                at - intervals.centres[k][pairs.interval, pairs.part],
            )
            for k in range(3)
        )
        radii = moving.radii[pairs.part] + obstacles.radii[pairs.other]
        doubt = moving.doubt(intervals, pairs.interval, pairs.part)
        doubt += ROUNDING * (np.linalg.norm(at, axis=1) + radii)
        bend = moving.bend(intervals, pairs.interval, pairs.part)
        return answer(Question(settings, radii, bend, doubt, self._needed), pairs.proposal)


class FromItself:
    """Gaps between a robot's own parts, as its base sees them."""

    def __init__(self, motions: Motions, pairs: list[tuple[int, int]]) -> None:
        """Ask for gaps between ``pairs`` of parts."""
        self._moving, self._pairs = Moving(motions, from_base=True), pairs

    def names(self, part: int, other: int) -> tuple[str, str, str]:
        """The kind and the names."""
        return "self", self._moving.names[part], self._moving.names[other]

    def pairs(self, intervals: Intervals) -> Pairs:
        """Every pair in every interval."""
        one, two = np.array(self._pairs, dtype=np.intp).T
        count, n = len(intervals.motion), intervals.centres[0].shape[2]
        interval = np.repeat(np.arange(count), len(one))
        none = np.zeros((len(interval), n))
        return Pairs(interval, np.tile(one, count), np.tile(two, count), none)

    def answer(self, intervals: Intervals, pairs: Pairs) -> Answer:
        """Which of them keep apart."""
        moving, at = self._moving, pairs.interval
        settings = tuple(
            Setting(
                intervals.matrices[k][at, pairs.part],
                intervals.matrices[k][at, pairs.other],
                intervals.centres[k][at, pairs.other] - intervals.centres[k][at, pairs.part],
            )
            for k in range(3)
        )
        both = pairs.part, pairs.other
        radii = np.sum([moving.radii[part] for part in both], axis=0)
        bend = np.sum([moving.bend(intervals, at, part) for part in both], axis=0)
        doubt = np.sum([moving.doubt(intervals, at, part) for part in both], axis=0)
        doubt += ROUNDING * radii
        return answer(Question(settings, radii, bend, doubt, 0.0), pairs.proposal)
