"""How far around its ends a query looks: little of a large world at first, more if need be.

Only the surroundings decide what a plan costs, then, and not the size of the world. The lines of a
level stand in its box, so that a small box has them close together.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

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
# A box of a larger share of the bounds than this is not worth it: the whole is taken.
_LARGEST_SHARE = 0.25


def query_box(cspace: CSpace, ends: Array, doublings: int) -> Box | None:
    """Corners (n,), (n,) of a box around the positions of ``ends`` (m, 7); None for everything.

    Each of ``doublings`` doubles the margin, until the box is not worth it. Margins are powers of
    √2 of the robot's reach and corners stand on a lattice, so that queries from about here to
    about there share a box, and its roadmap.
    """
    n, world = cspace.dimension, cspace.world
    low, high = ends[:, :n].min(axis=0), ends[:, :n].max(axis=0)
    reach = float(layout.part_rows(cspace.scene)[:, layout.PART_REACH].max())
    least = max(_REACHES, _SPANS * float(np.max(high - low)) / reach)
    margin = reach * 2.0 ** (0.5 * math.ceil(2.0 * math.log2(least)) + doublings)
    step = margin / _STEPS
    low = np.maximum(world.low, (np.floor(low / step) - _STEPS) * step)
    high = np.minimum(world.high, (np.ceil(high / step) + _STEPS) * step)
    if np.prod((high - low) / (world.high - world.low)) > _LARGEST_SHARE:
        return None
    return low, high


def within(cspace: CSpace, box: Box | None) -> CSpace:
    """The part of ``cspace`` in a box; all of it if there is none."""
    return cspace if box is None else LocalCSpace(cspace, *box)
