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
from .containers import pop
from .grid import UNKNOWN, find_nearest
from .layout import new_placed
from .lines import CAPACITY
from .roadmap_metric import across, apart, heuristic, step_length, turn_length, write_pose
from .roadmap_nodes import line_nodes, node_at
from .roadmap_open import open_entry
from .roadmap_passages import OFFERS, offer_new_passages, offer_passages, pass_through
from .roadmap_proofs import crossing, is_proved, middle_is_free, prove_edge
from .roadmap_tables import (
    COLUMN_STRIDE,
    EDGES,
    END_LENGTH,
    ENDS,
    ENTRIES,
    EXHAUSTED,
    EXPANSIONS,
    FIRST_PASSAGE,
    FIRST_REACHED,
    FREE_ENTRY,
    GOAL_REACHED,
    GROW,
    JOINED,
    KNOWN_ENDS,
    LAST_REACHED,
    LINES,
    NODE_COLUMN,
    NODE_COST,
    NODE_ENTRY,
    NODE_LAYER,
    NODE_LEAVE,
    NODE_NEXT,
    NODE_PARENT,
    NODE_STAMP,
    NODE_VIA,
    NODES,
    OFFERED,
    OPEN,
    OWN_LAYERS,
    PROVED,
    QUERY,
    REFUTED,
    SEARCHING,
    SOLVED,
    STEPS,
)
from .robot_model import scene_of

# Rise over run beyond which intervals that do not overlap are not worth trying to join.
_STEEPEST = 3.0


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
        own, other = rm.orientations[own_layer], rm.orientations[layer]
        step += turn_length(rm.joints, own, other, weight)
    cost = rm.node_reals[node, NODE_COST] + step
    ahead = heuristic(
        rm.orientations, rm.joints, rm.columns, layer, column, entry, axis, goals, weight
    )
    line = layer * COLUMN_STRIDE + column
    open_entry(rm, cost + inflation * ahead, cost, entry, -1, node, line)


@inlined
def _open_edges(model, rm, parent, line, axis, goals, inflation, weight, intervals):
    """Look at a promised line: open the edges from ``parent`` to its nodes."""
    layer, column = line // COLUMN_STRIDE, line % COLUMN_STRIDE
    first, count = line_nodes(model, rm, layer, column, axis, intervals)
    entry = rm.node_reals[parent, NODE_ENTRY]
    for node in range(first, first + count):
        if rm.node_integers[node, NODE_STAMP] == rm.counters[QUERY]:
            continue
        za, zb, exists = crossing(rm.node_reals, parent, node, entry, 0)
        if not exists:
            # Intervals that do not overlap are joined aslant, unless that would be steep.
            if layer != rm.node_integers[parent, NODE_LAYER]:
                continue
            other = rm.node_integers[parent, NODE_COLUMN]
            if apart(rm.node_reals, parent, node) > _STEEPEST * across(rm.columns, other, column):
                continue
            za, zb, exists = crossing(rm.node_reals, parent, node, entry, 3)
        cost = rm.node_reals[parent, NODE_COST] + abs(entry - za)
        cost += step_length(
            rm.orientations,
            rm.joints,
            rm.columns,
            rm.node_integers,
            parent,
            za,
            node,
            zb,
            axis,
            weight,
        )
        ahead = heuristic(
            rm.orientations, rm.joints, rm.columns, layer, column, zb, axis, goals, weight
        )
        open_entry(rm, cost + inflation * ahead, cost, za, node, parent, line)


@inlined
def _reach(rm, node, parent, leave, entry, cost, via):
    rm.node_integers[node, NODE_STAMP] = rm.counters[QUERY]
    rm.node_integers[node, NODE_PARENT] = parent
    rm.node_integers[node, NODE_VIA] = via
    rm.node_reals[node, NODE_COST] = cost
    rm.node_reals[node, NODE_ENTRY] = entry
    rm.node_reals[node, NODE_LEAVE] = leave
    rm.node_integers[node, NODE_NEXT] = -1
    if rm.counters[FIRST_REACHED] < 0:
        rm.counters[FIRST_REACHED] = node
    else:
        rm.node_integers[rm.counters[LAST_REACHED], NODE_NEXT] = node
    rm.counters[LAST_REACHED] = node


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
        find_nearest(rm.orientations, rm.joints, rm.layer_neighbours, layer, own, joined, weight)
    for k in range(rm.layer_neighbours.shape[1]):
        other = rm.layer_neighbours[layer, k]
        if other >= 0:
            _promise(rm, node, other, column, axis, goals, inflation, weight)
    rm.counters[EXPANSIONS] += 1


@inlined
def _meets_goal(model, rm, node, axis, goals, ends, placed):
    """The goal to which the direct motion from ``node`` is proved free, or −1."""
    entry = rm.node_reals[node, NODE_ENTRY]
    write_pose(rm.orientations, rm.columns, rm.node_integers, node, entry, axis, ends[0])
    for k in range(goals.shape[0]):
        for m in range(3):
            ends[1, m] = goals[k, 1 + m]
        for m in range(rm.orientations.shape[1]):
            ends[1, 3 + m] = rm.orientations[int(goals[k, 0]), m]
        proved = middle_is_free(model, rm, ends, placed) and is_proved(model, rm, ends)
        rm.counters[PROVED if proved else REFUTED] += 1
        if proved:
            return k
    return -1


@kernel
def begin(model, rm, starts, goals, axis, inflation, weight):
    """Start a query: rows of ``starts`` and ``goals`` are (layer, x, y, z, column)."""
    intervals = np.empty((CAPACITY, 2))
    rm.counters[QUERY] += 1
    rm.counters[ENTRIES] = 0
    rm.counters[FREE_ENTRY] = -1
    rm.counters[OPEN] = 0
    rm.counters[GOAL_REACHED] = -1
    rm.counters[FIRST_REACHED] = rm.counters[LAST_REACHED] = -1
    rm.counters[OFFERED] = rm.counters[ENDS]
    rm.counters[KNOWN_ENDS] = rm.counters[ENDS]
    for k in range(starts.shape[0]):
        swept = starts[k, 1 + axis]
        layer, column = int(starts[k, 0]), int(starts[k, 4])
        node = node_at(model, rm, layer, column, swept, axis, intervals)
        ahead = heuristic(
            rm.orientations, rm.joints, rm.columns, layer, column, swept, axis, goals, weight
        )
        open_entry(rm, inflation * ahead, 0.0, swept, node, -1, -1)
    return SEARCHING


@inlined
def _has_room(rm):
    """Whether every table has room for one more step of the search."""
    counters = rm.counters
    branches = rm.column_neighbours.shape[1] + rm.layer_neighbours.shape[1] + counters[ENDS]
    branches += OFFERS * (counters[ENDS] - counters[OFFERED])
    return (
        counters[NODES] + 2 * CAPACITY < rm.node_reals.shape[0]
        and counters[EDGES] + 2 < rm.edge_reals.shape[0]
        and 2 * (counters[EDGES] + 2) < rm.edges.shape[1]
        and 2 * (counters[LINES] + 2) < rm.lines.shape[1]
        and counters[ENTRIES] + branches + 2 * CAPACITY < rm.entry_reals.shape[0]
    )


@kernel
def search(model, rm, goals, axis, inflation, weight, steps):
    """Up to ``steps`` steps of the search: SEARCHING, SOLVED, EXHAUSTED or GROW.

    When SOLVED, counters[GOAL_REACHED] packs the last node and the goal:
    node · (number of goals) + goal.
    """
    intervals = np.empty((CAPACITY, 2))
    ends = np.empty((2, 3 + rm.orientations.shape[1]))
    placed = new_placed(scene_of(model))
    if not _has_room(rm):
        return GROW
    offer_new_passages(rm, axis, goals, inflation, weight)
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
            node = pass_through(model, rm, parent, via, axis, ends, placed, intervals)
            if node < 0:
                continue
        elif node < 0:
            _open_edges(model, rm, parent, line, axis, goals, inflation, weight, intervals)
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
            za, zb, proved = prove_edge(model, rm, parent, node, entry, axis, ends)
            if not proved:
                continue
            cost = rm.node_reals[parent, NODE_COST] + abs(entry - za)
            cost += step_length(
                rm.orientations,
                rm.joints,
                rm.columns,
                rm.node_integers,
                parent,
                za,
                node,
                zb,
                axis,
                weight,
            )
            _reach(rm, node, parent, za, zb, cost, -1)
        goal = _meets_goal(model, rm, node, axis, goals, ends, placed)
        if goal >= 0:
            rm.counters[GOAL_REACHED] = node * goals.shape[0] + goal
            return SOLVED
        _expand(rm, node, axis, goals, inflation, weight)
        offer_passages(rm, node, 0, axis, goals, inflation, weight)
    return SEARCHING
