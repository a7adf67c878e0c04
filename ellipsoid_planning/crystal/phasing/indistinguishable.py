"""Isometries that leave every magnitude of diffraction, and the space group, as they are.

A density and its image under an isometry x -> ± x + t have the same magnitudes |F(h)|: a shift
changes phases only, and |F(-h)| = |F(h)|. The image has the group's symmetry, so that a model in
this group can have it, when the isometry lies in the group's Euclidean normaliser. Isometries with
other linear parts are products of these with the group's own operations, or exchange reflections
with others of another magnitude.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from ellipsoid_planning.crystal.symmetry.exact_matrix import Vector, apply, unit_matrix
from ellipsoid_planning.crystal.symmetry.integer_linear import smith_form, solve_modulo_one
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.primitive import PrimitiveGroup, primitive
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup


@dataclass(frozen=True)
class Indistinguishable:
    """The isometries of a group, modulo the group and its lattice.

    Attributes:
        isometries: a finite number of them, the identity first; linear parts are ± 1.
        directions: of the shifts by any amount that may follow, in fractional coordinates; all
            directions in P1, those along the only axis in P2, none in P2₁2₁2₁.
    """

    isometries: tuple[Operation, ...]
    directions: tuple[Vector, ...]


def indistinguishable(group: SpaceGroup) -> Indistinguishable:
    """The isometries that keep a group and the magnitudes of all densities with its symmetry.

    Inversion is among them where the group is its own mirror image in this cell: not in P4₁.
    """
    inner = primitive(group.operations)
    shifts, directions = _shifts(inner)
    unit = unit_matrix(inner.dimension)
    inverted = tuple(tuple(-entry for entry in row) for row in unit)
    found = [Operation(unit, apply(inner.basis, shift)) for shift in shifts]
    centre = None if inverted in inner.by_rotation else _centre(inner)
    if centre is not None:
        for shift in shifts:
            moved = [a + b for a, b in zip(shift, centre, strict=True)]
            found.append(Operation(inverted, apply(inner.basis, moved)))
    free = tuple(apply(inner.basis, direction) for direction in directions)
    return Indistinguishable(tuple(one.modulo() for one in found), free)


def _equations(group: PrimitiveGroup) -> list[list[int]]:
    """Rows of W - 1 for all operations: a shift t keeps the group when (W - 1) t is integer."""
    return [
        [int(entry) - (row == column) for column, entry in enumerate(entries)]
        for operation in group.operations
        for row, entries in enumerate(operation.rotation)
    ]


def _shifts(group: PrimitiveGroup) -> tuple[list[Vector], list[Vector]]:
    """Shifts that keep the group, modulo its lattice and the free directions; and these."""
    form = smith_form(_equations(group))
    right = tuple(tuple(Fraction(entry) for entry in row) for row in form.right)
    columns = list(zip(*right, strict=True))
    sizes = form.diagonal[: form.rank]
    rest = [Fraction(0)] * (group.dimension - form.rank)
    steps = product(*(range(size) for size in sizes))
    parts = ([Fraction(k, size) for k, size in zip(step, sizes, strict=True)] for step in steps)
    return [apply(right, [*part, *rest]) for part in parts], columns[form.rank :]


def _centre(group: PrimitiveGroup) -> list[Fraction] | None:
    """A t for which x -> t - x keeps the group: (W - 1) t = -2 w modulo 1 for all (W, w)."""
    values = [-2 * entry for operation in group.operations for entry in operation.translation]
    return solve_modulo_one(_equations(group), values)
