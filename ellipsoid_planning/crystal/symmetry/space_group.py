"""Space groups modulo the conventional lattice: cosets of its translations, exactly."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.cell_check import check_cell, fitted_cell
from ellipsoid_planning.crystal.symmetry.exact_matrix import exact_matrix, inverse, multiply
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError

Integers = NDArray[np.int64]
LARGEST = 10**6  # of a matrix' entries and of denominators, so that products stay below 2^63
Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True, eq=False)
class SpaceGroup:
    """A group of n-dimensional operations that contains the translations Z^n of its cell.

    What is kept is one operation of each coset of these translations. Centring translations are
    no integers, so that they are elements here.

    Attributes:
        name: what messages and results call the group, such as ``P212121``.
        number: of its type in the International Tables (1 to 230, 1 to 17 in the plane), None
            for groups whose operations come from elsewhere.
        operations: the coset representatives, the identity first, translations in [0, 1).

    Raises:
        CrystalError: an operation occurs twice, the identity is missing or not the first one, a
            matrix does not map the lattice to itself, or a product is missing; says which.
    """

    name: str
    number: int | None
    operations: tuple[Operation, ...]

    def __post_init__(self) -> None:
        operations = tuple(operation.modulo() for operation in self.operations)
        object.__setattr__(self, "operations", operations)
        _check_operations(self.name, operations)
        _ = self.table

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.operations[0].dimension

    @property
    def order(self) -> int:
        """The number m of operations modulo the conventional lattice."""
        return len(self.operations)

    @cached_property
    def integer_rotations(self) -> Integers:
        """The linear parts, shape (m, n, n)."""
        rows = [[[int(entry) for entry in row] for row in op.rotation] for op in self.operations]
        return _read_only(np.array(rows, dtype=np.int64))

    @cached_property
    def denominator(self) -> int:
        """The least common denominator of all translations."""
        return lcm(*(t.denominator for op in self.operations for t in op.translation))

    @cached_property
    def integer_translations(self) -> Integers:
        """The translations times `denominator`, shape (m, n)."""
        rows = [[int(t * self.denominator) for t in op.translation] for op in self.operations]
        return _read_only(np.array(rows, dtype=np.int64))

    @cached_property
    def rotations(self) -> NDArray[np.float64]:
        """The linear parts in fractional coordinates, shape (m, n, n)."""
        return _read_only(self.integer_rotations.astype(float))

    @cached_property
    def translations(self) -> NDArray[np.float64]:
        """The translations in fractional coordinates, shape (m, n)."""
        return _read_only(self.integer_translations / float(self.denominator))

    @cached_property
    def table(self) -> Integers:
        """The multiplication table, shape (m, m): entry i, j is the index of g_i o g_j."""
        return _read_only(_multiplication_table(self))

    @cached_property
    def inverses(self) -> Integers:
        """Shape (m,), the index of each operation's inverse."""
        return _read_only(np.argmin(self.table, axis=1).astype(np.int64))

    @cached_property
    def symmorphic(self) -> bool:
        """Whether some point is fixed by an operation of every linear part."""
        from ellipsoid_planning.crystal.symmetry.flags import is_symmorphic

        return is_symmorphic(self)

    @cached_property
    def bieberbach(self) -> bool:
        """Whether the group is torsion-free: no operation but the identity has a finite order."""
        from ellipsoid_planning.crystal.symmetry.flags import is_bieberbach

        return is_bieberbach(self)

    @property
    def sohncke(self) -> bool:
        """Whether all operations are motions, so that chiral molecules can have the group."""
        return all(operation.determinant == 1 for operation in self.operations)

    @cached_property
    def enantiomorphic(self) -> bool:
        """Whether the mirror image of the group is of another type (as P41 and P43)."""
        from ellipsoid_planning.crystal.symmetry.flags import is_enantiomorphic

        return is_enantiomorphic(self)

    def cartesian(self, cell: UnitCell) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rotations (m, n, n) and translations (m, n) of the operations in Cartesian world axes.

        Raises:
            CrystalError: the cell contradicts the group.
        """
        self.check_cell(cell)
        # Exactly, and rounded at the end: in flat cells large numbers cancel.
        basis = exact_matrix([[Fraction(entry) for entry in row] for row in cell.basis.tolist()])
        back = inverse(basis)
        turns = [multiply(multiply(basis, op.rotation), back) for op in self.operations]
        return np.array(turns, dtype=float), cell.cartesian(self.translations)

    def check_cell(self, cell: UnitCell) -> None:
        """Check that the linear parts keep all lengths and angles in this cell.

        Raises:
            CrystalError: names the length or angle that the group's system does not allow.
        """
        check_cell(self.name, self.integer_rotations, cell)

    def fitted_cell(self, cell: UnitCell) -> UnitCell:
        """The cell that the operations keep exactly, next to one that was rounded in a file.

        Raises:
            CrystalError: the cell contradicts the group.
        """
        self.check_cell(cell)
        return fitted_cell(self.integer_rotations, cell)

    def index(self, operation: Operation) -> int:
        """The index of an operation, modulo the lattice.

        Raises:
            CrystalError: the operation is none of the group's.
        """
        found = self._indices.get(operation.modulo())
        if found is None:
            raise CrystalError(f"{self.name}: {operation} is none of its operations")
        return found

    @cached_property
    def _indices(self) -> dict[Operation, int]:
        return {operation: index for index, operation in enumerate(self.operations)}


def _read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    array.setflags(write=False)
    return array


def _check_operations(name: str, operations: tuple[Operation, ...]) -> None:
    if not operations:
        raise CrystalError(f"{name}: expected at least the identity x,y,z, got no operations")
    dimension = operations[0].dimension
    identity = Operation.identity(dimension)
    first: dict[Operation, int] = {}
    for number, operation in enumerate(operations, start=1):
        if operation.dimension != dimension:
            raise CrystalError(
                f"{name}: operation 1, {operations[0]}, has {dimension} coordinates, "
                f"operation {number}, {operation}, has {operation.dimension}"
            )
        if operation in first:
            raise CrystalError(
                f"{name}: operation {number}, {operation}, is the same as operation "
                f"{first[operation]} modulo the lattice; remove one"
            )
        first[operation] = number
        _check_lattice(name, number, operation)
    if lcm(*(entry.denominator for op in operations for entry in op.translation)) > LARGEST**2:
        raise CrystalError(f"{name}: the translations have no common denominator of a few digits")
    if identity not in first:
        raise CrystalError(f"{name}: the identity {identity} is missing; add it as the first")
    if first[identity] != 1:
        raise CrystalError(
            f"{name}: expected the identity {identity} first, it is operation {first[identity]}; "
            "move it"
        )


def _check_lattice(name: str, number: int, operation: Operation) -> None:
    whole = all(entry.denominator == 1 for row in operation.rotation for entry in row)
    if not whole or abs(operation.determinant) != 1:
        raise CrystalError(
            f"{name}: operation {number}, {operation}, does not map the cell's lattice to itself; "
            "expected a matrix of integers with determinant 1 or -1"
        )
    entries = [abs(int(entry)) for row in operation.rotation for entry in row]
    denominators = [entry.denominator for entry in operation.translation]
    if max(entries) > LARGEST or lcm(*denominators) > LARGEST:
        raise CrystalError(
            f"{name}: operation {number}, {operation}: expected numbers with a few digits only; "
            "write fractions such as 1/3 as such"
        )


def _multiplication_table(group: SpaceGroup) -> Integers:
    turns, shifts = group.integer_rotations, group.integer_translations
    order, size = group.order, group.denominator
    products = np.einsum("aij,bjk->abik", turns, turns).reshape(order, order, -1)
    moved = (np.einsum("aij,bj->abi", turns, shifts) + shifts[:, None, :]) % size
    keys = np.ascontiguousarray(np.concatenate([products, moved], axis=2))
    own = np.ascontiguousarray(np.concatenate([turns.reshape(order, -1), shifts], axis=1))
    index = {row.tobytes(): number for number, row in enumerate(own)}
    table = np.empty((order, order), dtype=np.int64)
    for i in range(order):
        for j in range(order):
            found = index.get(keys[i, j].tobytes())
            if found is None:
                raise _missing_product(group, i, j)
            table[i, j] = found
    return table


def _missing_product(group: SpaceGroup, i: int, j: int) -> CrystalError:
    first, second = group.operations[i], group.operations[j]
    product = (first @ second).modulo()
    return CrystalError(
        f"{group.name}: the operations make no group: g_{i + 1} o g_{j + 1} = ({first}) o "
        f"({second}) = ({product}) is not among them; add it, or correct one of the two"
    )
