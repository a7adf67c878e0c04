"""Distances and places on the roadmap."""

import math

from .compile import kernel
from .linear import norm
from .roadmap_tables import NODE_COLUMN, NODE_HIGH, NODE_LAYER, NODE_LOW

# Columns of the table of joints: kind, where the value stands in a layer's row, and what it counts.
METRIC_REAL = 0
METRIC_CONTINUOUS = 1
METRIC_BALL = 2
METRIC = 3


@kernel
def half_angle(p, q, at):
    """Half the angle between the rotations of the quaternions at ``at`` of two rows [rad]."""
    dot = abs(p[at] * q[at] + p[at + 1] * q[at + 1] + p[at + 2] * q[at + 2] + p[at + 3] * q[at + 3])
    return math.acos(min(dot, 1.0))


@kernel
def turn_length(joints, p, q, weight):
    """Length of the way between two layers' rows (4 + V,): turn and joints (thesis 6.3.1).

    ``weight`` is that of the base's turn [rad]; ``joints`` (J, METRIC) tells what others count.
    """
    total = weight * 2.0 * half_angle(p, q, 0)
    for j in range(joints.shape[0]):
        kind, at = int(joints[j, 0]), int(joints[j, 1])
        if kind == METRIC_BALL:
            away = half_angle(p, q, at)
        else:
            away = abs(p[at] - q[at])
            if kind == METRIC_CONTINUOUS and away > math.pi:
                away = abs(2.0 * math.pi - away)
        total += joints[j, 2] * away
    return total


@kernel
def heuristic(orientations, joints, columns, layer, column, swept, axis, goals, weight):
    """Smallest distance to a goal row (layer, x, y, z)."""
    best = math.inf
    for k in range(goals.shape[0]):
        total = 0.0
        for m in range(3):
            value = swept if m == axis else columns[column, m]
            total += (value - goals[k, 1 + m]) ** 2
        goal = orientations[int(goals[k, 0])]
        turn = turn_length(joints, orientations[layer], goal, weight)
        best = min(best, math.sqrt(total) + turn)
    return best


@kernel
def step_length(orientations, joints, columns, nodes, a, za, b, zb, axis, weight):
    """Length of the edge from node ``a`` at ``za`` to node ``b`` at ``zb``."""
    ca, cb = nodes[a, NODE_COLUMN], nodes[b, NODE_COLUMN]
    total = (za - zb) ** 2
    for m in range(3):
        if m != axis:
            total += (columns[ca, m] - columns[cb, m]) ** 2
    la, lb = nodes[a, NODE_LAYER], nodes[b, NODE_LAYER]
    if la == lb:
        return math.sqrt(total)
    return math.sqrt(total) + turn_length(joints, orientations[la], orientations[lb], weight)


@kernel
def write_pose(orientations, columns, nodes, node, swept, axis, out):
    """Write the pose (7 + V,) of ``node`` at the coordinate ``swept`` to ``out``."""
    layer, column = nodes[node, NODE_LAYER], nodes[node, NODE_COLUMN]
    for m in range(3):
        out[m] = swept if m == axis else columns[column, m]
    for m in range(orientations.shape[1]):
        out[3 + m] = orientations[layer, m]


@kernel
def apart(nodes, a, b):
    """Length of the gap between the intervals of two nodes; negative where they overlap."""
    return max(nodes[b, NODE_LOW] - nodes[a, NODE_HIGH], nodes[a, NODE_LOW] - nodes[b, NODE_HIGH])


@kernel
def across(columns, a, b):
    """Distance of two columns."""
    dx, dy = columns[a, 0] - columns[b, 0], columns[a, 1] - columns[b, 1]
    return norm(dx, dy, columns[a, 2] - columns[b, 2])
