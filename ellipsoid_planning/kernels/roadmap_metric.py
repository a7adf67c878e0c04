"""Distances and places on the roadmap."""

import math

from .compile import kernel
from .linear import norm
from .roadmap_tables import NODE_COLUMN, NODE_HIGH, NODE_LAYER, NODE_LOW


@kernel
def angle(orientations, a, b):
    """Angle between the orientations of two layers [rad]."""
    p, q = orientations[a], orientations[b]
    dot = abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3])
    return 2.0 * math.acos(min(dot, 1.0))


@kernel
def heuristic(orientations, columns, layer, column, swept, axis, goals, weight):
    """Smallest distance to a goal row (layer, x, y, z)."""
    best = math.inf
    for k in range(goals.shape[0]):
        total = 0.0
        for m in range(3):
            value = swept if m == axis else columns[column, m]
            total += (value - goals[k, 1 + m]) ** 2
        distance = math.sqrt(total) + weight * angle(orientations, layer, int(goals[k, 0]))
        best = min(best, distance)
    return best


@kernel
def step_length(orientations, columns, nodes, a, za, b, zb, axis, weight):
    """Length of the edge from node ``a`` at ``za`` to node ``b`` at ``zb``."""
    ca, cb = nodes[a, NODE_COLUMN], nodes[b, NODE_COLUMN]
    total = (za - zb) ** 2
    for m in range(3):
        if m != axis:
            total += (columns[ca, m] - columns[cb, m]) ** 2
    la, lb = nodes[a, NODE_LAYER], nodes[b, NODE_LAYER]
    return math.sqrt(total) + (weight * angle(orientations, la, lb) if la != lb else 0.0)


@kernel
def write_pose(orientations, columns, nodes, node, swept, axis, out):
    """Write the pose (7,) of ``node`` at the coordinate ``swept`` to ``out``."""
    layer, column = nodes[node, NODE_LAYER], nodes[node, NODE_COLUMN]
    for m in range(3):
        out[m] = swept if m == axis else columns[column, m]
    for m in range(4):
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
