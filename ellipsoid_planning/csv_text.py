"""CSV in which text stays text: spreadsheets take what begins with = + - @ for a formula."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence

# Coordinate triplets such as -x,y+1/2,-z: no formula, and data to read back.
_TRIPLET = re.compile(r"[-+xyz0-9/]+(?:,[-+xyz0-9/]+){1,2}")
_FORMULAS = ("=", "+", "-", "@", "\t", "\r")
_END = "\r\n"  # csv quotes the characters of its line ends only, so it gets both


class _Lines(list[str]):
    """Takes the lines that csv writes, one at a time, and ends them as everything here does."""

    def write(self, line: str) -> None:
        self.append(line.removesuffix(_END) + "\n")


def csv_text(rows: Iterable[Sequence[object]]) -> str:
    """Return rows as CSV, numbers as they are, and text so that no spreadsheet runs it."""
    lines = _Lines()
    csv.writer(lines, lineterminator=_END).writerows([csv_cell(x) for x in row] for row in rows)
    return "".join(lines)


def csv_cell(cell: object) -> object:
    """Return a cell, with an apostrophe before text that would be taken for a formula."""
    if not isinstance(cell, str) or not cell.lstrip(" \n").startswith(_FORMULAS):
        return cell
    return cell if _is_number(cell) or _TRIPLET.fullmatch(cell) else f"'{cell}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
