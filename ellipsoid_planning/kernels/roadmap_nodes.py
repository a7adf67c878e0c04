"""Nodes of the roadmap: the free intervals of its lines, computed when they are first asked for."""

from .compile import kernel
from .containers import EMPTY, lookup, store
from .layout import ARENA_COUNT, OBSTACLE_COUNT
from .lines import free_intervals
from .placement import place
from .roadmap_tables import (
    COLUMN_STRIDE,
    LAYERS_PLACED,
    LINE_BASE,
    LINES,
    NODE_COLUMN,
    NODE_HIGH,
    NODE_LAYER,
    NODE_LOW,
    NODE_STAMP,
    NODES,
)


@kernel
def line_nodes(scene, rm, layer, column, axis, intervals):
    """Nodes of a line, computed once: (first, count)."""
    key = layer * COLUMN_STRIDE + column
    value = lookup(rm.lines, key)
    if value != EMPTY:
        return value // LINE_BASE, value % LINE_BASE
    q = rm.orientations[layer]
    if not rm.ready[layer]:
        place(scene, 0.0, 0.0, 0.0, q[0], q[1], q[2], q[3], rm.placed[layer])
        rm.ready[layer] = True
        rm.counters[LAYERS_PLACED] += 1
    bodies = int(scene[OBSTACLE_COUNT] + scene[ARENA_COUNT])
    base = layer * rm.placed.shape[1] * bodies
    point = rm.columns[column]
    count = free_intervals(
        scene,
        rm.placed[layer],
        base,
        rm.whitening,
        rm.whitening_keys,
        rm.scratch,
        axis,
        point[0],
        point[1],
        point[2],
        intervals,
    )
    first = rm.counters[NODES]
    for k in range(count):
        node = first + k
        rm.node_integers[node, NODE_LAYER] = layer
        rm.node_integers[node, NODE_COLUMN] = column
        rm.node_integers[node, NODE_STAMP] = 0
        rm.node_reals[node, NODE_LOW] = intervals[k, 0]
        rm.node_reals[node, NODE_HIGH] = intervals[k, 1]
    rm.counters[NODES] += count
    rm.counters[LINES] += 1
    store(rm.lines, key, first * LINE_BASE + count)
    return first, count


@kernel
def node_at(scene, rm, layer, column, swept, axis, intervals):
    """The node of the line's interval that holds ``swept``, or a new one of that point alone.

    The point is free, but intervals keep a tolerance, and more where parts all but fill an arena.
    """
    first, count = line_nodes(scene, rm, layer, column, axis, intervals)
    for node in range(first, first + count):
        if rm.node_reals[node, NODE_LOW] <= swept <= rm.node_reals[node, NODE_HIGH]:
            return node
    node = rm.counters[NODES]
    rm.counters[NODES] += 1
    rm.node_integers[node, NODE_LAYER] = layer
    rm.node_integers[node, NODE_COLUMN] = column
    rm.node_integers[node, NODE_STAMP] = 0
    rm.node_reals[node, NODE_LOW] = swept
    rm.node_reals[node, NODE_HIGH] = swept
    return node
