"""Edges of the roadmap, proved when the search first wants to use them."""

import math

from .compile import inlined, kernel
from .containers import EMPTY, lookup, store
from .roadmap_metric import METRIC_BALL, METRIC_CONTINUOUS, write_pose
from .roadmap_tables import (
    EDGE_LOWER,
    EDGE_PROVED,
    EDGE_STAMP,
    EDGE_TRIED,
    EDGE_UPPER,
    EDGES,
    NODE_BITS,
    NODE_HIGH,
    NODE_LOW,
    PROVED,
    QUERY,
    REFUTED,
)
from .robot_model import pose_is_free, prove_way


@kernel
def crossing(nodes, a, b, entry, choice):
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
def is_proved(model, rm, ends):
    """Whether the motion between the two poses ``ends`` is proved free."""
    return prove_way(model, ends[0], ends[1], rm.motion) > 0


@inlined
def middle_is_free(model, rm, ends, placed):
    """Whether the robot is free half-way, which most long motions that are not free show."""
    first, last, middle = ends[0], ends[1], rm.pose
    for m in range(middle.shape[0]):
        middle[m] = 0.5 * (first[m] + last[m])
    _set_middle(first, last, 3, middle)
    for j in range(rm.joints.shape[0]):
        kind, at = int(rm.joints[j, 0]), 3 + int(rm.joints[j, 1])
        if kind == METRIC_BALL:
            _set_middle(first, last, at, middle)
        elif kind == METRIC_CONTINUOUS and abs(last[at] - first[at]) > math.pi:
            middle[at] += math.pi if middle[at] < 0.0 else -math.pi
    return pose_is_free(model, middle, placed)


@kernel
def _set_middle(first, last, at, middle):
    """Write the quaternion half-way between those at ``at`` of two rows, of any length."""
    dot = 0.0
    for m in range(4):
        dot += first[at + m] * last[at + m]
    # The sum of two unit quaternions, the shorter way round, points half-way between them.
    sign = -1.0 if dot < 0.0 else 1.0
    for m in range(4):
        middle[at + m] = first[at + m] + sign * last[at + m]


@inlined
def prove_edge(model, rm, a, b, entry, axis, ends):
    """Where a proved edge leaves ``a`` and enters ``b``: (z_a, z_b, proved), remembered.

    What an earlier query found out is used where this one would have tried the same motions, so
    that it goes the same way as on an empty roadmap.
    """
    key = (min(a, b) << NODE_BITS) | max(a, b)
    edge = lookup(rm.edges, key)
    first_try, _, _ = crossing(rm.node_reals, a, b, entry, 0)
    third_try, _, _ = crossing(rm.node_reals, a, b, entry, 2)
    if edge != EMPTY:
        row = rm.edge_reals[edge]
        same = row[EDGE_TRIED] == first_try and row[EDGE_TRIED + 1] == third_try
        if same or row[EDGE_STAMP] == rm.counters[QUERY]:
            # What this query was told once, it is told again.
            row[EDGE_STAMP] = rm.counters[QUERY]
            if a < b:
                return row[EDGE_LOWER], row[EDGE_UPPER], row[EDGE_PROVED] > 0.0
            return row[EDGE_UPPER], row[EDGE_LOWER], row[EDGE_PROVED] > 0.0
    za, zb, proved = 0.0, 0.0, False
    for choice in range(4):
        za, zb, exists = crossing(rm.node_reals, a, b, entry, choice)
        if not exists:
            continue
        write_pose(rm.orientations, rm.columns, rm.node_integers, a, za, axis, ends[0])
        write_pose(rm.orientations, rm.columns, rm.node_integers, b, zb, axis, ends[1])
        proved = is_proved(model, rm, ends)
        if proved:
            break
    if edge == EMPTY:
        edge = rm.counters[EDGES]
        rm.counters[EDGES] += 1
        store(rm.edges, key, edge)
    rm.counters[PROVED if proved else REFUTED] += 1
    row = rm.edge_reals[edge]
    row[EDGE_PROVED] = 1.0 if proved else 0.0
    row[EDGE_LOWER], row[EDGE_UPPER] = (za, zb) if a < b else (zb, za)
    row[EDGE_TRIED], row[EDGE_TRIED + 1] = first_try, third_try
    row[EDGE_STAMP] = rm.counters[QUERY]
    return za, zb, proved
