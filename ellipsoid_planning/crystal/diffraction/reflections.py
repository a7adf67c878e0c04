"""Reflections: the points of the reciprocal lattice inside a sphere, each kind of them once."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# More lattice points than this in the box around the sphere are a slip of the unit, no data.
MOST_POINTS = 20_000_000

# Points on the sphere belong to it, whatever rounding has made of their length.
ON_THE_SPHERE = 1e-10


@dataclass(frozen=True, eq=False)
class Reflections:
    """R reflections of a cell, those of the lowest resolution first; all arrays read-only.

    Attributes:
        indices: (R, n), Miller indices h.
        vectors: (R, n), h in Cartesian reciprocal axes [1/length]: their length is 1/d.
        multiplicities: (R,), how many pairs (h, -h) of the sphere each one stands for.
    """

    indices: Integers
    vectors: Array
    multiplicities: Integers

    def __len__(self) -> int:
        return len(self.indices)

    @property
    def spacings(self) -> Array:
        """(R,), the spacings d of the lattice planes [length]."""
        return 1.0 / np.linalg.norm(self.vectors, axis=1)

    def subset(self, chosen: NDArray[np.bool_] | Integers) -> Reflections:
        """Those chosen by a mask or by their positions."""
        arrays = (self.indices, self.vectors, self.multiplicities)
        return Reflections(*(_frozen(array[chosen]) for array in arrays))


def all_reflections(cell: UnitCell, resolution: float) -> Reflections:
    """One of each pair (h, -h) with spacing d >= ``resolution``, without (0, 0, 0).

    Since h_k = s · a_k for the reciprocal vector s of length 1/d, no index exceeds |a_k|/d_min,
    so that none is forgotten. Of each pair the one whose first index that is not 0 is positive.

    Raises:
        CrystalError: if the resolution is no positive number, no reflection reaches it, or far too
            many do.
    """
    if not (np.isfinite(resolution) and resolution > 0.0):
        raise CrystalError(f"expected a positive resolution, got {resolution:g}")
    largest = np.floor(cell.lengths / resolution * (1.0 + ON_THE_SPHERE))
    if math.prod(2.0 * k + 1.0 for k in largest.tolist()) > MOST_POINTS:
        raise CrystalError(
            f"a resolution of {resolution:g} asks for indices up to {largest.max():g}, millions of "
            "reflections; choose a larger spacing"
        )
    reach = largest.astype(np.int64)
    axes = [np.arange(-k, k + 1) for k in reach]
    axes[0] = np.arange(reach[0] + 1)
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, cell.dimension)
    grid = grid[(friedel_signs(grid) > 0) & np.any(grid != 0, axis=1)]
    squares = np.sum((grid @ cell.reciprocal.T) ** 2, axis=1)
    found = _sorted(grid[squares * resolution**2 <= 1.0 + ON_THE_SPHERE], cell)
    if not len(found):
        raise CrystalError(
            f"no reflection of the cell has a spacing of {resolution:g} or more; planes along its "
            f"faces are up to {1.0 / np.linalg.norm(cell.reciprocal, axis=0).min():g} apart, "
            "choose a smaller one"
        )
    return Reflections(found, _vectors(found, cell), _frozen(np.ones(len(found), np.int64)))


def unique_reflections(cell: UnitCell, group: SpaceGroup, resolution: float) -> Reflections:
    """One of each set of reflections that the group's Laue class makes alike, none absent ones.

    Args:
        cell: the unit cell.
        group: its space group or plane group.
        resolution: the smallest spacing d_min.

    Raises:
        CrystalError: as `all_reflections`; also if the cell contradicts the group.
    """
    group.check_cell(cell)
    whole = all_reflections(cell, resolution).indices
    whole = whole[~absent(group, whole)]
    found, counts = np.unique(representatives(group, whole), axis=0, return_counts=True)
    order = _order(found, cell)
    found = _frozen(found[order])
    return Reflections(found, _vectors(found, cell), _frozen(counts[order].astype(np.int64)))


def absent(group: SpaceGroup, indices: Integers) -> NDArray[np.bool_]:
    """(R,), which of the reflections (R, n) no structure of this group can have.

    F(h) = exp(2πi h·w) F(h) under an operation x -> W x + w with hW = h: where h·w is no whole
    number, F(h) = 0. Decided with integers.
    """
    gone = np.zeros(len(indices), bool)
    for rotation, shift in zip(group.integer_rotations, group.integer_translations, strict=True):
        kept = np.all(indices @ rotation == indices, axis=1)
        gone |= kept & ((indices @ shift) % group.denominator != 0)
    return gone


def representatives(group: SpaceGroup, indices: Integers) -> Integers:
    """The reflection (R, n) that stands for each of ``indices`` (R, n) under the Laue class.

    It is the last in alphabetical order among all h W and -h W.
    """
    best = np.array(indices, dtype=np.int64)
    for rotation in group.integer_rotations:
        for other in (indices @ rotation, -(indices @ rotation)):
            later = _signs(other - best) > 0
            best[later] = other[later]
    return best


def friedel_signs(indices: Integers) -> Integers:
    """(R,), 1 for the reflection of a pair (h, -h) that stands for both, -1 for the other.

    (0, 0, 0) has 1.
    """
    signs = _signs(indices)
    return np.where(signs < 0, -1, 1)


def _signs(indices: Integers) -> Integers:
    """(R,), the signs of the first entries that are not 0."""
    first = np.argmax(indices != 0, axis=1)
    return np.sign(np.take_along_axis(indices, first[:, None], axis=1)[:, 0])


def _order(indices: Integers, cell: UnitCell) -> Integers:
    """Low resolution first; of equal spacings (but for rounding) alphabetically by indices."""
    squares = np.sum((indices @ cell.reciprocal.T) ** 2, axis=1)
    if not len(squares):
        return np.zeros(0, np.int64)
    shells = np.round(squares / squares.max() / ON_THE_SPHERE)
    return np.lexsort([*indices.T[::-1], shells])


def _sorted(indices: Integers, cell: UnitCell) -> Integers:
    return _frozen(indices[_order(indices, cell)])


def _vectors(indices: Integers, cell: UnitCell) -> Array:
    return _frozen(np.asarray(indices @ cell.reciprocal.T, dtype=float))


def _frozen(array: NDArray) -> NDArray:  # type: ignore[type-arg]
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array
