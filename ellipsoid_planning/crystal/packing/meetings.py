"""Which parts of which copies meet in an arrangement, for people to see what is wrong."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.collisions import watched_pairs
from ellipsoid_planning.crystal.packing.copies import image
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.geometry.dual import gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid


class Meeting(NamedTuple):
    """Two bodies that reach deeper into each other than the model allows.

    Attributes:
        first: a part of the molecule.
        second: a part of it, or of one of its copies.
        operation: the index of the copy's operation, 0 for the identity.
        lattice: (n,), the lattice vector in cells that is added.
        depth: how deep they meet [length], an upper bound.
    """

    first: str
    second: str
    operation: int
    lattice: tuple[int, ...]
    depth: float


def meetings(model: PackingModel, configuration: ArrayLike) -> list[Meeting]:
    """Every meeting once, deepest first; none of a free arrangement.

    Args:
        model: the packing model.
        configuration: (K,), angles [rad].

    Raises:
        CrystalError: if the configuration has another size, or a value is not finite.
    """
    bodies = model.molecule.bodies(configuration)
    found = [
        Meeting(bodies[i].name, bodies[j].name, operation, lattice, -value)
        for i, j, operation, lattice, copy in _near(model, bodies)
        if (value := gap(bodies[i], copy).value) <= model.required
    ]
    return sorted(found, key=lambda meeting: (-meeting.depth, *meeting[:4]))


Near = tuple[int, int, int, tuple[int, ...], Ellipsoid]


def _near(model: PackingModel, bodies: tuple[Ellipsoid, ...]) -> Iterator[Near]:
    """Parts i, and copies of parts j >= i, whose circumscribed balls meet."""
    watched = {frozenset(pair) for pair in watched_pairs(model)}
    for i, j in itertools.combinations_with_replacement(range(len(bodies)), 2):
        for operation, lattice, turn, shift in _close_motions(model, bodies[i], bodies[j]):
            if operation == 0 and not any(lattice) and frozenset((i, j)) not in watched:
                continue
            # A part meets its image under a motion where it meets that of the inverse.
            if i == j and _inverse(model, operation, lattice) < (operation, lattice):
                continue
            yield i, j, operation, lattice, image(bodies[j], turn, shift)


Motion = tuple[int, tuple[int, ...], NDArray[np.float64], NDArray[np.float64]]


def _close_motions(model: PackingModel, first: Ellipsoid, second: Ellipsoid) -> Iterator[Motion]:
    """Operation, lattice vector, rotation and translation that bring the second body close."""
    reach = float(first.semi_axes.max() + second.semi_axes.max())
    for index, (turn, shift) in enumerate(zip(*model.group.cartesian(model.cell), strict=True)):
        away = turn @ second.centre + shift - first.centre
        for lattice in model.cell.lattice_within(away, reach):
            yield index, lattice, turn, shift + model.cell.cartesian(lattice)


def _inverse(
    model: PackingModel, operation: int, lattice: tuple[int, ...]
) -> tuple[int, tuple[int, ...]]:
    """The operation and the lattice vector of a motion's inverse."""
    inverse = int(model.group.inverses[operation])
    turned = model.group.rotations[inverse] @ (model.group.translations[operation] + lattice)
    vector = np.rint(-turned - model.group.translations[inverse]).astype(int)
    return inverse, tuple(vector.tolist())
