"""A molecule's bodies as densities: what diffraction sees of an arrangement, and its rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.molecule import WORLD, Molecule
from ellipsoid_planning.kernels import molecule as kernels

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Bodies:
    """The parts of one molecule in the world, as sets of points.

    Attributes:
        centres: (P, 3).
        shapes: (P, 3, 3), shape matrices A Aᵀ; they do not tell a body from its mirror image, or
            a spheroid from itself turned about its axis.
    """

    centres: Array
    shapes: Array

    @classmethod
    def of(cls, molecule: Molecule, configuration: Array) -> Bodies:
        """The bodies of a configuration (K,)."""
        centres, matrices = molecule.placed(configuration)
        return cls(centres, matrices @ matrices.transpose(0, 2, 1))

    def moved(self, rotation: Array, shift: Array) -> Bodies:
        """The images under x -> rotation x + shift; ``rotation`` may be any isometry's (3, 3)."""
        return Bodies(self.centres @ rotation.T + shift, rotation @ self.shapes @ rotation.T)

    def permuted(self, order: NDArray[np.int64]) -> Bodies:
        """The bodies in another order."""
        return Bodies(self.centres[order], self.shapes[order])


def body_rates(molecule: Molecule, configuration: Array) -> tuple[Array, Array]:
    """Derivatives of centres (K, P, 3) and shape matrices (K, P, 3, 3) by each coordinate."""
    frames = molecule.frames(configuration)
    lines = np.empty((len(frames), 6))
    kernels.motion_axes(molecule.axes, frames, lines)
    bodies = Bodies.of(molecule, configuration)
    carried = carried_parts(molecule)
    turns = (molecule.kinds == kernels.TURN)[:, None, None]
    axes, points = lines[:, None, :3], lines[:, None, 3:]
    centres = np.where(turns, np.cross(axes, bodies.centres - points), axes)
    spins = np.where(turns, _cross_matrices(lines[:, :3]), 0.0)[:, None]
    shapes = spins @ bodies.shapes - bodies.shapes @ spins
    return centres * carried[:, :, None], shapes * carried[:, :, None, None]


def carried_parts(molecule: Molecule) -> NDArray[np.bool_]:
    """(K, P), which coordinates carry which parts."""
    carried = np.zeros((len(molecule.coordinates), len(molecule.part_frames)), bool)
    for part, frame in enumerate(molecule.part_frames.tolist()):
        at = frame
        while at != WORLD:
            carried[at, part] = True
            at = int(molecule.parents[at])
    return carried


def _cross_matrices(vectors: Array) -> Array:
    """(m, 3, 3), the matrices of v × for vectors (m, 3)."""
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
