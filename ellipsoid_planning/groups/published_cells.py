"""The thesis' polyhedra in exponential coordinates that enclose the Voronoi cells, as published.

Equations (4.7) to (4.9). The boundaries of the exact cells curve inwards from their faces, so that
they cover the exact cells. In (4.8) the printed t = 3 pi / 4 - sqrt(3) h must be divided by pi / 4;
in (4.9) x and y are exchanged here, a quarter turn, to fit the axes of our icosahedral group.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError

Array = NDArray[np.float64]

_GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))


@dataclass(frozen=True, eq=False)
class PublishedCell:
    """A polyhedron about the origin of exponential coordinates [rad].

    Attributes:
        vertices: (m, 3).
        normals: unit normals (k, 3) of its faces.
        offsets: (k,) distances of the faces.
    """

    vertices: Array
    normals: Array
    offsets: Array

    def contains(self, coordinates: ArrayLike) -> NDArray[np.bool_]:
        """Whether exponential coordinates (..., 3) lie in the polyhedron."""
        along = np.asarray(coordinates, dtype=float) @ self.normals.T
        return np.asarray(np.all(along <= self.offsets + 1e-12, axis=-1))


def published_cell(name: str) -> PublishedCell:
    """The polyhedron of the ``tetrahedral``, ``octahedral`` or ``icosahedral`` group.

    Raises:
        GridError: the thesis has no cell of that name.
    """
    makers = {"tetrahedral": _tetrahedral, "octahedral": _octahedral, "icosahedral": _icosahedral}
    if name not in makers:
        raise GridError(f"no published cell {name!r}; known are {', '.join(makers)}")
    return makers[name]()


def _signed(*values: float) -> Array:
    choices = [(v, -v) if v else (0.0,) for v in values]
    return np.array(list(itertools.product(*choices)))


def _cyclic(points: Array) -> Array:
    return np.vstack([np.roll(points, shift, axis=1) for shift in range(3)])


def _cropped(vertices: Array, axes: float, diagonals: float) -> PublishedCell:
    normals = np.vstack([np.eye(3), -np.eye(3), _signed(1.0, 1.0, 1.0) / math.sqrt(3.0)])
    return PublishedCell(vertices, normals, np.repeat([axes, diagonals], [6, 8]))


def _tetrahedral() -> PublishedCell:
    half, third = math.pi / 2.0, math.pi / 3.0
    rest = math.sqrt(3.0) * third - half
    vertices = np.vstack([_cyclic(_signed(half, rest, 0.0)), _cyclic(_signed(half, 0.0, rest))])
    return _cropped(vertices, half, third)


def _octahedral() -> PublishedCell:
    quarter = math.pi / 4.0
    corner = quarter * (1.0 - (3.0 - 4.0 / math.sqrt(3.0)))
    return _cropped(_cyclic(_signed(corner, quarter, quarter)), quarter, math.pi / 3.0)


def _icosahedral() -> PublishedCell:
    fifth = math.pi / 5.0
    scale = 20.0 * fifth / (math.sqrt(250.0 + 110.0 * math.sqrt(5.0)) * (math.sqrt(5.0) - 1.0))
    ring = _cyclic(_signed(0.0, _GOLDEN, 1.0 / _GOLDEN))
    normals = _cyclic(_signed(0.0, 1.0, _GOLDEN)) / math.hypot(_GOLDEN, 1.0)
    vertices = scale * np.vstack([_signed(1.0, 1.0, 1.0), ring])
    return PublishedCell(vertices, normals, np.full(12, fifth))
