"""A path's motions written out: which way every angle turns, and what OMPL does at its corners.

OMPL turns the shortest way. At a half-turn rounding decides which way that is, so both are
listed. It does not turn a quaternion by less than about 9e-5 rad: it keeps the first, and the
state after it is the second, so this jump is listed as a motion of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.robot import Robot
from planners.verify.coordinates import coordinates
from planners.verify.motion import SAME_QUATERNION, turn_between

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_DOUBT = 1e-12  # of the numbers that decide which way OMPL goes
_MOST_WAYS = 64  # of one motion, where several angles are in doubt


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions (M,), each of which turns and shifts at constant rates.

    Attributes:
        robot: what moves.
        index: (M,), the motion of the path that each belongs to.
        first: (M, d), where they begin.
        change: (M, d), how numbers and angles change; of quaternions it means nothing.
        arcs: (M, Q), how far quaternions travel on their sphere, half the turn; 0 if they rest.
        ends: (M, Q, 4), where they end, with the sign that makes the arc the one meant.
        undecided: motions of the path with more ways than are listed.
    """

    robot: Robot
    index: Indices
    first: Array
    change: Array
    arcs: Array
    ends: Array
    undecided: frozenset[int] = frozenset()

    def at(self, row: Indices, s: Array) -> Array:
        """Configurations (k, d) at s (k,) of the motions ``row`` (k,)."""
        out = self.first[row] + s[:, None] * self.change[row]
        for q, turn in enumerate(coordinates(self.robot).quaternions):
            arc = self.arcs[row, q]
            sine = np.where(arc > 0.0, np.sin(arc), 1.0)
            begin = np.where(arc > 0.0, np.sin((1.0 - s) * arc) / sine, 1.0)
            end = np.where(arc > 0.0, np.sin(s * arc) / sine, 0.0)
            first = self.first[row][:, turn.place]
            out[:, turn.place] = begin[:, None] * first + end[:, None] * self.ends[row, q]
        return out

    def taken(self, rows: Indices) -> Motions:
        """Copies of some of the motions."""
        return Motions(
            self.robot,
            self.index[rows],
            self.first[rows],
            self.change[rows],
            self.arcs[rows],
            self.ends[rows],
            self.undecided,
        )

    def and_also(self, other: Motions) -> Motions:
        """These motions and others of the same robot."""
        return Motions(
            self.robot,
            np.concatenate([self.index, other.index]),
            np.concatenate([self.first, other.first]),
            np.concatenate([self.change, other.change]),
            np.concatenate([self.arcs, other.arcs]),
            np.concatenate([self.ends, other.ends]),
            self.undecided,
        )


def unrolled(robot: Robot, path: Array) -> Motions:
    """The motions of a path (m, d), with every way and every jump that OMPL may make of them."""
    # The last state is a motion of its own, which goes nowhere.
    first, second = path, np.vstack([path[1:], path[-1:]])
    count, turns = len(path), coordinates(robot).quaternions
    ends = np.stack([second[:, turn.place] for turn in turns], axis=1) if turns else np.zeros(0)
    motions = Motions(
        robot,
        np.arange(count),
        first,
        second - first,
        np.zeros((count, len(turns))),
        ends.reshape(count, len(turns), 4),
    )
    return _with_quaternions(_with_angles(motions, second))


def _with_angles(motions: Motions, second: Array) -> Motions:
    """Headings and continuous joints turn the shortest way, in doubt both ways."""
    for turn in coordinates(motions.robot).angles:
        at = turn.place.start
        change = turn_between(motions.first[:, at], second[motions.index, at])
        motions.change[:, at] = change
        motions, copies = _doubled(motions, np.abs(np.abs(change) - np.pi) <= _DOUBT)
        motions.change[copies, at] -= 2.0 * np.pi * np.sign(motions.change[copies, at])
    return motions


def _with_quaternions(motions: Motions) -> Motions:
    """Quaternions turn the shortest way, in doubt both ways, or rest and then jump."""
    for q, turn in enumerate(coordinates(motions.robot).quaternions):
        product = np.sum(motions.first[:, turn.place] * motions.ends[:, q], axis=1)
        motions.ends[product < 0.0, q] *= -1.0
        motions, copies = _doubled(motions, np.abs(product) <= _DOUBT)
        motions.ends[copies, q] *= -1.0
        first, end = motions.first[:, turn.place], motions.ends[:, q]
        apart, summed = (np.linalg.norm(x, axis=1) for x in (end - first, end + first))
        motions.arcs[:, q] = 2.0 * np.arctan2(apart, summed)
    return _with_rests(motions)


def _with_rests(motions: Motions) -> Motions:
    """Let quaternions rest that turn by little, and add the jumps that follow."""
    product = np.cos(motions.arcs)
    small = product > 1.0 - SAME_QUATERNION - _DOUBT
    unsure = small & (product <= 1.0 - SAME_QUATERNION + _DOUBT)
    moving = motions.taken(np.flatnonzero(unsure.any(axis=1)))
    several = motions.index[np.sum(unsure, axis=1) > 1]
    jumping = np.flatnonzero((small & (motions.arcs > 0.0)).any(axis=1))
    arcs = np.where(small, motions.arcs, 0.0)[jumping]
    motions = replace(motions, arcs=np.where(small, 0.0, motions.arcs))
    jumps = replace(
        motions.taken(jumping),
        first=motions.at(jumping, np.ones(len(jumping))),
        change=np.zeros((len(jumping), motions.first.shape[1])),
        arcs=arcs,
    )
    undecided = motions.undecided | {int(index) for index in several}
    return replace(motions.and_also(moving).and_also(jumps), undecided=undecided)


def _doubled(motions: Motions, doubtful: NDArray[np.bool_]) -> tuple[Motions, Indices]:
    """The motions, copies of the ``doubtful`` ones (M,) behind them, and the copies' rows."""
    rows = np.flatnonzero(doubtful)
    ways = np.bincount(motions.index)[motions.index[rows]]
    undecided = motions.undecided | {int(i) for i in motions.index[rows[ways >= _MOST_WAYS]]}
    rows = rows[ways < _MOST_WAYS]
    copies = len(motions.index) + np.arange(len(rows))
    return replace(motions.and_also(motions.taken(rows)), undecided=undecided), copies
