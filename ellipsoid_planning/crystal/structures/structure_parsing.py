"""Coordinates as gemmi reads them, from PDB files of all ages and mmCIF files."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ellipsoid_planning.crystal.file_content import read_content
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import ScenarioError

CIF_START = re.compile(rb"(?:\s|#[^\n]*\n)*data_", re.IGNORECASE)
ATOMS = (b"ATOM  ", b"HETATM")
# Until 1996 the last columns had the entry's name and the line's number, where there are symbols
# of elements and charges now.
OLD_COLUMNS = re.compile(rb"([0-9][0-9A-Z]{3})[ \d]{3}\d")
OLD_LENGTH = 72
SMALL_MOLECULE = ("_atom_site_label", "_atom_site_fract_x")


def parse_structure(path: Path) -> tuple[Any, tuple[str, ...]]:
    """Gemmi's structure, with atoms in its first model, and what a user should know of it.

    Raises:
        ScenarioError: the file cannot be read, or has no atoms of a molecule.
        CrystalError: gemmi is not installed.
    """
    file, content = str(path), read_content(path)
    if CIF_START.match(content):
        found, notes = _from_cif(content, file)
    else:
        found, notes = _from_pdb(content, file)
    if not len(found) or not any(len(residue) for chain in found[0] for residue in chain):
        raise ScenarioError(
            "expected atoms, there are none; is this a file of coordinates?", file=file
        )
    if any(not operation.given for operation in found.ncs):
        raise ScenarioError(
            "the file has only a part of the asymmetric unit, the rest is given by operations; "
            "write out all of it",
            file=file,
            field="MTRIX",
        )
    if len(found) > 1:
        notes += (f"the first of {len(found)} models is read",)
    found.merge_chain_parts()
    found.setup_entities()
    return found, notes


def _from_cif(content: bytes, file: str) -> tuple[Any, tuple[str, ...]]:
    library = gemmi()
    try:
        document = library.cif.read_string(content)
        blocks = [block for block in document if block.find_loop("_atom_site.Cartn_x")]
        if not blocks:
            raise _no_atoms(document, file)
        found = library.make_structure_from_block(blocks[0])
    except (RuntimeError, ValueError) as error:
        raise _unreadable(error, file) from None
    others = ", ".join(block.name for block in blocks[1:])
    told = f"the block {blocks[0].name} is read, and not {others}"
    return found, (told,) if others else ()


def _no_atoms(document: Any, file: str) -> ScenarioError:
    problem = "expected atoms (_atom_site.Cartn_x), there are none"
    if any(block.find_loop(tag) for block in document for tag in SMALL_MOLECULE):
        problem = (
            "expected chains of residues, by which domains are named; this is a small molecule's "
            "file (core CIF), which has none: give a PDB or mmCIF file of a macromolecule"
        )
    elif any(block.find_loop("_refln.index_h") for block in document):
        problem += "; this is a file of reflections, give the one with coordinates"
    return ScenarioError(problem, file=file)


def _from_pdb(content: bytes, file: str) -> tuple[Any, tuple[str, ...]]:
    library = gemmi()
    old = _has_old_columns(content)
    try:
        # Zero means that all columns are read.
        found = library.read_pdb_string(content, max_line_length=OLD_LENGTH if old else 0)
    except (RuntimeError, ValueError) as error:
        raise _unreadable(error, file) from None
    note = f"columns {OLD_LENGTH + 1} to 80 are not read: they have the entry's name and numbers"
    return found, (note,) if old else ()


def _has_old_columns(content: bytes) -> bool:
    """Whether all atoms have one entry's name and a line's number in their last columns."""
    ends = [
        line[OLD_LENGTH:].rstrip(b"\r ") for line in content.split(b"\n") if line.startswith(ATOMS)
    ]
    found = [OLD_COLUMNS.fullmatch(end) for end in ends]
    names = {match[1] if match else None for match in found}
    return len(names) == 1 and None not in names


def _unreadable(error: Exception, file: str) -> ScenarioError:
    return ScenarioError(
        f"expected coordinates in the PDB or mmCIF format (.pdb, .ent, .cif, .gz): "
        f"{' '.join(str(error).split())}",
        file=file,
    )
