"""Space groups by name or number: the 230 in their tabulated settings, the 17 plane groups."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import lru_cache
from types import ModuleType
from typing import Any

from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.plane_catalogue import (
    PLANE_GROUPS,
    SHORT_SYMBOLS,
    generate,
)
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.errors import CrystalError

TYPES = 230
PREFERENCE = "2H"  # the second origin, at an inversion centre, and hexagonal axes
SUBSCRIPTS = str.maketrans("₀₁₂₃₄₅₆\N{MINUS SIGN}", "0123456-", "_{}$()")
NUMBER = re.compile("[+-]?[0-9]{1,9}")
LONGEST = 40  # letters of a symbol that messages repeat
OVERBAR = re.compile("(.)[\u0304\u0305]")


def space_group(name: str | int) -> SpaceGroup:
    """The group of a Hermann-Mauguin symbol or number.

    Symbols are read with or without spaces, subscripts or underscores: ``P212121``,
    ``P 21 21 21``, ``P2_12_12_1``, ``P2(1)2(1)2(1)``. A colon chooses among tabulated settings:
    ``Fd-3m:1``, ``R32:R``; without it, and for numbers, the setting of the International Tables is
    taken, with the origin at an inversion centre and hexagonal axes. A small letter at the front
    means the plane: ``p4``, ``p3m1``.

    Raises:
        CrystalError: there is no such group; suggests some. Or gemmi is missing.
    """
    symbol = _tidy(str(name))
    if not NUMBER.fullmatch(symbol):
        return _plane(symbol) or _by_symbol(symbol, str(name)[:LONGEST])
    number = int(symbol)
    if not 1 <= number <= TYPES:
        raise CrystalError(
            f"space group {number}: expected a number from 1 to {TYPES}, or a symbol such as "
            "P212121"
        )
    return reference_group(number)


@lru_cache(maxsize=TYPES)
def reference_group(number: int) -> SpaceGroup:
    """The group of a number from 1 to 230 in the setting of the International Tables.

    Raises:
        CrystalError: gemmi is missing.
    """
    return _from_gemmi(gemmi().get_spacegroup_reference_setting(number))


@lru_cache(maxsize=32)
def plane_space_group(number: int) -> SpaceGroup:
    """The plane group of a number from 1 to 17."""
    number, name, generators = PLANE_GROUPS[number - 1]
    made = generate(tuple(Operation.parse(text) for text in generators), dimension=2)
    return SpaceGroup(name, number, made)


def gemmi() -> ModuleType:
    """The library that has the tables.

    Raises:
        CrystalError: it is not installed.
    """
    try:
        import gemmi as library
    except ImportError:
        raise CrystalError(
            "names and types of space groups need the library gemmi; install it with "
            "pip install 'ellipsoid-planning[crystal]'"
        ) from None
    return library


def _tidy(name: str) -> str:
    """The symbol in plain letters, without spaces."""
    plain = OVERBAR.sub(r"-\1", name).translate(SUBSCRIPTS)
    return "".join(plain.split())


def _plane(symbol: str) -> SpaceGroup | None:
    full = SHORT_SYMBOLS.get(symbol, symbol)
    numbers = [number for number, known, _ in PLANE_GROUPS if known == full]
    return plane_space_group(numbers[0]) if numbers else None


@lru_cache(maxsize=64)
def _by_symbol(symbol: str, given: str) -> SpaceGroup:
    capitalised = symbol[:1].upper() + symbol[1:]
    found = gemmi().find_spacegroup_by_name(capitalised, prefer=PREFERENCE)
    if found is None:
        raise CrystalError(f"space group {given!r}: there is no such group; {_hint(symbol)}")
    return _from_gemmi(found)


def _from_gemmi(found: Any) -> SpaceGroup:
    return SpaceGroup(symbol_of(found), found.number, tuple(map(_operation, found.operations())))


def _operation(op: Any) -> Operation:
    rotation = tuple(tuple(Fraction(entry, op.DEN) for entry in row) for row in op.rot)
    return Operation(rotation, tuple(Fraction(entry, op.DEN) for entry in op.tran))


def symbol_of(found: Any) -> str:
    """The name of one of gemmi's settings, without spaces; a colon names the setting."""
    short = found.short_name()
    if found.ext == "H":
        return "R" + short[1:]
    default = found.ext in ("\0", "2")
    return short if default else f"{short}:{found.ext}"


def _hint(symbol: str) -> str:
    """Close symbols; otherwise what symbols look like."""
    import difflib

    names = [name for _, name, _ in PLANE_GROUPS]
    names += sorted({symbol_of(entry) for entry in gemmi().spacegroup_table()})
    close = difflib.get_close_matches(symbol, names, n=3)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return "expected a symbol such as P212121, C2/c or p6 (in the plane), or a number from 1 to 230"
