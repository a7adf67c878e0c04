"""Results of ``crystal`` as JSON and CSV, written whole."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ellipsoid_planning.csv_text import csv_text
from planners.cli.terminal import say

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel

ARRANGEMENT_SUFFIXES = (".json", ".csv")
AT_ONCE = 4096


def save_json(result: Mapping[str, Any], output: Path) -> None:
    """Write a result.

    Raises:
        EllipsoidPlanningError: it cannot be written.
    """
    _save(output, iter([json.dumps(result, indent=1, allow_nan=False).encode() + b"\n"]))


def save_arrangements(
    result: Mapping[str, Any],
    model: PackingModel,
    columns: Mapping[str, NDArray[Any]],
    configurations: NDArray[np.float64],
    output: Path,
) -> None:
    """Write a result with all its arrangements: JSON with everything, or a CSV of them alone.

    Args:
        result: everything else.
        model: whose arrangements they are.
        columns: what there is to say about each besides its coordinates, (m,) by name.
        configurations: (m, K), angles [rad].
        output: its suffix chooses the format.

    Raises:
        EllipsoidPlanningError: it cannot be written.
    """
    rows = _rows(model, columns, configurations)
    as_csv = output.suffix.lower() == ".csv"
    _save(output, _csv([*columns, *model.keys], rows) if as_csv else _json(result, rows))


def arrangements(
    model: PackingModel, columns: Mapping[str, NDArray[Any]], configurations: NDArray[np.float64]
) -> list[dict[str, Any]]:
    """Arrangements as data for JSON; ``configuration`` is as in a target's file."""
    return [_entry(row) for row in _rows(model, columns, configurations)]


Row = tuple[dict[str, Any], dict[str, float]]


def _rows(
    model: PackingModel, columns: Mapping[str, NDArray[Any]], configurations: NDArray[np.float64]
) -> Iterator[Row]:
    for first in range(0, len(configurations), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        values = zip(*(column[part].tolist() for column in columns.values()), strict=True)
        shown = model.in_file_units(configurations[part]).tolist()
        for given, coordinates in zip(values, shown, strict=True):
            named = dict(zip(columns, given, strict=True))
            yield named, dict(zip(model.keys, coordinates, strict=True))


def _entry(row: Row) -> dict[str, Any]:
    return {**row[0], "configuration": row[1]}


def _json(result: Mapping[str, Any], rows: Iterator[Row]) -> Iterator[bytes]:
    whole = json.dumps({**result, "arrangements": []}, indent=1, allow_nan=False)
    start, end = whole.rsplit("[]", 1)
    yield f"{start}[".encode()
    for index, row in enumerate(rows):
        comma = "," if index else ""
        yield f"{comma}\n  {json.dumps(_entry(row), allow_nan=False)}".encode()
    yield f"\n ]{end}\n".encode()


def _csv(header: list[str], rows: Iterator[Row]) -> Iterator[bytes]:
    yield csv_text([header]).encode()
    for given, coordinates in rows:
        numbers = (*given.values(), *coordinates.values())
        yield (",".join(map(repr, numbers)) + "\n").encode()


def _save(output: Path, content: Iterator[bytes]) -> None:
    from ellipsoid_planning import atomic
    from ellipsoid_planning.errors import EllipsoidPlanningError

    try:
        atomic.write_pieces(output, content)
    except OSError as error:
        raise EllipsoidPlanningError(f"{output}: cannot write the file: {error.strerror}") from None
    say(f"Wrote {output}")
