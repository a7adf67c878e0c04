"""The packed scene: one flat float64 array that every kernel reads.

A single array keeps the cost of entering a kernel from Python low. It holds a header followed by
four tables, each a block of rows:

- *obstacles* and *arenas*, rows of ``BODY`` numbers: centre, A (row-major, A = R diag(a)), the
  inverse of A grown (obstacle) or shrunk (arena) by the clearance, its own inverse, largest
  semi-axis, half-extents of the axis-aligned box;
- *parts* of the robot in the base frame, rows of ``PART`` numbers: centre, A, largest semi-axis,
  largest distance of a point of the part from the base's origin;
- *tree*, rows of ``NODE`` numbers: a bounding-volume tree over the obstacles (see broad_phase).

Parts placed in the world (or in a layer, with the base at the origin) are rows of ``PLACED``
numbers: centre, rotated A, half-extents.
"""

import numpy as np

from .compile import kernel

# Header
OBSTACLE_COUNT = 0
ARENA_COUNT = 1
PART_COUNT = 2
DIMENSION = 3
CLEARANCE = 4
LOW = 5
HIGH = 8
SCALE = 11
HEADER = 12

# Body rows
BODY_CENTRE = 0
BODY_MATRIX = 3
BODY_WHITEN = 12
BODY_INVERSE = 21
BODY_RADIUS = 30
BODY_EXTENT = 31
BODY = 34

# Part rows
PART_CENTRE = 0
PART_MATRIX = 3
PART_RADIUS = 12
PART_REACH = 13
PART = 14

# Tree rows
NODE_LOW = 0
NODE_HIGH = 3
NODE_SKIP = 6
NODE_OBSTACLE = 7
NODE = 8

# Placed parts
PLACED_CENTRE = 0
PLACED_MATRIX = 3
PLACED_EXTENT = 12
PLACED = 15

# Rounding: a decision counts only if it holds by more than ROUNDING times the scene's scale, which
# covers some 30 roundings of numbers of that size. Intervals keep TOLERANCE times the scale away
# from contact, so that every point in them is provably free.
ROUNDING = 32 * 2.220446049250313e-16
TOLERANCE = 1e-12


@kernel
def obstacle_rows(scene):
    """Rows of the obstacles, shape (m, BODY), as a view."""
    count = int(scene[OBSTACLE_COUNT])
    return scene[HEADER : HEADER + count * BODY].reshape((count, BODY))


@kernel
def arena_rows(scene):
    """Rows of the arenas, shape (a, BODY), as a view."""
    first = HEADER + int(scene[OBSTACLE_COUNT]) * BODY
    count = int(scene[ARENA_COUNT])
    return scene[first : first + count * BODY].reshape((count, BODY))


@kernel
def part_rows(scene):
    """Rows of the robot's parts, shape (k, PART), as a view."""
    first = HEADER + int(scene[OBSTACLE_COUNT] + scene[ARENA_COUNT]) * BODY
    count = int(scene[PART_COUNT])
    return scene[first : first + count * PART].reshape((count, PART))


@kernel
def tree_rows(scene):
    """Rows of the obstacles' bounding-volume tree, shape (nodes, NODE), as a view."""
    bodies = int(scene[OBSTACLE_COUNT] + scene[ARENA_COUNT])
    first = HEADER + bodies * BODY + int(scene[PART_COUNT]) * PART
    count = (scene.size - first) // NODE
    return scene[first : first + count * NODE].reshape((count, NODE))


@kernel
def new_placed(scene):
    """An empty table for the robot's placed parts, shape (k, PLACED)."""
    return np.empty((int(scene[PART_COUNT]), PLACED))
