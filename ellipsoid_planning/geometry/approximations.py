"""Ellipsoids inside and around the Minkowski sum and difference of two ellipsoids.

Two families hold everything (A. B. Kurzhanski and I. Valyi, Ellipsoidal Calculus for Estimation
and Control, 1997). With shape matrices S1, S2 and matrices A1, A2,

- sums:        outside (1 + 1/p) S1 + (1 + p) S2, p > 0;  inside A1 + A2 O, O orthogonal;
- differences: inside (1 - m)(S1 - S2 / m), least m such that this is positive < m < 1;
               outside A1 - A2 O, O orthogonal.

The thesis' approximations are members: (5.3.1), by offsetting, is the inside one of greatest
volume for sums, the outside one of least volume for differences; (5.3.2), by Gaussians, is
p = 1, and its counterpart for differences m = 1/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.affine import ellipsoid_from_factor, relative_axes
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_fits, check_same_dimension
from ellipsoid_planning.geometry.optimal_members import (
    greatest_inner_difference,
    least_outer_sum,
)

Array = NDArray[np.float64]
Side = Literal["inner", "outer"]
Member = Literal["trace", "volume"]


@dataclass(frozen=True, eq=False)
class Approximation:
    """An ellipsoid that stands for a Minkowski sum or difference.

    Attributes:
        ellipsoid: in the frame of the bodies, at the exact set's centre.
        kind: "inner" if the exact set contains it, "outer" if it contains the exact set.
        name: the method, for tables.
    """

    ellipsoid: Ellipsoid
    kind: Side
    name: str


def offset_sum(first: Ellipsoid, second: Ellipsoid) -> Approximation:
    """Return the thesis' ellipsoid (5.19)-(5.20) inside first ⊕ second: semi-axes a' + r.

    Where the second body is a ball of radius r; always inner, and the largest `kurzhanski_sum`
    inside.
    """
    stretched = _offset(first, second, 1.0)
    return Approximation(
        ellipsoid_from_factor(_sum_centre(first, second), stretched), "inner", "offset"
    )


def offset_difference(arena: Ellipsoid, part: Ellipsoid) -> Approximation:
    """Return the thesis' ellipsoid (5.19)-(5.20) around arena ⊖ part: semi-axes a' - r.

    Always outer, and the smallest `kurzhanski_difference` outside.

    Raises:
        GeometryError: if the difference is empty or flat.
    """
    check_fits(arena, part)
    return _outer_difference(arena, part, _offset(arena, part, -1.0), "offset")


def gaussian_sum(first: Ellipsoid, second: Ellipsoid) -> Approximation:
    """Return the thesis' ellipsoid (5.33) around first ⊕ second: shape matrix 2 (S1 + S2)."""
    return Approximation(_outer_sum(first, second, 1.0), "outer", "gaussian")


def gaussian_difference(arena: Ellipsoid, part: Ellipsoid) -> Approximation:
    """Return the ellipsoid with shape matrix S1 / 2 - S2 inside arena ⊖ part.

    The one whose Gaussian sum with the part is the arena.

    Raises:
        GeometryError: if the part is too large for it: sqrt(2) times the part does not fit.
    """
    return Approximation(_inner_difference(arena, part, 0.5), "inner", "gaussian")


def kurzhanski_sum(
    first: Ellipsoid,
    second: Ellipsoid,
    member: Member | ArrayLike = "volume",
    side: Side = "outer",
) -> Approximation:
    """Return a member of the families around, or inside, first ⊕ second.

    Args:
        first: an ellipsoid.
        second: another of the same dimension.
        member: "trace" or "volume": the outer one of least, or the inner one of greatest, sum of
            squared semi-axes or volume; or a direction (n,) in which it touches the exact sum.
        side: "outer" or "inner".
    """
    check_same_dimension(first, second)
    name = _member_name(member, side)
    if side == "inner":
        factor = first.matrix + second.matrix @ _alignment(first, second, member)
        return Approximation(
            ellipsoid_from_factor(_sum_centre(first, second), factor), "inner", name
        )
    if isinstance(member, str) and member == "volume":
        p = float(least_outer_sum(relative_axes(first, second)))
    else:
        p = _ratio(first, second, member)
    return Approximation(_outer_sum(first, second, p), "outer", name)


def kurzhanski_difference(
    arena: Ellipsoid,
    part: Ellipsoid,
    member: Member | ArrayLike = "volume",
    side: Side = "inner",
) -> Approximation:
    """Return a member of the families inside, or around, arena ⊖ part.

    Args:
        arena: an ellipsoid.
        part: another of the same dimension.
        member: as for `kurzhanski_sum`; inner members are made as large, outer ones as small
            as they can be.
        side: "inner" or "outer".

    Raises:
        GeometryError: if the difference is empty or flat; if no member inside touches it in the
            direction; or if the sum of squared semi-axes grows towards a flat member.
    """
    check_same_dimension(arena, part)
    check_fits(arena, part)
    name = _member_name(member, side)
    if side == "outer":
        factor = arena.matrix - part.matrix @ _alignment(arena, part, member)
        return _outer_difference(arena, part, factor, name)
    if isinstance(member, str) and member == "volume":
        m = float(greatest_inner_difference(relative_axes(arena, part)))
    else:
        m = 1.0 / _ratio(arena, part, member)
    return Approximation(_inner_difference(arena, part, m), "inner", name)


def _outer_sum(first: Ellipsoid, second: Ellipsoid, p: float) -> Ellipsoid:
    check_same_dimension(first, second)
    grown = [math.sqrt(1.0 + 1.0 / p) * first.matrix, math.sqrt(1.0 + p) * second.matrix]
    return ellipsoid_from_factor(_sum_centre(first, second), np.hstack(grown))


def _inner_difference(arena: Ellipsoid, part: Ellipsoid, m: float) -> Ellipsoid:
    """(1 - m)(S1 - S2 / m) as A1 (I - K K^T / m) A1^T with K = A1^-1 A2."""
    check_same_dimension(arena, part)
    check_fits(arena, part)
    seen = (arena.rotation.T @ part.matrix) / arena.semi_axes[:, None]
    left, stretch, _ = np.linalg.svd(seen)
    squares = (1.0 - m) * (1.0 - stretch**2 / m)
    if not np.all(squares > 0.0):
        raise GeometryError(
            f"expected a member of the family inside the difference, but its parameter {m:.6g} "
            f"is not between {stretch[0] ** 2:.6g} and 1; the member 'volume' exists whenever the "
            "difference is not flat"
        )
    centre = arena.centre - part.centre
    return ellipsoid_from_factor(centre, arena.matrix @ (left * np.sqrt(squares)))


def _outer_difference(arena: Ellipsoid, part: Ellipsoid, factor: Array, name: str) -> Approximation:
    centre = arena.centre - part.centre
    return Approximation(ellipsoid_from_factor(centre, factor), "outer", name)


def _offset(first: Ellipsoid, second: Ellipsoid, sign: float) -> Array:
    """A2 U diag(s +- 1), where A2^-1 A1 = U diag(s) V^T."""
    check_same_dimension(first, second)
    left, axes = _seen_by_second(first, second)
    return np.asarray(second.matrix @ (left * (axes + sign)))


def _seen_by_second(first: Ellipsoid, second: Ellipsoid) -> tuple[Array, Array]:
    seen = (second.rotation.T @ first.matrix) / second.semi_axes[:, None]
    left, axes, _ = np.linalg.svd(seen)
    return left, axes


def _alignment(first: Ellipsoid, second: Ellipsoid, member: Member | ArrayLike) -> Array:
    """The orthogonal O of A1 +- A2 O."""
    if isinstance(member, str):
        _check_member(member)
        if member == "trace":  # the trace of A1^T A2 O is largest for the polar factor
            left, _, right = np.linalg.svd(second.matrix.T @ first.matrix)
        else:  # the determinant of A2^-1 A1 +- O is extreme for the polar factor
            seen = (second.rotation.T @ first.matrix) / second.semi_axes[:, None]
            left, _, right = np.linalg.svd(seen)
        return np.asarray(left @ right)
    direction = _direction(member, first.dimension)
    x, y = direction @ first.matrix, direction @ second.matrix
    return _tight(x, y, first.matrix.T @ second.matrix)


def _tight(x: Array, y: Array, product: Array) -> Array:
    """The orthogonal O with O^T y along x that makes the trace of A1^T A2 O largest."""
    along_x, across_x = _split(x)
    along_y, across_y = _split(y)
    left, _, right = np.linalg.svd((across_x.T @ product @ across_y).T)
    return np.asarray(np.outer(along_y, along_x) + across_y @ left @ right @ across_x.T)


def _split(vector: Array) -> tuple[Array, Array]:
    """The unit vector (n,) along `vector`, and an orthonormal basis (n, n - 1) across it."""
    unit = vector / np.linalg.norm(vector)
    basis, _ = np.linalg.qr(np.column_stack([unit, np.eye(len(unit))]))
    return unit, basis[:, 1:]


def _ratio(first: Ellipsoid, second: Ellipsoid, member: Member | ArrayLike) -> float:
    """p = sqrt(tr S1 / tr S2), or the ratio of the half-widths in a direction."""
    if isinstance(member, str):
        _check_member(member)
        return float(np.linalg.norm(first.semi_axes) / np.linalg.norm(second.semi_axes))
    direction = _direction(member, first.dimension)
    lengths = [np.linalg.norm(direction @ body.matrix) for body in (first, second)]
    return float(lengths[0] / lengths[1])


def _sum_centre(first: Ellipsoid, second: Ellipsoid) -> Array:
    return first.centre + second.centre


def _member_name(member: Member | ArrayLike, side: Side) -> str:
    if side not in ("inner", "outer"):
        raise GeometryError(f"expected the side 'inner' or 'outer', got {side!r}")
    return f"kurzhanski {member}" if isinstance(member, str) else "kurzhanski direction"


def _check_member(member: str) -> None:
    if member not in ("trace", "volume"):
        raise GeometryError(
            f"expected 'trace', 'volume' or a direction of the family, got {member!r}"
        )


def _direction(member: ArrayLike, dimension: int) -> Array:
    direction = np.asarray(member, dtype=float)
    if direction.shape != (dimension,) or not np.all(np.isfinite(direction)):
        raise GeometryError(f"expected a direction of {dimension} finite numbers")
    if not np.any(direction):
        raise GeometryError("expected a direction that is not zero")
    return direction
