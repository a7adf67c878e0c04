"""Nearest neighbours in a search tree: a k-d tree that grows with it.

The metric is that of the roadmap: the distance of the positions plus ``weight`` times the angle
between the orientations. The k-d tree splits positions and quaternions. Two unit quaternions δ
apart differ by an angle of at least 2 δ; since q and −q are the same rotation, both are looked
for.

A node splits its cell at itself, along the cell's longest side in that metric. Nothing is ever
balanced: samples are random enough for depths that are a small multiple of the logarithm.
"""

import math

from .compile import kernel
from .layout import HIGH, LOW
from .tree_tables import ABOVE, BELOW, NONE, PARENT, SPLIT


@kernel
def distance(first, last, weight):
    """Distance of two poses (7,) with unit quaternions."""
    x, y, z = last[0] - first[0], last[1] - first[1], last[2] - first[2]
    dot = first[3] * last[3] + first[4] * last[4] + first[5] * last[5] + first[6] * last[6]
    return math.sqrt(x * x + y * y + z * z) + 2.0 * weight * math.acos(min(abs(dot), 1.0))


@kernel
def insert(scene, trees, tree, pose, parent, weight):
    """Add a pose (7,) to a tree that has room for it; returns its node."""
    poses, links, box = trees.poses[tree], trees.links[tree], trees.box
    node = trees.counters[tree]
    trees.counters[tree] += 1
    for k in range(7):
        poses[node, k] = pose[k]
        box[0, k] = scene[LOW + k] if k < 3 else -1.0
        box[1, k] = scene[HIGH + k] if k < 3 else 1.0
    links[node, PARENT] = parent
    links[node, BELOW], links[node, ABOVE] = NONE, NONE
    here = 0
    while here != node:
        split = links[here, SPLIT]
        above = pose[split] >= poses[here, split]
        box[0 if above else 1, split] = poses[here, split]
        child = ABOVE if above else BELOW
        if links[here, child] == NONE:
            links[here, child] = node
        here = links[here, child]
    longest, split = -1.0, 0
    for k in range(7):
        side = (box[1, k] - box[0, k]) * (1.0 if k < 3 else 2.0 * weight)
        if side > longest:
            longest, split = side, k
    links[node, SPLIT] = split
    return node


@kernel
def nearest(trees, tree, target, weight):
    """The node of a tree, which is not empty, that is nearest to the pose ``target`` (7,)."""
    poses, links = trees.poses[tree], trees.links[tree]
    # Cells that are still to be looked into: their nodes, how far they are at least, and the
    # squared parts of that by coordinate. Row 0 holds the parts of the present cell.
    cells, bounds, parts = trees.cells, trees.bounds, trees.parts
    best, found = math.inf, 0
    for turn in range(2 if weight > 0.0 else 1):
        sign = 1.0 if turn == 0 else -1.0
        cells[1], bounds[1] = 0, 0.0
        for k in range(7):
            parts[1, k] = 0.0
        depth = 1
        while depth > 0:
            node, bound = cells[depth], bounds[depth]
            for k in range(7):
                parts[0, k] = parts[depth, k]
            depth -= 1
            while node != NONE and bound < best:
                x, y = target[0] - poses[node, 0], target[1] - poses[node, 1]
                z = target[2] - poses[node, 2]
                if x * x + y * y + z * z < best * best:
                    away = distance(poses[node], target, weight)
                    if away < best:
                        best, found = away, node
                split = links[node, SPLIT]
                offset = (sign if split >= 3 else 1.0) * target[split] - poses[node, split]
                above = offset >= 0.0
                far = links[node, BELOW if above else ABOVE]
                node = links[node, ABOVE if above else BELOW]
                if far == NONE:
                    continue
                place, turned = 0.0, 0.0
                for k in range(7):
                    part = offset * offset if k == split else parts[0, k]
                    parts[depth + 1, k] = part
                    if k < 3:
                        place += part
                    else:
                        turned += part
                least = math.sqrt(place) + 2.0 * weight * math.sqrt(turned)
                if least < best:
                    depth += 1
                    cells[depth], bounds[depth] = far, least
    return found
