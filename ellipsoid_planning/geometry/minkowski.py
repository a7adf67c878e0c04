"""Closed-form boundaries of the Minkowski sum and difference of two ellipsoids.

The sum is {x + y : x in the first, y in the second}, the difference {x : x + part lies in the
arena}, both as sets with their centres. Hence the C-obstacle of a part is the sum of the
obstacle and the part's mirror image -part, which for a part centred at the origin is the part.

Each comes in two parametrisations, for planar and spatial bodies alike:

- by outward normal u, x(u) = S1 u / |A1^T u| +- S2 u / |A2^T u| with the shape matrices
  S = A A^T;
- by shrinking, offsetting and stretching: Y. Yan and G. S. Chirikjian, "Closed-form
  characterization of the Minkowski sum and difference of two ellipsoids", Geometriae Dedicata
  177 (2015), and Yan's thesis, eq. (5.3)-(5.18), with the misprint of (5.18) corrected (its
  denominators are a'^2).

The normals' images describe the boundary of a difference only where they form no swallow-tail:
points that are not in the difference are dropped here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.farthest import farthest_squared

DEFAULT_COUNT = 200
ROUNDING = 64.0 * float(np.finfo(float).eps)


def minkowski_sum_boundary(
    first: Ellipsoid, second: Ellipsoid, directions: ArrayLike | int = DEFAULT_COUNT
) -> NDArray[np.float64]:
    """Return the boundary points (m, n) of the sum with the given outward normals.

    Args:
        first: an ellipsoid of dimension n.
        second: another of the same dimension, in the same frame.
        directions: outward normals (m, n) of any positive length, or how many evenly
            spread ones to take.

    Raises:
        GeometryError: if the dimensions differ or a direction is zero.
    """
    normals = _normals(first, second, directions)
    return np.asarray(first.support_points(normals) + second.support_points(normals))


def minkowski_difference_boundary(
    arena: Ellipsoid, part: Ellipsoid, directions: ArrayLike | int = DEFAULT_COUNT
) -> NDArray[np.float64]:
    """Return the points (k, n), k <= m, of the difference's boundary with the given normals.

    Normals whose point is on a swallow-tail, outside the difference, give no point. In a very
    flat arena few or none of evenly spread normals give one: their points crowd at the rim. To
    draw such a difference use `minkowski_difference_boundary_by_offset`.

    Raises:
        GeometryError: if the difference is empty, the dimensions differ or a direction is zero.
    """
    normals = _normals(arena, part, directions)
    check_fits(arena, part)
    points = arena.support_points(normals) - part.support_points(normals)
    return np.asarray(points[difference_contains(arena, part, points)])


def minkowski_sum_boundary_by_offset(
    first: Ellipsoid, second: Ellipsoid, parameters: ArrayLike | int = DEFAULT_COUNT
) -> NDArray[np.float64]:
    """Return the boundary points (m, n) of the sum by thesis eq. (5.11)-(5.17).

    Args:
        first: an ellipsoid of dimension n.
        second: another of the same dimension, in the same frame.
        parameters: unit vectors (m, n), (cos u sin v, sin u sin v, cos v) in (5.11), or how
            many evenly spread ones to take.
    """
    return _Shrunk.of(first, second).boundary(_normals(first, second, parameters), 1.0)


def minkowski_difference_boundary_by_offset(
    arena: Ellipsoid, part: Ellipsoid, parameters: ArrayLike | int = DEFAULT_COUNT
) -> NDArray[np.float64]:
    """Return the points (k, n), k <= m, of the difference's boundary by thesis eq. (5.18).

    Parameters as for the sum; those whose point is on a swallow-tail give no point.

    Raises:
        GeometryError: if the difference is empty or the dimensions differ.
    """
    unit = _normals(arena, part, parameters)
    check_fits(arena, part)
    points = _Shrunk.of(arena, part).boundary(unit, -1.0)
    return np.asarray(points[difference_contains(arena, part, points)])


def offset_normals(
    first: Ellipsoid, second: Ellipsoid, parameters: ArrayLike
) -> NDArray[np.float64]:
    """Return the outward unit normals (m, n) at the offset parametrisation's parameters (m, n)."""
    return _Shrunk.of(first, second).normals(_normals(first, second, parameters))


def difference_contains(arena: Ellipsoid, part: Ellipsoid, points: ArrayLike) -> NDArray[np.bool_]:
    """Tell for points (m, n) whether they lie in the closed difference of arena and part, (m,).

    x is in it iff u.x + h_part(u) <= h_arena(u) for every unit u, that is iff the part moved
    by x lies in the arena. In the arena's own norm its farthest point has the squared distance
    g = min over mu of mu + sum_i q_i^2 mu / (mu - s_i^2) (the S-lemma); every mu gives an upper
    bound, so that only rounding, for which a few machine epsilons times the arena's axis ratio
    are allowed, can let a point in.
    """
    offset = np.asarray(points, dtype=float) + (part.centre - arena.centre)
    left, stretch, _ = np.linalg.svd(_in_arena_frame(arena, part.matrix))
    coordinates = _in_arena_frame(arena, offset.T).T @ left
    return np.asarray(farthest_squared(coordinates, stretch) <= 1.0 + _tolerance(arena, part))


def check_fits(arena: Ellipsoid, part: Ellipsoid) -> None:
    """Raise GeometryError if the part, at its orientation, fits nowhere in the arena.

    The message names a direction along which the part is wider than the arena, and both widths.
    """
    check_same_dimension(arena, part)
    left, stretch, _ = np.linalg.svd(_in_arena_frame(arena, part.matrix))
    if stretch[0] <= 1.0 + _tolerance(arena, part):
        return
    direction = arena.rotation @ (left[:, 0] / arena.semi_axes)
    direction /= np.linalg.norm(direction)
    part_half = float(np.linalg.norm(direction @ part.matrix))
    arena_half = float(np.linalg.norm(direction @ arena.matrix))
    raise GeometryError(
        f"the Minkowski difference of {arena.name or 'the arena'} and {part.name or 'the part'} "
        f"is empty: along the direction {np.round(direction, 6).tolist()} the part's half-width "
        f"{part_half:.6g} exceeds the arena's {arena_half:.6g} by {part_half - arena_half:.3g}"
    )


@dataclass(frozen=True, eq=False)
class _Shrunk:
    """The first body after the shrinking that turns the second one into a ball.

    Attributes:
        centres: the centres of the first and the second body, (n,) each.
        stretch: T of thesis eq. (5.17), (n, n).
        rotation: principal axes of the shrunk first body, (n, n), R(n'_1, theta'_1).
        semi_axes: its semi-axes a'_1, (n,).
        radius: r, the ball's radius.
    """

    centres: tuple[NDArray[np.float64], NDArray[np.float64]]
    stretch: NDArray[np.float64]
    rotation: NDArray[np.float64]
    semi_axes: NDArray[np.float64]
    radius: float

    @classmethod
    def of(cls, first: Ellipsoid, second: Ellipsoid) -> _Shrunk:
        radius = float(np.min(second.semi_axes))
        factors = second.semi_axes / radius
        stretch = (second.rotation * factors) @ second.rotation.T
        shrinking = (second.rotation / factors) @ second.rotation.T
        rotation, semi_axes, _ = np.linalg.svd(shrinking @ first.matrix)
        return cls((first.centre, second.centre), stretch, rotation, semi_axes, radius)

    def boundary(self, unit: NDArray[np.float64], sign: float) -> NDArray[np.float64]:
        """Return centre + T R' (x' + sign r n'), (5.15)-(5.18), for unit vectors (m, n)."""
        offset = self.semi_axes * unit + sign * self.radius * self._shrunk_normals(unit)
        centre = self.centres[0] + sign * self.centres[1]
        return np.asarray(centre + offset @ (self.stretch @ self.rotation).T)

    def normals(self, unit: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the outward unit normals (m, n) after stretching: T^-T R' n', normalised."""
        normals = np.linalg.solve(self.stretch, self.rotation @ self._shrunk_normals(unit).T).T
        return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))

    def _shrunk_normals(self, unit: NDArray[np.float64]) -> NDArray[np.float64]:
        gradient = unit / self.semi_axes  # x'/a'^2 with x' = a' unit, (5.13)
        return np.asarray(gradient / np.linalg.norm(gradient, axis=1, keepdims=True))


def _in_arena_frame(arena: Ellipsoid, columns: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray((arena.rotation.T @ columns) / arena.semi_axes[:, None])


def _tolerance(arena: Ellipsoid, part: Ellipsoid) -> float:
    shift = float(np.linalg.norm(arena.centre) + np.linalg.norm(part.centre))
    size = shift + float(np.max(arena.semi_axes) + np.max(part.semi_axes))
    return ROUNDING * size / float(np.min(arena.semi_axes))


def _normals(
    first: Ellipsoid, second: Ellipsoid, directions: ArrayLike | int
) -> NDArray[np.float64]:
    check_same_dimension(first, second)
    if isinstance(directions, (int, np.integer)):
        return unit_directions(first.dimension, int(directions))
    return np.atleast_2d(np.asarray(directions, dtype=float))


def check_same_dimension(first: Ellipsoid, second: Ellipsoid) -> None:
    """Raise GeometryError if one body is planar and the other spatial."""
    if first.dimension != second.dimension:
        raise GeometryError(
            f"expected two bodies of one dimension, got {first.dimension} and {second.dimension}"
        )
