"""Nodes of the roadmap: the free intervals of its lines, computed when they are first asked for."""

from .compile import kernel
from .containers import EMPTY, lookup, store
from .layout import ARENA_COUNT, HIGH, LOW, OBSTACLE_COUNT
from .lines import free_intervals
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
from .robot_model import place_layer, pose_is_free, scene_of


@kernel
def line_nodes(model, rm, layer, column, axis, intervals):
    """Nodes of a line, computed once: (first, count)."""
    key = layer * COLUMN_STRIDE + column
    value = lookup(rm.lines, key)
    if value != EMPTY:
        return value // LINE_BASE, value % LINE_BASE
    scene = scene_of(model)
    if not rm.ready[layer]:
        for m in range(3):
            rm.pose[m] = 0.0
        for m in range(rm.orientations.shape[1]):
            rm.pose[3 + m] = rm.orientations[layer, m]
        rm.usable[layer] = place_layer(model, rm.pose, rm.placed[layer])
        rm.ready[layer] = True
        rm.counters[LAYERS_PLACED] += 1
    if not rm.usable[layer]:
        return 0, 0
    if scene[LOW + axis] == scene[HIGH + axis]:
        return _only_node(model, rm, layer, column)
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
        _add_node(rm, layer, column, intervals[k, 0], intervals[k, 1])
    rm.counters[LINES] += 1
    store(rm.lines, key, first * LINE_BASE + count)
    return first, count


@kernel
def _only_node(model, rm, layer, column):
    """The node of a layer whose base cannot move, if it is free: (first, count)."""
    scene, first = scene_of(model), rm.counters[NODES]
    for m in range(3):
        rm.pose[m] = scene[LOW + m]
    for m in range(rm.orientations.shape[1]):
        rm.pose[3 + m] = rm.orientations[layer, m]
    count = 1 if pose_is_free(model, rm.pose, rm.placed[layer]) else 0
    if count == 1:
        _add_node(rm, layer, column, scene[HIGH + 2], scene[HIGH + 2])
    rm.counters[LINES] += 1
    store(rm.lines, layer * COLUMN_STRIDE + column, first * LINE_BASE + count)
    return first, count


@kernel
def _add_node(rm, layer, column, low, high):
    """Add the node of an interval of a line: its number."""
    node = rm.counters[NODES]
    rm.node_integers[node, NODE_LAYER] = layer
    rm.node_integers[node, NODE_COLUMN] = column
    rm.node_integers[node, NODE_STAMP] = 0
    rm.node_reals[node, NODE_LOW] = low
    rm.node_reals[node, NODE_HIGH] = high
    rm.counters[NODES] += 1
    return node


@kernel
def node_at(model, rm, layer, column, swept, axis, intervals):
    """The node of the line's interval that holds ``swept``, or a new one of that point alone.

    The point is free, but intervals keep a tolerance, and more where parts all but fill an arena.
    """
    first, count = line_nodes(model, rm, layer, column, axis, intervals)
    for node in range(first, first + count):
        if rm.node_reals[node, NODE_LOW] <= swept <= rm.node_reals[node, NODE_HIGH]:
            return node
    return _add_node(rm, layer, column, swept, swept)
