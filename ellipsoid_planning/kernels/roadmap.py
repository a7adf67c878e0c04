"""The highway roadmap and its lazy search (thesis 6.3), all in one loop.

*Layers* are orientations, *columns* base positions without the swept coordinate. A line is a
layer and a column; its free intervals are the *nodes*. Lines, nodes and proved or refuted edges
are computed when the search first asks and remembered for later queries.

The search is A* with an inflated heuristic. Its open list holds *promises* (a line not yet looked
at) and *edges* (two nodes, not yet proved); both are settled when popped, so that only the most
promising lines are computed and edges proved. Every node that is reached also tries the direct
motion to the goal.
"""

import math

import numpy as np

from .compile import inlined, kernel
from .containers import EMPTY, lookup, pop, push, store
from .grid import UNKNOWN, find_nearest
from .layout import ARENA_COUNT, CLEARANCE, OBSTACLE_COUNT, new_placed
from .lines import CAPACITY, free_intervals
from .motion import prove_motion
from .placement import place
from .roadmap_metric import across, angle, apart, heuristic, step_length, write_pose
from .roadmap_tables import (
    COLUMN_STRIDE,
    EDGES,
    END_LENGTH,
    END_NEAREST,
    END_TRIED,
    END_USED,
    ENDS,
    ENTRIES,
    EXHAUSTED,
    EXPANSIONS,
    FIRST_PASSAGE,
    FREE_ENTRY,
    GOAL_REACHED,
    GROW,
    JOINED,
    LAYERS_PLACED,
    LINE_BASE,
    LINES,
    NODE_BITS,
    NODE_COLUMN,
    NODE_COST,
    NODE_ENTRY,
    NODE_HIGH,
    NODE_LAYER,
    NODE_LEAVE,
    NODE_LOW,
    NODE_PARENT,
    NODE_STAMP,
    NODE_VIA,
    NODES,
    OFFERED,
    OPEN,
    OWN_LAYERS,
    PASSAGES_USED,
    PROVED,
    QUERY,
    REFUTED,
    SEARCHING,
    SOLVED,
    STEPS,
)
from .validity import placed_is_free

# Rise over run beyond which intervals that do not overlap are not worth trying to join.
_STEEPEST = 3.0
# A passage is tried from a node only if that is nearer to it by this factor than those before.
_NEARER = 0.8
# So it is tried from no more nodes than this at once.
_OFFERS = 64


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
        if rm.node_reals[node, NODE_LOW] <= swept and swept <= rm.node_reals[node, NODE_HIGH]:
            return node
    node = rm.counters[NODES]
    rm.counters[NODES] += 1
    rm.node_integers[node, NODE_LAYER] = layer
    rm.node_integers[node, NODE_COLUMN] = column
    rm.node_integers[node, NODE_STAMP] = 0
    rm.node_reals[node, NODE_LOW] = swept
    rm.node_reals[node, NODE_HIGH] = swept
    return node


@kernel
def _crossing(nodes, a, b, entry, choice):
    """Candidate ``choice`` of where an edge leaves ``a`` and enters ``b``: (z_a, z_b, exists)."""
    low_a, high_a = nodes[a, NODE_LOW], nodes[a, NODE_HIGH]
    low_b, high_b = nodes[b, NODE_LOW], nodes[b, NODE_HIGH]
    low, high = max(low_a, low_b), min(high_a, high_b)
    if choice == 3:
        return 0.5 * (low_a + high_a), 0.5 * (low_b + high_b), True
    if low > high:
        return 0.0, 0.0, False
    width = high - low
    if choice == 0:
        swept = min(max(entry, low + 0.25 * width), high - 0.25 * width)
    elif choice == 1:
        swept = 0.5 * (low + high)
    else:
        swept = low + (0.1 if entry < 0.5 * (low + high) else 0.9) * width
    return swept, swept, True


@inlined
def is_proved(scene, rm, ends):
    """Whether the motion between the two poses ``ends`` is proved free."""
    proofs = prove_motion(
        scene, ends[0], ends[1], scene[CLEARANCE], rm.motion, rm.motion_placed, rm.motion_stack
    )
    return proofs > 0


@inlined
def _middle_is_free(scene, ends, placed):
    """Whether the robot is free half-way, which most long motions that are not free show."""
    first, last = ends[0], ends[1]
    dot = 0.0
    for m in range(3, 7):
        dot += first[m] * last[m]
    # The sum of two unit quaternions, the shorter way round, points half-way between them.
    sign = -1.0 if dot < 0.0 else 1.0
    place(
        scene,
        0.5 * (first[0] + last[0]),
        0.5 * (first[1] + last[1]),
        0.5 * (first[2] + last[2]),
        first[3] + sign * last[3],
        first[4] + sign * last[4],
        first[5] + sign * last[5],
        first[6] + sign * last[6],
        placed,
    )
    return placed_is_free(scene, placed)


@inlined
def _prove_edge(scene, rm, a, b, entry, axis, ends):
    """Where a proved edge leaves ``a`` and enters ``b``: (z_a, z_b, proved), remembered."""
    key = (min(a, b) << NODE_BITS) | max(a, b)
    known = lookup(rm.edges, key)
    if known != EMPTY:
        row = rm.edge_reals[known]
        if a < b:
            return row[1], row[2], row[0] > 0.0
        return row[2], row[1], row[0] > 0.0
    za, zb, proved = 0.0, 0.0, False
    for choice in range(4):
        za, zb, exists = _crossing(rm.node_reals, a, b, entry, choice)
        if not exists:
            continue
        write_pose(rm.orientations, rm.columns, rm.node_integers, a, za, axis, ends[0])
        write_pose(rm.orientations, rm.columns, rm.node_integers, b, zb, axis, ends[1])
        proved = is_proved(scene, rm, ends)
        if proved:
            break
    edge = rm.counters[EDGES]
    rm.counters[EDGES] += 1
    rm.counters[PROVED if proved else REFUTED] += 1
    rm.edge_reals[edge, 0] = 1.0 if proved else 0.0
    rm.edge_reals[edge, 1], rm.edge_reals[edge, 2] = (za, zb) if a < b else (zb, za)
    store(rm.edges, key, edge)
    return za, zb, proved


@inlined
def _open(rm, priority, cost, leave, target, parent, line):
    _add_entry(
        rm.counters,
        rm.heap,
        rm.heap_items,
        rm.entry_reals,
        rm.entry_integers,
        priority,
        cost,
        leave,
        target,
        parent,
        line,
    )


@kernel
def _add_entry(counters, heap, items, reals, integers, priority, cost, leave, target, parent, line):
    entry = counters[FREE_ENTRY]
    if entry >= 0:
        counters[FREE_ENTRY] = integers[entry, 0]
    else:
        entry = counters[ENTRIES]
        counters[ENTRIES] += 1
    reals[entry, 0], reals[entry, 1] = cost, leave
    integers[entry, 0] = target
    integers[entry, 1] = parent
    integers[entry, 2] = line
    counters[OPEN] = push(heap, items, counters[OPEN], priority, entry)


@kernel
def _promise(rm, node, layer, column, axis, goals, inflation, weight):
    """Open a line next to ``node`` that has not been looked at in this query."""
    entry = rm.node_reals[node, NODE_ENTRY]
    own_layer, own_column = rm.node_integers[node, NODE_LAYER], rm.node_integers[node, NODE_COLUMN]
    step = 0.0
    for m in range(3):
        if m != axis:
            step += (rm.columns[own_column, m] - rm.columns[column, m]) ** 2
    step = math.sqrt(step)
    if layer != own_layer:
        step += weight * angle(rm.orientations, own_layer, layer)
    cost = rm.node_reals[node, NODE_COST] + step
    ahead = heuristic(rm.orientations, rm.columns, layer, column, entry, axis, goals, weight)
    line = layer * COLUMN_STRIDE + column
    _open(rm, cost + inflation * ahead, cost, entry, -1, node, line)


@inlined
def _open_edges(scene, rm, parent, line, axis, goals, inflation, weight, intervals):
    """Look at a promised line: open the edges from ``parent`` to its nodes."""
    layer, column = line // COLUMN_STRIDE, line % COLUMN_STRIDE
    first, count = line_nodes(scene, rm, layer, column, axis, intervals)
    entry = rm.node_reals[parent, NODE_ENTRY]
    for node in range(first, first + count):
        if rm.node_integers[node, NODE_STAMP] == rm.counters[QUERY]:
            continue
        za, zb, exists = _crossing(rm.node_reals, parent, node, entry, 0)
        if not exists:
            # Intervals that do not overlap are joined aslant, unless that would be steep.
            if layer != rm.node_integers[parent, NODE_LAYER]:
                continue
            other = rm.node_integers[parent, NODE_COLUMN]
            if apart(rm.node_reals, parent, node) > _STEEPEST * across(rm.columns, other, column):
                continue
            za, zb, exists = _crossing(rm.node_reals, parent, node, entry, 3)
        cost = rm.node_reals[parent, NODE_COST] + abs(entry - za)
        cost += step_length(
            rm.orientations, rm.columns, rm.node_integers, parent, za, node, zb, axis, weight
        )
        ahead = heuristic(rm.orientations, rm.columns, layer, column, zb, axis, goals, weight)
        _open(rm, cost + inflation * ahead, cost, za, node, parent, line)


@inlined
def _reach(rm, node, parent, leave, entry, cost, via):
    rm.node_integers[node, NODE_STAMP] = rm.counters[QUERY]
    rm.node_integers[node, NODE_PARENT] = parent
    rm.node_integers[node, NODE_VIA] = via
    rm.node_reals[node, NODE_COST] = cost
    rm.node_reals[node, NODE_ENTRY] = entry
    rm.node_reals[node, NODE_LEAVE] = leave


@inlined
def _expand(rm, node, axis, goals, inflation, weight):
    """Promise every line next to ``node``; in the layer of a passage only from its own column."""
    layer, column = rm.node_integers[node, NODE_LAYER], rm.node_integers[node, NODE_COLUMN]
    leaving = rm.passing_layers[layer] and not rm.passing_columns[column]
    for k in range(rm.column_neighbours.shape[1]):
        other = rm.column_neighbours[column, k]
        if other >= 0 and not leaving:
            _promise(rm, node, layer, other, axis, goals, inflation, weight)
    if rm.layer_neighbours[layer, 0] == UNKNOWN:
        own, joined = rm.counters[OWN_LAYERS], rm.counters[JOINED]
        find_nearest(rm.orientations, rm.layer_neighbours, layer, own, joined)
    for k in range(rm.layer_neighbours.shape[1]):
        other = rm.layer_neighbours[layer, k]
        if other >= 0:
            _promise(rm, node, other, column, axis, goals, inflation, weight)
    rm.counters[EXPANSIONS] += 1


@inlined
def _meets_goal(scene, rm, node, axis, goals, ends, placed):
    """The goal to which the direct motion from ``node`` is proved free, or −1."""
    entry = rm.node_reals[node, NODE_ENTRY]
    write_pose(rm.orientations, rm.columns, rm.node_integers, node, entry, axis, ends[0])
    for k in range(goals.shape[0]):
        for m in range(3):
            ends[1, m] = goals[k, 1 + m]
        for m in range(4):
            ends[1, 3 + m] = rm.orientations[int(goals[k, 0]), m]
        proved = _middle_is_free(scene, ends, placed) and is_proved(scene, rm, ends)
        rm.counters[PROVED if proved else REFUTED] += 1
        if proved:
            return k
    return -1


@kernel
def _offer_passages(rm, node, first, axis, weight):
    """Open the ways from ``node`` into passages whose end is the nearest node yet to it."""
    layer, column = rm.node_integers[node, NODE_LAYER], rm.node_integers[node, NODE_COLUMN]
    entry, query = rm.node_reals[node, NODE_ENTRY], rm.counters[QUERY]
    for end in range(first, rm.counters[ENDS]):
        if rm.end_integers[end, END_USED] == query:
            continue
        row = rm.end_reals[end : end + 1]
        away = heuristic(rm.orientations, rm.columns, layer, column, entry, axis, row, weight)
        if rm.end_integers[end, END_TRIED] == query:
            if away > _NEARER * rm.end_reals[end, END_NEAREST]:
                continue
        rm.end_integers[end, END_TRIED] = query
        rm.end_reals[end, END_NEAREST] = away
        cost = rm.node_reals[node, NODE_COST] + away
        # Ahead of everything else: there are few, and a passage may be the only way.
        _open(rm, 0.0, cost, entry, -1, node, FIRST_PASSAGE - end)


@inlined
def _offer_new_passages(rm, axis, weight):
    """Offer passages that were found since the query's last step to the nodes reached so far."""
    if rm.counters[OFFERED] < rm.counters[ENDS]:
        for node in range(rm.counters[NODES]):
            if rm.node_integers[node, NODE_STAMP] == rm.counters[QUERY]:
                _offer_passages(rm, node, rm.counters[OFFERED], axis, weight)
        rm.counters[OFFERED] = rm.counters[ENDS]


@inlined
def _pass_through(scene, rm, parent, end, axis, ends, placed, intervals):
    """The node at the other side of a passage that is entered from ``parent``, or −1."""
    if rm.end_integers[end, END_USED] == rm.counters[QUERY]:
        return -1
    entry = rm.node_reals[parent, NODE_ENTRY]
    write_pose(rm.orientations, rm.columns, rm.node_integers, parent, entry, axis, ends[0])
    for m in range(3):
        ends[1, m] = rm.end_reals[end, 1 + m]
    for m in range(4):
        ends[1, 3 + m] = rm.orientations[int(rm.end_reals[end, 0]), m]
    if not (_middle_is_free(scene, ends, placed) and is_proved(scene, rm, ends)):
        rm.counters[REFUTED] += 1
        return -1
    rm.counters[PROVED] += 1
    rm.counters[PASSAGES_USED] += 1
    rm.end_integers[end, END_USED] = rm.counters[QUERY]
    rm.end_integers[end ^ 1, END_USED] = rm.counters[QUERY]
    other = rm.end_reals[end ^ 1]
    return node_at(scene, rm, int(other[0]), int(other[4]), other[1 + axis], axis, intervals)


@kernel
def begin(scene, rm, starts, goals, axis, inflation, weight):
    """Start a query: rows of ``starts`` and ``goals`` are (layer, x, y, z, column)."""
    intervals = np.empty((CAPACITY, 2))
    rm.counters[QUERY] += 1
    rm.counters[ENTRIES] = 0
    rm.counters[FREE_ENTRY] = -1
    rm.counters[OPEN] = 0
    rm.counters[GOAL_REACHED] = -1
    rm.counters[OFFERED] = rm.counters[ENDS]
    for k in range(starts.shape[0]):
        swept = starts[k, 1 + axis]
        layer, column = int(starts[k, 0]), int(starts[k, 4])
        node = node_at(scene, rm, layer, column, swept, axis, intervals)
        ahead = heuristic(rm.orientations, rm.columns, layer, column, swept, axis, goals, weight)
        _open(rm, inflation * ahead, 0.0, swept, node, -1, -1)
    return SEARCHING


@inlined
def _has_room(rm):
    """Whether every table has room for one more step of the search."""
    counters = rm.counters
    branches = rm.column_neighbours.shape[1] + rm.layer_neighbours.shape[1] + counters[ENDS]
    branches += _OFFERS * (counters[ENDS] - counters[OFFERED])
    return (
        counters[NODES] + 2 * CAPACITY < rm.node_reals.shape[0]
        and counters[EDGES] + 2 < rm.edge_reals.shape[0]
        and 2 * (counters[EDGES] + 2) < rm.edges.shape[1]
        and 2 * (counters[LINES] + 2) < rm.lines.shape[1]
        and counters[ENTRIES] + branches + 2 * CAPACITY < rm.entry_reals.shape[0]
    )


@kernel
def search(scene, rm, goals, axis, inflation, weight, steps):
    """Up to ``steps`` steps of the search: SEARCHING, SOLVED, EXHAUSTED or GROW.

    When SOLVED, counters[GOAL_REACHED] packs the last node and the goal:
    node · (number of goals) + goal.
    """
    intervals = np.empty((CAPACITY, 2))
    ends = np.empty((2, 7))
    placed = new_placed(scene)
    if not _has_room(rm):
        return GROW
    _offer_new_passages(rm, axis, weight)
    for _ in range(steps):
        if not _has_room(rm):
            return GROW
        if rm.counters[OPEN] == 0:
            return EXHAUSTED
        rm.counters[STEPS] += 1
        item = pop(rm.heap, rm.heap_items, rm.counters[OPEN])
        rm.counters[OPEN] -= 1
        node, parent = rm.entry_integers[item, 0], rm.entry_integers[item, 1]
        line = rm.entry_integers[item, 2]
        cost, leave = rm.entry_reals[item, 0], rm.entry_reals[item, 1]
        rm.entry_integers[item, 0] = rm.counters[FREE_ENTRY]
        rm.counters[FREE_ENTRY] = item
        via = -1
        if line <= FIRST_PASSAGE:
            via = FIRST_PASSAGE - line
            node = _pass_through(scene, rm, parent, via, axis, ends, placed, intervals)
            if node < 0:
                continue
        elif node < 0:
            _open_edges(scene, rm, parent, line, axis, goals, inflation, weight, intervals)
            continue
        if rm.node_integers[node, NODE_STAMP] == rm.counters[QUERY]:
            continue
        if parent < 0:
            _reach(rm, node, -1, leave, leave, 0.0, -1)
        elif via >= 0:
            other = rm.end_reals[via ^ 1]
            cost += other[END_LENGTH]
            _reach(rm, node, parent, leave, other[1 + axis], cost, via)
        else:
            entry = rm.node_reals[parent, NODE_ENTRY]
            za, zb, proved = _prove_edge(scene, rm, parent, node, entry, axis, ends)
            if not proved:
                continue
            cost = rm.node_reals[parent, NODE_COST] + abs(entry - za)
            cost += step_length(
                rm.orientations, rm.columns, rm.node_integers, parent, za, node, zb, axis, weight
            )
            _reach(rm, node, parent, za, zb, cost, -1)
        goal = _meets_goal(scene, rm, node, axis, goals, ends, placed)
        if goal >= 0:
            rm.counters[GOAL_REACHED] = node * goals.shape[0] + goal
            return SOLVED
        _expand(rm, node, axis, goals, inflation, weight)
        _offer_passages(rm, node, 0, axis, weight)
    return SEARCHING
