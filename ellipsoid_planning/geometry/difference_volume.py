"""The volume of the Minkowski difference of two ellipsoids.

Where the part rolls freely in the arena the difference is a summand, and Steiner's formula with
changed signs is exact: V = V1 - 3 V(1,1,2) + 3 V(1,2,2) - V2, in the plane V1 - 2 V(1,2) + V2.
Else the inward offset has a swallow-tail, and the boundary that remains (`offset_frame`) is
integrated: V is the integral of (h - 1) dS / n with the support function h of the arena and the
surface element of the offset, dS times (1 - k) in the plane and (1 - 2 H + K) in space.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.affine import (
    Body,
    cofactors,
    determinants,
    matrices_of,
    relative_axes,
)
from ellipsoid_planning.geometry.offset_frame import rim_height
from ellipsoid_planning.geometry.quadrature import crowded, gauss
from ellipsoid_planning.geometry.sum_volume import mixed_volumes

Array = NDArray[np.float64]
DEFAULT_ORDER = 32
CHUNK = 256


def difference_volume(arena: Body, part: Body, order: int = DEFAULT_ORDER) -> Array:
    """Return the volume (in the plane the area) of arena ⊖ part, shape (...).

    It is 0 where the part does not fit (`minkowski.check_fits` says where and by how much).

    Args:
        arena: an `Ellipsoid`, or matrices (..., n, n) of ellipsoids A (unit ball).
        part: likewise; the leading shapes broadcast. Centres do not matter.
        order: Gauss points a direction, where the part does not roll freely; 32 give twelve
            digits and more for axis ratios up to 1e6.

    Raises:
        GeometryError: if the dimensions differ or a body is flat.
    """
    one, two = np.broadcast_arrays(*matrices_of(arena, part))
    axes = relative_axes(one, two)
    n = axes.shape[-1]
    signs = np.array([1.0, -1.0, 1.0] if n == 2 else [1.0, -1.0, 1.0, -1.0])
    steiner = np.maximum(mixed_volumes(one, two) @ signs, 0.0)
    cut = (axes[..., -1] > 1.0) & (axes[..., -1] ** 2 < axes[..., 0])
    volumes = np.where(axes[..., -1] > 1.0, steiner, 0.0)
    if np.any(cut):
        scale = determinants(two, cofactors(two))[cut]
        volumes[cut] = scale * _cut_volumes(axes[cut], order)
    return volumes


def _cut_volumes(axes: Array, order: int) -> Array:
    """Volumes (m,) of E(s) ⊖ unit ball for semi-axes s (m, n), descending, with a rim."""
    integrate = _area if axes.shape[1] == 2 else _volume
    pieces = [integrate(axes[i : i + CHUNK], order) for i in range(0, len(axes), CHUNK)]
    return np.concatenate(pieces)


def _area(axes: Array, order: int) -> Array:
    a, b = axes[:, :1], axes[:, 1:]
    points, weights = gauss(2 * order)
    rim = np.arcsin(rim_height(axes, np.ones((len(axes), 1))))[:, None]
    angle, rate = crowded(rim, np.full_like(rim, 0.5 * math.pi), b / a, points)
    norm = np.hypot(np.cos(angle) / a, np.sin(angle) / b)
    integrand = a * b * (1.0 - norm) * (1.0 - 1.0 / (a**2 * b**2 * norm**3))
    return np.asarray(2.0 * np.sum(integrand * rate * weights, axis=1))


def _volume(axes: Array, order: int) -> Array:
    azimuth, around = _azimuths(axes, order)
    points, weights = gauss(order)
    a, b, c = (axes[:, None, i] for i in range(3))
    flat = np.hypot(np.cos(azimuth) / a, np.sin(azimuth) / b)[..., None]
    heading = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)
    rim = np.arcsin(rim_height(axes[:, None, :], heading))[..., None]
    scale = flat * c[..., None]
    elevation, rate = crowded(rim, np.full_like(rim, 0.5 * math.pi), scale, points)
    cosine, sine = np.cos(elevation), np.sin(elevation)
    squared = (cosine * flat) ** 2 + (sine / c[..., None]) ** 2
    fourth = np.hypot(np.cos(azimuth) / a**2, np.sin(azimuth) / b**2)[..., None]
    fourth = (cosine * fourth) ** 2 + (sine / c[..., None] ** 2) ** 2
    norm = np.sqrt(squared)
    product = np.prod(axes, axis=1)[:, None, None]
    total = np.sum(axes**-2.0, axis=1)[:, None, None]
    bend = (squared * total - fourth) / (squared * norm)  # 2 H
    spread = 1.0 - bend + 1.0 / (product * squared) ** 2
    caps = np.sum(product * (1.0 - norm) * spread * cosine * rate * weights, axis=2)
    return np.asarray(8.0 / 3.0 * np.sum(caps * around, axis=1))


def _azimuths(axes: Array, order: int) -> tuple[Array, Array]:
    """Angles and weights (m, 2 order) on [0, pi / 2], split where the rim leaves the plane.

    The rim's height has a square root there, which squaring the distance from it smooths.
    """
    a, b, c = axes.T
    # c^2 (cos^2 / a^2 + sin^2 / b^2) = 1 / c^2, where there is such an angle
    numerator = c**-4.0 - a**-2.0
    denominator = np.maximum(b**-2.0 - a**-2.0, 0.0)
    share = np.where(
        denominator > 0.0, numerator / np.where(denominator > 0.0, denominator, 1.0), 1.0
    )
    split = np.arcsin(np.sqrt(np.clip(share, 0.0, 1.0)))[:, None]
    points, weights = gauss(order)
    below = split * (1.0 - points**2)
    above = split + (0.5 * math.pi - split) * points**2
    rates = [split * 2.0 * points * weights, (0.5 * math.pi - split) * 2.0 * points * weights]
    return np.concatenate([below, above], axis=1), np.concatenate(rates, axis=1)
