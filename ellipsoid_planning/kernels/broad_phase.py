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
