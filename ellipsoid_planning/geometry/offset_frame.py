"""The affine frame in which a Minkowski sum or difference is an offset of an ellipsoid by 1.

There the second body is the unit ball and the first has the semi-axes s, descending, along the
coordinate axes. Boundary points are p(w) +- n(w) with p = s w on the ellipsoid and its unit
normal n, for unit vectors w.

An inward offset has a swallow-tail where normals cross. An ellipsoid's inward normals first
meet others in the plane across its shortest axis, after the length s_n^2 |w / s|: points with a
length of at least 1 are the difference's boundary, and the rest is none. So above and below
that plane the boundary is one cap each, graphs over the last axis that meet in the rim where the
length is 1 or, without a swallow-tail, where w lies in the plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.affine import relative_axes
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_fits

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OffsetFrame:
    """Where a sum (sign +1) or a difference (sign -1) is an offset by one.

    Attributes:
        semi_axes: s (n,), descending; at least 1 for a difference.
        matrix: (n, n), from this frame to the bodies' frame.
        centre: (n,), of the sum or difference in the bodies' frame.
        sign: +1.0 or -1.0.
    """

    semi_axes: Array
    matrix: Array
    centre: Array
    sign: float

    @classmethod
    def of_sum(cls, first: Ellipsoid, second: Ellipsoid) -> OffsetFrame:
        """The frame of first ⊕ second."""
        axes = relative_axes(first, second)
        return cls(axes, _axes_matrix(first, second), first.centre + second.centre, 1.0)

    @classmethod
    def of_difference(cls, arena: Ellipsoid, part: Ellipsoid) -> OffsetFrame:
        """The frame of arena ⊖ part.

        Raises:
            GeometryError: if the difference is empty.
        """
        check_fits(arena, part)
        axes = np.maximum(relative_axes(arena, part), 1.0)
        return cls(axes, _axes_matrix(arena, part), arena.centre - part.centre, -1.0)

    def points(self, unit: Array) -> Array:
        """Return the boundary points (..., n), in the bodies' frame, of unit vectors (..., n)."""
        normal = unit / self.semi_axes
        normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        local = self.semi_axes * unit + self.sign * normal
        return np.asarray(self.centre + local @ self.matrix.T)

    def rim_height(self, azimuth: Array) -> Array:
        """Return the last coordinate of w (...) at the rim of the upper cap, 0 without a cut.

        Args:
            azimuth: unit vectors (..., n - 1), the direction of w's other coordinates.
        """
        if self.sign > 0.0:
            return np.zeros(azimuth.shape[:-1])
        return rim_height(self.semi_axes, azimuth)


def rim_height(semi_axes: Array, azimuth: Array) -> Array:
    """Return the height of w (...) at the rim, for semi-axes (..., n), descending, at least 1.

    With w = (sqrt(1 - h^2) azimuth, h): s_n^4 ((1 - h^2) |azimuth / s|^2 + h^2 / s_n^2) = 1.
    """
    shortest = semi_axes[..., -1]
    flat = np.sum((shortest[..., None] / semi_axes[..., :-1] * azimuth) ** 2, axis=-1)
    needed = shortest**-2.0
    below = 1.0 - flat
    squared = np.where(below > 0.0, (needed - flat) / np.where(below > 0.0, below, 1.0), 0.0)
    return np.asarray(np.sqrt(np.clip(squared, 0.0, 1.0)))


def _axes_matrix(first: Ellipsoid, second: Ellipsoid) -> Array:
    """A2 U, where A2^-1 A1 = U diag(s) V^T, with a positive determinant."""
    seen = (second.rotation.T @ first.matrix) / second.semi_axes[:, None]
    left, _, _ = np.linalg.svd(seen)
    if np.linalg.det(left) < 0.0:
        left[:, -1] = -left[:, -1]
    return np.asarray(second.matrix @ left)
