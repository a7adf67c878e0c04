"""Small matrices and vectors of exact numbers: tuples of integers and fractions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

Number = int | Fraction
Matrix = tuple[tuple[Number, ...], ...]
Vector = tuple[Number, ...]


def exact(entry: Number) -> Number:
    """The same number, as an integer if it is one: integers are ten times faster."""
    return int(entry) if entry.denominator == 1 else Fraction(entry)


def exact_matrix(rows: Iterable[Iterable[Number]]) -> Matrix:
    """The rows as tuples of integers and fractions."""
    return tuple(tuple(exact(entry) for entry in row) for row in rows)


def unit_matrix(dimension: int) -> Matrix:
    """The identity, n rows of n numbers."""
    return tuple(tuple(int(i == j) for j in range(dimension)) for i in range(dimension))


def apply(matrix: Matrix, vector: Sequence[Number]) -> Vector:
    """The product of an (n, n) matrix and a vector (n,)."""
    return tuple(dot(row, vector) for row in matrix)


def dot(first: Sequence[Number], second: Sequence[Number]) -> Number:
    """The sum of the products of the entries."""
    total: Number = 0
    for a, b in zip(first, second, strict=True):
        if a and b:
            total += a * b
    return total


def multiply(first: Matrix, second: Matrix) -> Matrix:
    """The product of two (n, n) matrices."""
    columns = tuple(zip(*second, strict=True))
    return tuple(tuple(dot(row, column) for column in columns) for row in first)


def determinant(matrix: Matrix) -> Number:
    """The determinant of a (2, 2) or (3, 3) matrix."""
    if len(matrix) == 2:
        return matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0]
    return dot(matrix[0], [_cofactor(matrix, 0, i) for i in range(3)])


def inverse(matrix: Matrix) -> Matrix:
    """The inverse of an invertible (2, 2) or (3, 3) matrix."""
    scale = 1 / Fraction(determinant(matrix))
    if len(matrix) == 2:
        (a, b), (c, d) = matrix
        adjugate: Matrix = ((d, -b), (-c, a))
    else:
        adjugate = tuple(tuple(_cofactor(matrix, j, i) for j in range(3)) for i in range(3))
    return exact_matrix([entry * scale for entry in row] for row in adjugate)


def matrix_order(matrix: Matrix) -> int:
    """The smallest power of a matrix of finite order that is the identity."""
    return len(_powers(matrix))


def power_sum(matrix: Matrix) -> Matrix:
    """The sum of all different powers of a matrix of finite order."""
    size = range(len(matrix))
    powers = _powers(matrix)
    return tuple(tuple(sum(power[i][j] for power in powers) for j in size) for i in size)


def _powers(matrix: Matrix) -> list[Matrix]:
    powers = [unit_matrix(len(matrix))]
    power = matrix
    while power != powers[0]:
        powers.append(power)
        power = multiply(power, matrix)
    return powers


def _cofactor(matrix: Matrix, row: int, column: int) -> Number:
    # Cyclic indices carry the sign.
    r, s = (row + 1) % 3, (row + 2) % 3
    c, d = (column + 1) % 3, (column + 2) % 3
    return matrix[r][c] * matrix[s][d] - matrix[r][d] * matrix[s][c]
