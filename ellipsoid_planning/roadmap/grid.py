"""One resolution of the roadmap: its columns, its layers, and who neighbours whom."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.kernels.grid import UNKNOWN, find_column, find_layer
from ellipsoid_planning.world import World

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Places in each row of neighbours, and rows, for the columns and layers of starts and goals.
QUERY_ROOM = 16
SPARE_ROWS = 64
# A line's key has room for 2²⁰ columns; those of starts and goals come on top of the grid's.
MOST_COLUMNS = 1 << 18


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


def most_lines(dimension: int) -> int:
    """How many lines a side every world of ``dimension`` has room for."""
    return MOST_COLUMNS if dimension == 2 else math.isqrt(MOST_COLUMNS)


def grid_columns(world: World, axis: int, lines: int) -> tuple[Array, Indices]:
    """Columns (C, 3) of a regular grid across ``axis``, and their neighbours (C, 2 (n − 1)).

    ``lines`` stand along the longer side, at the middles of equal cells; shorter sides have as
    many as keep the cells square.

    Raises:
        PlannerError: if there would be more than MOST_COLUMNS.
    """
    low, high = swept_box(world)
    across = [k for k in range(world.dimension) if k != axis]
    widest = max(float(high[k] - low[k]) for k in across)
    shares = [(high[k] - low[k]) / widest if widest > 0.0 else 0.0 for k in across]
    counts = [max(1, math.ceil(share * lines - 1e-9)) for share in shares]
    if math.prod(counts) > MOST_COLUMNS:
        raise PlannerError(
            f"lines: {lines} a side make {math.prod(counts)} lines, at most {MOST_COLUMNS} are"
            " possible; the roadmap is refined where it needs to be"
        )
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
    index = np.arange(math.prod(counts), dtype=np.int64).reshape(counts)
    found = []
    for k in range(len(counts)):
        padded = np.pad(
            index, [(1, 1) if m == k else (0, 0) for m in range(len(counts))], constant_values=-1
        )
        below = np.take(padded, range(counts[k]), axis=k)
        above = np.take(padded, range(2, counts[k] + 2), axis=k)
        found += [below.ravel(), above.ravel()]
    return np.column_stack(found).astype(np.int64)


class Grid:
    """Columns and layers of one level; those of starts and goals are added as they come.

    The tables have spare rows; the counts say how many are in use.

    Attributes:
        columns: (≥ C, 3), the swept coordinate 0.
        column_neighbours: (≥ C, D), filled up with −1.
        orientations: quaternions of the layers, then values of joints (≥ L, 4 + V).
        joints: what joints count in distances (J, METRIC).
        layer_neighbours: (≥ L, K), filled up with −1; the rows of the grid's own layers are
            looked for when the search first needs them (kernels.grid.find_nearest).
        passing_columns, passing_layers: (≥ C,) and (≥ L,), those that only lead out of passages:
            no other column or layer has them for neighbours.
        column_count, layer_count: C and L.
        own_layers, own_columns: how many layers and columns the grid began with.
        joined: to how many of them each layer is joined.
    """

    def __init__(
        self,
        columns: Array,
        column_neighbours: Indices,
        orientations: Array,
        neighbours: int,
        joints: Array,
        weight: float,
        layer_neighbours: Indices | None = None,
    ) -> None:
        """Join each layer to its ``neighbours`` nearest ones; of the columns that is given.

        ``weight`` is that of the base's turn in the distance of layers, beside that of the
        ``joints`` (J, METRIC); see kernels.roadmap_metric. ``layer_neighbours`` (L, K), filled up
        with −1, are taken instead of the nearest ones.
        """
        self.joints = joints
        self._weight = weight
        self.column_count, self.layer_count = len(columns), len(orientations)
        self.columns = _with_spare_rows(columns, 0.0)
        self.column_neighbours = _with_spare_rows(_with_room(column_neighbours), -1)
        self.orientations = _with_spare_rows(orientations, 0.0)
        self.passing_columns = np.zeros(len(self.columns), dtype=np.bool_)
        self.passing_layers = np.zeros(len(self.orientations), dtype=np.bool_)
        self.own_layers, self.own_columns = len(orientations), len(columns)
        self._own_column_neighbours = self.column_neighbours[: len(columns)].copy()
        if layer_neighbours is None:
            self.joined = min(neighbours, len(orientations) + QUERY_ROOM)
            layer_neighbours = np.full((len(orientations), self.joined), UNKNOWN, dtype=np.int64)
        self.joined = layer_neighbours.shape[1]
        self.layer_neighbours = _with_spare_rows(_with_room(layer_neighbours), -1)
        self._distances = np.empty(max(len(self.columns), len(self.orientations)))

    def forget_added(self) -> None:
        """Take out all columns and layers but those that the grid began with."""
        columns, layers = self.own_columns, self.own_layers
        self.column_count, self.layer_count = columns, layers
        self.column_neighbours[:columns] = self._own_column_neighbours
        self.column_neighbours[columns:] = -1
        self.layer_neighbours[:layers, self.joined :] = -1
        self.layer_neighbours[layers:] = -1
        self.passing_columns[columns:] = False
        self.passing_layers[layers:] = False

    def column_of(self, position: Array, axis: int, joins: bool = True) -> int:
        """The column at ``position`` (3,), added and joined to those around it if it is new.

        Unless it ``joins``, they are not joined to it.
        """
        if self.column_count == len(self.columns):
            self.columns = _with_spare_rows(self.columns, 0.0)
            self.column_neighbours = _with_spare_rows(self.column_neighbours, -1)
            self.passing_columns = np.pad(self.passing_columns, (0, SPARE_ROWS))
            self._distances = np.empty(max(len(self.columns), len(self.orientations)))
        point = position.copy()
        point[axis] = 0.0
        found = find_column(
            self.columns,
            self.column_neighbours,
            self.column_count,
            self._distances,
            self.passing_columns,
            joins,
            *point,
        )
        self.column_count = max(self.column_count, found + 1)
        return int(found)

    def layer_of(self, orientation: Array, joins: bool = True) -> int:
        """The layer of a row (4 + V,), added and joined to its nearest if it is new.

        Unless it ``joins``, they are not joined to it.
        """
        if self.layer_count == len(self.orientations):
            self.orientations = _with_spare_rows(self.orientations, 0.0)
            self.layer_neighbours = _with_spare_rows(self.layer_neighbours, -1)
            self.passing_layers = np.pad(self.passing_layers, (0, SPARE_ROWS))
            self._distances = np.empty(max(len(self.columns), len(self.orientations)))
        found = find_layer(
            self.orientations,
            self.joints,
            self.layer_neighbours,
            self.layer_count,
            self._distances,
            self.passing_layers,
            joins,
            orientation,
            self.joined,
            self._weight,
        )
        self.layer_count = max(self.layer_count, found + 1)
        return int(found)


def _with_room(table: Indices) -> Indices:
    room = np.full((len(table), QUERY_ROOM), -1, dtype=np.int64)
    return np.hstack([table, room])


def _with_spare_rows(table: NDArray[Any], value: float) -> NDArray[Any]:
    spare = np.full((SPARE_ROWS, table.shape[1]), value, dtype=table.dtype)
    return np.ascontiguousarray(np.vstack([table, spare]))
