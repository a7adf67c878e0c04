"""One level of a roadmap as plain arrays, and back.

Only what later queries need is kept: columns and layers, the nodes of the lines looked at, and
the edges proved or refuted. What follows from the grid and the scene (who neighbours whom, placed
parts, whitening) is computed again, and what belongs to a query (open list, costs) is left out.
Every index is checked, because kernels do not.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.array_files import Document
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.kernels import roadmap_tables
from ellipsoid_planning.kernels.containers import EMPTY, rehash
from ellipsoid_planning.kernels.lines import CAPACITY
from ellipsoid_planning.kernels.robot_model import place_layer
from ellipsoid_planning.roadmap.grid import MOST_COLUMNS, Grid
from ellipsoid_planning.roadmap.level import Level
from ellipsoid_planning.roadmap.tables import grown, with_grid

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# The counters that only tell what has been done so far.
_COUNTS = {
    "proved": roadmap_tables.PROVED,
    "refuted": roadmap_tables.REFUTED,
    "expansions": roadmap_tables.EXPANSIONS,
    "passages_used": roadmap_tables.PASSAGES_USED,
    "steps": roadmap_tables.STEPS,
}
# The number of a query before those that a roadmap counts.
_EARLIER = -1
_NODE_MASK = (1 << roadmap_tables.NODE_BITS) - 1
_PLACES = [roadmap_tables.NODE_LAYER, roadmap_tables.NODE_COLUMN]
_ENDS = [roadmap_tables.NODE_LOW, roadmap_tables.NODE_HIGH]


def level_header(level: Level) -> dict[str, Any]:
    """What a level is and how much was done on it, as data for JSON."""
    counters = level.tables.counters
    return {
        "refinement": level.refinement,
        "axis": level.axis,
        "box": None if level.box is None else [corner.tolist() for corner in level.box],
        "own_layers": level.grid.own_layers,
        "of_last_query": level.query == level.passages.query,
        **{name: int(counters[place]) for name, place in _COUNTS.items()},
    }


def level_arrays(level: Level) -> dict[str, NDArray[Any]]:
    """What later queries on a level need."""
    grid, tables = level.grid, level.tables
    columns, layers = grid.column_count, grid.layer_count
    nodes = int(tables.counters[roadmap_tables.NODES])
    edges = tables.edges[:, tables.edges[0] != EMPTY]
    ready = np.zeros(layers, dtype=np.bool_)
    ready[: len(tables.ready)] = tables.ready[:layers]
    return {
        "columns": grid.columns[:columns],
        "passing_columns": grid.passing_columns[:columns],
        "orientations": grid.orientations[:layers],
        "passing_layers": grid.passing_layers[:layers],
        "ready": ready,
        "lines": tables.lines[:, tables.lines[0] != EMPTY],
        "nodes": tables.node_integers[:nodes, _PLACES],
        "intervals": tables.node_reals[:nodes, _ENDS],
        "edges": edges[0, np.argsort(edges[1])],
        "crossings": tables.edge_reals[: edges.shape[1], : roadmap_tables.EDGE_STAMP],
    }


class StoredLevel:
    """A level in a roadmap's file.

    Attributes:
        refinement, axis, box: see Level.
        orientations: of the level's own layers (L, 4).
    """

    def __init__(self, document: Document, index: int, cspace: CSpace) -> None:
        """Read level ``index``.

        Raises:
            RoadmapError: an entry is missing or wrong.
        """
        self._document, self._place = document, f"levels[{index}]"
        self._header: Mapping[str, Any] = document.header["levels"][index]
        self.refinement = self._count("refinement", 1000)
        dimension = cspace.dimension
        self.axis = self._count("axis", dimension - 1)
        self.box = self._box(dimension)
        self._layers = self._array("orientations", float, None, cspace.pose_size - 3)
        self.orientations = self._layers[: self._count("own_layers", len(self._layers))]
        planar = dimension == 2 and self._layers[:, :2].any()
        if planar or not self._layers[:, :4].any(axis=1).all():
            raise self._error("orientations", "expected quaternions of the world's dimension")

    def fill(self, level: Level, model: Any) -> None:
        """Enter everything in ``level``, an empty one of this refinement, axis and box.

        Raises:
            RoadmapError: an entry is missing or wrong.
        """
        self._fill_grid(level.grid, level.axis)
        level.tables = with_grid(level.tables, level.grid)
        self._fill_tables(level, level.grid)
        self._place_layers(level, model)
        if not self._header.get("of_last_query"):
            level.query = _EARLIER

    def _fill_grid(self, grid: Grid, axis: int) -> None:
        """Add columns and layers of queries and passages in the order in which they came."""
        columns = self._array("columns", float, None, 3)
        passing = self._array("passing_columns", bool, len(columns))
        own = grid.column_count
        if len(columns) > MOST_COLUMNS + (1 << 19) or not np.array_equal(
            columns[:own], grid.columns[:own]
        ):
            raise self._error("columns", "they are not those of these parameters")
        for k in range(own, len(columns)):
            if grid.column_of(columns[k], axis, not passing[k]) != k or columns[k, axis] != 0.0:
                raise self._error("columns", f"column {k} is there already, or none")
        passing = self._array("passing_layers", bool, len(self._layers))
        for k in range(grid.layer_count, len(self._layers)):
            if grid.layer_of(self._layers[k], not passing[k]) != k:
                raise self._error("orientations", f"layer {k} is there already")

    def _fill_tables(self, level: Level, grid: Grid) -> None:
        nodes = self._array("nodes", int, None, 2)
        intervals = self._array("intervals", float, len(nodes), 2)
        if np.any(nodes < 0) or np.any(nodes >= [grid.layer_count, grid.column_count]):
            raise self._error("nodes", "expected indices of layers and columns")
        if np.any(intervals[:, 0] > intervals[:, 1]):
            raise self._error("intervals", "expected low and high ends")
        lines, edges = self._lines(nodes, grid), self._edges(len(nodes))
        crossings = self._array("crossings", float, len(edges), roadmap_tables.EDGE_STAMP)
        counters = level.tables.counters
        counters[roadmap_tables.NODES] = len(nodes)
        counters[roadmap_tables.LINES] = lines.shape[1]
        counters[roadmap_tables.EDGES] = len(edges)
        for name, place in _COUNTS.items():
            counters[place] = self._count(name)
        level.tables = tables = grown(level.tables)
        tables.node_integers[: len(nodes), _PLACES] = nodes
        tables.node_reals[: len(nodes), _ENDS] = intervals
        tables.edge_reals[: len(edges), : roadmap_tables.EDGE_STAMP] = crossings
        tables.edge_reals[: len(edges), roadmap_tables.EDGE_STAMP] = 0.0
        rehash(lines, tables.lines)
        rehash(np.vstack([edges, np.arange(len(edges))]), tables.edges)

    def _lines(self, nodes: Indices, grid: Grid) -> Indices:
        """Keys and values (2, n) of the map to the nodes of lines."""
        lines = self._array("lines", int, 2, None)
        layer, column = np.divmod(lines[0], roadmap_tables.COLUMN_STRIDE)
        first, count = np.divmod(lines[1], roadmap_tables.LINE_BASE)
        known = (lines[0] >= 0) & (layer < grid.layer_count) & (column < grid.column_count)
        there = (lines[1] >= 0) & (count <= CAPACITY) & (first <= len(nodes) - count)
        if not (known & there).all() or len(np.unique(lines[0])) < lines.shape[1]:
            raise self._error("lines", "expected lines of the grid and the nodes on each")
        # Whoever looks for a point on a line gets a node, which has to be of that line.
        line = np.repeat(np.arange(lines.shape[1]), count)
        place = np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count) + first[line]
        if np.any(nodes[place] != np.column_stack([layer, column])[line]):
            raise self._error("lines", "the nodes of a line are those of another one")
        return lines

    def _edges(self, nodes: int) -> Indices:
        """Keys (E,) of the map to edges: two nodes each, the lower one first."""
        edges = self._array("edges", int, None)
        first, last = edges >> roadmap_tables.NODE_BITS, edges & _NODE_MASK
        if np.any((edges < 0) | (first >= last) | (last >= nodes)):
            raise self._error("edges", "expected pairs of nodes")
        if len(np.unique(edges)) < len(edges):
            raise self._error("edges", "expected each pair of nodes once")
        return edges

    def _place_layers(self, level: Level, model: Any) -> None:
        ready = self._array("ready", bool, level.grid.layer_count)
        tables = level.tables
        for layer in np.flatnonzero(ready):
            pose = np.concatenate([np.zeros(3), tables.orientations[layer]])
            tables.usable[layer] = place_layer(model, pose, tables.placed[layer])
            tables.ready[layer] = True
        tables.counters[roadmap_tables.LAYERS_PLACED] = np.count_nonzero(ready)

    def _box(self, dimension: int) -> tuple[Array, Array] | None:
        box = self._header.get("box")
        if box is None:
            return None
        try:
            corners = np.array(box, dtype=float)
        except (TypeError, ValueError):
            corners = np.empty(0)
        if corners.shape != (2, dimension) or not np.isfinite(corners).all():
            raise self._error("box", "expected two corners")
        if np.any(corners[0] > corners[1]):
            raise self._error("box", "expected the low corner first")
        return corners[0], corners[1]

    def _count(self, name: str, most: int = 1 << 62) -> int:
        return self._document.number(f"{self._place}.{name}", self._header, most)

    def _array(self, name: str, kind: type, *shape: int | None) -> NDArray[Any]:
        return self._document.array(f"{self._place}.{name}", kind, *shape)

    def _error(self, name: str, problem: str) -> EllipsoidPlanningError:
        return self._document.error(f"{self._place}.{name}: {problem}")
