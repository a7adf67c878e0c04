"""Structure-factor files in CIF and mmCIF as tables."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.diffraction.reflection_status import keep_usable
from ellipsoid_planning.crystal.diffraction.reflection_table import (
    INTENSITY,
    LARGEST_INDEX,
    MAGNITUDE,
    UNCERTAINTY,
    ReflectionTable,
    group_of,
    operations_of,
)
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import ScenarioError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

KINDS = {
    "F_meas_au": MAGNITUDE,
    "F_meas": MAGNITUDE,
    "F_calc_au": MAGNITUDE,
    "F_calc": MAGNITUDE,
    "intensity_meas": INTENSITY,
    "F_squared_meas": INTENSITY,
    "intensity_calc": INTENSITY,
    "F_squared_calc": INTENSITY,
    "F_meas_sigma_au": UNCERTAINTY,
    "F_meas_sigma": UNCERTAINTY,
    "F_meas_su": UNCERTAINTY,
    "intensity_sigma": UNCERTAINTY,
    "intensity_su": UNCERTAINTY,
    "F_squared_sigma": UNCERTAINTY,
    "F_squared_meas_su": UNCERTAINTY,
}
GROUP_TAGS = ("symmetry.space_group_name_H-M", "space_group.name_H-M_alt", "space_group_name_H-M")
OPERATION_TAGS = (
    "_space_group_symop.operation_xyz",
    "_space_group_symop_operation_xyz",
    "_symmetry_equiv.pos_as_xyz",
    "_symmetry_equiv_pos_as_xyz",
)
CELL_TAGS = ("length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma")
NOTHING = ("", "?", ".")
# A number of CIF, with its uncertainty in brackets or without.
NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:\(\d+\))?")


def cif_table(file: str, content: bytes, wanted: str | None = None) -> ReflectionTable:
    """The table of a CIF file's data block.

    Args:
        file: its path, for messages.
        content: its bytes, unpacked.
        wanted: the block's name; by default the first with reflections, and a note says so where
            there are others.

    Raises:
        ScenarioError: if it is broken, or has no reflections, or none in the block.
    """
    try:
        document = gemmi().cif.read_string(content)
    except (RuntimeError, OSError, ValueError) as error:
        raise ScenarioError(f"this is no readable CIF file: {error}", file=file) from None
    found = [
        (block, prefix)
        for block in document
        for prefix in ("_refln.", "_refln_")
        if block.find_loop(f"{prefix}index_h")
    ]
    if not found:
        raise ScenarioError(
            "expected a loop of reflections with _refln.index_h, the file has none; this may be a "
            "file of coordinates, give the one with structure factors",
            file=file,
        )
    block, prefix, notes = _chosen(found, wanted, file)
    return _table(file, block, prefix, notes)


def _chosen(
    found: list[tuple[Any, str]], wanted: str | None, file: str
) -> tuple[Any, str, tuple[str, ...]]:
    names = [block.name for block, _ in found]
    if wanted is not None and wanted not in names:
        raise ScenarioError(
            f"there is no block {wanted!r} with reflections; there are {', '.join(names)}",
            file=file,
        )
    block, prefix = found[0 if wanted is None else names.index(wanted)]
    if wanted is not None or len(names) == 1:
        return block, prefix, ()
    others = ", ".join(names[1:])
    return block, prefix, (f"read the block {names[0]}; choose another by its name: {others}",)


def _table(file: str, block: Any, prefix: str, notes: tuple[str, ...]) -> ReflectionTable:
    known = {tag.lower(): tag for tag in KINDS}  # CIF's names do not depend on case
    loop = block.find_loop(f"{prefix}index_h").get_loop()
    tags = [tag[len(prefix) :].lower() for tag in loop.tags]
    indices = _indices(file, block, prefix, tags)
    kinds = {known[tag]: KINDS[known[tag]] for tag in tags if tag in known}
    columns = {}
    for tag, kind in kinds.items():
        texts = _texts(block, prefix + tag)
        if kind == UNCERTAINTY:  # what is odd there is as good as nothing
            texts = [text if NUMBER.fullmatch(text) else "?" for text in texts]
        columns[tag] = _numbers(file, prefix + tag, texts, indices)
    statuses = {tag: _texts(block, prefix + tag) for tag in tags if tag.endswith("status")}
    usable, told = keep_usable(statuses, indices, file, prefix)
    cell = _cell(block, file)
    operations, group = _group(block, cell, file)
    columns = {tag: values[usable] for tag, values in columns.items()}
    notes += told
    return ReflectionTable(file, indices[usable], kinds, columns, cell, operations, group, notes)


def _texts(block: Any, tag: str) -> list[str]:
    return [gemmi().cif.as_string(text) or "?" for text in block.find_loop(tag)]


def _indices(file: str, block: Any, prefix: str, tags: Sequence[str]) -> Integers:
    """(N, 3), Miller indices."""
    indices = []
    for name in ("index_h", "index_k", "index_l"):
        if name not in tags:
            raise ScenarioError("this column is missing", file=file, field=prefix + name)
        values = _numbers(file, prefix + name, _texts(block, prefix + name))
        if not np.all((values == np.round(values)) & (np.abs(values) <= LARGEST_INDEX)):
            raise ScenarioError("expected whole numbers only", file=file, field=prefix + name)
        indices.append(values.astype(np.int64))
    return np.stack(indices, axis=1)


def _numbers(file: str, field: str, texts: Sequence[str], indices: Integers | None = None) -> Array:
    """The numbers of a column; NaN for ``?`` and ``.``, which say that there is none."""
    values = np.full(len(texts), np.nan)
    for row, text in enumerate(texts):
        if text in NOTHING:
            continue
        found = NUMBER.fullmatch(text)
        if found is None:
            where = f"row {row + 1}"
            if indices is not None:
                where = f"reflection {tuple(indices[row].tolist())}"
            raise ScenarioError(f"{where}: expected a number, got {text}", file=file, field=field)
        values[row] = float(found[1])
    return values


def _value(block: Any, *tags: str) -> str:
    """The text of the first of some tags that says something."""
    for tag in tags:
        raw = block.find_value(tag)
        text = gemmi().cif.as_string(raw).strip() if raw else ""
        if text not in NOTHING:
            return str(text)
    return ""


def _cell(block: Any, file: str) -> tuple[float, ...] | None:
    """The six parameters, None if the block has none of them."""
    texts = {tag: _value(block, f"_cell.{tag}", f"_cell_{tag}") for tag in CELL_TAGS}
    if not any(texts.values()):
        return None
    values = []
    for tag, text in texts.items():
        found = NUMBER.fullmatch(text)
        if found is None or not float(found[1]) > 0.0:
            raise ScenarioError(
                f"expected a positive number, got {text or 'none'}", file=file, field=f"_cell.{tag}"
            )
        values.append(float(found[1]))
    return tuple(values)


def _group(
    block: Any, cell: tuple[float, ...] | None, file: str
) -> tuple[tuple[str, ...] | None, str]:
    """The operations and the symbol: what the block lists, else what its symbol means."""
    names = [name for tag in GROUP_TAGS for name in (f"_{tag}", f"_{tag.replace('.', '_')}")]
    symbol = _value(block, *names)
    for tag in OPERATION_TAGS:
        listed = [gemmi().cif.as_string(text) for text in block.find_values(tag)]
        if listed:
            return operations_of(listed, file, tag), symbol or "the file's operations"
    if not symbol:
        return None, ""
    found = group_of(symbol, cell, file)
    return tuple(op.triplet() for op in found.operations()), found.xhm()
