"""Room that a robot's parts have inside arenas, throughout its motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.verify.ascent import value
from planners.verify.containment import narrowest_directions, room_at_least
from planners.verify.containment_proof import is_inside
from planners.verify.intervals import Intervals, Pairs
from planners.verify.proof_of_gaps import Answer
from planners.verify.questions import ROUNDING, Bodies, Moving
from planners.verify.unrolled import Motions

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


class InsideArenas:
    """Room that a robot's parts have inside arenas.

    An arena is convex, and so is its inside with a margin: what keeps its room at both ends of
    an interval, and bends by less, keeps it throughout.
    """

    def __init__(self, motions: Motions, arenas: Bodies, needed: float) -> None:
        """Ask for room of at least ``needed``."""
        self._moving, self._arenas, self._needed = Moving(motions), arenas, needed

    def names(self, part: int, other: int) -> tuple[str, str, str]:
        """The kind and the names."""
        return "arena", self._moving.names[part], self._arenas.names[other]

    def pairs(self, intervals: Intervals) -> Pairs:
        """Every part and arena in every interval."""
        shape = len(intervals.motion), len(self._moving.names), len(self._arenas.names)
        interval, part, other = (index.ravel() for index in np.indices(shape))
        return Pairs(
            interval, part, other, np.zeros((len(interval), intervals.centres[0].shape[2]))
        )

    def answer(self, intervals: Intervals, pairs: Pairs) -> Answer:
        """Which of them stay inside."""
        at, part = pairs.interval, pairs.part
        arenas, centres = self._arenas.matrices[pairs.other], self._arenas.centres[pairs.other]
        begin, middle, end = (
            (arenas, intervals.matrices[k][at, part], intervals.centres[k][at, part] - centres)
            for k in range(3)
        )
        doubt = self._moving.doubt(intervals, at, part)
        doubt += ROUNDING * (np.linalg.norm(centres, axis=1) + self._arenas.radii[pairs.other])
        room = self._moving.bend(intervals, at, part) + self._needed
        question = _Rooms((begin, middle, end), doubt, room, self._needed)
        least = [room_at_least(arenas, parts, offset) for arenas, parts, offset in (begin, end)]
        proved = np.minimum(*least) > room + doubt
        rows = np.flatnonzero(~proved)
        proved[rows] = question.taken(rows).kept_along(pairs.proposal[rows])
        return _looked_closer(question, proved)


@dataclass(frozen=True, eq=False)
class _Rooms:
    """Arenas' matrices, parts' and their offsets at three moments; doubt and room needed."""

    states: tuple[tuple[Array, ...], ...]
    doubt: Array
    room: Array
    needed: float

    def taken(self, rows: Indices) -> _Rooms:
        """Some of the pairs."""
        states = tuple(tuple(array[rows] for array in state) for state in self.states)
        return _Rooms(states, self.doubt[rows], self.room[rows], self.needed)

    def kept_along(self, u: Array) -> NDArray[np.bool_]:
        """Whether the room is kept at both ends, shown with directions (k, n)."""
        begin, _, end = self.states
        kept = is_inside(begin, self.room, u, self.doubt)
        rows = np.flatnonzero(kept)
        state = tuple(array[rows] for array in end)
        kept[rows] = is_inside(state, self.room[rows], u[rows], self.doubt[rows])
        return kept


def _looked_closer(question: _Rooms, proved: NDArray[np.bool_]) -> Answer:
    """What is known once the narrowest directions are searched where it was not proved."""
    count, n = question.states[0][2].shape
    stuck, meet = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    gap, distance, direction = np.full(count, np.inf), np.full(count, np.inf), np.zeros((count, n))
    rows = np.flatnonzero(~proved)
    if len(rows):
        asked = question.taken(rows)
        middle = asked.states[1]
        arenas, parts, offset = middle
        u = narrowest_directions(arenas, parts, offset)
        least = -value(u, offset, arenas, parts, -1.0)
        needed = np.full(len(rows), question.needed)
        direction[rows], meet[rows] = u, least < -asked.doubt
        gap[rows], distance[rows] = least - asked.doubt, least + asked.doubt
        proved[rows] = asked.kept_along(u)
        stuck[rows] = ~proved[rows] & ~is_inside(middle, needed, u, asked.doubt)
    return Answer(proved, stuck, meet, gap, distance, direction)
