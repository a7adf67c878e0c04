"""Single cosets, double cosets and the wedge: ever smaller pieces that tile the rotations.

Sections 4.2, 4.3.2: a rotation is an element of H after one of the centre cell (single coset), or
one of H, one of a smaller cell and one of K (double coset, H and K sharing the identity alone). For
H = K the centre cell is divided into wedges that H turns into each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.finite_groups import FiniteGroup
from ellipsoid_planning.groups.quaternions import (
    canonical,
    exponential,
    from_rodrigues,
    inverse,
    logarithm,
    product,
    unit,
)
from ellipsoid_planning.groups.voronoi import VoronoiCell, polyhedron_vertices

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

BEST_CONJUGATION = (
    0.33987551193004158,
    -0.88304210707092671,
    -0.32359528994824720,
    -0.00271327354687201,
)
"""The rotation g for which the icosahedral group I and g I g^-1 have the smallest cells found: the
farthest rotation is 0.388207 rad from a centre, the best of 4,000 random g and a local search."""


class SingleCoset(NamedTuple):
    """``group.quaternions[elements]`` after ``rotations``, which lie in the centre cell."""

    elements: Indices
    rotations: Array


def single_coset(group: FiniteGroup, rotations: ArrayLike) -> SingleCoset:
    """Divide rotations (..., 4) into an element and a rotation of the centre cell."""
    q = unit(rotations)
    elements = group.nearest(q)
    return SingleCoset(elements, canonical(product(inverse(group.quaternions[elements]), q)))


class DividedRotation(NamedTuple):
    """``left[h]``, then ``rotations`` of the centre cell, then ``right[k]``: their product."""

    left: Indices
    rotations: Array
    right: Indices


@dataclass(frozen=True, eq=False)
class DoubleCosets:
    r"""The double cosets H\SO(3)/K of two groups that share the identity alone, (4.12).

    Attributes:
        left: the group H.
        right: the group K.
    """

    left: FiniteGroup
    right: FiniteGroup

    def __post_init__(self) -> None:
        shared = self.left.intersection_order(self.right)
        if shared != 1:
            raise GridError(
                f"{self.left.name} and {self.right.name} share {shared} rotations; double cosets "
                "need groups that share the identity alone, so conjugate one of them"
            )

    @cached_property
    def centres(self) -> Array:
        """The centres h k of all cells, (|H| |K|, 4), the one of (h, k) at h |K| + k."""
        products = product(self.left.quaternions[:, None], self.right.quaternions[None])
        return canonical(products.reshape(-1, 4))

    @cached_property
    def cell(self) -> VoronoiCell:
        """The Voronoi cell of the identity among the centres; all others are congruent."""
        return VoronoiCell.of_centres(self.centres)

    def divide(self, rotations: ArrayLike) -> DividedRotation:
        """Write rotations (..., 4) as h x k with x in the centre cell."""
        q = unit(rotations)
        nearest = np.abs(q @ self.centres.T).argmax(axis=-1)
        h, k = np.divmod(nearest, len(self.right))
        middle = product(inverse(self.left.quaternions[h]), q)
        middle = product(middle, inverse(self.right.quaternions[k]))
        return DividedRotation(h, canonical(middle), k)


@dataclass(frozen=True, eq=False)
class Wedge:
    r"""The part of a group's centre cell that the group turns into all others, H\SO(3)/H.

    For the icosahedral group, the tetrahedron of the identity, a face's centre and two neighbouring
    corners of that face: a barycentric piece of the cell (Fig. 4.10).

    Attributes:
        group: a tetrahedral, octahedral or icosahedral group H.
        normals: unit normals (k, 3) of its planes through the identity; inside is <= 0.
        cell: the group's centre cell.
    """

    group: FiniteGroup
    normals: Array
    cell: VoronoiCell

    @classmethod
    def of_group(cls, group: FiniteGroup) -> Wedge:
        """The wedge about the plane of a main axis and the nearest axis of half turns.

        Raises:
            GridError: the group is cyclic or dihedral, whose cell has no such pieces.
        """
        middle = unit(np.add(*_axes(group)))
        turned = _turn(group.quaternions[1:], middle)
        between = unit(turned - middle)
        return cls(group, between, VoronoiCell.of_group(group))

    def contains(self, rotations: ArrayLike, margin: float = 1e-12) -> NDArray[np.bool_]:
        """Whether the rotations (..., 4) lie in the closed wedge."""
        q = canonical(np.asarray(rotations, dtype=float))
        inside = np.all(q[..., :3] @ self.normals.T <= margin, axis=-1)
        return np.asarray(inside & self.cell.contains(q, margin))

    @cached_property
    def vertices(self) -> Array:
        """The rotations (m, 4) at its corners, the identity among them."""
        main, half = _axes(self.group)
        inside = 0.1 * self.cell.inradius * unit(main + half)
        normals = np.vstack([self.cell.normals, self.normals])
        offsets = np.append(self.cell.offsets, np.zeros(len(self.normals)))
        return from_rodrigues(polyhedron_vertices(normals, offsets, inside))

    @cached_property
    def centre(self) -> Array:
        """The mean of its corners in exponential coordinates, as a rotation (4,)."""
        return exponential(logarithm(self.vertices).mean(axis=0))


def _turn(quaternions: Array, vector: Array) -> Array:
    pure = np.append(vector, 0.0)
    return product(product(quaternions, pure), inverse(quaternions))[..., :3]


def _axes(group: FiniteGroup) -> tuple[Array, Array]:
    """An axis of the smallest turn, and the nearest axis of half turns that is not one too."""
    q = group.quaternions[1:]
    axes = unit(q[:, :3])
    smallest = q[:, 3] > q[:, 3].max() - 1e-9
    half = axes[np.abs(q[:, 3]) < 1e-9]
    half = np.vstack([half, -half])
    main = axes[smallest]
    half = half[~np.any(np.abs(half @ main.T) > 1.0 - 1e-9, axis=1)]
    if len(main) < 6 or len(half) < 6:
        raise GridError(f"the group {group.name} has no wedges; take a Platonic solid's")
    return main[0], half[np.argmax(half @ main[0])]
