"""Coordinate triplets such as ``-x+y,x+1/2,z``: reading and printing them, exactly.

The grammar takes coefficients, fractions, decimals and parentheses: ``(-2x+1/4+y+z, ...)``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction

from ellipsoid_planning.crystal.symmetry.exact_matrix import Number
from ellipsoid_planning.errors import CrystalError

VARIABLES = "xyz"
LONGEST = 200  # letters of an operation; none that is meant is as long
TOKEN = re.compile(r"\s*(?:(\d+\.\d*|\.\d+|\d+)|([A-Za-z])|(.))")

Row = tuple[Fraction, ...]  # the coefficients of x, y (, z), then the constant


def parse_triplet(text: str) -> list[Row]:
    """The rows of an operation: for each coordinate its n coefficients and its constant.

    Raises:
        CrystalError: the text is no triplet (in 2-D: no pair); says where and what was expected.
    """
    text = text.strip().replace("\N{MINUS SIGN}", "-")
    if len(text) > LONGEST:
        raise CrystalError(
            f"{text[:20]!r}...: expected coordinates such as x,y,z, got {len(text)} letters"
        )
    parts = _split(text)
    if len(parts) not in (2, 3):
        raise CrystalError(
            f"{text!r}: expected three coordinates such as x,y,z (in the plane two: x,y), "
            f"got {len(parts)}"
        )
    return [_Expression(part, len(parts), text).row() for part in parts]


def _split(text: str) -> list[str]:
    """The coordinates, without parentheses around them all."""
    if text.startswith("(") and _closing(text) == len(text) - 1 and "," in text:
        text = text[1:-1]
    return text.split(",")


def _closing(text: str) -> int:
    """Where the parenthesis closes that the text begins with; -1 when it does not."""
    depth = 0
    for place, letter in enumerate(text):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if depth == 0:
            return place
    return -1


class _Expression:
    """A linear expression, read from left to right."""

    def __init__(self, text: str, dimension: int, whole: str) -> None:
        self.symbols = [match.group().strip() for match in TOKEN.finditer(text.strip())]
        self.place = 0
        self.dimension = dimension
        self.whole = whole

    def row(self) -> Row:
        total = self._sum()
        if self._next():
            raise self._error(f"unexpected {self._next()!r}")
        return total

    def _sum(self) -> Row:
        total = (Fraction(0),) * (self.dimension + 1)
        sign = self._sign(required=False)
        while sign:
            total = tuple(a + sign * b for a, b in zip(total, self._product(), strict=True))
            sign = self._sign(required=True)
        return total

    def _sign(self, *, required: bool) -> int:
        """The sign of the next term; 0 when there is no further term."""
        sign = self._next()
        if sign and sign in "+-":
            self.place += 1
            return -1 if sign == "-" else 1
        return 0 if required else 1

    def _product(self) -> Row:
        """Factors one after another, with ``*`` or without, or divided by numbers."""
        product = self._factor()
        while (symbol := self._next()) and symbol not in "+-)":
            if symbol in "*/":
                self.place += 1
            elif _is_number(symbol):
                raise self._error(f"unexpected {symbol!r}")
            factor = self._factor()
            product = (
                self._divided(product, factor) if symbol == "/" else self._times(product, factor)
            )
        return product

    def _factor(self) -> Row:
        symbol = self._next()
        self.place += 1
        if symbol == "(":
            inner = self._sum()
            if self._next() != ")":
                raise self._error("a parenthesis is not closed")
            self.place += 1
            return inner
        row = [Fraction(0)] * (self.dimension + 1)
        if symbol and symbol.lower() in VARIABLES[: self.dimension]:
            row[VARIABLES.index(symbol.lower())] = Fraction(1)
        elif _is_number(symbol):
            row[-1] = Fraction(symbol)
        else:
            self.place -= 1
            raise self._error(f"unexpected {symbol!r}" if symbol else "it ends too early")
        return tuple(row)

    def _times(self, first: Row, second: Row) -> Row:
        if any(first[:-1]) and any(second[:-1]):
            raise self._error("a product of two variables is not linear")
        if any(first[:-1]):
            first, second = second, first
        return tuple(first[-1] * entry for entry in second)

    def _divided(self, row: Row, divisor: Row) -> Row:
        if any(divisor[:-1]) or not divisor[-1]:
            raise self._error("expected a number other than zero after '/'")
        return tuple(entry / divisor[-1] for entry in row)

    def _next(self) -> str:
        return self.symbols[self.place] if self.place < len(self.symbols) else ""

    def _error(self, problem: str) -> CrystalError:
        letters = ", ".join(VARIABLES[: self.dimension])
        return CrystalError(
            f"{self.whole!r}: {problem}; expected coordinates such as -x+1/2 of {letters}, "
            "fractions and numbers"
        )


def _is_number(symbol: str) -> bool:
    return any(letter.isdecimal() for letter in symbol)


def print_triplet(rows: Sequence[Sequence[Number]]) -> str:
    """The operation's shortest text: ``-x+1/2,-y,z+1/2``."""
    return ",".join(_print_row(row) for row in rows)


def _print_row(row: Sequence[Number]) -> str:
    terms = [
        _sign(entry)
        + ("" if abs(entry) == 1 else str(abs(entry)) + "*" * (entry.denominator > 1))
        + letter
        for letter, entry in zip(VARIABLES, row[:-1], strict=False)
        if entry
    ]
    if row[-1] or not terms:
        terms.append(_sign(row[-1]) + str(abs(row[-1])))
    return "".join(terms).removeprefix("+")


def _sign(entry: Number) -> str:
    return "-" if entry < 0 else "+"
