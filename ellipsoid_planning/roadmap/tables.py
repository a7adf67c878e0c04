"""The growing arrays of one roadmap level (see kernels.roadmap.Roadmap)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import layout, motion, roadmap_tables, whitening
from ellipsoid_planning.kernels.containers import EMPTY, rehash
from ellipsoid_planning.kernels.lines import CAPACITY
from ellipsoid_planning.kernels.roadmap_tables import Roadmap
from ellipsoid_planning.roadmap.grid import Grid

_ROWS = 1 << 12
_WHITENED = 1 << 14
_ENDS = 64
_NODE_MASK = (1 << roadmap_tables.NODE_BITS) - 1


def _map(size: int) -> NDArray[np.int64]:
    return np.full((2, size), EMPTY, dtype=np.int64)


def new_tables(grid: Grid, parts: int) -> Roadmap:
    """Empty tables for the columns and layers of ``grid`` and a robot of ``parts`` parts."""
    width = 3 + grid.orientations.shape[1]
    counters = np.zeros(roadmap_tables.COUNTERS, dtype=np.int64)
    counters[[roadmap_tables.OWN_LAYERS, roadmap_tables.JOINED]] = grid.own_layers, grid.joined
    return Roadmap(
        orientations=grid.orientations,
        layer_neighbours=grid.layer_neighbours,
        columns=grid.columns,
        column_neighbours=grid.column_neighbours,
        passing_layers=grid.passing_layers,
        passing_columns=grid.passing_columns,
        placed=np.empty((len(grid.orientations), parts, layout.PLACED)),
        ready=np.zeros(len(grid.orientations), dtype=np.bool_),
        whitening=np.empty((_WHITENED, whitening.WHITEN)),
        whitening_keys=np.full(_WHITENED, EMPTY, dtype=np.int64),
        scratch=np.empty((1, 9)),
        lines=_map(2 * _ROWS),
        edges=_map(2 * _ROWS),
        node_integers=np.zeros((_ROWS, roadmap_tables.NODE_INTEGERS), dtype=np.int64),
        node_reals=np.empty((_ROWS, roadmap_tables.NODE_REALS)),
        edge_reals=np.empty((_ROWS, roadmap_tables.EDGE_REALS)),
        heap=np.empty(4 * _ROWS),
        heap_items=np.empty(4 * _ROWS, dtype=np.int64),
        entry_reals=np.empty((4 * _ROWS, 2)),
        entry_integers=np.empty((4 * _ROWS, 3), dtype=np.int64),
        end_reals=np.empty((_ENDS, roadmap_tables.END_REALS)),
        end_integers=np.zeros((_ENDS, roadmap_tables.END_INTEGERS), dtype=np.int64),
        passage_poses=np.empty((_ROWS, width)),
        counters=counters,
        motion=motion.motion_workspaces(),
        joints=grid.joints,
        usable=np.zeros(len(grid.orientations), dtype=np.bool_),
        pose=np.empty(width),
    )


def _longer(array: NDArray[Any], used: int) -> NDArray[Any]:
    """``array``, or longer with the same beginning if more than 3/8 of it is used."""
    size = _enough(len(array), used)
    if size == len(array):
        return array
    out = np.empty((size, *array.shape[1:]), dtype=array.dtype)
    out[: len(array)] = array
    return out


def _larger_map(table: NDArray[np.int64], used: int) -> NDArray[np.int64]:
    size = _enough(table.shape[1], used)
    if size == table.shape[1]:
        return table
    larger = _map(size)
    rehash(table, larger)
    return larger


def _enough(size: int, used: int) -> int:
    while 8 * used > 3 * size:
        size *= 2
    return size


def grown(tables: Roadmap, starts: int = 0) -> Roadmap:
    """``tables`` with more room wherever it runs short, for a step or a query of ``starts``."""
    used = tables.counters
    nodes, edges = (
        int(used[roadmap_tables.NODES]) + starts * CAPACITY,
        int(used[roadmap_tables.EDGES]),
    )
    branches = tables.column_neighbours.shape[1] + tables.layer_neighbours.shape[1]
    entries = max(int(used[roadmap_tables.ENTRIES]), starts) + branches
    entries += 64 * int(used[roadmap_tables.ENDS])
    return tables._replace(
        lines=_larger_map(tables.lines, int(used[roadmap_tables.LINES]) + starts),
        edges=_larger_map(tables.edges, edges),
        node_integers=_longer(tables.node_integers, nodes),
        node_reals=_longer(tables.node_reals, nodes),
        edge_reals=_longer(tables.edge_reals, edges),
        heap=_longer(tables.heap, entries),
        heap_items=_longer(tables.heap_items, entries),
        entry_reals=_longer(tables.entry_reals, entries),
        entry_integers=_longer(tables.entry_integers, entries),
    )


def with_passage(
    tables: Roadmap, rows: NDArray[np.float64], length: float, poses: NDArray[np.float64]
) -> Roadmap:
    """``tables`` with one more passage along ``poses`` (m, 7 + V).

    ``rows`` (2, 5) tell layer, x, y, z and column of its first and its last pose.
    """
    counters = tables.counters
    end = int(counters[roadmap_tables.ENDS])
    used = int(tables.end_reals[end - 1, roadmap_tables.END_FIRST]) + 1 if end else 0
    tables = tables._replace(
        end_reals=_longer(tables.end_reals, end + 2),
        end_integers=_longer(tables.end_integers, end + 2),
        passage_poses=_longer(tables.passage_poses, used + len(poses)),
    )
    tables.passage_poses[used : used + len(poses)] = poses
    first, last = used, used + len(poses) - 1
    tables.end_reals[end : end + 2, :5] = rows
    tables.end_reals[end : end + 2, roadmap_tables.END_LENGTH] = length
    tables.end_reals[end : end + 2, roadmap_tables.END_FIRST] = first, last
    tables.end_reals[end : end + 2, roadmap_tables.END_LAST] = last, first
    tables.end_integers[end : end + 2] = 0
    counters[roadmap_tables.ENDS] += 2
    return tables


def without_added(tables: Roadmap, layers: int, columns: int, bodies: int) -> Roadmap:
    """``tables`` with nothing on layers and columns but the first ``layers`` and ``columns``.

    Passages go as well. ``bodies`` is the number of obstacles and arenas.
    """
    used, counters = int(tables.counters[roadmap_tables.NODES]), tables.counters
    places = tables.node_integers[:used, [roadmap_tables.NODE_LAYER, roadmap_tables.NODE_COLUMN]]
    stays = np.all(places < [layers, columns], axis=1)
    # One more: the first node of a line without any may be the one after the last.
    number = np.concatenate([[0], np.cumsum(stays)])
    count = int(number[-1])
    tables.node_integers[:count] = tables.node_integers[:used][stays]
    tables.node_reals[:count] = tables.node_reals[:used][stays]
    counters[roadmap_tables.NODES] = count
    lines = _lines_that_stay(tables.lines, layers, columns, number)
    counters[roadmap_tables.LINES] = lines.shape[1]
    edges, kept = _edges_that_stay(tables.edges, stays, number)
    tables.edge_reals[: len(kept)] = tables.edge_reals[kept]
    counters[roadmap_tables.EDGES] = len(kept)
    for table, entries in ((tables.lines, lines), (tables.edges, edges)):
        table[:] = EMPTY
        rehash(entries, table)
    # Rows of whitening are addressed by the numbers of layers, which others will have.
    pairs = layers * tables.placed.shape[1] * bodies
    tables.whitening_keys[tables.whitening_keys >= pairs] = EMPTY
    counters[roadmap_tables.LAYERS_PLACED] -= np.count_nonzero(tables.ready[layers:])
    tables.ready[layers:] = tables.usable[layers:] = False
    counters[[roadmap_tables.ENDS, roadmap_tables.OFFERED]] = 0
    return tables


def _lines_that_stay(
    table: NDArray[np.int64], layers: int, columns: int, number: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Keys and values (2, n) of lines; ``number`` tells the new numbers of nodes."""
    layer, column = np.divmod(table[0], roadmap_tables.COLUMN_STRIDE)
    lines = table[:, (table[0] != EMPTY) & (layer < layers) & (column < columns)]
    first, count = np.divmod(lines[1], roadmap_tables.LINE_BASE)
    return np.vstack([lines[0], number[first] * roadmap_tables.LINE_BASE + count])


def _edges_that_stay(
    table: NDArray[np.int64], stays: NDArray[np.bool_], number: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Keys and values (2, m) of edges between nodes that stay, and their old rows (m,)."""
    edges = table[:, table[0] != EMPTY]
    edges = edges[:, np.argsort(edges[1])]
    first, last = edges[0] >> roadmap_tables.NODE_BITS, edges[0] & _NODE_MASK
    kept = stays[first] & stays[last]
    keys = (number[first] << roadmap_tables.NODE_BITS) | number[last]
    return np.vstack([keys[kept], np.arange(np.count_nonzero(kept))]), edges[1, kept]


def warm_up_growth() -> None:
    """Compile what :func:`grown` calls."""
    rehash(_map(2), _map(2))


def with_grid(tables: Roadmap, grid: Grid) -> Roadmap:
    """``tables`` for the same grid after columns or layers were added to it."""
    if tables.columns is grid.columns and tables.orientations is grid.orientations:
        return tables
    new = len(grid.orientations) - len(tables.ready)
    more = np.empty((new, *tables.placed.shape[1:]))
    return tables._replace(
        orientations=grid.orientations,
        layer_neighbours=grid.layer_neighbours,
        columns=grid.columns,
        column_neighbours=grid.column_neighbours,
        passing_layers=grid.passing_layers,
        passing_columns=grid.passing_columns,
        placed=np.concatenate([tables.placed, more]) if new else tables.placed,
        ready=np.pad(tables.ready, (0, new)),
        usable=np.pad(tables.usable, (0, new)),
    )
