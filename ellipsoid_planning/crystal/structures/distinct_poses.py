"""Which poses of a molecule make different crystals: what a search has to go through.

Crystals are the same when the molecule is replaced by one of its own copies, and to diffraction
when the origin moves to another point of the same kind. Both are used here as far as they leave
a box of shifts along the cell's axes and of ZXZ Euler angles.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell

Array = NDArray[np.float64]

# Origins of one kind along an axis are this part of the cell apart.
PARTS = (Fraction(1, 6), Fraction(1, 4), Fraction(1, 3), Fraction(1, 2))
ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class DistinctPoses:
    """A box of poses in which every crystal of a molecule, in three dimensions, occurs.

    Attributes:
        group: the space group.
        cell: its cell.
        shifts: how far the molecule is to be moved along each axis of the cell, shape (3,);
            0 along axes on which the origin can be anywhere.
        alpha: the first Euler angle is in [0, alpha) [rad].
        beta: the second one in [0, beta] [rad]; the third one in [0, 2π).
    """

    group: SpaceGroup
    cell: UnitCell
    shifts: Array
    alpha: float
    beta: float

    def brought_inside(self, rotation: Array, position: Array) -> tuple[Array, Array]:
        """The shifts (3,) and Euler angles (3,) [rad] in the box of the same crystal.

        Args:
            rotation: of the molecule, (3, 3).
            position: of the molecule, (3,).
        """
        rotations, translations = self.group.cartesian(self.cell)
        for turn, move in zip(rotations, translations, strict=True):
            if np.linalg.det(turn) < 0.0:
                continue
            angles = euler_zxz(turn @ rotation)
            if angles[0] < self.alpha - ROUNDING and angles[1] <= self.beta + ROUNDING:
                return self._shifted(turn @ position + move), angles
        # Rounding put an angle on the wrong side of the box.
        angles = euler_zxz(rotation)
        return self._shifted(position), angles

    def _shifted(self, position: Array) -> Array:
        along = self.cell.fractional(position) * self.cell.lengths
        inside = np.zeros(3)
        used = self.shifts > 0.0
        inside[used] = along[used] % self.shifts[used]
        return inside


def distinct_poses(group: SpaceGroup, cell: UnitCell) -> DistinctPoses:
    """The box for a group in its cell."""
    shifts = np.array([float(_origin_step(group, axis)) for axis in range(3)]) * cell.lengths
    rotations, _ = group.cartesian(cell)
    proper = [turn for turn in rotations if np.linalg.det(turn) > 0.0]
    upright = {tuple(np.round(turn.ravel(), 6)) for turn in proper if turn[2, 2] > 1.0 - ROUNDING}
    turned_over = any(turn[2, 2] < ROUNDING - 1.0 for turn in proper)
    beta = 0.5 * math.pi if turned_over else math.pi
    return DistinctPoses(group, cell, shifts, 2.0 * math.pi / len(upright), beta)


def _origin_step(group: SpaceGroup, axis: int) -> Fraction:
    """The smallest shift of the origin along an axis that the group does not notice; 0 for any."""
    along = [rotation[:, axis].tolist() for rotation in group.integer_rotations]
    unit = [int(k == axis) for k in range(3)]
    changes = [[entry - one for entry, one in zip(column, unit, strict=True)] for column in along]
    if not any(itertools.chain(*changes)):
        return Fraction(0)
    centring = {
        tuple(operation.translation)
        for operation, rotation in zip(group.operations, group.integer_rotations, strict=True)
        if np.array_equal(rotation, np.eye(3))
    }
    for part in PARTS:
        if all(tuple(part * k % 1 for k in change) in centring for change in changes):
            return part
    return Fraction(1)


def euler_zxz(rotation: Array) -> Array:
    """The angles (3,) of R = Rz(α) Rx(β) Rz(γ), α and γ in [0, 2π), β in [0, π] [rad]."""
    sine = math.hypot(rotation[0, 2], rotation[1, 2])
    beta = math.atan2(sine, rotation[2, 2])
    if sine < ROUNDING:  # only the sum or the difference of the others counts
        turn = math.atan2(rotation[1, 0], rotation[0, 0])
        return np.array([turn % (2.0 * math.pi), beta, 0.0])
    alpha = math.atan2(rotation[0, 2], -rotation[1, 2])
    gamma = math.atan2(rotation[2, 0], rotation[2, 1])
    return np.array([alpha % (2.0 * math.pi), beta, gamma % (2.0 * math.pi)])
