"""Intrinsic measures of ellipses and ellipsoids, exact and vectorised.

With Carlson's R_G the perimeter is L = 8 R_G(0, a^2, b^2), the surface F = 4 pi R_G(a^2 b^2,
a^2 c^2, b^2 c^2) and the total mean curvature M = 4 pi R_G(a^2, b^2, c^2): closed forms for
thesis eq. (5.42), (5.73) and (5.54), accurate for spheres, needles and discs alike.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.carlson import mean_length

Array = NDArray[np.float64]


def area(semi_axes: ArrayLike) -> Array:
    """Return the area of ellipses with semi-axes (..., 2), shape (...).

    Raises:
        GeometryError: here and below, if the shape is wrong or an axis is not positive.
    """
    return np.asarray(math.pi * np.prod(checked_axes(semi_axes, 2), axis=-1))


def perimeter(semi_axes: ArrayLike) -> Array:
    """Return the perimeter L of ellipses with semi-axes (..., 2), shape (...); eq. (5.42)."""
    axes = checked_axes(semi_axes, 2)
    return 8.0 * mean_length(np.concatenate([axes, np.zeros_like(axes[..., :1])], axis=-1))


def volume(semi_axes: ArrayLike) -> Array:
    """Return the volume of ellipsoids with semi-axes (..., 3), shape (...); eq. (5.21)."""
    return np.asarray(4.0 / 3.0 * math.pi * np.prod(checked_axes(semi_axes, 3), axis=-1))


def surface_area(semi_axes: ArrayLike) -> Array:
    """Return the surface F of ellipsoids with semi-axes (..., 3), shape (...); eq. (5.73)."""
    axes = checked_axes(semi_axes, 3)
    return 4.0 * math.pi * mean_length(axes[..., [1, 2, 0]] * axes[..., [2, 0, 1]])


def mean_curvature(semi_axes: ArrayLike) -> Array:
    """Return the total mean curvature M of ellipsoids (..., 3), shape (...); eq. (5.54).

    M is the integral of the mean curvature over the surface, 4 pi r for a ball, and 2 pi times
    the mean width of any convex body.
    """
    return 4.0 * math.pi * mean_length(checked_axes(semi_axes, 3))


def checked_axes(semi_axes: ArrayLike, dimension: int | None = None) -> Array:
    """Return semi-axes (..., n), n = `dimension` or else 2 or 3, finite and positive."""
    axes = np.asarray(semi_axes, dtype=float)
    allowed = (2, 3) if dimension is None else (dimension,)
    if axes.ndim == 0 or axes.shape[-1] not in allowed:
        wanted = " or ".join(str(n) for n in allowed)
        raise GeometryError(f"expected {wanted} semi-axes, got an array of shape {axes.shape}")
    wrong = ~(np.isfinite(axes) & (axes > 0.0))
    if np.any(wrong):
        raise GeometryError(
            f"expected finite positive semi-axes, got {float(axes[wrong].flat[0]):g}"
        )
    return axes
