"""Arrangements whose crystals are one set of bodies that belong to other molecules.

Which parts make up one molecule is nothing that diffraction sees: where joints are long, an ear
may lie where the ear of a copy lay. So each part is looked for among all copies in the crystal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.placed_bodies import Bodies

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Regrouping:
    """Puts together molecules from the bodies of a crystal.

    Attributes:
        model: its group and cell.
        weights: (P,), of the parts in sums.
        unlike: (P, P), whether two parts differ in size or density.
        unit: the length that distances are measured in.
        directions: (c, 3), unit vectors along which the crystal may be shifted by any amount.
    """

    model: PackingModel
    weights: Array
    unlike: NDArray[np.bool_]
    unit: float
    directions: Array

    def near(self, image: Bodies, target: Bodies) -> list[tuple[float, Bodies]]:
        """Bodies of the image's crystal, in the target's order, and how far they are from it.

        The crystal is shifted so that a part is where the target's largest one is, as far as
        shifts are free.
        """
        largest = int(np.argmax(self.weights))
        copies = self._copies(image)
        if not len(self.directions):
            return [self._gathered(copies, np.zeros(3), target)]
        like = ~self.unlike[largest]
        ways = (target.centres[largest] - copies.centres[:, like]).reshape(-1, 3)
        return [self._gathered(copies, self._free(way), target) for way in ways]

    def _copies(self, image: Bodies) -> Bodies:
        """Centres (m, P, 3) and shapes (m, P, 3, 3) of the copies under the group's operations."""
        operations = self.model.crystal[0]
        turns = operations[:, None, :9].reshape(-1, 1, 3, 3)
        centres = (turns @ image.centres[None, :, :, None])[..., 0] + operations[:, None, 9:]
        return Bodies(centres, turns @ image.shapes[None] @ turns.swapaxes(2, 3))

    def _gathered(self, copies: Bodies, shift: Array, target: Bodies) -> tuple[float, Bodies]:
        """For each part of the target the nearest like it; all are different ones."""
        from scipy.optimize import linear_sum_assignment

        _, basis, inverse, _ = self.model.crystal
        # (m, i, j): part j's copies, each in the cell that brings it nearest to the target's i.
        centres = np.repeat(copies.centres[:, None] + shift, len(self.weights), axis=1)
        steps = np.round((target.centres[None, :, None] - centres) @ inverse.T)
        centres = centres + steps @ basis.T
        away = ((centres - target.centres[None, :, None]) ** 2).sum(axis=3) / self.unit**2
        shapes = copies.shapes[:, None] - target.shapes[None, :, None]
        away += (shapes**2).sum(axis=(3, 4)) / self.unit**4
        nearest = np.argmin(away, axis=0)
        i, j = np.indices(nearest.shape)
        least = np.where(self.unlike, np.inf, away[nearest, i, j]) * self.weights[:, None]
        rows, columns = linear_sum_assignment(least)
        chosen = nearest[rows, columns]
        bodies = Bodies(centres[chosen, rows, columns], copies.shapes[chosen, columns])
        middle = (self.weights[:, None] * (target.centres - bodies.centres)).sum(axis=0)
        bodies = bodies.moved(np.eye(3), self._free(middle))
        whole = ((bodies.centres - target.centres) ** 2).sum(axis=1) / self.unit**2
        whole += ((bodies.shapes - target.shapes) ** 2).sum(axis=(1, 2)) / self.unit**4
        return float(whole @ self.weights), bodies

    def _free(self, way: Array) -> Array:
        if not len(self.directions):
            return np.zeros(3)
        shares = np.linalg.lstsq(self.directions.T, way, rcond=None)[0]
        return np.asarray(shares @ self.directions)
