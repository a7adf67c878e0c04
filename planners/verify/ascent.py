"""Maximises differences of support functions over unit directions, for many bodies at once.

The function is f(u) = u.c - s1 |A1' u| - s2 |A2' u| with signs s1, s2: with both +1 its maximum is
the distance of two ellipsoids whose centres are c apart; with s1 = +1 and s2 = -1 its maximum is
minus the room that a part (A2) has in an arena (A1).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_STEPS = 40
_CONVERGED = 1e-13
_LONGEST_STEP = 0.5  # of one Newton step on the unit sphere [rad]


def value(u: Array, c: Array, first: Array, second: Array, sign: float) -> Array:
    """The function f (k,) at directions u (k, n), for offsets c (k, n) and matrices (k, n, n)."""
    one = np.linalg.norm(_transposed(first, u), axis=1)
    two = np.linalg.norm(_transposed(second, u), axis=1)
    return np.einsum("ki,ki->k", u, c) - one - sign * two


def difference(u: Array, c: Array, first: Array, second: Array, sign: float) -> Array:
    """The gradient (k, n) of f: the difference of the two support points, so that f = u.gradient.

    With both signs +1 its length is the distance of two points of the bodies, hence at least
    their distance, as f is at most their distance.
    """
    return c - _support_point(first, u) - sign * _support_point(second, u)


def ascend(u: Array, c: Array, first: Array, second: Array, sign: float) -> Array:
    """Directions (k, n) at which f is locally largest, not below f at the given ones."""
    u = u.copy()
    best = value(u, c, first, second, sign)
    active = np.arange(len(u))
    damping = np.ones(len(u))
    for _ in range(_STEPS):
        if not len(active):
            break
        batch = u[active], c[active], first[active], second[active]
        step, gradient = _newton_step(*batch, sign)
        trial = _normalised(batch[0] + damping[active, None] * step)
        reached = value(trial, *batch[1:], sign)
        better = reached > best[active]
        u[active[better]], best[active[better]] = trial[better], reached[better]
        damping[active] = np.where(better, 1.0, 0.25 * damping[active])
        settled = gradient <= _CONVERGED * np.linalg.norm(batch[1], axis=1)
        active = active[~settled & (damping[active] > 1e-6)]
    return u


def _newton_step(
    u: Array, c: Array, first: Array, second: Array, sign: float
) -> tuple[Array, Array]:
    """A step (k, n) uphill in the tangent plane, and the length (k,) of the gradient there."""
    tangent = _tangents(u)
    gradient = difference(u, c, first, second, sign)
    slope = np.einsum("kni,kn->ki", tangent, gradient)
    bend = _curvature(first, u, tangent) + sign * _curvature(second, u, tangent)
    hessian = -bend - np.einsum("kn,kn->k", u, gradient)[:, None, None] * np.eye(slope.shape[1])
    # Uphill also where f is not concave: turn every eigenvalue negative.
    eigenvalues, vectors = np.linalg.eigh(hessian)
    strength = np.maximum(np.abs(eigenvalues), 1e-12 * np.abs(eigenvalues).max(axis=1)[:, None])
    strength = np.maximum(strength, np.finfo(float).tiny)
    along = np.einsum("kji,kj->ki", vectors, slope) / strength
    step = np.einsum("kni,kij,kj->kn", tangent, vectors, along)
    length = np.linalg.norm(step, axis=1, keepdims=True)
    step *= np.minimum(1.0, _LONGEST_STEP / np.maximum(length, np.finfo(float).tiny))
    return step, np.linalg.norm(slope, axis=1)


def _curvature(matrix: Array, u: Array, tangent: Array) -> Array:
    """The Hessian (k, n-1, n-1) of |A'u| in the tangent plane."""
    ball = _transposed(matrix, u)
    length = np.maximum(np.linalg.norm(ball, axis=1), np.finfo(float).tiny)
    moved = np.einsum("kni,knj->kij", matrix, tangent)
    along = np.einsum("ki,kij->kj", ball, moved) / length[:, None]
    flat = np.einsum("kni,knj->kij", moved, moved)
    return (flat - along[:, :, None] * along[:, None, :]) / length[:, None, None]


def _tangents(u: Array) -> Array:
    """Orthonormal bases (k, n, n-1) of the planes normal to u (k, n)."""
    if u.shape[1] == 2:
        return np.stack([-u[:, 1], u[:, 0]], axis=1)[:, :, None]
    axis = np.eye(3)[np.argmin(np.abs(u), axis=1)]
    one = _normalised(np.cross(u, axis))
    return np.stack([one, np.cross(u, one)], axis=2)


def _transposed(matrix: Array, u: Array) -> Array:
    return np.einsum("kij,ki->kj", matrix, u)


def _support_point(matrix: Array, u: Array) -> Array:
    ball = _transposed(matrix, u)
    length = np.maximum(np.linalg.norm(ball, axis=1, keepdims=True), np.finfo(float).tiny)
    return np.einsum("kij,kj->ki", matrix, ball / length)


def _normalised(rows: Array) -> Array:
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)
