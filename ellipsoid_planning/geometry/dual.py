"""Separation, containment and chords of two ellipsoids by the dual kernels.

Every value errs on the safe side: a gap is a lower bound of the distance, an extent in an arena
is an upper bound, a blocked chord is outer and a free chord inner, by a few roundings.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rows import body_row, placed_row
from ellipsoid_planning.kernels import chords, containment, layout, separation, whitening

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Gap:
    """A lower bound of the distance of two bodies, proved by a direction.

    Attributes:
        value: u·(c₂ − c₁) − |A₁ᵀu| − |A₂ᵀu|, the distance itself when positive; if negative, the
            bodies meet and −value bounds the penetration depth from above.
        direction: the unit vector u, shape (n,), from the first body to the second.
    """

    value: float
    direction: Array


@dataclass(frozen=True)
class Containment:
    """How far a part reaches in an arena.

    Attributes:
        extent: an upper bound g of zᵀΣ_a⁻¹z over the part; at most 1 if the part is inside.
        margin: 1 − √g, in the arena's own norm |A_a⁻¹ v|.
    """

    extent: float
    margin: float


def _same_dimension(first: Ellipsoid, second: Ellipsoid) -> int:
    if first.dimension != second.dimension:
        raise GeometryError(
            f"expected bodies of one dimension, got {first.dimension} and {second.dimension}"
        )
    return first.dimension


def _scale(first: Ellipsoid, second: Ellipsoid) -> float:
    reach = [np.linalg.norm(b.centre) + b.semi_axes.max() for b in (first, second)]
    return float(max(reach))


def gap(first: Ellipsoid, second: Ellipsoid) -> Gap:
    """The gap of two ellipsoids and its direction.

    Raises:
        GeometryError: if the dimensions differ.
    """
    n = _same_dimension(first, second)
    bodies, placed = body_row(first)[None], placed_row(second)[None]
    start = first.semi_axes.max() / (first.semi_axes.max() + second.semi_axes.max())
    value, *u, _ = separation.separation(bodies, 0, placed, 0, start, math.inf, separation.CONVERGE)
    return Gap(value - layout.ROUNDING * _scale(first, second), np.array(u[:n]))


def containment_of(part: Ellipsoid, arena: Ellipsoid) -> Containment:
    """How far ``part`` reaches in ``arena``.

    Raises:
        GeometryError: if the dimensions differ.
    """
    _same_dimension(part, arena)
    bodies, placed = body_row(arena)[None], placed_row(part)[None]
    extent = containment.extent_in_arena(
        bodies, 0, placed, 0, _scale(part, arena), layout.BODY_INVERSE, True
    )[0]
    return Containment(extent, 1.0 - math.sqrt(extent))


def _frame(direction: Array) -> Array:
    """A rotation (n, n) whose first row is the unit vector ``direction``."""
    n = len(direction)
    basis = np.linalg.qr(np.column_stack([direction, np.eye(n)]))[0].T[:n]
    basis[0] = direction
    if np.linalg.det(basis) < 0.0:
        basis[-1] = -basis[-1]
    return np.asarray(basis)


def _aligned(
    body: Ellipsoid, part: Ellipsoid, origin: ArrayLike, direction: ArrayLike
) -> tuple[Array, Array, Array, float]:
    """Rows of both bodies, and the line's origin, in a frame whose x axis is the line."""
    n = _same_dimension(body, part)
    along = np.asarray(direction, dtype=float)
    length = float(np.linalg.norm(along))
    if along.shape != (n,) or not 0.0 < length < math.inf:
        raise GeometryError(
            f"expected a direction of {n} numbers, not all zero, got {along.tolist()}"
        )
    turn = _frame(along / length)
    start = np.zeros(3)
    start[:n] = turn @ (np.asarray(origin, dtype=float) - body.centre)
    fixed = Ellipsoid(np.zeros(n), turn @ body.rotation, body.semi_axes)
    moving = Ellipsoid(np.zeros(n), turn @ part.rotation, part.semi_axes)
    return body_row(fixed)[None], placed_row(moving)[None], start, length


def _whitened(bodies: Array, placed: Array) -> Array:
    table = np.empty((1, whitening.WHITEN))
    whitening.whiten(bodies, 0, placed, 0, np.empty((1, 9)), table, 0)
    return table


def sum_chord(
    obstacle: Ellipsoid, part: Ellipsoid, origin: ArrayLike, direction: ArrayLike
) -> tuple[float, float] | None:
    """Parameters t for which ``part``, centred at origin + t direction, meets ``obstacle``.

    Returns the ends of the interval, outer by a few roundings, or None if the line misses.

    Raises:
        GeometryError: if the dimensions differ or the direction is zero.
    """
    bodies, placed, start, length = _aligned(obstacle, part, origin, direction)
    table = _whitened(bodies, placed)
    size = float(np.linalg.norm(start) + obstacle.semi_axes.max() + part.semi_axes.max())
    status, low, high = chords.obstacle_chord(
        bodies, 0, placed, 0, table, 0, 0.0, layout.ROUNDING * size, 0, *start
    )
    return (low / length, high / length) if status == chords.HIT else None


def difference_chord(
    arena: Ellipsoid, part: Ellipsoid, origin: ArrayLike, direction: ArrayLike
) -> tuple[float, float] | None:
    """Parameters t for which ``part``, centred at origin + t direction, lies inside ``arena``.

    Returns the ends of the interval, inner by a few roundings, or None if there is none.

    Raises:
        GeometryError: if the dimensions differ or the direction is zero.
    """
    bodies, placed, start, length = _aligned(arena, part, origin, direction)
    table = _whitened(bodies, placed)
    size = 1.0 + float(np.linalg.norm(start)) / float(arena.semi_axes.min())
    inside, low, high = chords.arena_chord(
        bodies, 0, placed, 0, table, 0, layout.ROUNDING * size, 0, *start
    )
    return (low / length, high / length) if inside else None
