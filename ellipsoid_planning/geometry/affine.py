"""Two ellipsoids seen from where one of them is the unit ball, without losing digits.

Bodies are given as `Ellipsoid` or as matrices A (..., n, n), the images A (unit ball); formulas
about volumes need no centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]
Body = Ellipsoid | ArrayLike


def matrices_of(first: Body, second: Body) -> tuple[Array, Array]:
    """Return both bodies' matrices (..., n, n), n = 2 or 3.

    Raises:
        GeometryError: if the dimensions differ, or a matrix is singular or not finite.
    """
    one, two = _matrix(first), _matrix(second)
    if one.shape[-1] != two.shape[-1]:
        raise GeometryError(
            f"expected two bodies of one dimension, got {one.shape[-1]} and {two.shape[-1]}"
        )
    return one, two


def cofactors(matrices: Array) -> Array:
    """Return cof(A) = det(A) A^-T for A (..., n, n), by cross products of the columns.

    Each of its columns is accurate to rounding when A's columns are principal axes.
    """
    if matrices.shape[-1] == 2:
        a, b, c, d = (matrices[..., i, j] for i in (0, 1) for j in (0, 1))
        return np.stack([np.stack([d, -c], -1), np.stack([-b, a], -1)], -2)
    x, y, z = (matrices[..., :, i] for i in range(3))
    return np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=-1)


def determinants(matrices: Array, cofactor: Array) -> Array:
    """Return |det A| (...) for A (..., n, n) and its cofactors."""
    return np.abs(np.sum(matrices[..., :, 0] * cofactor[..., :, 0], axis=-1))


def relative_axes(first: Body, second: Body) -> Array:
    """Return the first body's semi-axes (..., n), descending, where the second is the unit ball.

    They are the singular values of A2^-1 A1. The largest is the norm of that matrix, the least
    the inverse norm of its inverse, the middle one follows from the determinant: each is as
    accurate as if it were the largest.
    """
    one, two = matrices_of(first, second)
    cof_one, cof_two = cofactors(one), cofactors(two)
    det_one, det_two = determinants(one, cof_one), determinants(two, cof_two)
    largest = _norm(np.swapaxes(cof_two, -1, -2) @ one) / det_two
    least = np.minimum(det_one / _norm(np.swapaxes(cof_one, -1, -2) @ two), largest)
    if one.shape[-1] == 2:
        return np.stack([largest, least], axis=-1)
    middle = np.clip(det_one / det_two / largest / least, least, largest)
    return np.stack([largest, middle, least], axis=-1)


def ellipsoid_from_factor(centre: Array, factor: Array) -> Ellipsoid:
    """Return centre + factor (unit ball) for a factor (n, k), k >= n.

    Raises:
        GeometryError: if it is flat.
    """
    axes, lengths, _ = np.linalg.svd(factor, full_matrices=False)
    if not lengths[-1] > 0.0:
        raise GeometryError("the ellipsoid is flat: one of its semi-axes is zero")
    if np.linalg.det(axes) < 0.0:
        axes[:, -1] = -axes[:, -1]
    return Ellipsoid.from_semi_axes(lengths, centre, axes)


def _norm(matrices: Array) -> Array:
    return np.asarray(np.linalg.svd(matrices, compute_uv=False)[..., 0])


def _matrix(body: Body) -> Array:
    if isinstance(body, Ellipsoid):
        return body.matrix
    matrix = np.asarray(body, dtype=float)
    if matrix.ndim < 2 or matrix.shape[-2:] not in ((2, 2), (3, 3)):
        raise GeometryError(f"expected (2, 2) or (3, 3) matrices, got shape {matrix.shape}")
    if not np.all(np.isfinite(matrix)):
        raise GeometryError("expected finite matrices")
    lengths = np.linalg.norm(matrix, axis=-2)
    size = np.abs(np.linalg.det(matrix / np.where(lengths > 0.0, lengths, 1.0)[..., None, :]))
    if not (np.all(lengths > 0.0) and np.all(size > 0.0)):
        raise GeometryError("expected regular matrices: a body has a semi-axis of zero length")
    return matrix
