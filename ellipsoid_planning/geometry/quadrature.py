"""Gauss-Legendre points on [0, 1] and maps of that interval that crowd them where needed."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@lru_cache(maxsize=32)
def gauss(count: int) -> tuple[Array, Array]:
    """Return the points and the weights (count,) on [0, 1]; read-only."""
    points, weights = np.polynomial.legendre.leggauss(count)
    points, weights = 0.5 * (points + 1.0), 0.5 * weights
    points.setflags(write=False)
    weights.setflags(write=False)
    return points, weights


def crowded(low: Array, high: Array, scale: Array, points: Array) -> tuple[Array, Array]:
    """Map points of [0, 1] to [low, high], crowded at `low` with steps from `scale` up.

    x = (low + scale) ((high + scale) / (low + scale))^u - scale; all arguments broadcast.

    Returns:
        x and dx/du.
    """
    start = low + scale
    growth = np.log((high + scale) / start)
    grown = start * np.exp(growth * points)
    return grown - scale, grown * growth
