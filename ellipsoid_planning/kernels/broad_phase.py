"""Broad phase: which obstacles have boxes that meet a given box.

The tree's nodes stand in preorder, each with the index to go on from when its box is missed, so a
traversal needs neither a stack nor a buffer:

    node = next_overlap(tree, 0, …box…)
    while node >= 0:
        obstacle = int(tree[node, NODE_OBSTACLE])
        …
        node = next_overlap(tree, node + 1, …box…)
"""

from .compile import kernel
from .layout import NODE_HIGH, NODE_LOW, NODE_OBSTACLE, NODE_SKIP


@kernel
def next_overlap(tree, node, x0, y0, z0, x1, y1, z1):
    """First leaf at or after ``node`` whose box meets [(x0, y0, z0), (x1, y1, z1)], or −1."""
    count = tree.shape[0]
    while node < count:
        if (
            tree[node, NODE_LOW] <= x1
            and tree[node, NODE_HIGH] >= x0
            and tree[node, NODE_LOW + 1] <= y1
            and tree[node, NODE_HIGH + 1] >= y0
            and tree[node, NODE_LOW + 2] <= z1
            and tree[node, NODE_HIGH + 2] >= z0
        ):
            if tree[node, NODE_OBSTACLE] >= 0.0:
                return node
            node += 1
        else:
            node = int(tree[node, NODE_SKIP])
    return -1


@kernel
def overlapping_nodes(tree, x0, y0, z0, x1, y1, z1, out):
    """Write all nodes, inner ones too, whose boxes meet the given one to ``out``: their number.

    They stand in preorder, and each with all nodes above it.
    """
    count, node = 0, 0
    while node < tree.shape[0]:
        if (
            tree[node, NODE_LOW] <= x1
            and tree[node, NODE_HIGH] >= x0
            and tree[node, NODE_LOW + 1] <= y1
            and tree[node, NODE_HIGH + 1] >= y0
            and tree[node, NODE_LOW + 2] <= z1
            and tree[node, NODE_HIGH + 2] >= z0
        ):
            out[count] = node
            count += 1
            node += 1
        else:
            node = int(tree[node, NODE_SKIP])
    return count


@kernel
def _distance_to_box(tree, node, x, y, z):
    """Squared distance of a point from a node's box."""
    total = 0.0
    for k in range(3):
        value = x if k == 0 else (y if k == 1 else z)
        away = max(0.0, max(tree[node, NODE_LOW + k] - value, value - tree[node, NODE_HIGH + k]))
        total += away * away
    return total


@kernel
def near_obstacle(tree, x, y, z):
    """An obstacle near the point, mostly among the nearest; −1 if none is found.

    From the root down, always into the nearer box. A tree that was cut out of a larger one
    (cspace.packing.scene_within) may end where no obstacle is.
    """
    if tree.shape[0] == 0:
        return -1
    node = 0
    while tree[node, NODE_OBSTACLE] < 0.0:
        end = int(tree[node, NODE_SKIP])
        first = node + 1
        if first >= end:
            return -1
        node = first
        second = int(tree[first, NODE_SKIP])
        if second < end:
            near = _distance_to_box(tree, first, x, y, z)
            if _distance_to_box(tree, second, x, y, z) < near:
                node = second
    return int(tree[node, NODE_OBSTACLE])
