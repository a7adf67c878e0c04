"""Grids of planar motions that a wallpaper group replicates (thesis 4.4).

The centre cell's nodes are a finer copy of the group's own lattice times evenly spread headings.
The group's turns map that finer lattice to itself, so that cells meet without seams.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.plane_groups import PlaneGroup, nearest_translation, wrapped

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PlaneGrid:
    """Motions (x, y, heading), made from their indices.

    Attributes:
        group: the plane group.
        divisions: how many steps an edge of the group's lattice has.
        headings: how many headings the centre cell has.
        cells: lattice cells (2,) along each edge of the lattice, beginning at ``origin``.
        origin: lattice coordinates (2,) of the first cell.
    """

    group: PlaneGroup
    divisions: int
    headings: int
    cells: tuple[int, int]
    origin: tuple[int, int]

    @property
    def steps(self) -> tuple[int, int, int]:
        """How many places along each edge and how many headings there are."""
        along = self.cells[0] * self.divisions, self.cells[1] * self.divisions
        return (*along, self.group.order * self.headings)

    @property
    def count(self) -> int:
        """How many motions the grid has."""
        return math.prod(self.steps)

    @property
    def fine_basis(self) -> Array:
        """The shortest steps between places, the columns of (2, 2)."""
        return self.group.basis / self.divisions

    @cached_property
    def cell_nodes(self) -> Array:
        """The centre cell's nodes (divisions^2 headings, 3), one of each coset."""
        fine = np.arange(self.divisions)
        places = np.stack(np.meshgrid(fine, fine, indexing="ij"), -1).reshape(-1, 2)
        points = places @ self.fine_basis.T
        points -= nearest_translation(self.group.basis, points) @ self.group.basis.T
        headings = (np.arange(self.headings) - 0.5 * (self.headings - 1)) * self._turn
        rows = np.repeat(points, self.headings, axis=0)
        return np.column_stack([rows, np.tile(headings, len(points))])

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int | slice | Integers) -> Array:
        if isinstance(index, slice):
            return self.at(np.arange(*index.indices(self.count)))
        wanted = np.asarray(index)
        if np.any((wanted < -self.count) | (wanted >= self.count)):
            raise IndexError(f"the grid has {self.count} motions")
        return self.at(wanted % self.count)

    def __iter__(self) -> Iterator[Array]:
        return (self.at(index) for index in range(self.count))

    def at(self, indices: ArrayLike) -> Array:
        """The motions (..., 3) of nodes 0 <= indices (...) < count."""
        i, j, k = np.unravel_index(np.asarray(indices), self.steps)
        places = np.stack([i, j], axis=-1) + self._first
        place = places @ self.fine_basis.T
        heading = wrapped((k - self._heading_shift) * self._turn)
        return np.concatenate([place, heading[..., None]], axis=-1)

    def nearest(self, motions: ArrayLike) -> Integers:
        """The index (...) of the node nearest to each motion (..., 3), in constant time.

        Nearest in place and in heading; motions beyond the grid are given a node at its edge.
        """
        g = np.asarray(motions, dtype=float)
        place = nearest_translation(self.fine_basis, g[..., :2]) - self._first
        heading = np.rint(g[..., 2] / self._turn + self._heading_shift).astype(np.int64)
        first, second, turns = self.steps
        i, j = np.clip(place[..., 0], 0, first - 1), np.clip(place[..., 1], 0, second - 1)
        return np.asarray((i * second + j) * turns + heading % turns)

    def neighbours(self, index: int, radius: float, heading_weight: float = 1.0) -> Integers:
        """The other nodes within ``radius`` of a node, in rising order.

        The distance is the square root of |translation|^2 + (heading_weight heading [rad])^2.
        """
        i, j, k = np.unravel_index(index % self.count, self.steps)
        offsets = self._offsets(radius, heading_weight)
        first, second, turns = self.steps
        a, b, c = i + offsets[:, 0], j + offsets[:, 1], (k + offsets[:, 2]) % turns
        kept = (a >= 0) & (a < first) & (b >= 0) & (b < second)
        return np.unique((a[kept] * second + b[kept]) * turns + c[kept])

    def _offsets(self, radius: float, heading_weight: float) -> Integers:
        # A lattice point within the radius has coordinates of at most radius / (row's height).
        rows = np.linalg.norm(np.linalg.inv(self.fine_basis), axis=1)
        reach = np.floor(radius * rows + 1e-9).astype(int)
        turns = self.steps[2]
        most = math.floor(radius / (heading_weight * self._turn) + 1e-9)
        spins = np.arange(-min(most, (turns - 1) // 2), min(most, turns // 2) + 1)
        ranges = [np.arange(-r, r + 1) for r in reach]
        every = np.stack(np.meshgrid(*ranges, spins, indexing="ij"), -1).reshape(-1, 3)
        flat = np.sum((every[:, :2] @ self.fine_basis.T) ** 2, axis=1)
        far = flat + (heading_weight * self._turn * every[:, 2]) ** 2
        return every[(far <= radius**2 * (1.0 + 1e-9)) & np.any(every != 0, axis=1)]

    @property
    def _turn(self) -> float:
        return self.group.turn / self.headings

    @property
    def _heading_shift(self) -> float:
        return 0.5 * (self.headings - 1)

    @property
    def _first(self) -> Integers:
        return np.array(self.origin, dtype=np.int64) * self.divisions


def plane_grid(
    group: PlaneGroup,
    *,
    divisions: int = 1,
    headings: int = 1,
    cells: tuple[int, int] = (1, 1),
    origin: tuple[int, int] = (0, 0),
) -> PlaneGrid:
    """A grid of planar motions over ``cells`` cells of the group's lattice.

    Raises:
        GridError: a number is not positive.
    """
    if min(divisions, headings, *cells) < 1:
        raise GridError("a grid of planar motions needs positive divisions, headings and cells")
    return PlaneGrid(group, divisions, headings, cells, origin)
