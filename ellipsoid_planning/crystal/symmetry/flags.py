"""Which kind of space group one is, computed from its operations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ellipsoid_planning.crystal.symmetry.exact_matrix import Number, apply, power_sum, unit_matrix
from ellipsoid_planning.crystal.symmetry.integer_linear import (
    has_integer_solution,
    solve_modulo_one,
)
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.primitive import primitive

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup

# The eleven pairs of types that are each other's mirror images.
ENANTIOMORPHIC_PAIRS = (
    (76, 78),
    (91, 95),
    (92, 96),
    (144, 145),
    (151, 153),
    (152, 154),
    (169, 170),
    (171, 172),
    (178, 179),
    (180, 181),
    (212, 213),
)


def is_symmorphic(group: SpaceGroup) -> bool:
    """Whether some point s is fixed by an operation of every linear part W.

    That is w = (1 - W) s modulo the lattice for generators of the group.
    """
    reduced = primitive(group.operations)
    matrix: list[list[int]] = []
    values: list[Number] = []
    for operation in reduced.generators:
        matrix += fixing_rows(operation)
        values += operation.translation
    return not matrix or solve_modulo_one(matrix, values) is not None


def fixing_rows(operation: Operation) -> list[list[int]]:
    """The rows of 1 - W for an operation with a matrix W of integers."""
    unit = unit_matrix(operation.dimension)
    return [
        [int(a - b) for a, b in zip(one, row, strict=True)]
        for one, row in zip(unit, operation.rotation, strict=True)
    ]


def is_bieberbach(group: SpaceGroup) -> bool:
    """Whether no operation but the identity has a finite order."""
    reduced = primitive(group.operations)
    return not any(has_torsion(operation) for operation in reduced.operations[1:])


def has_torsion(operation: Operation) -> bool:
    """Whether some of the operations t o g, with t in Z^n, has a finite order.

    With N the sum of the powers of W, that is N (w + k) = 0 for a k of integers.
    """
    total = power_sum(operation.rotation)
    moved = apply(total, operation.translation)
    rows = [[int(entry) for entry in row] for row in total]
    return has_integer_solution(rows, [-entry for entry in moved])


def is_enantiomorphic(group: SpaceGroup) -> bool:
    """Whether the mirror image is of another type than the group."""
    if group.dimension == 2 or not group.sohncke:
        return False
    number = group.number
    if number is None:
        from ellipsoid_planning.crystal.symmetry.names import type_number

        number = type_number(group.operations)
    return any(number in pair for pair in ENANTIOMORPHIC_PAIRS)
