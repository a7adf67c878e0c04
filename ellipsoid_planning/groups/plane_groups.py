"""The chiral wallpaper groups p1, p2, p3, p4 and p6 as groups of planar motions.

Section 4.4: lattice translations, and turns about the origin by multiples of 360° / n. Motions are
(x, y, heading), which turn first and then translate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

_ORDERS = {"p1": 1, "p2": 2, "p3": 3, "p4": 4, "p6": 6}
PLANE_GROUPS = tuple(_ORDERS)


@dataclass(frozen=True, eq=False)
class PlaneGroup:
    """A lattice of translations and n turns, which map the lattice to itself.

    Attributes:
        name: p1, p2, p3, p4 or p6.
        basis: the shortest translations, the columns of (2, 2).
    """

    name: str
    basis: Array

    @property
    def order(self) -> int:
        """How many headings the group has: 1, 2, 3, 4 or 6."""
        return _ORDERS[self.name]

    @property
    def turn(self) -> float:
        """The angle [rad] between its headings."""
        return 2.0 * math.pi / self.order

    @cached_property
    def cell(self) -> PlaneCell:
        """The Voronoi cell of the identity for the metric of thesis (4.3)."""
        return PlaneCell(self)

    def element(self, steps: ArrayLike, turns: ArrayLike) -> Array:
        """The motions (..., 3) with lattice coordinates (..., 2) and whole turns (...)."""
        place = np.asarray(steps, dtype=float) @ self.basis.T
        heading = wrapped(np.asarray(turns, dtype=float) * self.turn)
        return np.concatenate(
            [place, np.broadcast_to(heading[..., None], (*place.shape[:-1], 1))], -1
        )

    def nearest(self, motions: ArrayLike) -> tuple[Integers, Integers]:
        """Lattice coordinates (..., 2) and turns (...) of the element nearest to each motion."""
        g = np.asarray(motions, dtype=float)
        turns = np.mod(np.rint(g[..., 2] / self.turn).astype(np.int64), self.order)
        return nearest_translation(self.basis, g[..., :2]), turns


def plane_group(
    name: str, a: float = 1.0, b: float | None = None, angle: float | None = None
) -> PlaneGroup:
    """A wallpaper group with the lattice's edges ``a``, ``b`` and the ``angle`` [rad] between.

    Without ``b`` and ``angle``: a square lattice for p1, p2 and p4, a hexagonal one for p3, p6.

    Raises:
        GridError: the group is unknown, or its turns do not map such a lattice to itself.
    """
    if name not in _ORDERS:
        raise GridError(f"unknown plane group {name!r}; known are {', '.join(_ORDERS)}")
    hexagonal = name in {"p3", "p6"}
    natural = 2.0 * math.pi / 3.0 if hexagonal else 0.5 * math.pi
    b, angle = a if b is None else b, natural if angle is None else angle
    if not (a > 0.0 and b > 0.0 and 0.0 < angle < math.pi and math.isfinite(a * b)):
        raise GridError(f"no lattice has the edges {a}, {b} and the angle {angle}")
    fits = math.isclose(a, b) and math.isclose(angle, natural)
    fits |= hexagonal and math.isclose(a, b) and math.isclose(angle, math.pi / 3.0)
    if name in {"p3", "p4", "p6"} and not fits:
        kind = "hexagonal (b = a, angle = 120° or 60°)" if hexagonal else "square (b = a, 90°)"
        raise GridError(f"the turns of {name} need a lattice that is {kind}")
    edges = np.array([[a, b * math.cos(angle)], [0.0, b * math.sin(angle)]])
    return PlaneGroup(name, reduced(edges))


@dataclass(frozen=True, eq=False)
class PlaneCell:
    """A prism: the lattice's Voronoi polygon times headings of at most half a turn's angle.

    Attributes:
        group: the plane group.
    """

    group: PlaneGroup

    @cached_property
    def normals(self) -> Array:
        """The lattice vectors (k, 2) whose half planes make the polygon."""
        near = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])
        vectors = near @ self.group.basis.T
        # A vector makes a side when its middle is nearer to nothing else.
        middle = 0.5 * vectors
        others = np.sum((middle[:, None] - vectors[None]) ** 2, axis=-1)
        own = np.sum(middle**2, axis=-1)[:, None]
        return vectors[np.sum(others < own * (1.0 + 1e-9), axis=1) == 1]

    @cached_property
    def polygon(self) -> Array:
        """The polygon's corners (k, 2), anticlockwise."""
        order = np.argsort(np.arctan2(self.normals[:, 1], self.normals[:, 0]))
        sides = self.normals[order]
        following = np.roll(sides, -1, axis=0)
        pairs = np.stack([sides, following], axis=1)
        return np.linalg.solve(pairs, 0.5 * np.sum(pairs**2, axis=2)[..., None])[..., 0]

    @property
    def half_height(self) -> float:
        """The largest heading [rad], pi / n."""
        return math.pi / self.group.order

    @property
    def volume(self) -> float:
        """Its area times its height."""
        return abs(float(np.linalg.det(self.group.basis))) * 2.0 * self.half_height

    def contains(self, motions: ArrayLike) -> NDArray[np.bool_]:
        """Whether the motions (..., 3), headings [rad] wrapped, lie in the closed cell."""
        g = np.asarray(motions, dtype=float)
        along = g[..., :2] @ self.normals.T
        flat = np.all(along <= 0.5 * np.sum(self.normals**2, axis=1) + 1e-12, axis=-1)
        return np.asarray(flat & (np.abs(wrapped(g[..., 2])) <= self.half_height + 1e-12))


def wrapped(headings: ArrayLike) -> Array:
    """Headings in [-pi, pi) [rad]."""
    return np.mod(np.asarray(headings, dtype=float) + math.pi, 2.0 * math.pi) - math.pi


def compose(first: ArrayLike, second: ArrayLike) -> Array:
    """The motions "first after second", (..., 3) by (..., 3)."""
    g, h = np.broadcast_arrays(np.asarray(first, dtype=float), np.asarray(second, dtype=float))
    cosine, sine = np.cos(g[..., 2]), np.sin(g[..., 2])
    x = g[..., 0] + cosine * h[..., 0] - sine * h[..., 1]
    y = g[..., 1] + sine * h[..., 0] + cosine * h[..., 1]
    return np.stack([x, y, wrapped(g[..., 2] + h[..., 2])], axis=-1)


def reduced(basis: Array) -> Array:
    """The shortest basis (2, 2) of a plane lattice, by Lagrange and Gauss."""
    u, v = basis[:, 0].copy(), basis[:, 1].copy()
    while True:
        if u @ u > v @ v * (1.0 + 1e-12):
            u, v = v, u
        steps = np.rint((u @ v) / (u @ u))
        if steps == 0.0:
            return np.column_stack([u, v])
        v = v - steps * u
        if v @ v >= u @ u * (1.0 - 1e-12):
            return np.column_stack([u, v])


def nearest_translation(basis: Array, points: Array) -> Integers:
    """Coordinates (..., 2) of the lattice point nearest to each point (..., 2); basis reduced."""
    lower = np.floor(points @ np.linalg.inv(basis).T).astype(np.int64)
    around = np.array([(i, j) for i in (0, 1) for j in (0, 1)])
    choices = lower[..., None, :] + around
    gaps = np.sum((choices @ basis.T - points[..., None, :]) ** 2, axis=-1)
    best = gaps.argmin(axis=-1)
    return np.take_along_axis(choices, best[..., None, None], axis=-2)[..., 0, :]
