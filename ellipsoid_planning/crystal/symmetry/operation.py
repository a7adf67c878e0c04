"""Symmetry operations x -> W x + w in fractional coordinates, exactly."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor

from ellipsoid_planning.crystal.symmetry.exact_matrix import (
    Matrix,
    Number,
    Vector,
    apply,
    determinant,
    exact_matrix,
    inverse,
    multiply,
    unit_matrix,
)
from ellipsoid_planning.crystal.symmetry.triplets import parse_triplet, print_triplet
from ellipsoid_planning.errors import CrystalError


@dataclass(frozen=True)
class Operation:
    """An affine map of fractional coordinates with rational entries.

    Two operations are equal when all entries are; `modulo` makes those equal that differ by a
    lattice vector only.

    Attributes:
        rotation: the linear part W, n rows of n integers (fractions where they are none); a
            matrix in the cell's own basis, so that it need not be orthogonal.
        translation: w, n fractions, in units of the cell's vectors.

    Raises:
        CrystalError: the linear part is not square, or not invertible.
    """

    rotation: Matrix
    translation: Vector

    def __post_init__(self) -> None:
        rotation = exact_matrix(self.rotation)
        translation = tuple(Fraction(entry) for entry in self.translation)
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "translation", translation)
        sizes = {len(row) for row in rotation} | {len(rotation), len(translation)}
        if len(sizes) != 1 or sizes.pop() not in (2, 3):
            raise CrystalError("expected an (n, n) matrix and n numbers with n = 2 or 3")
        if not self.determinant:
            raise CrystalError(
                f"{self.triplet()!r}: expected an invertible operation, this one flattens space"
            )

    @classmethod
    def parse(cls, text: str) -> Operation:
        """The operation of a triplet such as ``-x,y+1/2,-z``, or ``(-x,y)`` in the plane.

        Raises:
            CrystalError: the text is no triplet, or that of no invertible operation.
        """
        rows = parse_triplet(text)
        return cls(tuple(row[:-1] for row in rows), tuple(row[-1] for row in rows))

    @classmethod
    def identity(cls, dimension: int) -> Operation:
        """The operation that does nothing."""
        return cls(unit_matrix(dimension), (Fraction(0),) * dimension)

    @classmethod
    def shift(cls, vector: Iterable[Number]) -> Operation:
        """The translation by a vector."""
        translation = tuple(vector)
        return cls(unit_matrix(len(translation)), translation)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.translation)

    @cached_property
    def determinant(self) -> Number:
        """Of the linear part: 1 for motions, -1 for mirror images."""
        return determinant(self.rotation)

    def triplet(self) -> str:
        """The text ``-x,y+1/2,-z`` of this operation; `parse` gives the operation back."""
        rows = zip(self.rotation, self.translation, strict=True)
        return print_triplet([(*row, shift) for row, shift in rows])

    def __str__(self) -> str:
        return self.triplet()

    def __matmul__(self, other: Operation) -> Operation:
        """The composition: first the other operation, then this one (thesis (3.3))."""
        moved = apply(self.rotation, other.translation)
        shifts = tuple(b + a for a, b in zip(moved, self.translation, strict=True))
        return Operation(multiply(self.rotation, other.rotation), shifts)

    def compose(self, other: Operation) -> Operation:
        """The same as ``self @ other``."""
        return self @ other

    def inverse(self) -> Operation:
        """The operation that undoes this one."""
        rotation = inverse(self.rotation)
        shifts = apply(rotation, self.translation)
        return Operation(rotation, tuple(-entry for entry in shifts))

    def modulo(self, lattice: Sequence[Sequence[Number]] | None = None) -> Operation:
        """The operation whose translation lies in the lattice's cell, [0, 1) along each vector.

        Args:
            lattice: n rows of n fractions, the columns are the lattice's basis; by default the
                unit vectors, the conventional cell's own.
        """
        if lattice is None:
            return Operation(self.rotation, tuple(entry % 1 for entry in self.translation))
        basis = exact_matrix(lattice)
        steps = [floor(entry) for entry in apply(inverse(basis), self.translation)]
        whole = apply(basis, steps)
        shifts = tuple(a - b for a, b in zip(self.translation, whole, strict=True))
        return Operation(self.rotation, shifts)
