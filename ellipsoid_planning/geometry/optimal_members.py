"""The members of greatest or least volume of Kurzhanski's families, for many pairs at once.

Pairs are given by the first body's semi-axes s where the second is the unit ball
(`affine.relative_axes`), in which frame the families are of diagonal matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
BISECTIONS = 100


def least_outer_sum(axes: Array) -> Array:
    """Return the p (...) of the least (1 + 1/p) S1 + (1 + p) S2 for semi-axes (..., n).

    The root of sum 1 / (s^2 + p) = n / (p (p + 1)), between the least and greatest s.
    """
    n = axes.shape[-1]
    low, high = np.log(np.min(axes, axis=-1)), np.log(np.max(axes, axis=-1))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        p = np.exp(middle)[..., None]
        # Both sides times p (p + 1), so that nothing overflows.
        below = np.sum((p + 1.0) / (axes**2 / p + 1.0), axis=-1) < n
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.exp(0.5 * (low + high))


def greatest_inner_difference(axes: Array) -> Array:
    """Return the m (...) of the greatest (1 - m)(S1 - S2 / m) for semi-axes (..., n) above 1.

    The root of sum 1 / (m (m s^2 - 1)) = n / (1 - m), between 1 / min(s)^2 and 1. Both ends are
    near 1 when the second body hardly fits, so that the bisection runs over 1 - m.
    """
    n = axes.shape[-1]
    least = np.min(axes, axis=-1)
    low, high = np.zeros_like(least), (least - 1.0) * (least + 1.0) / least**2
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        rest = middle[..., None]
        slack = (axes - 1.0) * (axes + 1.0) - rest * axes**2  # m s^2 - 1
        inside = np.all(slack > 0.0, axis=-1)
        safe = np.where(slack > 0.0, slack, 1.0)
        flat = middle * np.sum(1.0 / ((1.0 - rest) * safe), axis=-1) < n
        up = inside & flat
        low, high = np.where(up, middle, low), np.where(up, high, middle)
    return np.asarray(1.0 - 0.5 * (low + high))
