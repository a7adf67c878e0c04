"""The configuration whose bodies are given ones, nearest to a configuration.

There may be more than one nearby, even a curve of them: a spheroid that turns about its axis, with
all that it carries turned back, is the same set of points. So each step goes towards the solutions
by the shortest way and, where bodies do not change, back towards the start.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.molecule import Molecule
from ellipsoid_planning.crystal.phasing.placed_bodies import Bodies, body_rates

Array = NDArray[np.float64]

STEPS = 60
# Steps are at most so long [rad, or length units], and singular values below this share are zero.
LONGEST = 0.3
SINGULAR = 1e-6
# Steps and misfits below this have come to their end.
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class BodyFit:
    """A fit of a molecule to bodies (in the molecule's own order of parts).

    Attributes:
        configuration: (K,).
        misfit: root mean square of what is left, in units of the largest semi-axis.
    """

    configuration: Array
    misfit: float


def fit_bodies(molecule: Molecule, wanted: Bodies, start: Array, directions: Array) -> BodyFit:
    """Fit the coordinates, and a shift of all that is wanted along ``directions`` (c, 3).

    Args:
        molecule: the molecule.
        wanted: the bodies.
        start: (K,), where the fit begins; of all solutions it finds the nearest as a rule.
        directions: which shifts do not matter.
    """
    task = _Task(molecule, wanted, directions)
    at = np.concatenate([start, task.first_shift(start)])
    free = np.zeros(len(at))
    for _ in range(STEPS):
        free[: len(start)] = start - at[: len(start)]
        step = _step(task.jacobian(at), task.residuals(at), free)
        at = at + step * min(1.0, LONGEST / max(_size(step), LONGEST))
        if _size(step) < TOLERANCE:
            break
    misfit = _size(task.residuals(at)) / np.sqrt(len(wanted.centres))
    return BodyFit(at[: len(start)], float(misfit))


def _step(jacobian: Array, residuals: Array, free: Array) -> Array:
    """The step that takes the residuals to zero, and follows ``free`` where they do not change."""
    left, sizes, right = np.linalg.svd(jacobian, full_matrices=False)
    rank = int((sizes > SINGULAR * sizes[0]).sum())
    right = right[:rank]
    newton = right.T @ ((left[:, :rank].T @ residuals) / sizes[:rank])
    return free - right.T @ (right @ free) - newton


def _size(vector: Array) -> float:
    return float(np.linalg.norm(vector))


class _Task:
    """Residuals in units of the largest semi-axis, and their derivatives."""

    def __init__(self, molecule: Molecule, wanted: Bodies, directions: Array) -> None:
        self._molecule, self._wanted, self._directions = molecule, wanted, directions
        self._count = len(molecule.coordinates)
        self._unit = body_unit(molecule)

    def first_shift(self, start: Array) -> Array:
        """The shift that brings the centres together."""
        if not len(self._directions):
            return np.zeros(0)
        away = Bodies.of(self._molecule, start).centres - self._wanted.centres
        return np.linalg.lstsq(self._directions.T, away.mean(axis=0), rcond=None)[0]

    def residuals(self, unknowns: Array) -> Array:
        bodies = Bodies.of(self._molecule, unknowns[: self._count])
        shift = unknowns[self._count :] @ self._directions
        centres = (bodies.centres - self._wanted.centres - shift) / self._unit
        shapes = (bodies.shapes - self._wanted.shapes) / self._unit**2
        # Unknowns may be more than centres say; nine entries a part are always enough.
        return np.concatenate([centres.ravel(), shapes.ravel()])

    def jacobian(self, unknowns: Array) -> Array:
        centres, shapes = body_rates(self._molecule, unknowns[: self._count])
        parts = len(self._wanted.centres)
        rows = np.hstack(
            [
                centres.reshape(self._count, 3 * parts) / self._unit,
                shapes.reshape(self._count, 9 * parts) / self._unit**2,
            ]
        )
        shifts = np.zeros((len(self._directions), rows.shape[1]))
        shifts[:, : 3 * parts] = np.tile(-self._directions / self._unit, parts)
        return np.vstack([rows, shifts]).T


def body_unit(molecule: Molecule) -> float:
    """The largest semi-axis: the length that misfits are measured in."""
    return max(float(part.semi_axes.max()) for part in molecule.robot.parts)
