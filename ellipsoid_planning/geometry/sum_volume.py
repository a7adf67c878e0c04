"""The exact volume of the Minkowski sum of two ellipsoids, in closed form.

Steiner's formula for an ellipsoid and a ball (thesis eq. (5.41), (5.47)), carried over by the
affine map that makes one body a ball (5.81, 5.88). With the exact total mean curvature, which
the thesis had only numerically, and with cofactors in the place of inverses,

    V = (det A1 + det A2) 4 pi / 3 + 4 pi (R(A2^T cof A1) + R(A1^T cof A2)),

where R(K) is the mean length of K u over the unit sphere (Carlson's R_G of the squared singular
values of K). It is symmetric in the bodies, and neither is inverted. In the plane
A = pi (det A1 + det A2) + L, with the perimeter L of the ellipse (cof A2)^T A1 (unit disc).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.affine import Body, cofactors, determinants, matrices_of
from ellipsoid_planning.geometry.carlson import (
    mean_length,
    mean_length_of_images,
    perimeter_of_image,
)
from ellipsoid_planning.geometry.intrinsic import checked_axes

Array = NDArray[np.float64]
UNIT_BALL = {2: math.pi, 3: 4.0 / 3.0 * math.pi}


def sum_volume(first: Body, second: Body) -> Array:
    """Return the exact volume (in the plane the area) of first ⊕ second, shape (...).

    Args:
        first: an `Ellipsoid`, or matrices A1 (..., n, n) of ellipsoids A1 (unit ball).
        second: likewise; the leading shapes broadcast. Centres do not matter.

    Raises:
        GeometryError: if the dimensions differ or a body is flat.
    """
    return np.sum(mixed_volumes(first, second), axis=-1)


def mixed_volumes(first: Body, second: Body) -> Array:
    """Return the coefficients (..., n + 1) of V(t E1 ⊕ E2) in t, by descending powers.

    In the plane (V1, 2 V(1,2), V2), in space (V1, 3 V(1,1,2), 3 V(1,2,2), V2).
    """
    one, two = matrices_of(first, second)
    cof_one, cof_two = cofactors(one), cofactors(two)
    dimension = one.shape[-1]
    volumes = [
        UNIT_BALL[dimension] * determinants(matrix, cof)
        for matrix, cof in ((one, cof_one), (two, cof_two))
    ]
    if dimension == 2:
        mixed = [perimeter_of_image(np.swapaxes(cof_two, -1, -2) @ one)]
    else:
        surface = mean_length_of_images(np.swapaxes(two, -1, -2) @ cof_one)
        curvature = mean_length_of_images(np.swapaxes(one, -1, -2) @ cof_two)
        mixed = [4.0 * math.pi * surface, 4.0 * math.pi * curvature]
    terms = np.broadcast_arrays(volumes[0], *mixed, volumes[1])
    return np.stack(terms, axis=-1)


def sum_area(first_axes: ArrayLike, second_axes: ArrayLike, angle: ArrayLike) -> Array:
    """Return the exact area of the sum of two ellipses, shape (...).

    Args:
        first_axes: semi-axes (..., 2).
        second_axes: semi-axes (..., 2).
        angle: heading of the second relative to the first [rad], (...).
    """
    one, two = checked_axes(first_axes, 2), checked_axes(second_axes, 2)
    cosine, sine = np.cos(angle), np.sin(angle)
    (a, b), (c, d) = (one[..., 0], one[..., 1]), (two[..., 0], two[..., 1])
    # Of the ellipse diag(d, c) R^T diag(a, b), in terms of its singular values' sum and difference.
    plus = np.hypot((a * d + b * c) * cosine, (a * c + b * d) * sine)
    minus = np.hypot((a * d - b * c) * cosine, (a * c - b * d) * sine)
    lengths = np.stack([0.5 * (plus + minus), 0.5 * np.abs(plus - minus), 0.0 * plus], axis=-1)
    return np.asarray(math.pi * (a * b + c * d) + 8.0 * mean_length(lengths))
