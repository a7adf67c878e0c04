"""Plane sections and intersections of convex sets that are known by their support functions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.directions import unit_directions

Support = Callable[[NDArray[np.float64]], NDArray[np.float64]]
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
STEPS = 48
TILTS = np.linspace(-0.5, 0.5, 65)[1:-1] * np.pi


def section_support(
    support: Support, plane: NDArray[np.float64], normal: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """Return bounds of a plane section in `count` even directions, (count,).

    The section of {x : u.x <= h(u) for every u} by the plane through the origin with the unit
    normal n obeys v.x <= min over s of h(v + s n) for each direction v in the plane. Where h is
    a support function this is the section's own, and a negative width tells that it is empty.

    Args:
        support: h of rows (m, 3), positively homogeneous.
        plane: (2, 3), orthonormal directions within the plane.
        normal: (3,), its unit normal.
        count: the number of directions, anticlockwise from plane[0].
    """
    flat = unit_directions(2, count) @ plane

    def tilted(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(support(flat + np.tan(angle)[:, None] * normal))

    # A grid first: the difference of two support functions can have several minima.
    grid = np.array([tilted(np.full(count, tilt)) for tilt in TILTS])
    best = TILTS[np.argmin(grid, axis=0)]
    low, high = best - (TILTS[1] - TILTS[0]) * 0.999, best + (TILTS[1] - TILTS[0]) * 0.999
    for _ in range(STEPS):
        first, second = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        left = tilted(first) <= tilted(second)
        low, high = np.where(left, low, first), np.where(left, second, high)
    return np.asarray(np.minimum(tilted(0.5 * (low + high)), grid.min(axis=0)))


def intersect_half_planes(
    polygon: NDArray[np.float64], normals: NDArray[np.float64], offsets: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Cut a convex polygon (k, 2) down to the points x with normals @ x <= offsets.

    Returns the corners that are left, (j, 2), none of them if nothing is.
    """
    for normal, offset in zip(normals, offsets, strict=True):
        excess = polygon @ normal - offset
        if np.all(excess <= 0.0):
            continue
        following = np.roll(polygon, -1, axis=0)
        after = np.roll(excess, -1)
        crossing = (excess <= 0.0) != (after <= 0.0)
        share = np.where(crossing, excess, 0.0) / np.where(crossing, excess - after, 1.0)
        cuts = polygon + share[:, None] * (following - polygon)
        corners = np.stack([polygon, cuts], axis=1)
        polygon = corners[np.stack([excess <= 0.0, crossing], axis=1)]
        if len(polygon) == 0:
            break
    return polygon
