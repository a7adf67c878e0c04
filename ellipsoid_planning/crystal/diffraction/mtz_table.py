"""MTZ files of reflections as tables."""

from __future__ import annotations

import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.diffraction.reflection_table import (
    INTENSITY,
    LARGEST_INDEX,
    MAGNITUDE,
    OTHER,
    UNCERTAINTY,
    ReflectionTable,
    group_of,
    operations_of,
)
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import ScenarioError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

KINDS = {"F": MAGNITUDE, "J": INTENSITY, "Q": UNCERTAINTY}
RECORD = 80  # bytes of a line of the header


def mtz_table(file: str, content: bytes) -> ReflectionTable:
    """The table of an MTZ file.

    Args:
        file: its path, for messages.
        content: its bytes, unpacked.

    Raises:
        ScenarioError: if it is broken, has no reflections, or several measurements of each.
    """
    mtz = _parsed(file, content)
    if mtz.nreflections == 0 or len(mtz.columns) < 3:
        raise ScenarioError("expected reflections, the file has none", file=file)
    if len(mtz.batches):
        raise ScenarioError(
            f"expected merged reflections, the file has {len(mtz.batches)} batches of single "
            "measurements; scale and merge them first",
            file=file,
        )
    columns = dict(zip(_labels(mtz), list(mtz.columns)[3:], strict=True))
    cell = tuple(mtz.cell.parameters) if mtz.cell.is_crystal() else None
    operations, group = _group(mtz, content, cell, file)
    return ReflectionTable(
        file,
        _indices(mtz, file),
        {label: KINDS.get(column.type, OTHER) for label, column in columns.items()},
        {label: _values(mtz, column) for label, column in columns.items()},
        cell,
        operations,
        group,
    )


def _parsed(file: str, content: bytes) -> Any:
    library = gemmi()
    with tempfile.TemporaryDirectory() as folder:
        beside = Path(folder) / "unpacked.mtz"
        beside.write_bytes(content)
        try:
            return library.read_mtz_file(str(beside))
        except (RuntimeError, OSError, ValueError, MemoryError) as error:
            told = str(error).removesuffix(f": {beside}")
            raise ScenarioError(f"this is no readable MTZ file: {told}", file=file) from None


def _labels(mtz: Any) -> list[str]:
    """Names of the columns after the indices; with the dataset's where a label is not unique."""
    columns = list(mtz.columns)[3:]
    counts = Counter(column.label for column in columns)
    labels: list[str] = []
    for column in columns:
        label = column.label
        if counts[label] > 1:
            label = f"{column.dataset.dataset_name}/{label}"
        while label in labels:
            label += "'"
        labels.append(label)
    return labels


def _indices(mtz: Any, file: str) -> Integers:
    found = np.stack([np.array(column, dtype=float) for column in list(mtz.columns)[:3]], axis=1)
    whole = np.isfinite(found) & (found == np.round(found)) & (np.abs(found) <= LARGEST_INDEX)
    if not np.all(whole):
        row = int(np.flatnonzero(~whole.all(axis=1))[0])
        raise ScenarioError(
            f"row {row + 1}: expected whole numbers as Miller indices, got "
            f"({', '.join(f'{value:g}' for value in found[row])})",
            file=file,
        )
    return found.astype(np.int64)


def _values(mtz: Any, column: Any) -> Array:
    """A column (N,) with NaN where the header's missing-number flag (VALM) stands."""
    values = np.array(column, dtype=np.float32)
    found = values.astype(float)
    if np.isfinite(mtz.valm):  # NaN, as most files have it, needs nothing
        found[values == np.float32(mtz.valm)] = np.nan
    return found


def _group(
    mtz: Any, content: bytes, cell: tuple[float, ...] | None, file: str
) -> tuple[tuple[str, ...] | None, str]:
    """The operations and the symbol: what the records SYMM list, else what the symbol means."""
    symbol, listed = str(mtz.spacegroup_name or "").strip(), _symmetry_records(content)
    if listed:
        return operations_of(listed, file, "SYMM"), symbol or "the file's operations"
    if not symbol:
        return None, ""
    found = mtz.spacegroup or group_of(symbol, cell, file)
    return tuple(op.triplet() for op in found.operations()), found.xhm()


def _symmetry_records(content: bytes) -> list[str]:
    """The operations of the header, which stands behind the data."""
    start = content.rfind(b"VERS MTZ")
    if start < 0:
        return []
    records = (content[k : k + RECORD] for k in range(start, len(content), RECORD))
    listed = []
    for record in records:
        if record.startswith(b"END"):
            break
        if record.startswith(b"SYMM "):
            listed.append(record[5:].decode("ascii", "replace"))
    return listed
