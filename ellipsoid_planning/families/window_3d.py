"""``window-3d``: a hole among three or four big bodies, which a long robot must be turned for."""

from __future__ import annotations

from ellipsoid_planning.families.gap import one_wall
from ellipsoid_planning.families.openings import frame
from ellipsoid_planning.families.scene import Layout, Request
from ellipsoid_planning.families.shapes import long_shape


def window_3d(request: Request) -> Layout:
    """A window between two rooms; start and goal orientations do not fit."""
    shape = long_shape(request.draws, 3)
    count = request.draws.integer(4, 3, 4)
    return one_wall(request, shape, frame(shape.main, request.draws, count), fits=False)
