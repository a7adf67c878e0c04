"""A space group in a primitive basis: one operation of each coset of all its translations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import lcm

from ellipsoid_planning.crystal.symmetry.exact_matrix import (
    Matrix,
    Vector,
    apply,
    determinant,
    exact_matrix,
    inverse,
    matrix_order,
    multiply,
    unit_matrix,
)
from ellipsoid_planning.crystal.symmetry.integer_linear import lattice_basis
from ellipsoid_planning.crystal.symmetry.operation import Operation


@dataclass(frozen=True, eq=False)
class PrimitiveGroup:
    """A space group whose translations are exactly the integer vectors of its basis.

    Attributes:
        basis: n rows of n fractions, the columns are the primitive vectors, right-handed, in units
            of the cell that the group was given in.
        operations: one for each linear part, the identity first, in the primitive basis; matrices
            of integers, translations in [0, 1).
    """

    basis: Matrix
    operations: tuple[Operation, ...]

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.basis)

    @cached_property
    def by_rotation(self) -> dict[Matrix, Operation]:
        """The operation of each linear part."""
        return {operation.rotation: operation for operation in self.operations}

    @cached_property
    def generators(self) -> tuple[Operation, ...]:
        """A few operations, the highest orders first, whose linear parts generate all others."""
        ranked = sorted(self.operations, key=lambda op: -matrix_order(op.rotation))
        reached = {unit_matrix(self.dimension)}
        chosen: list[Operation] = []
        for operation in ranked:
            if operation.rotation not in reached:
                chosen.append(operation)
                reached = _generated([op.rotation for op in chosen])
        return tuple(chosen)


def primitive(operations: Sequence[Operation]) -> PrimitiveGroup:
    """The group of these operations and the integer translations, in a primitive basis."""
    dimension = operations[0].dimension
    unit = unit_matrix(dimension)
    centrings = [op.translation for op in operations if op.rotation == unit]
    basis = _primitive_basis(centrings, dimension)
    back = inverse(basis)
    found: dict[Matrix, Operation] = {}
    for operation in operations:
        rotation = multiply(multiply(back, operation.rotation), basis)
        if rotation not in found:
            found[rotation] = Operation(rotation, apply(back, operation.translation)).modulo()
    return PrimitiveGroup(basis, tuple(found.values()))


def _primitive_basis(centrings: list[Vector], dimension: int) -> Matrix:
    if len(centrings) == 1:
        return unit_matrix(dimension)
    size = lcm(*(entry.denominator for vector in centrings for entry in vector))
    vectors = [[int(entry * size) for entry in vector] for vector in centrings]
    vectors += [[size * int(i == j) for j in range(dimension)] for i in range(dimension)]
    rows = [tuple(Fraction(entry, size) for entry in row) for row in lattice_basis(vectors)]
    if determinant(tuple(rows)) < 0:
        # Handedness tells enantiomorphic types apart.
        rows[-1] = tuple(-entry for entry in rows[-1])
    return exact_matrix(zip(*rows, strict=True))


def _generated(generators: list[Matrix]) -> set[Matrix]:
    found = [unit_matrix(len(generators[0]))]
    known = set(found)
    for known_so_far in found:
        for generator in generators:
            product = multiply(generator, known_so_far)
            if product not in known:
                known.add(product)
                found.append(product)
    return known
