"""Proves that two bodies stay apart throughout intervals, of which at least one moves.

The proof is a direction u in which they lie apart at both ends. A material point stays within
K w^2 / 8 of the straight line between its places at the ends (see `bends`). If all of them moved
along these lines, the gap along u, a minimum of functions that change evenly, would be concave
and hence least at an end. So the bodies stay apart if the smaller gap exceeds what both bend.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.directions import unit_directions
from planners.verify.ascent import ascend, difference, value
from planners.verify.separation import nearest_directions

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]

_STARTS = {2: 64, 3: 256}


@dataclass(frozen=True, eq=False)
class Setting:
    """Two bodies of each of k pairs at one moment: matrices (k, n, n), and how far apart (k, n)."""

    first: Array
    second: Array
    offset: Array

    def taken(self, rows: Indices) -> Setting:
        """Some of the pairs."""
        return Setting(self.first[rows], self.second[rows], self.offset[rows])

    def gap(self, u: Array) -> Array:
        """How far (k,) the bodies lie apart along directions (k, n)."""
        return value(u, self.offset, self.first, self.second, 1.0)


@dataclass(frozen=True, eq=False)
class Question:
    """Pairs of bodies at the begin, the middle and the end of intervals.

    Attributes:
        settings: at these three.
        radii: (k,), the sums of the bodies' largest semi-axes.
        bend: (k,), how far their points together depart from straight lines.
        doubt: (k,), rounding, as a length.
        needed: (k,), the gap that is to be proved.
    """

    settings: tuple[Setting, ...]
    radii: Array
    bend: Array
    doubt: Array
    needed: float

    def taken(self, rows: Indices) -> Question:
        """Some of the pairs."""
        settings = tuple(setting.taken(rows) for setting in self.settings)
        return Question(settings, self.radii[rows], self.bend[rows], self.doubt[rows], self.needed)


@dataclass(frozen=True, eq=False)
class Answer:
    """What is known of k pairs.

    Attributes:
        proved: (k,), True where they keep apart throughout.
        stuck: (k,), True where even the middle of the interval cannot be decided or fails.
        meet: (k,), True where they certainly meet in the middle.
        gap, distance: (k,), in the middle: bounds of the distance from below and above; infinite
            where nobody had to look closely.
        direction: (k, n), along which the gap is largest there.
    """

    proved: Mask
    stuck: Mask
    meet: Mask
    gap: Array
    distance: Array
    direction: Array


def spheres_apart(begin: Array, end: Array, spare: Array) -> Mask:
    """Whether offsets that move from ``begin`` to ``end`` (..., n) stay longer than ``spare``."""
    along = end - begin
    squared = np.sum(along * along, axis=-1)
    t = -np.sum(begin * along, axis=-1) / np.where(squared > 0.0, squared, 1.0)
    nearest = begin + np.clip(t, 0.0, 1.0)[..., None] * along
    return np.asarray(np.sum(nearest * nearest, axis=-1) > np.square(spare))


def proved_by(question: Question, u: Array) -> Mask:
    """Whether directions (k, n) prove that bodies keep apart throughout."""
    begin, _, end = question.settings
    least = np.minimum(begin.gap(u), end.gap(u))
    return least - question.bend - question.doubt > question.needed


def answer(question: Question, proposal: Array) -> Answer:
    """Try directions for pairs (k,): the ``proposal`` (k, n), cheap ones, then the best."""
    begin, middle, end = question.settings
    spare = question.radii + question.bend + question.doubt + question.needed
    proved = spheres_apart(begin.offset, end.offset, spare)
    for u in (proposal, _unit(middle.offset), _normals(middle)):
        rows = np.flatnonzero(~proved)
        proved[rows] = proved_by(question.taken(rows), u[rows])
    count = len(proved)
    rows = np.flatnonzero(~proved)
    stuck, meet = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    gap, distance = np.full(count, np.inf), np.full(count, np.inf)
    direction = np.zeros_like(proposal)
    if len(rows):
        asked = question.taken(rows)
        direction[rows], meet[rows], gap[rows], distance[rows] = _in_the_middle(asked)
        proved[rows] = proved_by(asked, direction[rows])
        stuck[rows] = ~proved[rows] & (gap[rows] <= question.needed)
    return Answer(proved, stuck, meet, gap, distance, direction)


def _in_the_middle(question: Question) -> tuple[Array, Mask, Array, Array]:
    """Best directions there, who certainly meets, and bounds of the distance."""
    middle = question.settings[1]
    u, meet = nearest_directions(middle.first, middle.second, middle.offset)
    doubtful = np.flatnonzero(~meet & (middle.gap(u) - question.doubt <= question.needed))
    if len(doubtful):
        # The search may have ended early: begin it elsewhere before giving up.
        u[doubtful] = _searched(middle.taken(doubtful), u[doubtful])
    # A contact counts only where rounding in the bodies' places cannot have made it.
    meet &= middle.gap(u) < -question.doubt
    gap = middle.gap(u) - question.doubt
    apart = difference(u, middle.offset, middle.first, middle.second, 1.0)
    return u, meet, gap, np.linalg.norm(apart, axis=1) + question.doubt


def _searched(setting: Setting, u: Array) -> Array:
    starts = unit_directions(u.shape[1], _STARTS[u.shape[1]])
    wide = [
        np.linalg.norm(np.einsum("kij,pi->kpj", matrices, starts), axis=2)
        for matrices in (setting.first, setting.second)
    ]
    best = starts[np.argmax(setting.offset @ starts.T - wide[0] - wide[1], axis=1)]
    other = ascend(best, setting.offset, setting.first, setting.second, 1.0)
    return np.where((setting.gap(other) > setting.gap(u))[:, None], other, u)


def _normals(setting: Setting) -> Array:
    """The second bodies' normals that point away from the first's centres."""
    inverse = np.linalg.inv(setting.second)
    ball = np.einsum("kij,kj->ki", inverse, setting.offset)
    return _unit(np.einsum("kji,kj->ki", inverse, ball))


def _unit(rows: Array) -> Array:
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.where(
        length > 0.0, rows / np.where(length > 0.0, length, 1.0), np.eye(rows.shape[1])[0]
    )
