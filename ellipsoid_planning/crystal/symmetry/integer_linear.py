"""Linear equations over the integers and modulo one, by the Smith normal form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from ellipsoid_planning.crystal.symmetry.exact_matrix import dot

Rows = list[list[int]]


@dataclass(frozen=True)
class SmithForm:
    """Unimodular ``left`` (r, r) and ``right`` (c, c) with left A right diagonal.

    Attributes:
        left: rows of integers.
        diagonal: min(r, c) integers, not negative, zeros last; they need not divide each other.
        right: rows of integers.
    """

    left: Rows
    diagonal: list[int]
    right: Rows

    @property
    def rank(self) -> int:
        """The number of equations that say something."""
        return sum(entry != 0 for entry in self.diagonal)


def smith_form(matrix: Sequence[Sequence[int]]) -> SmithForm:
    """Diagonalise an integer matrix (r, c) by unimodular row and column operations."""
    work = [list(row) for row in matrix]
    rows, columns = len(work), len(work[0])
    left, right = _unit(rows), _unit(columns)
    for step in range(min(rows, columns)):
        while pivot := _smallest(work, step):
            _swap_rows(work, left, step, pivot[0])
            _swap_columns(work, right, step, pivot[1])
            _clear_column(work, left, step)
            _clear_row(work, right, step)
            if _is_clear(work, step):
                break
    diagonal = [work[i][i] for i in range(min(rows, columns))]
    for i, entry in enumerate(diagonal):
        if entry < 0:
            left[i] = [-value for value in left[i]]
    return SmithForm(left, [abs(entry) for entry in diagonal], right)


def solve_modulo_one(
    matrix: Sequence[Sequence[int]], values: Sequence[int | Fraction]
) -> list[Fraction] | None:
    """A rational s (c,) with A s = b modulo 1, for A (r, c) and b (r,); None: there is none."""
    form = smith_form(matrix)
    target = _times(form.left, values)
    if any(entry.denominator != 1 for entry in target[form.rank :]):
        return None
    scaled = [entry / size for entry, size in zip(target, form.diagonal, strict=False) if size]
    return _times(form.right, [*scaled, *[Fraction(0)] * (len(form.right) - len(scaled))])


def has_integer_solution(matrix: Sequence[Sequence[int]], values: Sequence[int | Fraction]) -> bool:
    """Whether A k = b has a solution k of integers, for A (r, c) and b (r,)."""
    form = smith_form(matrix)
    target = _times(form.left, values)
    if any(target[form.rank :]):
        return False
    return all((target[i] / form.diagonal[i]).denominator == 1 for i in range(form.rank))


def integer_kernel(matrix: Sequence[Sequence[int]]) -> Rows:
    """A basis of the integer solutions k (c,) of A k = 0, one a row."""
    form = smith_form(matrix)
    return [[row[i] for row in form.right] for i in range(form.rank, len(form.right))]


def lattice_basis(generators: Sequence[Sequence[int]]) -> Rows:
    """A basis, one vector a row, of the lattice that integer vectors (r, n) generate."""
    work = [list(row) for row in generators]
    basis: Rows = []
    for column in range(len(work[0])):
        while len(rest := [row for row in work if row[column]]) > 1:
            smallest = min(rest, key=lambda row: abs(row[column]))
            for row in rest:
                if row is not smallest:
                    _subtract(row, smallest, row[column] // smallest[column])
        if rest:
            basis.append(rest[0])
            work = [row for row in work if row is not rest[0]]
    return basis


def _unit(size: int) -> Rows:
    return [[int(i == j) for j in range(size)] for i in range(size)]


def _times(matrix: Sequence[Sequence[int]], values: Sequence[int | Fraction]) -> list[Fraction]:
    return [Fraction(dot(row, values)) for row in matrix]


def _subtract(row: list[int], other: list[int], factor: int) -> None:
    for i, entry in enumerate(other):
        row[i] -= factor * entry


def _smallest(work: Rows, step: int) -> tuple[int, int] | None:
    """Where the smallest entry other than zero is, at or after the step."""
    found = [
        (abs(entry), i, j)
        for i, row in enumerate(work[step:], start=step)
        for j, entry in enumerate(row[step:], start=step)
        if entry
    ]
    return min(found)[1:] if found else None


def _swap_rows(work: Rows, left: Rows, i: int, j: int) -> None:
    for rows in (work, left):
        rows[i], rows[j] = rows[j], rows[i]


def _swap_columns(work: Rows, right: Rows, i: int, j: int) -> None:
    for row in (*work, *right):
        row[i], row[j] = row[j], row[i]


def _clear_column(work: Rows, left: Rows, step: int) -> None:
    for i in range(step + 1, len(work)):
        factor = work[i][step] // work[step][step]
        if factor:
            _subtract(work[i], work[step], factor)
            _subtract(left[i], left[step], factor)


def _clear_row(work: Rows, right: Rows, step: int) -> None:
    for j in range(step + 1, len(work[0])):
        factor = work[step][j] // work[step][step]
        if factor:
            for row in (*work, *right):
                row[j] -= factor * row[step]


def _is_clear(work: Rows, step: int) -> bool:
    below = any(work[i][step] for i in range(step + 1, len(work)))
    return not below and not any(work[step][step + 1 :])
