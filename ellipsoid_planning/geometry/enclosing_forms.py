"""Minimum-volume ellipsoids around boxes, cylinders and capsules in closed form.

All are centred at the origin and aligned with the axes; cylinders and capsules along z. The
ellipsoid has the body's symmetries, because the minimum-volume one is unique.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.enclosing import THINNEST

Array = NDArray[np.float64]


def box_semi_axes(half_sizes: ArrayLike) -> Array:
    """Semi-axes (n,) for the box |x_i| <= h_i, h_i > 0: all corners have the norm sqrt(n)."""
    half = np.asarray(half_sizes, dtype=float)
    axes = math.sqrt(len(half)) * half
    return np.maximum(axes, THINNEST * axes.max())


def cylinder_semi_axes(radius: float, half_length: float) -> Array:
    """Semi-axes (3,) for the cylinder: minimise a^2 b with (r/a)^2 + (h/b)^2 = 1.

    Flat discs, also of no length, get the thickness `THINNEST` times their width.
    """
    across, along = math.sqrt(1.5) * radius, math.sqrt(3.0) * half_length
    if along < THINNEST * across:
        # Twice the thickness of the body leaves the disc nearly its own radius.
        along = max(THINNEST * radius, 2.0 * half_length)
        across = radius / math.sqrt(1.0 - (half_length / along) ** 2)
    across = max(across, THINNEST * along)
    return np.array([across, across, along])


def capsule_semi_axes(radius: float, half_length: float) -> Array:
    """Semi-axes (3,) for the convex hull of two balls about (0, 0, +-h).

    The norm over the upper ball is largest where z - h = h / m, with b^2 = (1 + m) a^2, and there
    it is 1 if a^2 = r^2 + h^2 / m. The volume a^3 sqrt(1 + m) is least at the positive root of
    r^2 m^2 - 2 h^2 m - 3 h^2 = 0.
    """
    r, h = radius, half_length
    if h == 0.0:
        return np.full(3, r)
    m = h * (h + math.hypot(h, math.sqrt(3.0) * r)) / (r * r)
    across = math.sqrt(r * r + h * h / m)
    along = math.sqrt(1.0 + m) * across
    return np.array([max(across, THINNEST * along)] * 2 + [along])
