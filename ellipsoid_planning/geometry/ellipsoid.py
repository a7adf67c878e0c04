"""Ellipses and ellipsoids as images of the unit ball."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.orientation import check_rotation, rotation_from_yaw

SYMMETRY_TOLERANCE = 1e-9
# Worlds and robots take a narrower range, see `ellipsoid_planning.sizes`.
LEAST_SIZE, MOST_SIZE = 1e-150, 1e150


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """The solid set {c + R diag(a) z : |z| <= 1} in n = 2 or 3 dimensions.

    The arrays are copied, validated and made read-only.

    Attributes:
        centre: c, shape (n,), in the frame that the owner states (world or robot base).
        rotation: R, shape (n, n), principal axes as columns.
        semi_axes: a, shape (n,), positive, in the scenario's unit of length.
        name: what messages call the body.

    Raises:
        GeometryError: if the numbers describe no ellipsoid.
    """

    centre: NDArray[np.float64]
    rotation: NDArray[np.float64]
    semi_axes: NDArray[np.float64]
    name: str = ""

    def __post_init__(self) -> None:
        semi_axes = _checked_semi_axes(self.semi_axes)
        dimension = len(semi_axes)
        centre = _checked_vector(self.centre, dimension, "centre")
        rotation = check_rotation(self.rotation, dimension)
        for field, value in (("semi_axes", semi_axes), ("centre", centre), ("rotation", rotation)):
            value.setflags(write=False)
            object.__setattr__(self, field, value)

    @classmethod
    def from_semi_axes(
        cls,
        semi_axes: ArrayLike,
        position: ArrayLike | None = None,
        rotation: ArrayLike | float | None = None,
        name: str = "",
    ) -> Ellipsoid:
        """Build from semi-axes (n,), centre (n,) and a rotation (n, n), or a heading in 2-D [rad].

        Position and rotation default to the origin and to none.
        """
        axes = _checked_semi_axes(semi_axes)
        dimension = len(axes)
        centre = np.zeros(dimension) if position is None else position
        return cls(np.asarray(centre), _rotation_matrix(rotation, dimension), axes, name)

    @classmethod
    def from_shape_matrix(
        cls, shape_matrix: ArrayLike, centre: ArrayLike | None = None, name: str = ""
    ) -> Ellipsoid:
        """Build from the shape matrix A A^T, shape (n, n), symmetric and positive definite.

        The semi-axes come out in ascending order. A shape matrix holds the squares of the
        semi-axes, so that a needle of axis ratio 1e6 keeps only four digits of its thickness.
        """
        matrix = np.array(shape_matrix, dtype=float)
        if matrix.shape not in ((2, 2), (3, 3)) or not np.all(np.isfinite(matrix)):
            raise GeometryError(
                f"expected a finite (2, 2) or (3, 3) shape matrix, got shape {matrix.shape}"
            )
        asymmetry = float(np.max(np.abs(matrix - matrix.T)))
        if asymmetry > SYMMETRY_TOLERANCE * float(np.max(np.abs(matrix))):
            raise GeometryError(f"expected a symmetric shape matrix, it is off by {asymmetry:.3g}")
        squares, axes = np.linalg.eigh((matrix + matrix.T) / 2.0)
        if not squares[0] > 0.0:
            raise GeometryError(
                f"expected a positive definite shape matrix, got the eigenvalue {squares[0]:.3g}"
            )
        if np.linalg.det(axes) < 0.0:
            axes[:, 0] = -axes[:, 0]
        return cls.from_semi_axes(np.sqrt(squares), centre, axes, name)

    @classmethod
    def from_covariance(
        cls,
        covariance: ArrayLike,
        mean: ArrayLike | None = None,
        radius: float = 1.0,
        name: str = "",
    ) -> Ellipsoid:
        """Build the set within the Mahalanobis distance `radius` of a Gaussian's `mean` (n,)."""
        if not (radius > 0.0 and np.isfinite(radius)):
            raise GeometryError(f"expected a positive Mahalanobis radius, got {radius}")
        unit = cls.from_shape_matrix(covariance, mean, name)
        return cls(unit.centre, unit.rotation, unit.semi_axes * radius, name)

    @property
    def dimension(self) -> int:
        """The dimension n, 2 or 3."""
        return len(self.semi_axes)

    @cached_property
    def matrix(self) -> NDArray[np.float64]:
        """A = R diag(a), shape (n, n), read-only: the map from the unit ball."""
        return _read_only(self.rotation * self.semi_axes)

    @cached_property
    def shape_matrix(self) -> NDArray[np.float64]:
        """The shape matrix A A^T, shape (n, n), read-only."""
        return _read_only(self.matrix @ self.matrix.T)

    def support(self, directions: ArrayLike) -> NDArray[np.float64]:
        """Return h(u) = u.c + |A^T u| for directions (..., n) of any length, shape (...)."""
        u = self._checked_rows(directions)
        return np.asarray(u @ self.centre + np.linalg.norm(u @ self.matrix, axis=-1))

    def support_points(self, directions: ArrayLike) -> NDArray[np.float64]:
        """Return the boundary points (..., n) with outward normals along `directions` (..., n).

        Raises:
            GeometryError: if a direction is zero.
        """
        ball = self._checked_rows(directions) @ self.matrix
        length = np.linalg.norm(ball, axis=-1, keepdims=True)
        if not np.all(length > 0.0):
            raise GeometryError("expected non-zero directions")
        return np.asarray(self.centre + (ball / length) @ self.matrix.T)

    def surface_points(self, count: int) -> NDArray[np.float64]:
        """Return `count` boundary points (count, n): the images of evenly spread unit vectors."""
        return self.centre + unit_directions(self.dimension, count) @ self.matrix.T

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Tell for points (..., n) whether they lie in the closed ellipsoid, shape (...)."""
        offset = self._checked_rows(points) - self.centre
        ball = (offset @ self.rotation) / self.semi_axes
        return np.asarray(np.linalg.norm(ball, axis=-1) <= 1.0)

    def transform(self, rotation: ArrayLike, translation: ArrayLike) -> Ellipsoid:
        """Return the image under x -> rotation @ x + translation, with (n, n) and (n,)."""
        turn = check_rotation(rotation, self.dimension)
        shift = _checked_vector(translation, self.dimension, "translation")
        return Ellipsoid(
            turn @ self.centre + shift, turn @ self.rotation, self.semi_axes, self.name
        )

    def with_name(self, name: str) -> Ellipsoid:
        """Return the same ellipsoid under another name."""
        named = copy.copy(self)  # shares the arrays, which are read-only and checked already
        object.__setattr__(named, "name", name)
        return named

    def _checked_rows(self, rows: ArrayLike) -> NDArray[np.float64]:
        array = np.asarray(rows, dtype=float)
        if array.ndim == 0 or array.shape[-1] != self.dimension:
            raise GeometryError(
                f"expected vectors of shape (..., {self.dimension}), got shape {array.shape}"
            )
        return array


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.setflags(write=False)
    return array


def _rotation_matrix(rotation: ArrayLike | float | None, dimension: int) -> NDArray[np.float64]:
    if rotation is None:
        return np.eye(dimension)
    if np.ndim(rotation) == 0:
        if dimension != 2:
            raise GeometryError("a heading orients an ellipse only; give a (3, 3) rotation in 3-D")
        return rotation_from_yaw(float(np.asarray(rotation)))
    return np.asarray(rotation, dtype=float)


def _checked_semi_axes(semi_axes: ArrayLike) -> NDArray[np.float64]:
    axes = np.array(semi_axes, dtype=float)
    if axes.shape not in ((2,), (3,)):
        raise GeometryError(f"expected 2 or 3 semi-axes, got an array of shape {axes.shape}")
    if not (np.all(np.isfinite(axes)) and np.all(axes > 0.0)):
        raise GeometryError(f"expected finite positive semi-axes, got {axes.tolist()}")
    if not (np.all(axes >= LEAST_SIZE) and np.all(axes <= MOST_SIZE)):
        raise GeometryError(
            f"expected semi-axes from {LEAST_SIZE:g} to {MOST_SIZE:g}, whose squares double "
            f"precision can hold, got {axes.tolist()}; choose another unit of length"
        )
    return axes


def _checked_vector(vector: ArrayLike, dimension: int, what: str) -> NDArray[np.float64]:
    array = np.array(vector, dtype=float)
    if array.shape != (dimension,) or not np.all(np.isfinite(array)):
        raise GeometryError(
            f"expected a {what} of {dimension} finite numbers, got {array.tolist()}"
        )
    if not np.all(np.abs(array) <= MOST_SIZE):
        raise GeometryError(
            f"expected a {what} of numbers of at most {MOST_SIZE:g}, whose squares double "
            f"precision can hold, got {array.tolist()}; choose another unit of length"
        )
    return array
