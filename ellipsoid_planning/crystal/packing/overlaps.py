"""Where copies of a molecule overlap, or parts of one that should keep apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.copies import Copy
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]
STEPS = 50  # of bisection


class Overlap(NamedTuple):
    """The common region of two bodies.

    Attributes:
        first, second: the bodies.
        inside: (n,), the point that is deepest in both, on the scale where a body's centre is at
            0 and its boundary at 1.
    """

    first: Ellipsoid
    second: Ellipsoid
    inside: Array

    def surface(self, longitudes: int = 48, latitudes: int = 12) -> Array:
        """Points (2·latitudes + 1, longitudes + 1, 3) of the boundary in space, row by row.

        The rows run from where the first body ends to where the second one does, and the middle
        row on the edge between them.
        """
        normal, others = self._frame()
        azimuth = np.linspace(0.0, 2.0 * np.pi, longitudes + 1)
        around = np.column_stack([np.cos(azimuth), np.sin(azimuth)]) @ others
        low, high = np.zeros(len(around)), np.full(len(around), np.pi)
        for _ in range(STEPS):
            polar = 0.5 * (low + high)
            directions = np.cos(polar)[:, None] * normal + np.sin(polar)[:, None] * around
            before = np.less(*self._reaches(directions))
            low, high = np.where(before, polar, low), np.where(before, high, polar)
        share = np.sin(np.linspace(0.0, 0.5 * np.pi, latitudes + 1))[:, None]  # finest at the edge
        rows = np.concatenate([share * low, np.pi - (np.pi - low) * share[-2::-1]])[..., None]
        directions = np.cos(rows) * normal + np.sin(rows) * around
        return self.boundary(directions.reshape(-1, 3)).reshape(directions.shape)

    def boundary(self, directions: Array) -> Array:
        """The boundary points (m, n) seen from ``inside`` along directions (m, n)."""
        reach = np.minimum(*self._reaches(directions))
        return np.asarray(self.inside + reach[:, None] * directions)

    def _reaches(self, directions: Array) -> tuple[Array, Array]:
        """How far both bodies extend along directions (m, n)."""
        first, second = (_reach(b, self.inside, directions) for b in (self.first, self.second))
        return first, second

    def _frame(self) -> tuple[Array, Array]:
        """The first body's outward normal (3,), and two directions (2, 3) across it."""
        inverse = np.linalg.inv(self.first.matrix)
        normal = inverse.T @ (inverse @ (self.inside - self.first.centre))
        if not np.any(normal):
            normal = self.second.centre - self.first.centre
        if not np.any(normal):
            normal = np.array([0.0, 0.0, 1.0])
        frame = np.linalg.svd(normal[None])[2]
        if np.linalg.det(frame) < 0.0:
            frame[2] = -frame[2]
        return np.asarray(normal / np.linalg.norm(normal)), frame[1:]


def overlaps(
    model: PackingModel, chosen: Sequence[Copy], others: Sequence[Copy] = ()
) -> list[Overlap]:
    """All overlaps of the chosen copies with each other and with other ones.

    Parts of one molecule that are joined, or are allowed to overlap, do not count, and neither do
    overlaps that are no deeper than the model allows.
    """
    from ellipsoid_planning.crystal.packing.collisions import watched_pairs

    bodies = [body for copy in (*chosen, *others) for body in copy.bodies]
    pairs = _near_pairs(bodies, len(chosen) * len(model.parts))
    owner, part = np.divmod(pairs, len(model.parts))
    watched = {frozenset(pair) for pair in watched_pairs(model)}
    own = [frozenset(row) in watched for row in part.tolist()]
    found = _meeting(bodies, pairs[(owner[:, 0] != owner[:, 1]) | np.array(own, dtype=bool)])
    if model.overlap == 0.0:
        return found
    from ellipsoid_planning.geometry.dual import gap

    return [one for one in found if gap(one.first, one.second).value <= model.required]


def _near_pairs(bodies: Sequence[Ellipsoid], first: int) -> NDArray[np.int64]:
    """Pairs (k, 2) with one or two of the ``first`` bodies, whose circumscribed balls meet."""
    centres = np.array([body.centre for body in bodies])
    radii = np.array([body.semi_axes.max() for body in bodies])
    found = [np.zeros((0, 2), dtype=np.int64)]
    for i in range(first):
        distance = np.linalg.norm(centres[i + 1 :] - centres[i], axis=1)
        near = i + 1 + np.flatnonzero(distance < radii[i + 1 :] + radii[i])
        found.append(np.column_stack([np.full(len(near), i), near]))
    return np.concatenate(found)


def _meeting(bodies: Sequence[Ellipsoid], pairs: NDArray[np.int64]) -> list[Overlap]:
    """Those pairs (k, 2) that overlap.

    The minimiser of λF + (1-λ)G of two bodies' quadratic forms runs from one centre to the other
    as λ goes from 0 to 1; where F = G it is deepest in both (Perram and Wertheim 1985).
    """
    if not len(pairs):
        return []
    centres = np.array([body.centre for body in bodies])[pairs]
    inverse = np.array([np.linalg.inv(body.matrix) for body in bodies])[pairs]
    forms = np.swapaxes(inverse, -1, -2) @ inverse
    low, high = np.zeros(len(pairs)), np.ones(len(pairs))
    for _ in range(STEPS):
        share = 0.5 * (low + high)
        points, values = _minimisers(forms, centres, share)
        before = values[:, 0] > values[:, 1]
        low, high = np.where(before, share, low), np.where(before, high, share)
    return [
        Overlap(bodies[i], bodies[j], point)
        for (i, j), point, value in zip(pairs.tolist(), points, values.max(axis=1), strict=True)
        if value < 1.0
    ]


def _minimisers(forms: Array, centres: Array, share: Array) -> tuple[Array, Array]:
    """Points (k, n) and the two forms' values (k, 2) there."""
    weights = np.stack([share, 1.0 - share], axis=1)[:, :, None]
    pulled = weights * np.einsum("kaij,kaj->kai", forms, centres)
    total = (weights[..., None] * forms).sum(axis=1)
    points = np.linalg.solve(total, pulled.sum(axis=1)[:, :, None])[:, :, 0]
    away = points[:, None] - centres
    return points, np.einsum("kai,kaij,kaj->ka", away, forms, away)


def _reach(body: Ellipsoid, origin: Array, directions: Array) -> Array:
    """How far (m,) a body extends along directions (m, n) from a point inside it."""
    inverse = np.linalg.inv(body.matrix)
    start, way = inverse @ (origin - body.centre), directions @ inverse.T
    square, half = (way**2).sum(axis=1), way @ start
    return np.asarray((-half + np.sqrt(half**2 + square * (1.0 - start @ start))) / square)
