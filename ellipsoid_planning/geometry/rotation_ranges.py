"""Sets of rotations with quadrature weights: all of them, or a restricted range.

The measure of SO(2) is 2 pi, that of SO(3) is 8 pi^2; volumes of motions integrate over it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.orientation import check_rotation
from ellipsoid_planning.geometry.quadrature import gauss

Array = NDArray[np.float64]
Range = tuple[float, float]


@dataclass(frozen=True, eq=False)
class RotationRange:
    """Rotations that stand for a set of them.

    Attributes:
        rotations: (m, n, n).
        weights: (m,), their sum is the measure of the set.
    """

    rotations: Array
    weights: Array

    def turned(self, body: Ellipsoid) -> Array:
        """Return the matrices (m, n, n) of a body after each rotation.

        Raises:
            GeometryError: if the rotations are of another dimension.
        """
        n = self.rotations.shape[-1]
        if body.dimension != n:
            raise GeometryError(
                f"expected rotations of dimension {body.dimension}, got dimension {n}"
            )
        return np.asarray(self.rotations @ body.matrix)

    @property
    def measure(self) -> float:
        """The measure of the set of rotations."""
        return float(np.sum(self.weights))


def single_rotation(rotation: ArrayLike) -> RotationRange:
    """One rotation (n, n) with weight 1: the translative case."""
    matrix = np.asarray(rotation, dtype=float)
    checked = check_rotation(matrix, 2 if matrix.shape == (2, 2) else 3)
    return RotationRange(checked[None], np.ones(1))


def yaw_range(low: float, high: float, count: int = 64) -> RotationRange:
    """Headings from `low` to `high` [rad], at most a turn; `count` points."""
    angles, weights = _points((low, high), 2.0 * math.pi, count, "yaw")
    return RotationRange(_planar(angles), weights)


def euler_zxz_range(alpha: Range, beta: Range, gamma: Range, count: int = 16) -> RotationRange:
    """Rotations R_z(alpha) R_x(beta) R_z(gamma), dR = sin(beta) d alpha d beta d gamma.

    Args:
        alpha: from, to [rad], at most a turn.
        beta: from, to [rad], within [0, pi].
        gamma: from, to [rad], at most a turn.
        count: points an angle, so count^3 in all.
    """
    if not 0.0 <= beta[0] <= beta[1] <= math.pi:
        raise GeometryError(f"expected a range of beta within [0, pi], got {beta}")
    one, one_weights = _points(alpha, 2.0 * math.pi, count, "alpha")
    two, two_weights = _points((-math.cos(beta[0]), -math.cos(beta[1])), math.inf, count, "beta")
    three, three_weights = _points(gamma, 2.0 * math.pi, count, "gamma")
    tilts = _about_x(np.arccos(np.clip(-two, -1.0, 1.0)))
    rotations = np.einsum("aij,bjk,ckl->abcil", _about_z(one), tilts, _about_z(three))
    weights = np.einsum("a,b,c->abc", one_weights, two_weights, three_weights)
    return RotationRange(rotations.reshape(-1, 3, 3), weights.reshape(-1))


def angle_range(largest: float, count: int = 16, around: ArrayLike | None = None) -> RotationRange:
    """All rotations of space by at most `largest` [rad], within [0, pi], after `around` (3, 3).

    dR = 2 (1 - cos angle) d angle d axis, with `count` angles and 2 count^2 axes.
    """
    if not 0.0 <= largest <= math.pi:
        raise GeometryError(f"expected a largest angle within [0, pi], got {largest}")
    points, weights = gauss(count)
    angles, axes = largest * points, _axes(count)
    radial = largest * weights * 2.0 * (1.0 - np.cos(angles))
    skew = np.zeros((len(axes), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        skew[:, i, j], skew[:, j, i] = -axes[:, k], axes[:, k]
    sine, versine = np.sin(angles)[:, None, None, None], 1.0 - np.cos(angles)[:, None, None, None]
    rotations = np.eye(3) + sine * skew + versine * (skew @ skew)
    each = radial[:, None] * np.repeat(weights, 2 * count) * (2.0 * math.pi / count)
    base = np.eye(3) if around is None else check_rotation(around, 3)
    return RotationRange(rotations.reshape(-1, 3, 3) @ base, each.reshape(-1))


def _axes(count: int) -> Array:
    """Unit vectors (2 count^2, 3) at Gauss heights, 2 count evenly around each."""
    heights = 2.0 * gauss(count)[0] - 1.0
    turns = np.arange(2 * count) * (math.pi / count)
    flat = np.sqrt(1.0 - heights**2)[:, None]
    z = np.broadcast_to(heights[:, None], (count, 2 * count))
    around = np.stack([flat * np.cos(turns), flat * np.sin(turns), z], axis=-1)
    return np.asarray(around.reshape(-1, 3))


def all_rotations(dimension: int, count: int) -> RotationRange:
    """All rotations, for functions of ellipsoids: half turns about principal axes do nothing.

    Args:
        dimension: 2 or 3.
        count: points an angle, evenly spaced in headings, alpha and gamma over half a turn.
    """
    angles = np.asarray(np.arange(count) * (math.pi / count), dtype=float)
    if dimension == 2:
        return RotationRange(_planar(angles), np.full(count, 2.0 * math.pi / count))
    heights, weights = gauss(count)
    tilts = _about_x(np.arccos(1.0 - 2.0 * heights))
    turns = _about_z(angles)
    rotations = np.einsum("aij,bjk,ckl->abcil", turns, tilts, turns)
    each = np.broadcast_to(
        2.0 * weights[None, :, None] * (2.0 * math.pi / count) ** 2, rotations.shape[:3]
    )
    return RotationRange(rotations.reshape(-1, 3, 3), each.reshape(-1))


def _points(limits: Range, largest: float, count: int, what: str) -> tuple[Array, Array]:
    """Evenly spaced points over a whole turn, Gauss points over less."""
    low, high = limits
    length = high - low
    if not 0.0 <= length <= largest * (1.0 + 1e-12):
        raise GeometryError(f"expected a range of {what} of at most a turn, got {limits}")
    if math.isclose(length, largest, rel_tol=1e-12):
        return low + length * np.arange(count) / count, np.full(count, length / count)
    points, weights = gauss(count)
    return low + length * points, length * weights


def _planar(angles: Array) -> Array:
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.stack([np.stack([cosine, -sine], -1), np.stack([sine, cosine], -1)], -2)


def _about_z(angles: Array) -> Array:
    matrices = np.zeros((len(angles), 3, 3))
    matrices[:, :2, :2] = _planar(angles)
    matrices[:, 2, 2] = 1.0
    return matrices


def _about_x(angles: Array) -> Array:
    matrices = np.zeros((len(angles), 3, 3))
    matrices[:, 1:, 1:] = _planar(angles)
    matrices[:, 0, 0] = 1.0
    return matrices
