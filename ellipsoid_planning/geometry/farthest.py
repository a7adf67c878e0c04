"""How far a point of an ellipsoid can lie from the origin: a one-dimensional convex problem."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BISECTIONS = 120


def farthest_squared(coordinates: Array, stretch: Array) -> Array:
    """Return the max of |q + s w|^2 over |w| <= 1 for each q (m, n), from above, shape (m,).

    ``stretch`` s is (n,) or (m, n), not negative, descending, its first entry positive. With
    t = mu - s_max^2 the derivative 1 - sum q^2 s^2 / (t + d)^2 of the dual grows in t, and its
    root lies between 0 and |q s|; every mu bounds the maximum from above.
    """
    excess, gaps = _best_multiplier(coordinates, stretch)
    mu = stretch[..., 0] ** 2 + excess
    terms = _ratio(coordinates**2 * mu[:, None], excess[:, None] + gaps)
    return np.asarray(mu + np.sum(terms, axis=1))


def farthest_points(coordinates: Array, stretch: Array) -> Array:
    """Return a w (m, n), |w| = 1, that attains the maximum of `farthest_squared` to rounding."""
    excess, gaps = _best_multiplier(coordinates, stretch)
    w = _ratio(coordinates * stretch, excess[:, None] + gaps)
    # Where q has nothing along the longest axis, both ends of that axis are farthest.
    missing = np.sqrt(np.maximum(1.0 - np.sum(w * w, axis=1), 0.0))
    w[:, 0] += np.where(w[:, 0] < 0.0, -missing, missing)
    return np.asarray(w / np.linalg.norm(w, axis=1, keepdims=True))


def _best_multiplier(coordinates: Array, stretch: Array) -> tuple[Array, Array]:
    """The dual's root t (m,), from above, and the gaps d = s_max^2 - s^2."""
    weights = (coordinates * stretch) ** 2
    # As a product of sum and difference the gaps keep their digits.
    longest = stretch[..., :1]
    gaps = (longest - stretch) * (longest + stretch)
    low = np.zeros(len(coordinates))
    high = np.sqrt(np.sum(weights, axis=1))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        rising = np.sum(_ratio(weights, (middle[:, None] + gaps) ** 2), axis=1) <= 1.0
        high = np.where(rising, middle, high)
        low = np.where(rising, low, middle)
    return high, gaps


def _ratio(above: Array, below: Array) -> Array:
    """Return above / below with 0 / 0 = 0: an absent coordinate adds nothing."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.where(above != 0.0, above / below, 0.0)
