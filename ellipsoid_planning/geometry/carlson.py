"""Carlson's completely symmetric elliptic integral R_G, scaled so that nothing overflows.

R_G(x, y, z) is the mean of sqrt(x u1^2 + y u2^2 + z u3^2) over unit vectors u: the mean length
of K u over the unit sphere when x, y, z are the squared singular values of K (DLMF 19.16.3).
Perimeter, surface and total mean curvature of ellipsoids, and the mixed volumes of two of them,
are such means, without a case for spheres, needles or discs.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def mean_length(lengths: Array) -> Array:
    """Return the mean of |diag(lengths) u| over the unit sphere, for lengths (..., 3), shape (...).

    Homogeneous of degree one; lengths are not negative.
    """
    from scipy.special import elliprg

    largest = np.max(lengths, axis=-1)
    scale = np.where(largest > 0.0, largest, 1.0)
    squares = (lengths / scale[..., None]) ** 2
    return np.asarray(scale * elliprg(squares[..., 0], squares[..., 1], squares[..., 2]))


def mean_length_of_images(matrices: Array) -> Array:
    """Return the mean of |K u| over the unit sphere for matrices K (..., 3, 3), shape (...).

    R_G is well conditioned in the largest singular value, so that the eigenvalues of K^T K
    serve although they keep few digits of the small ones.
    """
    from scipy.special import elliprg

    largest = np.max(np.abs(matrices), axis=(-2, -1))
    scale = np.where(largest > 0.0, largest, 1.0)
    unit = matrices / scale[..., None, None]
    squares = np.maximum(np.linalg.eigvalsh(np.swapaxes(unit, -1, -2) @ unit), 0.0)
    return np.asarray(scale * elliprg(squares[..., 0], squares[..., 1], squares[..., 2]))


def perimeter_of_image(matrices: Array) -> Array:
    """Return the perimeter of the ellipse K (unit disc) for K (..., 2, 2), shape (...).

    The sum and the difference of the singular values are lengths of differences and sums of
    entries, so that circles and segments keep all digits.
    """
    a, b, c, d = (matrices[..., i, j] for i in (0, 1) for j in (0, 1))
    plus, minus = np.hypot(a + d, b - c), np.hypot(a - d, b + c)
    lengths = np.stack([0.5 * (plus + minus), 0.5 * np.abs(plus - minus), np.zeros_like(a)], -1)
    return np.asarray(8.0 * mean_length(lengths))
