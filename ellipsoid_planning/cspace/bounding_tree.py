"""A bounding-volume tree over obstacles, in the preorder that kernels.broad_phase walks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import layout

Array = NDArray[np.float64]


def bounding_tree(obstacles: Array) -> Array:
    """Nodes (2 m − 1, NODE) of a balanced tree over body rows (m, BODY); (0, NODE) for none.

    Splits at the median centre along the widest axis. Leaves hold one obstacle each.
    """
    count = len(obstacles)
    nodes = np.full((max(2 * count - 1, 0), layout.NODE), -1.0)
    if count == 0:
        return nodes
    centre = obstacles[:, layout.BODY_CENTRE : layout.BODY_CENTRE + 3]
    extent = obstacles[:, layout.BODY_EXTENT : layout.BODY_EXTENT + 3]
    # Outward by some roundings: a box must never be smaller than its body.
    extent = extent + 1e-14 * (np.abs(centre) + extent)
    low, high = centre - extent, centre + extent
    pending = [(0, np.arange(count))]
    while pending:
        node, members = pending.pop()
        nodes[node, layout.NODE_LOW : layout.NODE_LOW + 3] = low[members].min(axis=0)
        nodes[node, layout.NODE_HIGH : layout.NODE_HIGH + 3] = high[members].max(axis=0)
        nodes[node, layout.NODE_SKIP] = node + 2 * len(members) - 1
        if len(members) == 1:
            nodes[node, layout.NODE_OBSTACLE] = members[0]
            continue
        axis = int(np.argmax(np.ptp(centre[members], axis=0)))
        middle = len(members) // 2
        order = members[np.argpartition(centre[members, axis], middle)]
        pending.append((node + 1, order[:middle]))
        pending.append((node + 2 * middle, order[middle:]))
    return nodes
