"""Arrangements of a model that diffraction cannot tell from a given one.

They are the images under the isometries of :mod:`.indistinguishable` and the group's own
operations, as far as the molecule can make them: bodies count, not names, so that parts of one kind
may take each other's place, and spheroids turn about their axes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.body_fit import body_unit, fit_bodies
from ellipsoid_planning.crystal.phasing.indistinguishable import indistinguishable
from ellipsoid_planning.crystal.phasing.placed_bodies import Bodies
from ellipsoid_planning.crystal.phasing.regrouped import Regrouping
from ellipsoid_planning.crystal.symmetry.operation import Operation

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Bodies that agree to this share of the largest semi-axis are the same.
SAME = 1e-7
# So many of the images that are nearest to the target are fitted, and none that is farther than
# the nearest one that fits by this factor (of squared distances).
ATTEMPTS = 8
FARTHER = 4.0
# Molecules of parts of several images are fitted if they are this much nearer than whole ones.
NEARER = 1.0 - 1e-6
UNLIKE = 1e12


@dataclass(frozen=True, eq=False)
class Equivalent:
    """An arrangement with the magnitudes of another.

    Attributes:
        configuration: (K,).
        isometry: the isometry that it is the image under, group's operations left out.
    """

    configuration: Array
    isometry: Operation


@dataclass(frozen=True, eq=False)
class Equivalents:
    """What diffraction cannot tell apart in a model's arrangements."""

    model: PackingModel

    @cached_property
    def isometries(self) -> tuple[Operation, ...]:
        """Of the crystal's densities, modulo its group and free shifts; the identity first."""
        return indistinguishable(self.model.group).isometries

    @cached_property
    def directions(self) -> Array:
        """(c, 3), Cartesian unit vectors: along these the crystal may be shifted by any amount."""
        directions = indistinguishable(self.model.group).directions
        found = np.zeros((len(directions), 3))
        for row, direction in zip(found, directions, strict=True):
            way = self.model.cell.cartesian(np.array(direction, dtype=float))
            row[: self.model.dimension] = way / np.linalg.norm(way)
        return found

    def near(self, found: ArrayLike, target: ArrayLike) -> tuple[Equivalent, ...]:
        """Equivalents of the arrangement ``found`` near ``target`` (both (K,)).

        Images of its molecules come first, the nearest first; then molecules put together of
        parts of several images; the last is ``found`` itself.
        """
        start = np.asarray(target, dtype=float)
        wanted = Bodies.of(self.model.molecule, np.asarray(found, dtype=float))
        near = Bodies.of(self.model.molecule, start)
        chosen: list[Equivalent] = []
        farthest = nearest = np.inf

        def fit(away: float, isometry: Operation, bodies: Bodies) -> None:
            nonlocal farthest, nearest
            end = fit_bodies(self.model.molecule, bodies, start, self.directions)
            if end.misfit < SAME:
                chosen.append(Equivalent(end.configuration, isometry))
                farthest = min(farthest, FARTHER * away + SAME)
                nearest = min(nearest, NEARER * away)

        for one in self._images(wanted, near)[:ATTEMPTS]:
            if one[0] <= farthest:
                fit(*one)
        for one in self._regrouped(wanted, near)[:ATTEMPTS]:
            if one[0] < nearest:
                fit(*one)
        return (*chosen, Equivalent(np.asarray(found, dtype=float), self.isometries[0]))

    def _regrouped(self, bodies: Bodies, target: Bodies) -> list[tuple[float, Operation, Bodies]]:
        """Molecules of parts of several images, the nearest to the target first."""
        unit = body_unit(self.model.molecule)
        whole = Regrouping(self.model, self._weights, self._unlike, unit, self.directions)
        found = [
            (away, isometry, one)
            for isometry in self.isometries
            for away, one in whole.near(bodies.moved(*self._cartesian(isometry)), target)
        ]
        return sorted(found, key=lambda one: one[0])

    def _images(self, bodies: Bodies, target: Bodies) -> list[tuple[float, Operation, Bodies]]:
        """All images of bodies, each where it is nearest to the target, the nearest first."""
        found = []
        for isometry in self.isometries:
            turned = bodies.moved(*self._cartesian(isometry))
            for rotation, shift in self._operations():
                image = turned.moved(rotation, shift)
                image = image.moved(np.eye(3), self._way(image, target))
                order, away = self._order(image, target)
                found.append((away, isometry, image.permuted(order)))
        return sorted(found, key=lambda one: one[0])

    def _operations(self) -> Iterator[tuple[Array, Array]]:
        for row in self.model.crystal[0]:
            yield row[:9].reshape(3, 3), row[9:]

    def _cartesian(self, isometry: Operation) -> tuple[Array, Array]:
        n = self.model.dimension
        rotation, shift = np.eye(3), np.zeros(3)
        rotation[:n, :n] *= float(isometry.rotation[0][0])  # linear parts are ± 1
        shift[:n] = self.model.cell.cartesian(np.array(isometry.translation, dtype=float))
        return rotation, shift

    def _way(self, image: Bodies, target: Bodies) -> Array:
        """The lattice vector plus free shift that brings an image's middle to the target's."""
        way = (self._weights[:, None] * (target.centres - image.centres)).sum(axis=0)
        _, basis, inverse, _ = self.model.crystal
        lattice = basis @ np.round(inverse @ (way - self._free(way)))
        # Where free shifts lie askew to the lattice, as in R3, the vector has some of them, too.
        return lattice + self._free(way - lattice)

    def _free(self, way: Array) -> Array:
        """The share of a vector that lies along the free shifts."""
        if not len(self.directions):
            return np.zeros(3)
        shares = np.linalg.lstsq(self.directions.T, way, rcond=None)[0]
        return shares @ self.directions

    @cached_property
    def _weights(self) -> Array:
        parts = self.model.parts
        volumes = np.array([float(np.prod(part.semi_axes)) for part in parts])
        return volumes / volumes.sum()

    @cached_property
    def _unlike(self) -> NDArray[np.bool_]:
        """(P, P), whether two parts differ in size or density."""
        kinds = [
            np.append(np.sort(part.semi_axes), density)
            for part, density in zip(
                self.model.parts, self.model.molecule.densities.tolist(), strict=True
            )
        ]
        return np.array(
            [[not np.allclose(a, b, rtol=1e-12, atol=0.0) for b in kinds] for a in kinds]
        )

    def _order(self, image: Bodies, target: Bodies) -> tuple[Integers, float]:
        """Which part of an image goes with each of the target's, and how far all are away."""
        from scipy.optimize import linear_sum_assignment

        unit = body_unit(self.model.molecule)
        centres = image.centres[None] - target.centres[:, None]
        shapes = image.shapes[None] - target.shapes[:, None]
        away = (centres**2).sum(axis=2) / unit**2 + (shapes**2).sum(axis=(2, 3)) / unit**4
        away *= self._weights[:, None]
        rows, columns = linear_sum_assignment(np.where(self._unlike, UNLIKE, away))
        return columns.astype(np.int64), float(away[rows, columns].sum())
