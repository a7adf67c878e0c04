"""How far around its ends a query looks: little of a large world at first, more if need be.

Only the surroundings decide what a plan costs, then, and not the size of the world. The lines of a
level stand in its box, so that a small box has them close together.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import layout

Array = NDArray[np.float64]
Box = tuple[Array, Array]

# The first margin around starts and goals: so many times the robot's reach, and at least this
# fraction of how far they are apart.
_REACHES = 2.0
_SPANS = 0.5
# Corners stand on a lattice of so many steps to the margin.
_STEPS = 4
# Each box has a margin this many times that of the one before.
_GROWTH = 4.0
# A box of a larger share of the bounds than this is not worth it: the whole is taken.
_LARGEST_SHARE = 0.25


def query_boxes(cspace: CSpace, ends: Array) -> list[Box | None]:
    """Boxes around the positions of ``ends`` (m, 7), each larger than the one before.

    The last one is None: everything. A box is its two corners (n,). Margins are powers of √2 of
    the robot's reach and corners stand on a lattice, so that queries from about here to about
    there share boxes, and their roadmaps.
    """
    if isinstance(cspace, ArticulatedCSpace):
        return [None]
    n = cspace.dimension
    low, high = ends[:, :n].min(axis=0), ends[:, :n].max(axis=0)
    reach = float(layout.part_rows(cspace.scene)[:, layout.PART_REACH].max())
    least = max(_REACHES, _SPANS * float(np.max(high - low)) / reach)
    margin = reach * 2.0 ** (0.5 * math.ceil(2.0 * math.log2(least)))
    boxes: list[Box | None] = []
    while (box := _box(cspace, low, high, margin)) is not None:
        boxes.append(box)
        margin *= _GROWTH
    return [*boxes, None]


def _box(cspace: CSpace, low: Array, high: Array, margin: float) -> Box | None:
    """The box from ``low`` to ``high`` (n,) with a margin; None if it is not worth it."""
    world, step = cspace.world, margin / _STEPS
    first = np.maximum(world.low, (np.floor(low / step) - _STEPS) * step)
    last = np.minimum(world.high, (np.ceil(high / step) + _STEPS) * step)
    if np.prod((last - first) / (world.high - world.low)) > _LARGEST_SHARE:
        return None
    return first, last


def is_same(first: Box | None, second: Box | None) -> bool:
    """Whether two boxes are one."""
    if first is None or second is None:
        return first is second
    return np.array_equal(first, second)


def within(cspace: CSpace, box: Box | None) -> CSpace:
    """The part of ``cspace`` in a box; all of it if there is none."""
    return cspace if box is None else LocalCSpace(cspace, *box)
