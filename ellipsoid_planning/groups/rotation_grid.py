"""What every grid of rotations can do, and grids that are a formula of the index."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.nearby import both_signs, pairs_within, tree_of
from ellipsoid_planning.groups.quaternions import unit
from ellipsoid_planning.groups.voronoi import ALL_ROTATIONS

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_BLOCK = 4096


@dataclass(frozen=True, eq=False)
class NeighbourLists:
    """The neighbours of every node: those of node i are ``nodes[starts[i]:starts[i + 1]]``.

    Attributes:
        starts: (count + 1,).
        nodes: indices of nodes.
    """

    starts: Indices
    nodes: Indices

    def __len__(self) -> int:
        return len(self.starts) - 1

    def __getitem__(self, index: int) -> Indices:
        return self.nodes[self.starts[index] : self.starts[index + 1]]

    @property
    def pairs(self) -> Indices:
        """Each pair of neighbours once, (k, 2), the smaller index first."""
        first = np.repeat(np.arange(len(self)), np.diff(self.starts))
        once = first < self.nodes
        return np.column_stack([first[once], self.nodes[once]])


class RotationGrid(ABC):
    """A finite set of rotations, made one by one, in slices or at random from their indices.

    Attributes:
        name: of the grid, with what it was made from.
        count: how many rotations.
        max_distortion: the largest C of thesis (4.11) of the coordinates in which the grid is even;
            None for a grid that is even in no coordinates.
    """

    name: str
    count: int
    max_distortion: float | None = None

    @abstractmethod
    def at(self, indices: ArrayLike) -> Array:
        """The quaternions (..., 4) of nodes 0 <= indices (...) < count."""

    @property
    def spacing(self) -> float:
        """The edge [rad] of a cube that has a node's share of all rotations."""
        return float((ALL_ROTATIONS / self.count) ** (1.0 / 3.0))

    def __len__(self) -> int:
        return self.count

    @overload
    def __getitem__(self, index: int) -> Array: ...
    @overload
    def __getitem__(self, index: slice | Indices) -> Array: ...
    def __getitem__(self, index: int | slice | Indices) -> Array:
        if isinstance(index, slice):
            return self.at(np.arange(*index.indices(self.count)))
        wanted = np.asarray(index)
        if np.any((wanted < -self.count) | (wanted >= self.count)):
            raise IndexError(f"the grid has {self.count} rotations")
        return self.at(wanted % self.count)

    def __iter__(self) -> Iterator[Array]:
        for first in range(0, self.count, _BLOCK):
            yield from self.quaternions(first, min(first + _BLOCK, self.count))

    def quaternions(self, first: int = 0, last: int | None = None) -> Array:
        """The quaternions (m, 4) of the nodes from ``first`` to ``last`` (not included)."""
        return self[first:last]

    def nearest(self, rotations: ArrayLike) -> Indices:
        """The index (...) of the node nearest to each of the rotations (..., 4)."""
        q = np.asarray(rotations, dtype=float)
        _, found = self._tree.query(unit(q.reshape(-1, 4)))
        return np.asarray(found % self.count, dtype=np.intp).reshape(q.shape[:-1])

    def neighbours(self, index: int, radius: float) -> Indices:
        """The other nodes within ``radius`` [rad] of a node, in rising order."""
        query = self[index][None]
        _, found = pairs_within(tree_of(query), self._tree, radius)
        found = np.unique(found % self.count)
        return found[found != index % self.count]

    def neighbour_lists(self, radius: float) -> NeighbourLists:
        """The other nodes within ``radius`` [rad] of each node, for all nodes at once."""
        first, second = pairs_within(tree_of(self.quaternions()), self._tree, radius)
        return lists_of(first, second % self.count, self.count)

    @cached_property
    def _tree(self) -> cKDTree:
        return tree_of(both_signs(self.quaternions()))


def lists_of(first: Indices, second: Indices, count: int) -> NeighbourLists:
    """Lists from pairs, in any order and with repetitions, of a node and a neighbour."""
    coded = np.unique((first * np.int64(count) + second)[first != second])
    first, second = coded // count, coded % count
    starts = np.searchsorted(first, np.arange(count + 1))
    return NeighbourLists(starts.astype(np.intp), second.astype(np.intp))


class FormulaGrid(RotationGrid):
    """A grid whose rotations are a formula of their indices.

    Its neighbours and nearest nodes come from a k-d tree of all rotations, made when asked.
    """

    def __init__(
        self,
        name: str,
        count: int,
        formula: Callable[[NDArray[np.int64]], Array],
        max_distortion: float | None = None,
    ) -> None:
        if count < 1:
            raise GridError(f"a grid has at least 1 rotation, not {count}")
        self.name, self.count, self._formula = name, count, formula
        self.max_distortion = max_distortion

    def at(self, indices: ArrayLike) -> Array:
        """The quaternions (..., 4) of nodes 0 <= indices (...) < count."""
        return self._formula(np.asarray(indices, dtype=np.int64))
