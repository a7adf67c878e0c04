"""The growing arrays of a pair of trees (see kernels.tree_tables.Trees)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import tree, tree_tables
from ellipsoid_planning.kernels.motion import motion_workspaces
from ellipsoid_planning.kernels.tree_tables import Trees

_ROWS = 1 << 9
# A step of the search has room for the nodes that it can add at most, and one more.
_ROOM = tree.LONGEST + 2


def new_trees() -> Trees:
    """Two empty trees."""
    workspace, placed, stack = motion_workspaces()
    return Trees(
        poses=np.empty((2, _ROWS, 7)),
        links=np.empty((2, _ROWS, tree_tables.LINKS), dtype=np.int64),
        cells=np.empty(_ROWS, dtype=np.int64),
        bounds=np.empty(_ROWS),
        parts=np.empty((_ROWS, 7)),
        box=np.empty((2, 7)),
        ends=np.empty((4, 7)),
        counters=np.zeros(tree_tables.COUNTERS, dtype=np.int64),
        motion=workspace,
        motion_placed=placed,
        motion_stack=stack,
    )


def grown(trees: Trees, nodes: int = 0) -> Trees:
    """``trees`` with room for ``nodes`` more in each of them, and for one step of the search."""
    used = int(trees.counters[:2].max())
    size = trees.poses.shape[1]
    while used + nodes + _ROOM > size:
        size *= 2
    if size == trees.poses.shape[1]:
        return trees
    return trees._replace(
        poses=_longer(trees.poses, size),
        links=_longer(trees.links, size),
        cells=np.empty(size, dtype=np.int64),
        bounds=np.empty(size),
        parts=np.empty((size, 7)),
    )


def _longer(array: NDArray[Any], size: int) -> NDArray[Any]:
    out = np.empty((2, size, array.shape[2]), dtype=array.dtype)
    out[:, : array.shape[1]] = array
    return out


def path_of(trees: Trees) -> NDArray[np.float64]:
    """The poses (m, 7) from the root of the first tree to that of the second, where they met."""
    halves = []
    for side in range(2):
        node, rows = int(trees.counters[tree_tables.MEETING + side]), []
        while node != tree_tables.NONE:
            rows.append(trees.poses[side, node])
            node = int(trees.links[side, node, tree_tables.PARENT])
        halves.append(rows)
    return np.array(halves[0][::-1] + halves[1])


def edges_of(trees: Trees) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """First and last poses (k, 7) of all edges, in the direction in which they are proved."""
    pairs = []
    for side in range(2):
        count = int(trees.counters[side])
        poses = trees.poses[side, :count]
        parents = trees.links[side, :count, tree_tables.PARENT]
        child = np.flatnonzero(parents != tree_tables.NONE)
        ends = poses[parents[child]], poses[child]
        pairs.append(ends if side == 0 else ends[::-1])
    return np.vstack([pairs[0][0], pairs[1][0]]), np.vstack([pairs[0][1], pairs[1][1]])
