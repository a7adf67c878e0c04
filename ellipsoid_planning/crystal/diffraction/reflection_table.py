"""Files of reflections as tables: MTZ, and structure-factor files in CIF or mmCIF."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.file_content import read_content
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import ScenarioError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MAGNITUDE, INTENSITY, UNCERTAINTY, OTHER = "magnitude", "intensity", "uncertainty", "other"
SUFFIXES = (".mtz", ".cif", ".mmcif", ".ent", ".fcf")
# What other programs call their files of reflections: they hold neither cell nor group, or
# reflections that are not merged.
FOREIGN = (".hkl", ".hklf", ".sca", ".xds", ".cv", ".cns", ".fobs", ".phs", ".ref", ".mrg")
MTZ_MAGIC = b"MTZ "
CIF_START = re.compile(rb"(?:\s|#[^\n]*\n)*data_", re.IGNORECASE)
LARGEST_INDEX = 10**6


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
        notes: what a user should know of how the file was read.
    """

    file: str
    indices: Integers
    kinds: dict[str, str]
    columns: dict[str, Array]
    cell: tuple[float, ...] | None
    operations: tuple[str, ...] | None
    group: str
    notes: tuple[str, ...] = ()


def is_reflection_file(path: str | Path) -> bool:
    """Whether a file is one of reflections, by its name or its first bytes.

    Also true of files that `read_table` refuses because of their format.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix == ".gz":
        return True
    if suffix in SUFFIXES + FOREIGN:
        return True
    try:
        if not file.is_file():
            return False
        with file.open("rb") as stream:
            head = stream.read(4096)
    except (OSError, ValueError):
        return False
    return head.startswith(MTZ_MAGIC) or CIF_START.match(head) is not None


def read_table(path: str | Path, block: str | None = None) -> ReflectionTable:
    """Read an MTZ, CIF or mmCIF file, also compressed by gzip.

    Args:
        path: the file. Its content says which of them it is, then its suffix.
        block: of a CIF file, the name of its data block; the first with reflections by default.

    Raises:
        ScenarioError: if there is no such file, it is none of these, or it is broken.
        CrystalError: if gemmi is missing.
    """
    from ellipsoid_planning.crystal.diffraction.cif_table import cif_table
    from ellipsoid_planning.crystal.diffraction.mtz_table import mtz_table

    file, content = str(path), read_content(path)
    name = Path(path)
    suffix = (name.with_suffix("") if name.suffix.lower() == ".gz" else name).suffix.lower()
    if content.startswith(MTZ_MAGIC) or suffix == ".mtz":
        if block is not None:
            raise ScenarioError(f"an MTZ file has no block {block!r}; leave it out", file=file)
        return mtz_table(file, content)
    if suffix in SUFFIXES or CIF_START.match(content):
        return cif_table(file, content, block)
    raise ScenarioError(
        "expected a file of reflections (.mtz, .cif, .mmcif, also .gz), got "
        f"{suffix or name.name}; files of other programs do not tell cell, space group and "
        "whether values are magnitudes or intensities: make an MTZ or CIF file of it",
        file=file,
    )


def operations_of(triplets: list[str], file: str, field: str) -> tuple[str, ...]:
    """Triplets as gemmi writes them.

    Raises:
        ScenarioError: one is no operation.
    """
    return tuple(_operation(text, file, field) for text in triplets)


def _operation(text: str, file: str, field: str) -> str:
    try:
        return str(gemmi().Op(text.replace(" ", "")).triplet())
    except (RuntimeError, ValueError):
        problem = f"expected a symmetry operation such as -x,y+1/2,-z, got {text!r}"
        raise ScenarioError(problem, file=file, field=field) from None


def group_of(symbol: str, cell: tuple[float, ...] | None, file: str) -> Any:
    """Gemmi's space group of a symbol.

    Raises:
        ScenarioError: there is none of this name.
    """
    angles = (0.0, 0.0) if cell is None else (cell[3], cell[5])
    found = gemmi().find_spacegroup_by_name(symbol, *angles)
    if found is None:
        raise ScenarioError(
            f"there is no space group {symbol!r}, so it cannot be compared with the model's; "
            "correct its Hermann-Mauguin symbol, such as P 21 21 21",
            file=file,
            field="space group",
        )
    return found
