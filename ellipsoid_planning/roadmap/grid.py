"""One resolution of the roadmap: its columns, its layers, and who neighbours whom."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.roadmap.orientations import nearest
from ellipsoid_planning.world import World

Array = NDArray[np.float64]
Indices = NDArray[np.int32]

# Room in the neighbour tables for the columns and layers of starts and goals.
QUERY_ROOM = 16


def swept_box(world: World) -> tuple[Array, Array]:
    """Low and high corner (3,) of the box that base positions can reach: bounds and arenas."""
    low, high = np.zeros(3), np.zeros(3)
    low[: world.dimension], high[: world.dimension] = world.low, world.high
    for arena in world.arenas:
        extent = np.linalg.norm(arena.matrix, axis=1)
        n = world.dimension
        low[:n] = np.maximum(low[:n], arena.centre - extent)
        high[:n] = np.minimum(high[:n], arena.centre + extent)
    return low, np.maximum(low, high)


def grid_columns(world: World, axis: int, lines: int) -> tuple[Array, Indices]:
    """Columns (C, 3) of a regular grid across ``axis``, and their neighbours (C, 2 (n − 1)).

    ``lines`` stand along the longer side, at the middles of equal cells; shorter sides have as
    many as keep the cells square.
    """
    low, high = swept_box(world)
    across = [k for k in range(world.dimension) if k != axis]
    cell = max(float(high[k] - low[k]) for k in across) / lines
    counts = [max(1, math.ceil((high[k] - low[k]) / cell - 1e-9)) for k in across]
    places = [
        low[k] + (np.arange(count) + 0.5) * (high[k] - low[k]) / count
        for k, count in zip(across, counts, strict=True)
    ]
    grid = np.meshgrid(*places, indexing="ij")
    columns = np.zeros((grid[0].size, 3))
    for k, values in zip(across, grid, strict=True):
        columns[:, k] = values.ravel()
    return columns, _grid_neighbours(counts)


def _grid_neighbours(counts: list[int]) -> Indices:
    index = np.arange(math.prod(counts), dtype=np.int32).reshape(counts)
    found = []
    for k in range(len(counts)):
        padded = np.pad(index, [(1, 1) if m == k else (0, 0) for m in range(len(counts))],
                        constant_values=-1)
        below = np.take(padded, range(counts[k]), axis=k)
        above = np.take(padded, range(2, counts[k] + 2), axis=k)
        found += [below.ravel(), above.ravel()]
    return np.column_stack(found).astype(np.int32)


class Grid:
    """Columns and layers of one level; those of starts and goals are added as they come.

    Attributes:
        columns: (C, 3), the swept coordinate 0.
        column_neighbours: (C, D), filled up with −1.
        orientations: quaternions of the layers (L, 4).
        layer_neighbours: (L, K), filled up with −1.
    """

    def __init__(
        self, columns: Array, column_neighbours: Indices, orientations: Array, neighbours: int
    ) -> None:
        """Join each layer to its ``neighbours`` nearest ones, both ways."""
        self.columns = columns
        self.column_neighbours = _with_room(column_neighbours)
        self.orientations = orientations
        self._neighbours = neighbours
        table = nearest(orientations, orientations, neighbours + 1)
        own = np.arange(len(orientations), dtype=np.int32)[:, None]
        table = np.where(table == own, np.int32(-1), table)
        self.layer_neighbours = _with_room(table)

    def column_of(self, position: Array, axis: int) -> int:
        """The column at ``position`` (3,), added and joined to those around it if it is new."""
        point = position.copy()
        point[axis] = 0.0
        away = np.linalg.norm(self.columns - point, axis=1)
        if away.min() <= 1e-12 * (1.0 + float(np.abs(point).max())):
            return int(away.argmin())
        new = len(self.columns)
        around = np.argsort(away, kind="stable")[:4].astype(np.int32)
        self.columns = np.vstack([self.columns, point])
        self.column_neighbours = _joined(self.column_neighbours, new, around)
        return new

    def layer_of(self, orientation: Array) -> int:
        """The layer of a quaternion (4,), added and joined to its nearest if it is new."""
        away = 1.0 - np.abs(self.orientations @ orientation)
        exact = np.flatnonzero(away <= 1e-14)
        for layer in exact:
            if np.array_equal(self.orientations[layer], orientation):
                return int(layer)
        new = len(self.orientations)
        around = np.argsort(away, kind="stable")[: self._neighbours].astype(np.int32)
        self.orientations = np.vstack([self.orientations, orientation])
        self.layer_neighbours = _joined(self.layer_neighbours, new, around)
        return new


def _with_room(table: Indices) -> Indices:
    room = np.full((len(table), QUERY_ROOM), -1, dtype=np.int32)
    return np.ascontiguousarray(np.hstack([table, room]), dtype=np.int32)


def _joined(table: Indices, new: int, around: Indices) -> Indices:
    """``table`` with a row for ``new``, joined both ways to ``around``.

    Where a row is full, the newcomer takes the place of an earlier newcomer.
    """
    row = np.full((1, table.shape[1]), -1, dtype=np.int32)
    kept = around[: table.shape[1]]
    row[0, : len(kept)] = kept
    table = np.vstack([table, row])
    for other in kept:
        free = np.flatnonzero(table[other] < 0)
        place = int(free[0]) if len(free) else table.shape[1] - 1 - new % QUERY_ROOM
        table[other, place] = new
    return table
