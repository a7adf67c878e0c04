"""The copies of a molecule that a crystal has in a range of cells."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

# Middles this close below a border (in cells) count as on it: each cell has m copies for certain.
BORDER = 1e-9


class Copy(NamedTuple):
    """One copy of the molecule: x ↦ Q_g x + t_g + B v, see `SpaceGroup.cartesian`.

    Attributes:
        operation: the index g of the group's operation.
        lattice: v, (n,), the lattice vector in cells.
        bodies: the molecule's parts in the world, in their order.
    """

    operation: int
    lattice: tuple[int, ...]
    bodies: tuple[Ellipsoid, ...]

    @property
    def is_original(self) -> bool:
        """Whether this is the molecule where its coordinates put it."""
        return self.operation == 0 and not any(self.lattice)


def copies(
    model: PackingModel, configuration: ArrayLike, low: ArrayLike, high: ArrayLike
) -> list[Copy]:
    """All copies whose middle lies in a range of cells, by operation, then by lattice vector.

    There are as many for each cell of the range as the group has operations.

    Args:
        model: the molecule and its crystal.
        configuration: (K,), angles [rad].
        low: (n,), where the range begins, in fractional coordinates.
        high: (n,), where it ends; these ends do not belong to it.

    Raises:
        CrystalError: if the configuration has another size, or a value is not finite.
    """
    bodies = model.molecule.bodies(configuration)
    middle = middle_of(model, configuration)
    start, end = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    found = []
    for index, (turn, shift) in enumerate(zip(*model.group.cartesian(model.cell), strict=True)):
        place = model.cell.fractional(turn @ middle + shift)
        first, last = (np.ceil(side - place - BORDER).astype(int) for side in (start, end))
        for lattice in itertools.product(*map(range, first.tolist(), last.tolist())):
            moved = shift + model.cell.cartesian(lattice)
            found.append(Copy(index, lattice, tuple(image(b, turn, moved) for b in bodies)))
    return found


def middle_of(model: PackingModel, configuration: ArrayLike) -> Array:
    """The molecule's centre of mass (n,) in the world; overlaps of parts count twice."""
    bodies = model.molecule.bodies(configuration)
    sizes = [math.prod(body.semi_axes.tolist()) for body in bodies]
    centres = np.array([body.centre for body in bodies])
    return np.asarray(np.average(centres, axis=0, weights=model.molecule.densities * sizes))


def image(body: Ellipsoid, turn: Array, shift: Array) -> Ellipsoid:
    """The image of a body under x ↦ turn x + shift, where ``turn`` may be a reflection, too.

    An ellipsoid is its own mirror image across its principal planes, so that a rotation does.
    """
    left, _, right = np.linalg.svd(turn @ body.rotation)  # cells are exact to rounding only
    rotation = left @ right
    if np.linalg.det(rotation) < 0.0:
        rotation[:, -1] = -rotation[:, -1]
    return Ellipsoid(turn @ body.centre + shift, rotation, body.semi_axes, body.name)
