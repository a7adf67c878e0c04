"""Grids of orientations whose cells are found in constant time, with proved radii.

An orientation is known by a unit vector: a heading on the circle, the direction of an axis on the
sphere, a quaternion on the sphere in four dimensions. The cube around the sphere, seen from its
middle, divides the sphere into faces, and a grid on each face makes the cells. A cell is a
box in its face, so it lies in a cap around any vector as soon as the box's corners do: caps of
less than a right angle are convex cones. kernels.safety_table finds the cells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels.safety_table import BEND

Array = NDArray[np.float64]

NOTHING, HEADING, DIRECTION, QUATERNION = 1, 2, 3, 4
"""How many numbers the vector has that an orientation is looked up by."""

NAMES = {
    NOTHING: "one orientation",
    HEADING: "headings",
    DIRECTION: "directions of the axis",
    QUATERNION: "rotations",
}
# Cells count as larger by this on every side, in their face: far more than rounding moves them.
_SEAM = 1e-9
_IDENTITY = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class OrientationGrid:
    """A grid of orientations.

    Attributes:
        vector: NOTHING, HEADING, DIRECTION or QUATERNION.
        faces: how many faces of the cube have cells of their own; symmetric links need fewer.
        cells: number of cells along each edge of a face.
    """

    vector: int
    faces: int = 1
    cells: int = 1

    @property
    def count(self) -> int:
        """The number of cells."""
        return int(self.faces * self.cells ** (self.vector - 1))

    def radius(self) -> float:
        """Largest angle [rad] of a rotation that takes a cell's representative to one in the cell.

        For headings and directions it is the angle of two unit vectors, for quaternions twice that.
        """
        if self.vector == NOTHING:
            return 0.0
        corners = self._on_face(_edges(self.cells))
        middles = self._on_face(_middles(self.cells))[None]
        shape = (self.cells + 1,) * (self.vector - 1)
        grid = corners.reshape(*shape, self.vector)
        chord = 0.0
        for ends in product((slice(None, -1), slice(1, None)), repeat=self.vector - 1):
            corner = grid[ends].reshape(1, -1, self.vector)
            chord = max(chord, float(np.linalg.norm(corner - middles, axis=2).max()))
        angle = 2.0 * math.asin(min(0.5 * chord, 1.0)) + 4.0 * _SEAM
        return 2.0 * angle if self.vector == QUATERNION else angle

    def _on_face(self, ratios: Array) -> Array:
        """Unit vectors (m, vector) of all combinations of ratios, the largest component last."""
        axes = np.meshgrid(*[ratios] * (self.vector - 1), indexing="ij")
        ones = np.ones(axes[0].size)
        vectors = np.column_stack([*(axis.ravel() for axis in axes), ones])
        return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

    def vectors(self) -> Array:
        """The representatives' unit vectors (count, vector), in the order of the cells."""
        own = self._on_face(_middles(self.cells))
        return np.concatenate([_turned(own, self.vector, face) for face in range(self.faces)])

    def quaternions(self) -> Array:
        """The representatives as quaternions (count, 4), in the order of the cells."""
        if self.vector == NOTHING:
            return np.array([_IDENTITY])
        vectors = self.vectors()
        if self.vector == QUATERNION:
            return vectors
        zero = np.zeros(len(vectors))
        if self.vector == HEADING:
            half = 0.5 * np.arctan2(vectors[:, 1], vectors[:, 0])
            return np.column_stack([zero, zero, np.sin(half), np.cos(half)])
        return _tilts(vectors)


def smallest_grid(vector: int, faces: int, orientations: int) -> OrientationGrid:
    """The grid with the fewest cells that has at least ``orientations``."""
    cells = 1
    while OrientationGrid(vector, faces, cells).count < orientations and vector != NOTHING:
        cells += 1
    return OrientationGrid(vector, faces, cells)


def _unbent(values: NDArray[np.floating[Any]]) -> Array:
    """The inverse of the kernel's u ↦ u (1 + BEND − BEND |u|), for values in [−1, 1]."""
    root = np.sqrt(np.maximum((1.0 + BEND) ** 2 - 4.0 * BEND * np.abs(values), 0.0))
    return np.asarray(np.sign(values) * ((1.0 + BEND) - root) / (2.0 * BEND))


def _edges(cells: int) -> Array:
    return _unbent(np.arange(cells + 1) * (2.0 / cells) - 1.0)


def _middles(cells: int) -> Array:
    return _unbent((np.arange(cells) + 0.5) * (2.0 / cells) - 1.0)


def _turned(own: Array, vector: int, face: int) -> Array:
    """Vectors (m, vector) of a face from those whose largest component is the last one."""
    if vector == QUATERNION:
        # Back from what multiplying by 1, i, j or k from the right has made of them.
        x, y, z, w = own.T
        back = (x, y, z, w), (-w, -z, y, x), (z, -w, -x, y), (-y, x, -w, z)
        return np.column_stack(back[face])
    sign = 1.0 if face < vector else -1.0
    if vector == HEADING:
        a, top = own.T
        return sign * np.column_stack([(top, a), (a, top)][face % 2])
    a, b, top = own.T
    return sign * np.column_stack([(top, a, b), (b, top, a), (a, b, top)][face % 3])


def _tilts(directions: Array) -> Array:
    """Quaternions (m, 4) of rotations that take the z axis to unit vectors (m, 3)."""
    x, y, z = directions.T
    tilts = np.column_stack([-y, x, np.zeros(len(x)), 1.0 + z])
    lengths = np.linalg.norm(tilts, axis=1)
    tilts[lengths < 1e-8] = (1.0, 0.0, 0.0, 0.0)
    return tilts / np.linalg.norm(tilts, axis=1, keepdims=True)
