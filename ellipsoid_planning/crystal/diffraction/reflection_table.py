"""Files of reflections as tables: MTZ, and structure-factor files in CIF or mmCIF."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import ScenarioError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MAGNITUDE, INTENSITY, UNCERTAINTY, OTHER = "magnitude", "intensity", "uncertainty", "other"
MTZ_KINDS = {"F": MAGNITUDE, "J": INTENSITY, "Q": UNCERTAINTY}
CIF_KINDS = {
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
CELL_TAGS = ("length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma")
LARGEST_INDEX = 10**6
# A number of CIF, with its uncertainty in brackets or without.
NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:\(\d+\))?")


@dataclass(frozen=True, eq=False)
class ReflectionTable:
    """What a file of reflections says.

    Attributes:
        file: its path.
        indices: (N, 3), Miller indices.
        kinds: by column: MAGNITUDE, INTENSITY, UNCERTAINTY or OTHER, in the file's order.
        columns: (N,) by column, NaN where the file has no value.
        cell: a, b, c, alpha, beta, gamma [degree]; None where the file says nothing.
        operations: triplets of the space group; None where the file says nothing.
        group: the space group's symbol.
    """

    file: str
    indices: Integers
    kinds: dict[str, str]
    columns: dict[str, Array]
    cell: tuple[float, ...] | None
    operations: tuple[str, ...] | None
    group: str


def read_table(path: str | Path) -> ReflectionTable:
    """Read an ``.mtz``, ``.cif`` or ``.mmcif`` file.

    Raises:
        ScenarioError: if there is no such file, it is none of these, or it is broken.
        CrystalError: if gemmi is missing.
    """
    readers: dict[str, Callable[[str], ReflectionTable]] = {
        ".mtz": _read_mtz,
        ".cif": _read_cif,
        ".mmcif": _read_cif,
        ".ent": _read_cif,
    }
    file = Path(path)
    reader = readers.get(file.suffix.lower())
    if reader is None:
        raise ScenarioError(
            "expected a file of reflections (.mtz, .cif or .mmcif), got "
            + (file.suffix or file.name),
            file=str(path),
        )
    if not file.is_file():
        raise ScenarioError("no such file", file=str(path))
    return reader(str(path))


def _read_mtz(file: str) -> ReflectionTable:
    library = gemmi()
    try:
        mtz = library.read_mtz_file(file)
    except (RuntimeError, OSError, ValueError) as error:
        raise ScenarioError(f"this is no readable MTZ file: {error}", file=file) from error
    if mtz.nreflections == 0 or len(mtz.columns) < 3:
        raise ScenarioError("expected reflections, the file has none", file=file)
    columns = list(mtz.columns)[3:]
    group = mtz.spacegroup
    return ReflectionTable(
        file,
        np.array(mtz.make_miller_array(), dtype=np.int64),
        {column.label: MTZ_KINDS.get(column.type, OTHER) for column in columns},
        {column.label: np.array(column, dtype=float) for column in columns},
        tuple(mtz.cell.parameters) if mtz.cell.is_crystal() else None,
        _triplets(group),
        group.xhm() if group is not None else "",
    )


def _triplets(group: Any) -> tuple[str, ...] | None:
    return None if group is None else tuple(op.triplet() for op in group.operations())


def _read_cif(file: str) -> ReflectionTable:
    library = gemmi()
    try:
        document = library.cif.read(file)
    except (RuntimeError, OSError, ValueError) as error:
        raise ScenarioError(f"this is no readable CIF file: {error}", file=file) from error
    for block in document:
        for prefix in ("_refln.", "_refln_"):
            if block.find_loop(f"{prefix}index_h"):
                return _cif_table(file, block, prefix)
    raise ScenarioError(
        "expected a loop of reflections with _refln.index_h, the file has none; this may be a "
        "file of coordinates, give the one with structure factors",
        file=file,
    )


def _cif_table(file: str, block: Any, prefix: str) -> ReflectionTable:
    known = {tag.lower(): tag for tag in CIF_KINDS}  # CIF's names do not depend on case
    tags = [
        tag[len(prefix) :].lower() for tag in block.find_loop(f"{prefix}index_h").get_loop().tags
    ]
    indices = []
    for name in ("index_h", "index_k", "index_l"):
        if name not in tags:
            raise ScenarioError("this column is missing", file=file, field=prefix + name)
        values = _numbers(file, prefix + name, block.find_loop(prefix + name))
        if not np.all((values == np.round(values)) & (np.abs(values) <= LARGEST_INDEX)):
            raise ScenarioError("expected whole numbers only", file=file, field=prefix + name)
        indices.append(values.astype(np.int64))
    kinds = {known[tag]: CIF_KINDS[known[tag]] for tag in tags if tag in known}
    columns = {}
    for tag, kind in kinds.items():
        texts = list(block.find_loop(prefix + tag))
        if kind == UNCERTAINTY:  # what is odd there is as good as nothing
            texts = [text if NUMBER.fullmatch(text) else "?" for text in texts]
        columns[tag] = _numbers(file, prefix + tag, texts, indices)
    group = _cif_group(block)
    name = group.xhm() if group is not None else ""
    cell = _cif_cell(block)
    return ReflectionTable(
        file, np.stack(indices, axis=1), kinds, columns, cell, _triplets(group), name
    )


def _numbers(
    file: str, field: str, texts: Sequence[str], indices: Sequence[Integers] | None = None
) -> Array:
    """The numbers of a column; NaN for ``?`` and ``.``, which say that there is none."""
    values = np.full(len(texts), np.nan)
    for row, text in enumerate(texts):
        if text in ("?", "."):
            continue
        found = NUMBER.fullmatch(text)
        if found is None:
            where = f"row {row + 1}"
            if indices is not None:
                where = f"reflection {tuple(int(column[row]) for column in indices)}"
            raise ScenarioError(f"{where}: expected a number, got {text}", file=file, field=field)
        values[row] = float(found[1])
    return values


def _cif_cell(block: Any) -> tuple[float, ...] | None:
    values = []
    for tag in CELL_TAGS:
        text = block.find_value(f"_cell.{tag}") or block.find_value(f"_cell_{tag}")
        found = NUMBER.fullmatch(text) if text else None
        if found is None:
            return None
        values.append(float(found[1]))
    return tuple(values)


def _cif_group(block: Any) -> Any:
    library = gemmi()
    for tag in GROUP_TAGS:
        for name in (f"_{tag}", f"_{tag.replace('.', '_')}"):
            text = block.find_value(name)
            if text:
                return library.find_spacegroup_by_name(library.cif.as_string(text))
    return None
