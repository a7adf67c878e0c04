"""Narrow passages: found at saddle points of clearance and followed both ways.

The work is cut into short pieces, so that it can take turns with the search.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import centring, motion, passages
from ellipsoid_planning.kernels.roadmap_metric import turn_length
from ellipsoid_planning.metric import path_length
from ellipsoid_planning.roadmap.joint_layers import layer_metric
from ellipsoid_planning.roadmap.seeds import Seed, seeds_of_query

Array = NDArray[np.float64]

# In units of the robot's size (for rigid ones their reach): how far around the robot bodies are
# looked for, which gap makes no narrow place, at which gap a passage has opened (or if it is that
# wide itself, how many times as wide), and how long it may be.
_WITHIN = 0.5
_NARROW = 0.36
_WIDE = 0.25
_WIDER = 1.3
_LONGEST = 16.0
# Room for the poses of a passage, at first, and pairs of bodies that one call of the kernel looks
# at, so that it takes about half a millisecond.
_POSES = 16
_PAIRS_PER_CALL = 600
# Passages whose ends are this near to each other, in units of the reach, count as one.
_SAME = 0.05
# Pairs of bodies that are looked at while the search takes a step, about, and at first.
_PAIRS_PER_STEP = 6
_FIRST_PAIRS = 150
# But a passage on the direct way, once found, is followed at once, by so many at most.
_OVERDRAFT = -3000
# Later seeds are less likely to help: after so many the work gets less.
_LIKELY = 24
_PAIRS_LATER = 2
# What each piece of work costs besides.
_PAIRS_PER_PIECE = 150


@dataclass(frozen=True, eq=False)
class Passage:
    """Poses (m, 7 + V) joined by proved motions, ``length`` long."""

    poses: Array
    length: float

    def __post_init__(self) -> None:
        self.poses.setflags(write=False)


class PassageFinder:
    """Finds the passages of a C-space, those that a query is likely to need first.

    Attributes:
        cspace: where to look.
        found: the passages found so far for the present query.
        query: the present query's number.
        seeds_tried, seeds_closed: how many places were looked at, and found to leave no room.
    """

    def __init__(self, cspace: CSpace) -> None:
        """Nothing is computed yet."""
        self.cspace = cspace
        self.found: list[Passage] = []
        self.query = 0
        self.seeds_tried = 0
        self.seeds_closed = 0
        self._work: Iterator[None] = iter(())
        self._begun = False
        self._credit = _FIRST_PAIRS
        self._tried_before = 0
        self._promising = False
        self._model = cspace.model
        self._kernel = (centring.new_workspace(self._model), motion.motion_workspaces())
        self._reach, self._size = cspace.reach, cspace.size
        self._joints = layer_metric(cspace)

    @property
    def begun(self) -> bool:
        """Whether passages are being looked for, or have been, since the last :meth:`rest`."""
        return self._begun

    def rest(self, forget: bool = False) -> None:
        """Stop looking for passages; ``forget`` those that were found, or keep them."""
        self._work, self._begun = iter(()), False
        if forget:
            self.found, self.query = [], self.query + 1

    def begin(self, starts: Array, goals: Array) -> None:
        """Look for what a query from ``starts`` (S, 7 + V) to ``goals`` (G, 7 + V) may need."""
        self._begun = True
        self._credit, self._tried_before = _FIRST_PAIRS, self.seeds_tried
        self._kernel[0].keys[:] = -1
        self._work = self._explore(
            seeds_of_query(self.cspace, starts, goals, self._kernel[0].pairs)
        )

    def advance(self, steps: int, should_stop: Callable[[], bool]) -> bool:
        """Do about as much work as ``steps`` steps of the search, or until a passage is found.

        Returns whether there is anything left to do.
        """
        likely = self.seeds_tried - self._tried_before < _LIKELY
        self._credit += (_PAIRS_PER_STEP if likely else _PAIRS_LATER) * steps
        known = len(self.found)
        while self._credit > (_OVERDRAFT if self._promising else 0):
            before = self._pairs()
            if next(self._work, False) is False:
                return False
            self._credit -= self._pairs() - before + _PAIRS_PER_PIECE
            if len(self.found) > known or should_stop():
                break
        return True

    def _pairs(self) -> int:
        return int(self._kernel[0].pairs[0])

    def _explore(self, seeds: Iterator[Seed | None]) -> Iterator[None]:
        for seed in seeds:
            if seed is None:
                yield
            else:
                self.seeds_tried += 1
                yield from self._explore_seed(seed)

    def _explore_seed(self, seed: Seed) -> Iterator[None]:
        middle = seed.pose[None].copy()
        if seed.centred:
            state = np.zeros(passages.PROGRESS)
            self._follow(state, seed.across.copy(), middle, 1, _NARROW)
            yield
            if state[passages.STATE] != passages.FOLLOWING:
                self.seeds_closed += int(state[passages.STATE] == passages.CLOSED)
                return
            if self._known(middle[0]):
                return
        self._promising = self.seeds_tried == self._tried_before + 1
        wide = _WIDE
        if seed.centred:
            wide = max(_WIDE, _WIDER * float(state[passages.LAST_GAP]) / self._size)
        halves = []
        for sign in (1.0, -1.0) if seed.centred else (1.0,):
            state = np.zeros(passages.PROGRESS)
            state[[passages.STATE, passages.SIZE]] = passages.FOLLOWING, self._reach
            direction = sign * seed.across / np.linalg.norm(seed.across)
            path, count = np.empty((_POSES, len(seed.pose))), 1
            path[0] = middle[0]
            while state[passages.STATE] == passages.FOLLOWING:
                if count == len(path):
                    path = np.concatenate([path, np.empty_like(path)])
                count = self._follow(state, direction, path, count, wide)
                yield
            halves.append(path[:count])
        poses = np.vstack([halves[-1][::-1], halves[0][1:]]) if seed.centred else halves[0]
        self._promising = False
        if len(poses) > 1:
            self.found.append(Passage(poses, self._length(poses)))
            yield

    def _follow(self, state: Array, direction: Array, path: Array, count: int, wide: float) -> int:
        size = self._size
        return int(
            passages.follow(
                self._model,
                state,
                direction,
                self.cspace.rotates,
                _WITHIN * size,
                wide * size,
                _LONGEST * size,
                path,
                count,
                _PAIRS_PER_CALL,
                *self._kernel,
            )
        )

    def _known(self, pose: Array) -> bool:
        """Whether a passage found so far leads through ``pose`` (7 + V,), about."""
        for passage in self.found:
            for known in passage.poses.copy():
                away = float(np.linalg.norm(known[:3] - pose[:3]))
                away += turn_length(self._joints, known[3:], pose[3:], self._reach)
                if away < _SAME * self._reach:
                    return True
        return False

    def _length(self, poses: Array) -> float:
        """Length in OMPL's metric."""
        return path_length(self.cspace.robot, self.cspace.configurations(poses))
