"""Surface and total mean curvature of ellipsoids of revolution by elementary functions.

H. Hadwiger, Altes und Neues über konvexe Körper (1955); thesis eq. (5.69), (5.70) and those
after (5.75). Written with series near the sphere, so that they keep their digits there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NEAR = 0.02
TERMS = 10


def uniaxial_mean_curvature(radius: Array, height: Array) -> Array:
    """Return M for semi-axes (radius, radius, height), arrays (...); eq. (5.69), (5.70)."""
    ratio = height / radius
    return np.asarray(2.0 * math.pi * radius * (ratio + arc_quotient(ratio)))


def uniaxial_surface_area(radius: Array, height: Array) -> Array:
    """Return F for semi-axes (radius, radius, height), arrays (...)."""
    ratio = height / radius
    # log((1 + e) / ratio) / e for the oblate, arccos(1 / ratio) / e for the prolate.
    part = ratio * arc_quotient(1.0 / ratio)
    return np.asarray(2.0 * math.pi * radius**2 * (1.0 + part))


def arc_quotient(cosine: Array) -> Array:
    """Return arccos(c) / sqrt(1 - c^2) for c > 0, and for c > 1 arccosh(c) / sqrt(c^2 - 1).

    It is 1 at c = 1: with x = c^2 - 1, asinh(sqrt x) / sqrt x and asin(sqrt -x) / sqrt(-x) are
    one power series.
    """
    c = np.asarray(cosine, dtype=float)
    x = (c - 1.0) * (c + 1.0)
    root = np.sqrt(np.abs(x))
    safe = np.where(root > 0.0, root, 1.0)
    outside = np.where(x > 0.0, np.arcsinh(root), np.arctan2(root, c)) / safe
    return np.asarray(np.where(root > NEAR, outside, _series(np.where(root > NEAR, 0.0, x))))


def arctangent_quotient(x: Array) -> Array:
    """Return atan(sqrt x) / sqrt x for x >= 0, 1 at x = 0."""
    root = np.sqrt(x)
    return np.asarray(np.where(root > 0.0, np.arctan(root) / np.where(root > 0.0, root, 1.0), 1.0))


def _series(x: Array) -> Array:
    total, term = np.ones_like(x), np.ones_like(x)
    for k in range(1, TERMS):
        term = -term * x * (2 * k - 1) ** 2 / (2 * k * (2 * k + 1))
        total = total + term
    return total
