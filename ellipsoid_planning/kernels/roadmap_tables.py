"""The arrays of one roadmap, and what stands where in them (see kernels.roadmap)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Status of a burst
SEARCHING = 0
SOLVED = 1
EXHAUSTED = 2
GROW = 3

# Counters
NODES = 0
EDGES = 1
ENTRIES = 2
OPEN = 3
LINES = 4
PROVED = 5
REFUTED = 6
EXPANSIONS = 7
LAYERS_PLACED = 8
QUERY = 9
GOAL_REACHED = 10
# Layers of the grid itself, and to how many of them each layer is joined.
OWN_LAYERS = 11
JOINED = 12
# The last entry that was taken out and can be used again, or −1; each links to the one before.
FREE_ENTRY = 13
# Ends of passages, and how many of them the present query has looked at.
ENDS = 14
OFFERED = 15
PASSAGES_USED = 16
STEPS = 17
# Ends that were known when the present query began.
KNOWN_ENDS = 18
# The nodes that the present query reached first and last, or −1; each links to the next.
FIRST_REACHED = 19
LAST_REACHED = 20
COUNTERS = 21

# Node columns of the integer table
NODE_LAYER = 0
NODE_COLUMN = 1
NODE_PARENT = 2
NODE_STAMP = 3
# The end of the passage that led here, or −1.
NODE_VIA = 4
# The node that the query reached after this one, or −1.
NODE_NEXT = 5
NODE_INTEGERS = 6

# Node columns of the real table: the interval, then what the present query knows
NODE_LOW = 0
NODE_HIGH = 1
NODE_COST = 2
NODE_ENTRY = 3
NODE_LEAVE = 4
NODE_REALS = 5

# Edge columns: proved (1) or refuted (0), swept coordinate at either node (the lower one first),
# the coordinates that choices 0 and 2 of `roadmap_proofs.crossing` were, and the query that asked.
EDGE_PROVED = 0
EDGE_LOWER = 1
EDGE_UPPER = 2
EDGE_TRIED = 3
EDGE_STAMP = 5
EDGE_REALS = 6

# Ends of passages, two a passage; the other end of ``e`` is ``e ^ 1``. First like rows of goals:
# layer, x, y, z, column; then the passage's length, how near to the end a node of this query has
# come, and the rows of poses from here to the other end.
END_LENGTH = 5
END_NEAREST = 6
END_FIRST = 7
END_LAST = 8
END_REALS = 9
END_TRIED = 0
END_USED = 1
END_INTEGERS = 2
# The line of an entry that leads into a passage is FIRST_PASSAGE − end.
FIRST_PASSAGE = -2

# A line's key is layer · COLUMN_STRIDE + column; columns and layers may be added at any time.
COLUMN_STRIDE = 1 << 20
# A line holds at most CAPACITY nodes; its map value is first · LINE_BASE + count.
LINE_BASE = 128
NODE_BITS = 31


class Roadmap(NamedTuple):
    """The arrays of one roadmap; all but the first eight grow (kernels.roadmap tells how).

    Attributes:
        orientations: quaternions of the layers, then the values of joints (L, 4 + V).
        layer_neighbours: rows (L, K) of layers, filled up with −1; the grid's own neighbours of
            a layer are looked for when it is first expanded.
        columns: base positions (C, 3), swept coordinate 0.
        column_neighbours: rows (C, D) of columns, filled up with −1.
        passing_layers, passing_columns: (L,) and (C,), those that only lead out of passages.
        placed: parts of each layer (L, k, PLACED), base at the origin.
        ready: which layers are placed (L,).
        whitening, whitening_keys, scratch: cache of lines.
        lines, edges: maps (2, size) to nodes and edges.
        node_integers, node_reals: tables of the nodes.
        edge_reals: table of the edges.
        heap, heap_items: the open list's order.
        entry_reals: (N, 2): cost so far, swept coordinate at the parent.
        entry_integers: (N, 3): target node or −1, parent node, line of a promise.
        end_reals, end_integers: tables of the ends of passages.
        passage_poses: (P, 7 + V), the poses of all passages.
        counters: (COUNTERS,).
        motion: workspaces of kernels.motion.
        joints: (J, METRIC), what joints count (kernels.roadmap_metric); none for rigid robots.
        usable: (L,), which of the placed layers' robots do not meet themselves.
        pose: workspace for one row.
    """

    orientations: NDArray[np.float64]
    layer_neighbours: NDArray[np.int64]
    columns: NDArray[np.float64]
    column_neighbours: NDArray[np.int64]
    passing_layers: NDArray[np.bool_]
    passing_columns: NDArray[np.bool_]
    placed: NDArray[np.float64]
    ready: NDArray[np.bool_]
    whitening: NDArray[np.float64]
    whitening_keys: NDArray[np.int64]
    scratch: NDArray[np.float64]
    lines: NDArray[np.int64]
    edges: NDArray[np.int64]
    node_integers: NDArray[np.int64]
    node_reals: NDArray[np.float64]
    edge_reals: NDArray[np.float64]
    heap: NDArray[np.float64]
    heap_items: NDArray[np.int64]
    entry_reals: NDArray[np.float64]
    entry_integers: NDArray[np.int64]
    end_reals: NDArray[np.float64]
    end_integers: NDArray[np.int64]
    passage_poses: NDArray[np.float64]
    counters: NDArray[np.int64]
    motion: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
    joints: NDArray[np.float64]
    usable: NDArray[np.bool_]
    pose: NDArray[np.float64]
