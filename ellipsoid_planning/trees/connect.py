"""RRT-Connect on free intervals and proved motions, without OMPL."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.poses import configurations_from_poses
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.kernels import sampling, tree, tree_tables
from ellipsoid_planning.kernels.motion import motions_are_free
from ellipsoid_planning.kernels.tree_nearest import insert
from ellipsoid_planning.metric import path_length, turn_length
from ellipsoid_planning.outcome import SOLVED, TIMEOUT, Outcome
from ellipsoid_planning.roadmap.passage_kernels import compile_passage_kernels
from ellipsoid_planning.roadmap.passages import PassageFinder
from ellipsoid_planning.roadmap.shorten import shorten
from ellipsoid_planning.robots.rigid import check_rigid
from ellipsoid_planning.trees.parameters import TreeParameters
from ellipsoid_planning.trees.tables import edges_of, grown, new_trees, path_of

Array = NDArray[np.float64]

# Steps between two looks at the clock, at first and at most, and how long they should take.
_FIRST_BURST = 16
_LONGEST_BURST = 1024
_BURST_SECONDS = 3e-3
# Steps before passages are looked for; each look takes as much work, and the next comes after
# twice as many.
_FIRST_LOOK = 64
# Rows of random numbers drawn at once.
_BLOCK = 256


class FreeIntervalRRTConnect:
    """Two trees of proved motions that grow towards free samples, and towards each other.

    The direct motion comes first. Poses in narrow passages, found at saddle points of clearance,
    are tried as samples as well. A query that was stopped goes on where it was when it is asked
    again; another query starts new trees.

    Attributes:
        cspace: what is planned in.
        parameters: see TreeParameters.
    """

    def __init__(self, cspace: CSpace, parameters: TreeParameters | None = None) -> None:
        """Prepare to plan; nothing is computed yet.

        Raises:
            GeometryError: if the robot is not rigid.
        """
        check_rigid(cspace.robot)
        self.cspace = cspace
        self.parameters = parameters or TreeParameters()
        robot = cspace.robot
        self._rest = cspace.poses(np.zeros((1, robot.configuration_size)))[0]
        self._kind, self._weight = sampling.FIXED, 0.0
        if robot.rotates:
            self._kind = sampling.PLANAR if robot.dimension == 2 else sampling.SPATIAL
            chosen = self.parameters.metric_weight
            self._weight = turn_length(robot) if chosen is None else float(chosen)
        self.clear()

    def clear(self) -> None:
        """Forget everything computed so far."""
        self._trees = new_trees()
        self._passages = PassageFinder(self.cspace)
        self._planted_at = 0
        self._query: tuple[Array, Array] | None = None
        self._direct = self._steps_before = 0
        self._start_again()

    def _start_again(self) -> None:
        """Draw the same numbers once more, and forget passages."""
        self._random = np.random.default_rng(self.parameters.seed)
        self._numbers = np.empty((0, tree.ROW))
        self._passages.rest(forget=True)
        # The trees take turns by the number of steps.
        self._steps_before += int(self._trees.counters[tree_tables.STEPS])
        self._trees.counters[tree_tables.STEPS] = 0

    def solve(
        self,
        starts: Array,
        goals: Array,
        should_stop: Callable[[], bool],
        on_path: Callable[[Array], None] | None = None,
        seeds: ArrayLike | None = None,
    ) -> Outcome:
        """Look for a path from one of ``starts`` (S, d) to one of ``goals`` (G, d).

        All must be valid. ``should_stop`` is asked every few milliseconds. With ``anytime``,
        ``on_path`` receives every better path, and the search goes on until told to stop. Poses
        ``seeds`` (P, 7), say in narrow places, are tried as samples; they need not be free.

        Raises:
            PlannerError: if ``seeds`` have another shape or are no poses.
        """
        begin, end, gates = self.cspace.poses(starts), self.cspace.poses(goals), _gates(seeds)
        direct = self._direct_motion(begin, end)
        if direct is not None:
            self._direct += 1
            return self._solved(direct, on_path)
        if should_stop():
            return Outcome(TIMEOUT)
        if self._query is None or not all(map(np.array_equal, self._query, (begin, end))):
            # What an earlier query drew and found must not change the way this one goes.
            self._start_again()
            self._plant(begin, end)
        best = None
        while (path := self._search(gates, should_stop)) is not None:
            if not self.parameters.anytime:
                return self._solved(path, on_path)
            best = self._better(best, path, on_path)
            best = self._better(best, self._shortened(best, should_stop), on_path)
            self._plant(begin, end)
        if best is None:
            return Outcome(TIMEOUT)
        return Outcome(SOLVED, configurations_from_poses(self.cspace.robot, best))

    def clear_query(self) -> None:
        """Let the next query start new trees, even if it is the same one."""
        self._query = None

    @property
    def statistics(self) -> dict[str, int]:
        """Counts since the last :meth:`clear`; vertices are those of the present trees."""
        counters = self._trees.counters
        return {
            "direct_motions": self._direct,
            "passages": len(self._passages.found),
            "steps": self._steps_before + int(counters[tree_tables.STEPS]),
            "blocked_draws": int(counters[tree_tables.BLOCKED_DRAWS]),
            "start_vertices": int(counters[0]),
            "goal_vertices": int(counters[1]),
            "edges_certified": int(counters[tree_tables.PROVED]),
            "edges_refused": int(counters[tree_tables.REFUTED]),
        }

    def edges(self) -> tuple[Array, Array]:
        """First and last configurations (k, d) of the present trees' edges.

        The motion along each is proved; where it matters, in this direction.
        """
        robot = self.cspace.robot
        first, last = edges_of(self._trees)
        return configurations_from_poses(robot, first), configurations_from_poses(robot, last)

    def compile_kernels(self) -> None:
        """Compile everything that a query can call, so that the next one's time is its own.

        For a planner made for this alone: it is left with two trees of one node each.
        """
        rest = self._rest[np.newaxis]
        self._direct_motion(rest, rest)
        self.cspace.is_valid(configurations_from_poses(self.cspace.robot, rest)[0])
        self._plant(rest, rest)
        self._grow(_gates(None), 0)
        if self.parameters.gate_share > 0.0:
            compile_passage_kernels(self.cspace)

    def _direct_motion(self, starts: Array, goals: Array) -> Array | None:
        """The first proved motion (2, 7) from one of the starts to one of the goals, or None."""
        first, last = np.repeat(starts, len(goals), axis=0), np.tile(goals, (len(starts), 1))
        counts = np.empty(len(first), dtype=np.int64)
        motions_are_free(self.cspace.scene, first, last, counts)
        reached = np.flatnonzero(counts > 0)
        return np.vstack([first[reached[0]], last[reached[0]]]) if len(reached) else None

    def _plant(self, starts: Array, goals: Array) -> None:
        """Begin new trees: every start is a root of the first, every goal one of the second."""
        self._query = (starts, goals)
        self._planted_at = int(self._trees.counters[tree_tables.STEPS])
        self._passages.begin(starts, goals)
        self._trees.counters[:2] = 0
        self._trees = grown(self._trees, max(len(starts), len(goals)))
        for side, roots in enumerate((starts, goals)):
            for pose in roots:
                insert(self.cspace.scene, self._trees, side, pose, tree_tables.NONE, self._weight)

    def _search(self, gates: Array, should_stop: Callable[[], bool]) -> Array | None:
        """Grow the trees until they meet: the path (m, 7), or None if told to stop."""
        steps, looked = _FIRST_BURST, _FIRST_LOOK
        gates = np.vstack([gates, *(passage.poses for passage in self._passages.found)])
        while True:
            began = time.perf_counter()
            done = int(self._trees.counters[tree_tables.STEPS]) - self._planted_at
            if done >= looked:
                # By counts of steps and not by the clock, so that a query repeats exactly.
                known = len(self._passages.found)
                if self.parameters.gate_share > 0.0:
                    self._passages.advance(looked, should_stop)
                found = self._passages.found[known:]
                gates = np.vstack([gates, *(passage.poses for passage in found)])
                looked *= 2
            if self._grow(gates, min(steps, looked - done)) == tree_tables.SOLVED:
                path = path_of(self._trees)
                if self._is_proved(path):
                    return path
            if should_stop():
                return None
            # A step takes some ten microseconds or, among thousands of bodies, milliseconds.
            late = time.perf_counter() - began > _BURST_SECONDS
            steps = max(steps // 4, 1) if late else min(2 * steps, _LONGEST_BURST)

    def _grow(self, gates: Array, steps: int) -> int:
        """At most ``steps`` steps; the random numbers do not depend on how steps are divided."""
        if len(self._numbers) == 0:
            self._numbers = self._random.random((_BLOCK, tree.ROW))
        self._trees = grown(self._trees)
        given = self.parameters
        status = tree.grow(
            self.cspace.scene,
            self._trees,
            self._kind,
            self._rest,
            gates,
            self._numbers[:steps],
            float(given.gate_share),
            float(given.uniform),
            np.inf if given.range is None else float(given.range),
            self._weight,
            given.halvings,
        )
        self._numbers = self._numbers[int(self._trees.counters[tree_tables.ROWS_USED]) :]
        return int(status)

    def _is_proved(self, path: Array) -> bool:
        """Whether a path is proved as configurations too: headings are rounded once more."""
        configurations = configurations_from_poses(self.cspace.robot, path)
        return bool(self.cspace.are_motions_valid(configurations[:-1], configurations[1:]).all())

    def _shortened(self, path: Array, should_stop: Callable[[], bool]) -> Array:
        """A path shortened while that helps."""
        while not should_stop():
            shorter = shorten(self.cspace, path, self._random, should_stop)
            if self._length(shorter) > (1.0 - 1e-4) * self._length(path):
                return shorter
            path = shorter
        return path

    def _solved(self, path: Array, on_path: Callable[[Array], None] | None) -> Outcome:
        configurations = configurations_from_poses(self.cspace.robot, path)
        if on_path is not None:
            on_path(configurations)
        return Outcome(SOLVED, configurations)

    def _better(
        self, best: Array | None, path: Array, on_path: Callable[[Array], None] | None
    ) -> Array:
        """The shorter one of two paths; a new one is given to ``on_path``."""
        if best is not None and not self._length(path) < self._length(best):
            return best
        self._solved(path, on_path)
        return path

    def _length(self, path: Array) -> float:
        robot = self.cspace.robot
        return path_length(robot, configurations_from_poses(robot, path))


def _gates(seeds: ArrayLike | None) -> Array:
    """Poses (P, 7) with unit quaternions, given from outside.

    Raises:
        PlannerError: they have another shape, or are no poses.
    """
    if seeds is None:
        return np.empty((0, 7))
    gates = np.array(seeds, dtype=float, order="C", ndmin=2)
    if gates.size == 0:
        return np.empty((0, 7))
    if gates.ndim != 2 or gates.shape[1] != 7:
        raise PlannerError(f"seeds: expected poses of shape (P, 7), got {np.shape(seeds)}")
    lengths = np.linalg.norm(gates[:, 3:], axis=1)
    if not (np.isfinite(gates).all() and (lengths > 0.0).all()):
        raise PlannerError("seeds: expected finite positions and non-zero quaternions")
    gates[:, 3:] /= lengths[:, np.newaxis]
    return gates
