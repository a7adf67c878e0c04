"""Grids that a group replicates: the nodes of one Voronoi cell, shifted to all the others.

Only the centre cell's nodes are kept, the share 1 / |group| of all. Thesis (4.6): the nodes of the
cell about the element k are k after the nodes of the cell about the identity. Left shifts keep
distances, so who neighbours whom is known once it is known for the centre cell.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.buckets import Buckets
from ellipsoid_planning.groups.finite_groups import FiniteGroup
from ellipsoid_planning.groups.nearby import both_signs, pairs_within, tree_of
from ellipsoid_planning.groups.quaternions import (
    canonical,
    inverse,
    left_matrix,
    product,
    unit,
)
from ellipsoid_planning.groups.rotation_grid import NeighbourLists, RotationGrid, lists_of
from ellipsoid_planning.groups.voronoi import VoronoiCell

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


class _Shifted(NamedTuple):
    """Nodes about the centre cell: ``quaternions[i]`` is ``elements[i]`` after ``nodes[i]``."""

    quaternions: Array
    elements: Indices
    nodes: Indices


class GroupGrid(RotationGrid):
    """The nodes of the centre cell after each element of a group, element by element.

    Node ``k * len(cell_nodes) + j`` is element k after the cell's node j.

    Attributes:
        group: the group, which acts from the left.
        cell: the Voronoi cell of its identity.
        cell_nodes: the centre cell's nodes (m, 4), no two of which the group maps to each other.
    """

    def __init__(
        self, name: str, group: FiniteGroup, nodes: ArrayLike, max_distortion: float | None = None
    ) -> None:
        """Take nodes of the closed centre cell, of those on its border one of each coset."""
        self.name, self.group, self.max_distortion = name, group, max_distortion
        self.cell = VoronoiCell.of_group(group)
        self.cell_nodes = one_per_coset(canonical(unit(nodes)), group)
        self.cell_nodes.setflags(write=False)
        self.count = len(group) * len(self.cell_nodes)
        if not self.count:
            raise GridError(f"the grid {name} has no node in a cell")
        self._tables: dict[float, tuple[Indices, Indices, Indices]] = {}

    def at(self, indices: ArrayLike) -> Array:
        """The quaternions (..., 4) of nodes 0 <= indices (...) < count."""
        element, node = np.divmod(np.asarray(indices), len(self.cell_nodes))
        return product(self.group.quaternions[element], self.cell_nodes[node])

    def quaternions(self, first: int = 0, last: int | None = None) -> Array:
        """The quaternions (m, 4) of the nodes from ``first`` to ``last`` (not included)."""
        begin, end, _ = slice(first, last).indices(self.count)
        out = np.empty((max(end - begin, 0), 4))
        size = len(self.cell_nodes)
        for element in range(begin // size, -(-end // size)):
            low, high = max(begin, element * size), min(end, (element + 1) * size)
            nodes = self.cell_nodes[low - element * size : high - element * size]
            left = left_matrix(self.group.quaternions[element])
            np.matmul(nodes, left.T, out=out[low - begin : high - begin])
        return out

    def nearest(self, rotations: ArrayLike) -> Indices:
        """The index (...) of the node nearest to each of the rotations (..., 4).

        Its time does not depend on the number of nodes: the nearest element's cell, then a box of
        that cell, which knows the few nodes that can be nearest to a rotation in it.
        """
        q = np.asarray(rotations, dtype=float)
        flat = unit(q.reshape(-1, 4))
        element = self.group.nearest(flat)
        local = product(inverse(self.group.quaternions[element]), flat)
        found = self._buckets.nearest(local)
        around = self._around_buckets
        shifted = self.group.table[element, around.elements[found]]
        return (shifted * len(self.cell_nodes) + around.nodes[found]).reshape(q.shape[:-1])

    def neighbours(self, index: int, radius: float) -> Indices:
        """The other nodes within ``radius`` [rad] of a node, in rising order."""
        element, node = divmod(index % self.count, len(self.cell_nodes))
        starts, elements, nodes = self._table(radius)
        those = slice(starts[node], starts[node + 1])
        shifted = self.group.table[element, elements[those]]
        return np.sort(shifted * len(self.cell_nodes) + nodes[those])

    def neighbour_lists(self, radius: float) -> NeighbourLists:
        """The other nodes within ``radius`` [rad] of each node, for all nodes at once.

        The lists are those of the centre cell, shifted; they are not sorted.
        """
        starts, elements, nodes = self._table(radius)
        size = len(self.cell_nodes)
        every = self.group.table[:, elements] * size + nodes
        first = (np.arange(len(self.group)) * len(nodes))[:, None] + starts[:-1]
        ends = np.append(first.ravel(), every.size)
        return NeighbourLists(ends, every.ravel())

    def shifted(self, reach: float) -> tuple[Array, Indices]:
        """All nodes within ``reach`` [rad] of the identity and their indices, (m, 4) and (m,)."""
        near = self._shifted(reach)
        return near.quaternions, near.elements * len(self.cell_nodes) + near.nodes

    def _shifted(self, reach: float) -> _Shifted:
        least = np.cos(0.5 * min(reach, np.pi)) - 1e-9
        # The last entry of "h after q" is the product of q with the inverse of h, entry by entry.
        last = inverse(self.group.quaternions) @ self.cell_nodes.T
        elements, nodes = np.nonzero(np.abs(last) >= least)
        found = product(self.group.quaternions[elements], self.cell_nodes[nodes])
        return _Shifted(canonical(found), elements, nodes)

    def _table(self, radius: float) -> tuple[Indices, Indices, Indices]:
        """Starts, elements and nodes of the neighbours of the centre cell's nodes."""
        if radius not in self._tables:
            self._tables[radius] = self._find_table(radius)
        return self._tables[radius]

    def _find_table(self, radius: float) -> tuple[Indices, Indices, Indices]:
        reach = self.cell.circumradius + radius
        near = self._shifted(reach)
        wrap = reach >= np.pi
        targets = both_signs(near.quaternions) if wrap else near.quaternions
        node, found = pairs_within(tree_of(self.cell_nodes), tree_of(targets), radius)
        found %= len(near.elements)
        size = len(self.cell_nodes)
        lists = lists_of(node, near.elements[found] * size + near.nodes[found], self.count)
        elements, nodes = np.divmod(lists.nodes, size)
        return lists.starts[: size + 1], elements, nodes

    @cached_property
    def _prepared(self) -> tuple[_Shifted, Buckets]:
        margin = 6.0 * self.spacing
        while True:
            reach = self.cell.circumradius + margin
            near = self._shifted(reach)
            buckets = Buckets(self.cell, near.quaternions, self.spacing)
            if reach >= np.pi or buckets.reach <= margin:
                return near, buckets
            margin *= 2.0

    @property
    def _buckets(self) -> Buckets:
        return self._prepared[1]

    @property
    def _around_buckets(self) -> _Shifted:
        return self._prepared[0]


def one_per_coset(nodes: Array, group: FiniteGroup) -> Array:
    """The nodes (m, 4) of a closed centre cell, one of those that the group maps to each other.

    Nodes inside the cell are all kept; only those on its border can be related.
    """
    overlap = np.abs(nodes @ group.quaternions.T)
    node, element = np.nonzero(overlap > overlap[:, :1] - 1e-9)
    copies = canonical(product(inverse(group.quaternions[element]), nodes[node]))
    # Rounding must not split equal coordinates, and those of symmetric nodes are round numbers.
    keys = np.floor(copies * 1e7 + 0.123456).astype(np.int64)
    _, label = np.unique(keys, axis=0, return_inverse=True)
    label = label.reshape(-1)
    smallest = np.full(len(nodes), label.max(initial=0) + 1)
    np.minimum.at(smallest, node, label)
    _, kept = np.unique(smallest, return_index=True)
    return nodes[np.sort(kept)]
