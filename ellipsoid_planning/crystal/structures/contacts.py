"""How closely ellipsoids pack: which copies meet, how deep, and at which scale they touch."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.copies import image
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.geometry.dual import gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

ROUNDS = 60  # of the golden section: by 0.618 each, to rounding
GOLDEN = 0.5 * (5.0**0.5 - 1.0)


@dataclass(frozen=True)
class Contact:
    """A body and a copy of a body in the crystal.

    Attributes:
        first: the name of the body.
        second: the name of the copied body.
        operation: of the group, which makes the copy, by its number.
        shift: the lattice translation after it.
        factor: both touch when their semi-axes are multiplied by it; below 1 if they meet.
        gap: their distance; if they meet, it is negative: how deep they reach into each other.
    """

    first: str
    second: str
    operation: int
    shift: tuple[int, ...]
    factor: float
    gap: float


def closest_contacts(
    bodies: Sequence[Ellipsoid], cell: UnitCell, group: SpaceGroup, largest: float = 1.0
) -> list[Contact]:
    """All contacts of a molecule with its copies whose factor is at most ``largest``.

    Args:
        bodies: the molecule's, in the crystal's Cartesian frame; contacts among them do not count.
        cell: its cell.
        group: its group; the molecule is the asymmetric unit.
        largest: only pairs that touch at this factor or below are looked for.

    Returns:
        Sorted by factor. Each pair occurs once; a pair and its image by a symmetry that
        exchanges the copies count as one.
    """
    rotations, translations = group.cartesian(cell)
    found: dict[tuple[object, ...], Contact] = {}
    for index, (rotation, translation) in enumerate(zip(rotations, translations, strict=True)):
        copies = [image(body, rotation, translation) for body in bodies]
        for (i, first), (j, second) in itertools.product(enumerate(bodies), enumerate(copies)):
            reach = largest * float(first.semi_axes.max() + second.semi_axes.max())
            away = second.centre - first.centre
            for shift in cell.lattice_within(away, reach):
                if index == 0 and not any(shift):
                    continue
                moved = second.transform(np.eye(len(away)), cell.cartesian(shift))
                factor = contact_factor(first, moved)
                key = (min(i, j), max(i, j), round(factor, 9))
                if factor <= largest and key not in found:
                    names = first.name, second.name
                    away_by = gap(first, moved).value
                    found[key] = Contact(*names, index, shift, factor, away_by)
    return sorted(found.values(), key=lambda contact: contact.factor)


def contact_factor(first: Ellipsoid, second: Ellipsoid) -> float:
    """By which factor both bodies' semi-axes must be multiplied for them to touch.

    Perram and Wertheim, J. Comput. Phys. 58 (1985) 409: the square root of the maximum over λ of
    the concave function λ(1-λ) rᵀ[(1-λ)A + λB]⁻¹ r, with shape matrices A, B and the centres'
    distance r. Found by golden section, so that the result is at most the true factor.
    """
    away = second.centre - first.centre
    values, axes = np.linalg.eigh(_whitened(first, second))
    part = axes.T @ (first.rotation.T @ away / first.semi_axes)

    def height(blend: float) -> float:
        return blend * (1.0 - blend) * float(np.sum(part**2 / (1.0 - blend + blend * values)))

    low, high = 0.0, 1.0
    for _ in range(ROUNDS):
        left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        if height(left) < height(right):
            low = left
        else:
            high = right
    return float(np.sqrt(height(0.5 * (low + high))))


def _whitened(first: Ellipsoid, second: Ellipsoid) -> Array:
    """The second body's shape matrix where the first body is the unit ball."""
    inward = first.rotation.T / first.semi_axes[:, None]
    return np.asarray(inward @ second.shape_matrix @ inward.T)
