"""Proves that nothing meets anywhere along motions, by halving intervals until each is decided."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planners.verify.intervals import Intervals, Pairs, Places
from planners.verify.proof_of_gaps import Answer
from planners.verify.unrolled import Motions

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_MOST_LOOKS = 60_000
_MORE_A_MOTION = 50
_MOST_AT_ONCE = 20_000
_NARROWEST = 2.0**-50


class Gaps(Protocol):
    """Bodies that a robot's parts must keep away from, or inside of."""

    def pairs(self, intervals: Intervals) -> Pairs:
        """Every pair in every interval, but for those that are obviously far apart."""

    def answer(self, intervals: Intervals, pairs: Pairs) -> Answer:
        """What can be proved of ``pairs``."""

    def names(self, part: int, other: int) -> tuple[str, str, str]:
        """What kind of meeting it would be, and the names of the two."""


@dataclass(frozen=True)
class Place:
    """Two bodies at one place of a path.

    Attributes:
        kind: "obstacle", "arena" or "self".
        part, body: their names.
        motion, s: the motion's index and the fraction of it.
        gap, distance: bounds of their distance from below and above.
        meet: whether they certainly meet.
    """

    kind: str
    part: str
    body: str
    motion: int
    s: float
    gap: float
    distance: float
    meet: bool


@dataclass(frozen=True, eq=False)
class Resolution:
    """What could be decided of motions.

    Attributes:
        worst: among the places that could not be proved, that of the deepest contact or, without
            one, of the smallest gap; None if everything was proved.
        nearest: of the smallest distance at any place that was looked at closely.
        undecided: (k, 3), row of the motion, begin and end of the intervals that were not proved.
    """

    worst: Place | None
    nearest: Place | None
    undecided: Array


@dataclass(frozen=True, eq=False)
class _Round:
    """Pairs in intervals, and what is known of them."""

    motions: Motions
    gaps: Gaps
    intervals: Intervals
    pairs: Pairs
    answer: Answer

    def place(self, k: int) -> Place:
        """Where the middle of a pair's interval is, and what is there."""
        at = self.pairs.interval[k]
        return Place(
            *self.gaps.names(int(self.pairs.part[k]), int(self.pairs.other[k])),
            int(self.motions.index[self.intervals.motion[at]]),
            float(self.intervals.middle[at]),
            float(self.answer.gap[k]),
            float(self.answer.distance[k]),
            bool(self.answer.meet[k]),
        )

    def nearest(self) -> list[Place]:
        """The smallest distance, if there is any."""
        k = int(np.argmin(self.answer.distance))
        return [self.place(k)] if np.isfinite(self.answer.distance[k]) else []

    def worst(self, rows: Indices) -> list[Place]:
        """The deepest contact of pairs, or their smallest gap, if there are any."""
        if not len(rows):
            return []
        return [self.place(rows[np.lexsort((self.answer.gap[rows], ~self.answer.meet[rows]))[0]])]

    def spans(self, rows: Indices) -> Array:
        """Row of the motion, begin and end (k, 3) of pairs' intervals."""
        at, intervals = self.pairs.interval[rows], self.intervals
        return np.stack([intervals.motion[at], intervals.begin[at], intervals.end[at]], axis=1)


def resolve(motions: Motions, places: Places, gaps: Gaps) -> Resolution:
    """Ask of every pair of bodies, in every motion, whether it keeps apart.

    Intervals that cannot be answered at once are halved. It ends at a contact, at a place where
    rounding hides the answer, or when the budget is spent; what is left is not proved.
    """
    worst: list[Place] = []
    nearest: list[Place] = []
    undecided: list[Array] = []
    intervals = places.whole()
    pairs = gaps.pairs(intervals)
    looks = 0
    while len(pairs):
        now = _Round(motions, gaps, intervals, pairs, _answered(gaps, intervals, pairs))
        looks += int(np.sum(np.isfinite(now.answer.distance)))
        ending = looks > _MOST_LOOKS + _MORE_A_MOTION * len(motions.index) or bool(
            now.answer.meet.any()
        )
        narrow = intervals.width[pairs.interval] < _NARROWEST
        given_up = ~now.answer.proved & (now.answer.stuck | narrow | ending)
        rows = np.flatnonzero(given_up)
        worst += now.worst(rows)
        nearest += now.nearest()
        undecided.append(now.spans(rows))
        left = ~now.answer.proved & ~given_up
        intervals, pairs = _halved(places, intervals, pairs.taken(left), now.answer.direction[left])
    return Resolution(
        min(worst, key=lambda place: (not place.meet, place.gap), default=None),
        min(nearest, key=lambda place: place.distance, default=None),
        np.concatenate([np.zeros((0, 3)), *undecided]),
    )


def _answered(gaps: Gaps, intervals: Intervals, pairs: Pairs) -> Answer:
    """As `Gaps.answer`, so many at a time that memory suffices."""
    starts = range(0, len(pairs), _MOST_AT_ONCE)
    found = [gaps.answer(intervals, pairs.taken(slice(i, i + _MOST_AT_ONCE))) for i in starts]
    names = ("proved", "stuck", "meet", "gap", "distance", "direction")
    return Answer(*(np.concatenate([getattr(x, name) for x in found]) for name in names))


def _halved(
    places: Places, intervals: Intervals, pairs: Pairs, direction: Array
) -> tuple[Intervals, Pairs]:
    """The halves of the intervals that pairs are left in, and these pairs in both halves."""
    chosen, interval = np.unique(pairs.interval, return_inverse=True)
    halves = places.halves(intervals, chosen)
    both = np.concatenate([interval, len(chosen) + interval])
    rest = (np.concatenate([x, x]) for x in (pairs.part, pairs.other, direction))
    return halves, Pairs(both, *rest)


def undecided_share(resolution: Resolution, lengths: Array) -> float:
    """How much of the motions, of ``lengths`` (M,), lies in intervals that were not proved."""
    spans, total = resolution.undecided, 0.0
    for row in np.unique(spans[:, 0]).astype(np.intp):
        own = spans[spans[:, 0] == row]
        own = own[np.argsort(own[:, 1])]
        before = np.maximum.accumulate(np.concatenate([[0.0], own[:-1, 2]]))
        fresh = own[:, 2] - np.maximum(own[:, 1], before)
        total += float(lengths[row] * np.sum(np.maximum(fresh, 0.0)))
    return total / float(np.sum(lengths)) if np.sum(lengths) > 0.0 else float(len(spans) > 0)
