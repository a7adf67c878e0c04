"""Closed polygons and triangle meshes of Minkowski sums and differences, for drawing.

Vertices lie on the exact boundary. Differences are cut where the thesis' parametrisation has a
swallow-tail: the sharp rim of the true region is a line of vertices.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_same_dimension
from ellipsoid_planning.geometry.offset_frame import OffsetFrame

Array = NDArray[np.float64]
DEFAULT_COUNT = 200
DEFAULT_RINGS = 16
DEFAULT_SECTORS = 48


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface.

    Attributes:
        vertices: (k, 3), in the frame of the bodies.
        triangles: (m, 3), rows of `vertices`, anticlockwise seen from outside.
    """

    vertices: Array
    triangles: NDArray[np.intp]

    @property
    def volume(self) -> float:
        """The volume enclosed by the triangles."""
        corners = self.vertices[self.triangles] - self.vertices.mean(axis=0)
        return float(np.sum(np.linalg.det(corners)) / 6.0)


def sum_polygon(first: Ellipsoid, second: Ellipsoid, count: int = DEFAULT_COUNT) -> Array:
    """Return the corners (count, 2), anticlockwise, of a polygon on the boundary of the sum.

    Raises:
        GeometryError: if a body is not planar or the count is odd or below 4.
    """
    _check(first, second, 2)
    return _polygon(OffsetFrame.of_sum(first, second), count)


def difference_polygon(arena: Ellipsoid, part: Ellipsoid, count: int = DEFAULT_COUNT) -> Array:
    """Return the corners (count, 2), anticlockwise, on the boundary of arena ⊖ part.

    Raises:
        GeometryError: as for the sum, or if the difference is empty.
    """
    _check(arena, part, 2)
    return _polygon(OffsetFrame.of_difference(arena, part), count)


def sum_mesh(
    first: Ellipsoid,
    second: Ellipsoid,
    rings: int = DEFAULT_RINGS,
    sectors: int = DEFAULT_SECTORS,
) -> Mesh:
    """Return a mesh of the boundary of first ⊕ second.

    Args:
        first: an ellipsoid in space.
        second: another.
        rings: how many rings of triangles from a pole to the equator, at least 1.
        sectors: how many around, at least 3.

    Raises:
        GeometryError: if a body is planar or there are too few rings or sectors.
    """
    _check(first, second, 3)
    return _mesh(OffsetFrame.of_sum(first, second), rings, sectors)


def difference_mesh(
    arena: Ellipsoid,
    part: Ellipsoid,
    rings: int = DEFAULT_RINGS,
    sectors: int = DEFAULT_SECTORS,
) -> Mesh:
    """Return a mesh of the boundary of arena ⊖ part; arguments as for the sum.

    Raises:
        GeometryError: as for the sum, or if the difference is empty.
    """
    _check(arena, part, 3)
    return _mesh(OffsetFrame.of_difference(arena, part), rings, sectors)


def _polygon(frame: OffsetFrame, count: int) -> Array:
    if count < 4 or count % 2:
        raise GeometryError(f"expected an even number of corners, at least 4, got {count}")
    start = math.asin(float(frame.rim_height(np.ones(1))))
    # Both arcs share the two corners where they meet.
    angles = np.linspace(start, math.pi - start, count // 2 + 1)
    upper = np.column_stack([np.cos(angles), np.sin(angles)])
    return frame.points(np.concatenate([upper, -upper[1:-1]]))


def _mesh(frame: OffsetFrame, rings: int, sectors: int) -> Mesh:
    if rings < 1 or sectors < 3:
        raise GeometryError(f"expected at least 1 ring and 3 sectors, got {rings} and {sectors}")
    angles = np.arange(sectors) * (2.0 * math.pi / sectors)
    azimuth = np.column_stack([np.cos(angles), np.sin(angles)])
    polar = np.linspace(0.0, 1.0, rings + 1)[1:, None] * np.arccos(frame.rim_height(azimuth))
    flat = np.sin(polar)[..., None] * azimuth
    upper = np.concatenate([flat, np.cos(polar)[..., None]], axis=-1)
    lower = upper[:-1] * [1.0, 1.0, -1.0]
    pole = np.array([[0.0, 0.0, 1.0]])
    unit = [pole, upper.reshape(-1, 3), -pole, lower.reshape(-1, 3)]
    top = 1 + np.arange(rings * sectors).reshape(rings, sectors)
    bottom = top[-1, -1] + 2 + np.arange((rings - 1) * sectors).reshape(rings - 1, sectors)
    faces = np.concatenate(
        [
            _cap(0, top),
            _cap(top[-1, -1] + 1, np.concatenate([bottom, top[-1:]]))[:, ::-1],
        ]
    )
    return Mesh(frame.points(np.concatenate(unit)), faces)


def _cap(pole: int, rings: NDArray[np.intp]) -> NDArray[np.intp]:
    """Triangles from a pole through rings (k, sectors) of vertices."""
    following = np.roll(rings, -1, axis=1)
    fan = np.stack([np.full_like(rings[0], pole), rings[0], following[0]], axis=-1)
    one = np.stack([rings[:-1], rings[1:], following[1:]], axis=-1).reshape(-1, 3)
    other = np.stack([rings[:-1], following[1:], following[:-1]], axis=-1).reshape(-1, 3)
    return np.concatenate([fan, one, other])


def _check(first: Ellipsoid, second: Ellipsoid, dimension: int) -> None:
    check_same_dimension(first, second)
    if first.dimension != dimension:
        wanted = "planar" if dimension == 2 else "spatial"
        raise GeometryError(f"expected {wanted} bodies, got bodies of dimension {first.dimension}")
