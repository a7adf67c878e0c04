"""Decisions about ellipsoids in 60-digit decimal arithmetic, each one backed by a proof.

Every number of a body is a float64 and hence an exact decimal, so these answers are about the
very bodies that were handed in, at axis ratios and distances where float64 is no judge.  Each
function searches until it holds a proof of one answer or of the other (a separating direction
or a common point; a multiplier of the S-lemma or a point that sticks out).  It never guesses.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Context, Decimal, localcontext

import numpy as np
from numpy.typing import NDArray

from tests.oracles import Body

DIGITS = 60
Vector = list[Decimal]
Matrix = list[list[Decimal]]


class UndecidedError(AssertionError):
    """The two bodies are closer to contact than 60 digits can tell."""


def _decimal(value: float | np.longdouble) -> Decimal:
    """A number of up to 106 bits, exactly."""
    high = float(value)
    return Decimal(high) + Decimal(float(value - high))


def decimals(array: NDArray[np.floating] | Sequence[float]) -> Vector:
    """A vector, double or long double, as exact decimals."""
    return [_decimal(value) for value in array]


def _matrix(array: NDArray[np.floating]) -> Matrix:
    return [decimals(row) for row in array]


def _dot(first: Vector, second: Vector) -> Decimal:
    return sum((a * b for a, b in zip(first, second, strict=True)), Decimal(0))


def _times(matrix: Matrix, vector: Vector) -> Vector:
    return [_dot(row, vector) for row in matrix]


def _transposed(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]


def _shape(matrix: Matrix) -> Matrix:
    return [[_dot(row, other) for other in matrix] for row in matrix]


def _combined(first: Matrix, a: Decimal, second: Matrix, b: Decimal) -> Matrix:
    return [
        [a * x + b * y for x, y in zip(row, other, strict=True)]
        for row, other in zip(first, second, strict=True)
    ]


def _solved(matrix: Matrix, right: Vector) -> tuple[Vector, bool]:
    """Solution of a symmetric system by elimination, and whether the matrix is positive."""
    size = len(right)
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    positive = True
    for k in range(size):
        if rows[k][k] <= 0:
            return right, False
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    solution = [Decimal(0)] * size
    for k in reversed(range(size)):
        rest = sum((rows[k][j] * solution[j] for j in range(k + 1, size)), Decimal(0))
        solution[k] = (rows[k][size] - rest) / rows[k][k]
    return solution, positive


def _norm(vector: Vector) -> Decimal:
    return _dot(vector, vector).sqrt()


def separation(
    first: Body, second: Body, offset: Vector | None = None, steps: int = 400
) -> Decimal:
    """A proved number whose sign tells whether two ellipsoids are disjoint.

    Positive: a lower bound of their distance, with a separating direction as the proof.
    Zero: a common point was found.

    Parameters: `offset` replaces the difference of the centres (second minus first), exactly.
    Raises UndecidedError when neither proof turns up.
    """
    with localcontext(Context(prec=DIGITS)):
        c = offset or _difference(second.centre, first.centre)
        if not any(c):
            return Decimal(0)
        a1, a2 = _transposed(_matrix(first.matrix)), _transposed(_matrix(second.matrix))
        s1, s2 = _shape(_transposed(a1)), _shape(_transposed(a2))
        low, high = Decimal(0), Decimal(1)
        for _ in range(steps):
            weight = (low + high) / 2
            y, _ = _solved(_combined(s1, 1 / weight, s2, 1 / (1 - weight)), c)
            r1, r2 = _norm(_times(a1, y)), _norm(_times(a2, y))
            value = _dot(y, c) - r1 - r2
            if value > 0:
                return value / _norm(y)
            if max(r1 / weight, r2 / (1 - weight)) <= 1:
                return Decimal(0)
            low, high = (weight, high) if r1 * (1 - weight) > r2 * weight else (low, weight)
    raise UndecidedError("contact to within 60 digits")


def is_separated(first: Body, second: Body, offset: Vector | None = None) -> bool:
    """Whether two ellipsoids have no common point."""
    return separation(first, second, offset) > 0


def _difference(first: NDArray[np.float64], second: NDArray[np.float64]) -> Vector:
    return [a - b for a, b in zip(decimals(first), decimals(second), strict=True)]


def is_contained(arena: Body, part: Body, offset: Vector | None = None, steps: int = 100) -> bool:
    """Whether an ellipsoid lies within another, by the S-lemma or by a point that sticks out.

    `offset` replaces the part's centre relative to the arena's, exactly.
    Raises UndecidedError when neither proof turns up.
    """
    with localcontext(Context(prec=DIGITS)):
        c = offset or _difference(part.centre, arena.centre)
        s_arena, s_part = _shape(_matrix(arena.matrix)), _shape(_matrix(part.matrix))
        low, high = Decimal(0), Decimal(1)
        for _ in range(steps):
            mu = (low + high) / 2
            w, positive = _solved(_combined(s_arena, Decimal(1), s_part, -1 / mu), c)
            if not positive:
                low = mu
                continue
            if mu + _dot(c, w) <= 1:
                return True
            if _is_outside(part, c, _times(_transposed(_matrix(part.matrix)), w), s_arena):
                return False
            slope = 1 - _dot(w, _times(s_part, w)) / mu**2
            low, high = (low, mu) if slope > 0 else (mu, high)
        if 1 - low < Decimal(10) ** -25:  # at least as large as the arena along some direction
            return False
        if _hard_case_sticks_out(part, c, high, s_arena, s_part):
            return False
    raise UndecidedError("contact to within 60 digits")


def _is_outside(part: Body, c: Vector, z: Vector, s_arena: Matrix) -> bool:
    """Whether the part's point c + A z / |z| lies outside the arena."""
    length = _norm(z)
    if length == 0:
        return False
    move = _times(_matrix(part.matrix), z)
    point = [x + y / length for x, y in zip(c, move, strict=True)]
    inverse, _ = _solved(s_arena, point)
    return _dot(point, inverse) > 1


def _hard_case_sticks_out(
    part: Body, c: Vector, mu: Decimal, s_arena: Matrix, s_part: Matrix
) -> bool:
    """The same when the minimum sits in the limit: the farthest points lie to both sides of the
    stationary one, along the direction in which the part first fills the arena."""
    matrix = _combined(s_arena, Decimal(1), s_part, -1 / mu)
    transposed = _transposed(_matrix(part.matrix))
    w, _ = _solved(matrix, c)
    v, _ = _solved(matrix, decimals([1.0, 0.37, 0.61][: len(c)]))
    z0, step = [x / mu for x in _times(transposed, w)], _times(transposed, v)
    half, rest = _dot(z0, step), _dot(z0, z0) - 1
    if rest >= 0:
        return False
    root = (half**2 - _dot(step, step) * rest).sqrt()
    for t in ((-half + root) / _dot(step, step), (-half - root) / _dot(step, step)):
        z = [x + t * y for x, y in zip(z0, step, strict=True)]
        if _is_outside(part, c, z, s_arena):
            return True
    return False


def on_line(
    origin: NDArray[np.float64],
    direction: NDArray[np.float64],
    parameter: float,
    centre: NDArray[np.float64],
) -> Vector:
    """The exact vector origin + parameter * direction - centre."""
    with localcontext(Context(prec=DIGITS)):
        t = Decimal(float(parameter))
        parts = zip(decimals(origin), decimals(direction), decimals(centre), strict=True)
        return [o + t * d - c for o, d, c in parts]
