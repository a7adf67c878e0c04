"""One level of the highway roadmap: a grid, its tables, and queries on them."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import roadmap, roadmap_path, roadmap_tables
from ellipsoid_planning.roadmap.grid import Grid
from ellipsoid_planning.roadmap.tables import grown, new_tables, warm_up_growth, with_grid

Array = NDArray[np.float64]

# Steps of the search between two looks at the clock, at first and at most, and how long they
# should take.
_FIRST_BURST = 64
_LONGEST_BURST = 1024
_BURST_SECONDS = 3e-3


class Level:
    """A roadmap of one resolution. What a query computes is kept for later ones.

    Attributes:
        grid: its columns and layers.
        tables: lines, nodes and edges known so far (kernels.roadmap.Roadmap).
    """

    def __init__(self, cspace: CSpace, grid: Grid, axis: int) -> None:
        """An empty roadmap on ``grid``, swept along ``axis``."""
        self.grid = grid
        self.axis = axis
        self.tables = new_tables(grid, len(cspace.robot.parts))
        self._scene = cspace.scene

    def solve(
        self,
        starts: Array,
        goals: Array,
        inflation: float,
        metric_weight: float,
        should_stop: Callable[[], bool],
    ) -> tuple[int, Array]:
        """Search from ``starts`` (S, 7) to ``goals`` (G, 7): (status, poses (m, 7)).

        The status is kernels.roadmap's SOLVED, EXHAUSTED or, when told to stop, SEARCHING; there
        are no poses unless SOLVED.
        """
        start_rows, goal_rows = self._rows(starts), self._rows(goals)
        self.tables = grown(with_grid(self.tables, self.grid), len(starts))
        status = roadmap.begin(
            self._scene, self.tables, start_rows, goal_rows, self.axis, inflation, metric_weight
        )
        steps = _FIRST_BURST
        while status in (roadmap_tables.SEARCHING, roadmap_tables.GROW):
            if status == roadmap_tables.GROW:
                self.tables = grown(self.tables)
            began = time.perf_counter()
            status = roadmap.search(
                self._scene, self.tables, goal_rows, self.axis, inflation, metric_weight, steps
            )
            if status == roadmap_tables.SEARCHING and should_stop():
                break
            # A step may take a microsecond or, among thousands of bodies, a hundredth of a second.
            late = time.perf_counter() - began > _BURST_SECONDS
            steps = max(steps // 4, 1) if late else min(2 * steps, _LONGEST_BURST)
        if status != roadmap_tables.SOLVED:
            return status, np.empty((0, 7))
        return self._path(goal_rows)

    def _rows(self, ends: Array) -> Array:
        rows = [
            [self.grid.layer_of(pose[3:]), *pose[:3], self.grid.column_of(pose[:3], self.axis)]
            for pose in ends
        ]
        return np.array(rows, dtype=float)

    def _path(self, goals: Array) -> tuple[int, Array]:
        last, goal = divmod(int(self.tables.counters[roadmap_tables.GOAL_REACHED]), len(goals))
        path = np.empty((roadmap_path.path_room(self.tables, last), 7))
        count = roadmap_path.trace(self._scene, self.tables, last, goal, goals, self.axis, path)
        return (roadmap_tables.SOLVED if count else roadmap_tables.EXHAUSTED), path[:count]

    def compile_kernels(self, ends: Array) -> None:
        """Call every kernel of a query once, on two poses ``ends`` (2, 7), without searching."""
        rows = self._rows(ends)
        self.tables = grown(with_grid(self.tables, self.grid))
        roadmap.begin(self._scene, self.tables, rows[:1], rows[1:], self.axis, 1.0, 1.0)
        roadmap.search(self._scene, self.tables, rows[1:], self.axis, 1.0, 1.0, 0)
        warm_up_growth()
        path = np.empty((roadmap_path.path_room(self.tables, -1) + 1, 7))
        roadmap_path.trace(self._scene, self.tables, -1, 0, rows[1:], self.axis, path)

    @property
    def statistics(self) -> dict[str, int]:
        """Counts of what has been computed so far."""
        counters = self.tables.counters
        return {
            "layers": int(counters[roadmap_tables.LAYERS_PLACED]),
            "lines": int(counters[roadmap_tables.LINES]),
            "intervals": int(counters[roadmap_tables.NODES]),
            "edges_certified": int(counters[roadmap_tables.PROVED]),
            "edges_refused": int(counters[roadmap_tables.REFUTED]),
            "expansions": int(counters[roadmap_tables.EXPANSIONS]),
        }
