"""The arrays of a pair of search trees, and what stands where in them (see kernels.tree)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Status of a burst
GROWING = 0
SOLVED = 1
GROW = 2

# Counters; the first two are the trees' numbers of nodes
STEPS = 2
ROWS_USED = 3
BLOCKED_DRAWS = 4
PROVED = 5
REFUTED = 6
# Where the trees met when a burst ended with SOLVED: a node of either.
MEETING = 7
COUNTERS = 9

# Columns of links: the parent, and the node's place in its tree's k-d tree
PARENT = 0
BELOW = 1
ABOVE = 2
SPLIT = 3
LINKS = 4

NONE = -1


class Trees(NamedTuple):
    """Two trees, from the starts (0) and from the goals (1); the first five arrays grow.

    Attributes:
        poses: (2, N, 7).
        links: (2, N, LINKS): parent, children and coordinate in the k-d tree; NONE where there is
            no such node.
        cells, bounds, parts: workspaces (N,), (N,) and (N, 7) of nearest neighbours.
        box: workspace (2, 7): a cell of a k-d tree.
        ends: workspace (4, 7): the sample, the target of a motion, its last proved pose, and one
            that is tried.
        counters: (COUNTERS,).
        motion, motion_placed, motion_stack: workspaces of kernels.motion.
    """

    poses: NDArray[np.float64]
    links: NDArray[np.int64]
    cells: NDArray[np.int64]
    bounds: NDArray[np.float64]
    parts: NDArray[np.float64]
    box: NDArray[np.float64]
    ends: NDArray[np.float64]
    counters: NDArray[np.int64]
    motion: NDArray[np.float64]
    motion_placed: NDArray[np.float64]
    motion_stack: NDArray[np.float64]
