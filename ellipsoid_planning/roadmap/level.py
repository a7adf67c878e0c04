"""One level of the highway roadmap: a grid, its tables, and queries on them."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import layout, roadmap, roadmap_path, roadmap_tables
from ellipsoid_planning.roadmap.grid import Grid
from ellipsoid_planning.roadmap.passages import PassageFinder
from ellipsoid_planning.roadmap.regions import Box
from ellipsoid_planning.roadmap.tables import (
    grown,
    new_tables,
    warm_up_growth,
    with_grid,
    with_passage,
    without_added,
)

Array = NDArray[np.float64]

# Steps of the search between two looks for passages, at first and at most.
_FIRST_TURN = 32
_LONGEST_TURN = 1024
# Turns that are given to passages when the grid is exhausted, if other grids will be searched.
_PATIENCE = 2
# How long a call of the kernel should take at most [s].
_BURST_SECONDS = 3e-3


class Level:
    """A roadmap of one resolution. What a query computes is kept for later ones.

    Attributes:
        grid: its columns and layers.
        axis: the swept axis.
        passages: finds passages for it, and for the other levels of its part of the world.
        refinement: how many coarser resolutions there are.
        box: the corners (n,), (n,) of the part of the world that it covers; None for all of it.
        tables: lines, nodes and edges known so far (kernels.roadmap.Roadmap).
        query: that to which the added columns, layers and passages belong, as ``passages`` counts.
    """

    def __init__(
        self,
        cspace: CSpace,
        grid: Grid,
        axis: int,
        passages: PassageFinder,
        refinement: int = 0,
        box: Box | None = None,
        guides: Callable[[Array, Array], Array] | None = None,
    ) -> None:
        """An empty roadmap on ``grid``, swept along ``axis``.

        ``guides`` gives layers between two poses, for robots with many joints.
        """
        self.grid = grid
        self.axis = axis
        self.refinement, self.box = refinement, box
        self.tables = new_tables(grid, len(cspace.robot.parts))
        self._model = cspace.model
        self.passages = passages
        self._bodies = int(cspace.scene[[layout.OBSTACLE_COUNT, layout.ARENA_COUNT]].sum())
        self._taken_in = 0
        self.query = passages.query
        self._guides = guides
        self._burst = _FIRST_TURN

    def solve(
        self,
        starts: Array,
        goals: Array,
        inflation: float,
        metric_weight: float,
        should_stop: Callable[[], bool],
        thorough: bool = True,
    ) -> tuple[int, Array]:
        """Search from ``starts`` (S, 7 + V) to ``goals`` (G, 7 + V): (status, poses (m, 7 + V)).

        When the grid is exhausted, passages are looked for once more, to the end if ``thorough``.
        The status is kernels.roadmap's SOLVED, EXHAUSTED or, when told to stop, SEARCHING; there
        are no poses unless SOLVED.
        """
        start_rows, goal_rows = self._rows(starts), self._rows(goals)
        self._take_in(starts, goals)
        turn, exhausted, layers = _FIRST_TURN, 0, -1
        while True:
            if layers < 0:
                layers = self._begin(start_rows, goal_rows, inflation, metric_weight)
            status = self._search(goal_rows, inflation, metric_weight, turn, should_stop)
            if status == roadmap_tables.SOLVED or should_stop():
                break
            # Passages are looked for in turns with the search, by counts of work and not by the
            # clock, so that the same query finds the same path.
            more = self.passages.advance(turn, should_stop)
            self._take_in(starts, goals)
            counters = self.tables.counters
            new = counters[roadmap_tables.ENDS] > counters[roadmap_tables.OFFERED]
            if status == roadmap_tables.EXHAUSTED and not new:
                if self._guides and self.grid.layer_count > layers:
                    # What was reached before did not see the layers that came with passages.
                    layers = -1
                    continue
                exhausted += 1
                if not more or (exhausted > _PATIENCE and not thorough):
                    break
            turn = min(2 * turn, _LONGEST_TURN)
        if status != roadmap_tables.SOLVED:
            return status, starts[:0]
        return self._path(goal_rows)

    def forget_earlier_query(self) -> None:
        """Take out what another query added, unless ``passages`` still looks for that one.

        Lines and edges of the grid itself stay. So a query searches what it would search on an
        empty roadmap, and goes the same way, however many came before.
        """
        if self.query == self.passages.query:
            return
        self.grid.forget_added()
        self.tables = without_added(
            self.tables, self.grid.own_layers, self.grid.own_columns, self._bodies
        )
        self._taken_in, self.query = 0, self.passages.query

    def _begin(
        self, start_rows: Array, goal_rows: Array, inflation: float, metric_weight: float
    ) -> int:
        """Begin a query, or begin it again: how many layers there are."""
        self.tables = grown(with_grid(self.tables, self.grid), len(start_rows))
        roadmap.begin(
            self._model, self.tables, start_rows, goal_rows, self.axis, inflation, metric_weight
        )
        return self.grid.layer_count

    def _search(
        self,
        goal_rows: Array,
        inflation: float,
        metric_weight: float,
        turn: int,
        should_stop: Callable[[], bool],
    ) -> int:
        """``turn`` steps of the search, unless it ends or is told to stop before."""
        status, counters = roadmap_tables.SEARCHING, self.tables.counters
        end = counters[roadmap_tables.STEPS] + turn
        while counters[roadmap_tables.STEPS] < end:
            began = time.perf_counter()
            status = roadmap.search(
                self._model,
                self.tables,
                goal_rows,
                self.axis,
                inflation,
                metric_weight,
                min(self._burst, end - counters[roadmap_tables.STEPS]),
            )
            if status == roadmap_tables.GROW:
                self.tables = grown(self.tables)
                continue
            if status != roadmap_tables.SEARCHING or should_stop():
                break
            # A step may take a microsecond or, among thousands of bodies, a hundredth of a second.
            late = time.perf_counter() - began > _BURST_SECONDS
            self._burst = max(self._burst // 4, 1) if late else min(2 * self._burst, _LONGEST_TURN)
        return status

    def _take_in(self, starts: Array, goals: Array) -> None:
        """Enter the passages that were found since the last call.

        With many joints the layers at their ends become layers of the grid, and so do those
        between them and the layers of starts and goals: no motion may lead straight from where the
        search has been to the end of a passage.
        """
        if self._taken_in == len(self.passages.found):
            return
        for passage in self.passages.found[self._taken_in :]:
            ends = passage.poses[[0, -1]]
            rows = self._rows(ends, joins=self._guides is not None)
            if self._guides is not None:
                for end in ends:
                    for other in (*starts, *goals):
                        for row in self._guides(other, end):
                            self.grid.layer_of(row)
            self.tables = with_passage(
                with_grid(self.tables, self.grid), rows, passage.length, passage.poses
            )
            self._taken_in += 1
        self.tables = grown(self.tables)

    def _rows(self, ends: Array, joins: bool = True) -> Array:
        rows = [
            [
                self.grid.layer_of(pose[3:], joins),
                *pose[:3],
                self.grid.column_of(pose[:3], self.axis, joins),
            ]
            for pose in ends
        ]
        return np.array(rows, dtype=float)

    def _path(self, goals: Array) -> tuple[int, Array]:
        last, goal = divmod(int(self.tables.counters[roadmap_tables.GOAL_REACHED]), len(goals))
        path = self._room(last)
        count = roadmap_path.trace(self._model, self.tables, last, goal, goals, self.axis, path)
        return (roadmap_tables.SOLVED if count else roadmap_tables.EXHAUSTED), path[:count]

    def _room(self, last: int) -> Array:
        width = len(self.tables.pose)
        return np.empty((roadmap_path.path_room(self.tables, last), width))

    def compile_kernels(self, ends: Array) -> None:
        """Call every kernel of a query once, on two poses ``ends`` (2, 7), without searching."""
        rows = self._rows(ends)
        self.tables = grown(with_grid(self.tables, self.grid))
        roadmap.begin(self._model, self.tables, rows[:1], rows[1:], self.axis, 1.0, 1.0)
        roadmap.search(self._model, self.tables, rows[1:], self.axis, 1.0, 1.0, 0)
        warm_up_growth()
        path = np.repeat(self._room(-1), 2, axis=0)
        roadmap_path.trace(self._model, self.tables, -1, 0, rows[1:], self.axis, path)

    @property
    def statistics(self) -> dict[str, int]:
        """Counts of what is known, and of the work done so far."""
        counters = self.tables.counters
        return {
            "layers": int(counters[roadmap_tables.LAYERS_PLACED]),
            "lines": int(counters[roadmap_tables.LINES]),
            "intervals": int(counters[roadmap_tables.NODES]),
            **self.work,
        }

    @property
    def work(self) -> dict[str, int]:
        """Counts of the work done so far."""
        counters = self.tables.counters
        return {
            "edges_certified": int(counters[roadmap_tables.PROVED]),
            "edges_refused": int(counters[roadmap_tables.REFUTED]),
            "expansions": int(counters[roadmap_tables.EXPANSIONS]),
        }
