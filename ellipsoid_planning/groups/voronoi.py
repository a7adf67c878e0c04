"""Exact Voronoi cells of rotations: polyhedra in Rodrigues coordinates.

Where d(x, 1) <= d(x, g) is a half-space of the Rodrigues coordinates axis * tan(angle / 2); in
exponential coordinates its boundary is curved (section 4.3.0.5 of the thesis).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.finite_groups import FiniteGroup
from ellipsoid_planning.groups.quaternions import IDENTITY, angle, canonical

Array = NDArray[np.float64]

ALL_ROTATIONS = 8.0 * math.pi**2
"""The volume [rad^3] of all rotations for the metric of thesis (4.4)."""


@dataclass(frozen=True, eq=False)
class VoronoiCell:
    """The rotations no farther from the identity than from any other centre.

    Attributes:
        normals: unit normals (k, 3) of the half-spaces, their axes, in Rodrigues coordinates.
        offsets: (k,): the cell is where normals @ rho <= offsets, tan(angle / 4) of each centre.
        volume: its volume [rad^3], of 8 pi^2 for all rotations.
    """

    normals: Array
    offsets: Array
    volume: float

    @classmethod
    def of_group(cls, group: FiniteGroup) -> VoronoiCell:
        """The cell of the identity among the elements of ``group``."""
        return cls.of_centres(group.quaternions)

    @classmethod
    def of_centres(cls, centres: ArrayLike) -> VoronoiCell:
        """The cell of the identity among ``centres`` (n, 4), one of which is the identity.

        Its volume is that of n congruent cells, as the products of one or two groups have.
        """
        q = canonical(np.asarray(centres, dtype=float))
        turns = angle(q, IDENTITY)
        others = turns > 1e-9
        if np.count_nonzero(~others) != 1:
            raise GridError("the centres of Voronoi cells must have the identity once")
        q, turns = q[others], turns[others]
        axes = q[:, :3] / np.linalg.norm(q[:, :3], axis=1)[:, None]
        half_turns = turns > math.pi - 1e-9
        normals = np.vstack([axes, -axes[half_turns]]).reshape(-1, 3)
        offsets = np.tan(0.25 * np.concatenate([turns, turns[half_turns]]))
        kept = _irredundant(normals, offsets)
        return cls(normals[kept], offsets[kept], ALL_ROTATIONS / (len(q) + 1))

    def contains(self, rotations: ArrayLike, margin: float = 0.0) -> NDArray[np.bool_]:
        """Whether the rotations (..., 4) lie in the closed cell; ``margin`` widens it."""
        q = np.asarray(rotations, dtype=float)
        q = np.where(q[..., 3:] < 0.0, -q, q)
        # Multiplied by w, so that half turns (w = 0) are no exception.
        reach = q[..., :3] @ self.normals.T - q[..., 3:] * self.offsets
        return np.asarray(np.all(reach <= margin, axis=-1))

    def reach(self, axes: ArrayLike) -> Array:
        """The largest angle [rad] within the cell about each of the unit axes (..., 3)."""
        along = np.asarray(axes, dtype=float) @ self.normals.T
        with np.errstate(divide="ignore", invalid="ignore"):
            bounds = np.where(along > 1e-15, self.offsets / along, np.inf)
        return 2.0 * np.arctan(bounds.min(axis=-1, initial=np.inf))

    @cached_property
    def vertices(self) -> Array:
        """The vertices (m, 3) in Rodrigues coordinates.

        Raises:
            GridError: the cell reaches half turns in a whole direction, as cyclic groups' do.
        """
        found = polyhedron_vertices(self.normals, self.offsets, np.zeros(3))
        if not (len(found) and self.is_bounded):
            raise GridError("this Voronoi cell has no finite vertices in Rodrigues coordinates")
        return found

    @property
    def is_bounded(self) -> bool:
        """Whether every rotation of the cell is less than a half turn."""
        from scipy.optimize import linprog

        if len(self.normals) < 4:
            return False
        # Bounded: the normals span space and a positive combination of them vanishes.
        count = len(self.normals)
        found = linprog(np.zeros(count), A_eq=self.normals.T, b_eq=np.zeros(3), bounds=(1.0, None))
        return bool(found.status == 0 and np.linalg.matrix_rank(self.normals) == 3)

    @property
    def circumradius(self) -> float:
        """The largest angle [rad] in the cell: the covering radius of its centres."""
        if not self.is_bounded:
            return math.pi
        return float(2.0 * np.arctan(np.linalg.norm(self.vertices, axis=1).max()))

    @property
    def inradius(self) -> float:
        """Half the angle [rad] to the nearest other centre."""
        return float(2.0 * np.arctan(self.offsets.min(initial=np.inf)))


def polyhedron_vertices(normals: Array, offsets: Array, inside: Array) -> Array:
    """The finite vertices (m, 3) where normals @ x <= offsets, for a point strictly inside."""
    from scipy.spatial import HalfspaceIntersection, QhullError

    try:
        meet = HalfspaceIntersection(np.column_stack([normals, -offsets]), inside)
    except QhullError:
        return np.empty((0, 3))
    points = meet.intersections[np.all(np.isfinite(meet.intersections), axis=1)]
    return np.unique(np.round(points, 12) + 0.0, axis=0)


def _irredundant(normals: Array, offsets: Array) -> NDArray[np.intp]:
    """The half-spaces that have a face, or all when the cell has no vertices."""
    if len(normals) < 4:
        return np.arange(len(normals))
    vertices = polyhedron_vertices(normals, offsets, np.zeros(3))
    if len(vertices) < 4:
        return np.arange(len(normals))
    touching = np.abs(vertices @ normals.T - offsets) < 1e-9
    kept = [i for i in range(len(normals)) if touching[:, i].sum() >= 3]
    # Three vertices that only share an edge make no face.
    faces = [i for i in kept if np.linalg.matrix_rank(_spread(vertices[touching[:, i]]), 1e-7) == 2]
    return np.array(faces, dtype=np.intp)


def _spread(points: Array) -> Array:
    return points - points.mean(axis=0)


def polyhedron_edges(normals: Array, offsets: Array, vertices: Array) -> NDArray[np.intp]:
    """The edges (e, 2) of a polyhedron as pairs of vertices, for drawing."""
    on = np.abs(vertices @ normals.T - offsets) < 1e-9
    pairs = itertools.combinations(range(len(vertices)), 2)
    edges = [(i, j) for i, j in pairs if np.count_nonzero(on[i] & on[j]) >= 2]
    return np.array(edges, dtype=np.intp).reshape(-1, 2)
