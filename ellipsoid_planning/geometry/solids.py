"""Spheres, boxes, cylinders, capsules and meshes, to be enclosed whole or in pieces."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import enclosing_forms, triangles
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rounds import Rounds

Array = NDArray[np.float64]
Plane = tuple[Array, float]


@dataclass(frozen=True, eq=False)
class Solid:
    """A body inside the convex hull of points and round bodies, or a piece of one.

    Attributes:
        points: (m, 3), possibly none.
        rounds: discs and balls.
        surface: (k, 3, 3), triangles around the solid: its own for boxes and meshes, those of a
            polyhedron a little larger for curved solids.
        form: its minimum-volume ellipsoid in closed form, to rounding, where there is one.
        volume: where it is known in closed form.
        whole: (K, 3, 3), the closed surface that a piece was cut out of; None if uncut.
        planes: the cuts, the piece where normal . x <= offset.
    """

    points: Array
    rounds: Rounds
    surface: Array
    form: Ellipsoid | None = None
    volume: float | None = None
    whole: Array | None = None
    planes: tuple[Plane, ...] = ()

    @property
    def middle(self) -> Array:
        """The mean of the surface's corners, (3,)."""
        return np.asarray(self.surface.reshape(-1, 3).mean(axis=0))

    def extent(self, normal: Array) -> tuple[float, float]:
        """The least and the largest normal . x of the solid's convex hull."""
        along = self.points @ normal
        centres = self.rounds.centres @ normal
        reach = np.linalg.norm(normal @ self.rounds.matrices, axis=1)
        return (
            float(np.min(np.concatenate([along, centres - reach]))),
            float(np.max(np.concatenate([along, centres + reach]))),
        )

    def cut(self, normal: Array, offset: float) -> tuple[Solid | None, Solid | None]:
        """The pieces below and above the plane normal . x = offset, None for an empty one.

        Together they cover the solid. Curved solids that are cut become polyhedra around them.
        """
        low, high = self.extent(normal)
        if high <= offset:
            return self, None
        if low >= offset:
            return None, self
        return self._piece(normal, offset), self._piece(-normal, -offset)

    def _piece(self, normal: Array, offset: float) -> Solid:
        """What is below the plane.

        Its convex hull contains all of the solid there: an extreme point is on the surface, or
        is a corner where three cuts meet inside.
        """
        whole = self.surface if self.whole is None else self.whole
        planes = (*self.planes, (normal, offset))
        surface = triangles.cut_triangles(self.surface, normal, offset)
        corners = _corners(planes)
        corners = corners[triangles.are_inside(corners, whole)]
        kept = self.points[self.points @ normal <= offset]
        points = np.concatenate([surface.reshape(-1, 3), kept, corners])
        return Solid(points, Rounds.none(3), surface, whole=whole, planes=planes)

    def transform(self, rotation: Array, position: Array) -> Solid:
        """The uncut solid after x -> rotation @ x + position."""
        return replace(
            self,
            points=self.points @ rotation.T + position,
            rounds=self.rounds.transform(rotation, position),
            surface=self.surface @ rotation.T + position,
            form=None if self.form is None else self.form.transform(rotation, position),
        )


def sphere(radius: float) -> Solid:
    """A ball about the origin."""
    return capsule(radius, 0.0)


def box(sizes: ArrayLike) -> Solid:
    """A box of the whole sizes (3,) about the origin, which may be flat."""
    half = 0.5 * _positive("size of a box", sizes, 3, least=0.0)
    surface = triangles.box_triangles(half)
    corners = np.unique(surface.reshape(-1, 3), axis=0)
    form = None
    if np.all(half > 0.0):
        form = Ellipsoid.from_semi_axes(enclosing_forms.box_semi_axes(half))
    return Solid(corners, Rounds.none(3), surface, form, float(8.0 * np.prod(half)))


def cylinder(radius: float, length: float) -> Solid:
    """A cylinder about the z axis, its middle at the origin."""
    r = float(_positive("radius of a cylinder", radius, 1)[0])
    h = 0.5 * float(_positive("length of a cylinder", length, 1, least=0.0)[0])
    ends = np.array([[0.0, 0.0, h], [0.0, 0.0, -h]])
    rounds = Rounds(ends, np.array([np.diag([r, r, 0.0])] * 2))
    form = Ellipsoid.from_semi_axes(enclosing_forms.cylinder_semi_axes(r, h))
    surface = triangles.cylinder_triangles(r, h)
    return Solid(np.zeros((0, 3)), rounds, surface, form, 2.0 * math.pi * r * r * h)


def capsule(radius: float, length: float) -> Solid:
    """The points within the radius of a segment of this length on the z axis about the origin."""
    r = float(_positive("radius", radius, 1)[0])
    h = 0.5 * float(_positive("length of a capsule", length, 1, least=0.0)[0])
    ends = np.array([[0.0, 0.0, h], [0.0, 0.0, -h]])[: 2 if h > 0.0 else 1]
    rounds = Rounds(ends, np.array([np.diag([r, r, r])] * len(ends)))
    form = Ellipsoid.from_semi_axes(enclosing_forms.capsule_semi_axes(r, h))
    volume = 2.0 * math.pi * r * r * h + 4.0 / 3.0 * math.pi * r**3
    surface = triangles.capsule_triangles(r, h)
    return Solid(np.zeros((0, 3)), rounds, surface, form, volume)


def mesh(vertices: ArrayLike, faces: ArrayLike) -> Solid:
    """The triangles of vertices (m, 3) and faces (k, 3), and what they enclose.

    Raises:
        GeometryError: if there is no triangle or a vertex is not finite.
    """
    points = np.asarray(vertices, dtype=float)
    corners = np.asarray(faces, dtype=int)
    if not len(corners):
        raise GeometryError("a mesh without triangles")
    if not np.all(np.isfinite(points)):
        raise GeometryError("a mesh with vertices that are not finite")
    return Solid(np.unique(points, axis=0), Rounds.none(3), points[corners])


def _positive(what: str, value: ArrayLike, count: int, least: float | None = None) -> Array:
    numbers = np.atleast_1d(np.asarray(value, dtype=float))
    enough = numbers > 0.0 if least is None else numbers >= least
    if numbers.shape != (count,) or not np.all(np.isfinite(numbers) & enough):
        raise GeometryError(f"expected a positive {what}, got {numbers.tolist()}")
    return numbers


def _corners(planes: tuple[Plane, ...]) -> Array:
    """Where the last plane meets two others (k, 3), within all planes."""
    normals = np.array([normal for normal, _ in planes])
    offsets = np.array([offset for _, offset in planes])
    found = []
    for pair in itertools.combinations(range(len(planes) - 1), 2):
        rows = [*pair, len(planes) - 1]
        if abs(np.linalg.det(normals[rows])) < 1e-9:
            continue
        point = np.linalg.solve(normals[rows], offsets[rows])
        others = np.delete(np.arange(len(planes)), rows)
        if np.all(normals[others] @ point <= offsets[others]):
            found.append(point)
    return np.array(found).reshape(-1, 3)
