"""Crystal structures from PDB and mmCIF files: atoms, unit cell and space group."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.structures.frame import into_cell_frame, read_cell
from ellipsoid_planning.crystal.structures.structure_parsing import parse_structure
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi, space_group
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, ScenarioError

Array = NDArray[np.float64]
Texts = NDArray[np.str_]

WATER_MASS = 18.015  # [Da], lost by each residue that joins a chain
HYDROGEN_MASS = 1.008  # [Da]
LOST_HYDROGENS = 2  # with that water


@dataclass(frozen=True, eq=False)
class Atoms:
    """The atoms of a structure, heavier than hydrogen and not of water; arrays are read-only.

    Attributes:
        positions: Cartesian, in the cell's frame, shape (m, 3) [Å].
        masses: with occupancies, and each with its share of the hydrogens of its residue, which
            most files leave out, shape (m,) [Da].
        electrons: likewise, with those of hydrogens, shape (m,).
        radii: van der Waals radii, shape (m,) [Å].
        occupancies: shape (m,); alternative positions of an atom share one atom.
        b_factors: isotropic, shape (m,) [Å²].
        elements: symbols, shape (m,).
        names: such as CA, shape (m,).
        chains: names of chains, in mmCIF files those of the authors, shape (m,).
        residues: sequence numbers, in mmCIF files those of the authors, shape (m,).
        insertions: insertion codes of residues, mostly empty, shape (m,).
        polymer: true for atoms of a chain, false for ligands and ions, shape (m,).
    """

    positions: Array
    masses: Array
    electrons: Array
    radii: Array
    occupancies: Array
    b_factors: Array
    elements: Texts
    names: Texts
    chains: Texts
    residues: NDArray[np.int64]
    insertions: Texts
    polymer: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.positions)

    def residue(self, row: int) -> tuple[int, str]:
        """The number and insertion code of an atom's residue."""
        return int(self.residues[row]), str(self.insertions[row])

    def residue_name(self, row: int) -> str:
        """The same as text, such as 52 or 52A."""
        return "{}{}".format(*self.residue(row))


@dataclass(frozen=True, eq=False)
class CrystalStructure:
    """Atoms of one asymmetric unit in their unit cell.

    Attributes:
        name: the entry's, or the file's without its suffix.
        file: where it came from.
        title: what the file says it is, possibly nothing.
        cell: with a along x and b in the xy-plane; coordinates of other frames are moved there.
        group: in the file's setting.
        atoms: of the first model.
        notes: what a user should know of how the file was read.
    """

    name: str
    file: str
    title: str
    cell: UnitCell
    group: SpaceGroup
    atoms: Atoms
    notes: tuple[str, ...] = ()

    @property
    def chains(self) -> tuple[str, ...]:
        """The names of the chains that have polymers, in the order of the file."""
        return tuple(dict.fromkeys(self.atoms.chains[self.atoms.polymer].tolist()))


def read_structure(path: str | Path) -> CrystalStructure:
    """Read a PDB or mmCIF file, also compressed by gzip.

    Waters, hydrogens and all models but the first are left out; alternative positions are kept
    with their occupancies.

    Raises:
        ScenarioError: the file cannot be read, has no atoms, cell or space group, or they
            contradict each other; names the file, what is missing and the remedy.
        CrystalError: gemmi is not installed.
    """
    file = str(path)
    library = gemmi()
    found, notes = parse_structure(Path(path))
    cell, group = read_cell(found, file), _group(library, found, file)
    try:
        group.check_cell(cell)
    except CrystalError as error:
        raise ScenarioError(str(error), file=file, field="CRYST1") from None
    frame = into_cell_frame(found, cell, file)
    atoms = _atoms(library, found, file, frame)
    if found.cell.explicit_matrices:
        notes += ("the coordinates are moved into the frame of the cell (SCALE has another)",)
    name = _info(found, "_entry.id") or Path(path).name.split(".")[0] or "structure"
    title = " ".join(_info(found, "_struct.title").split())
    return CrystalStructure(name, file, title, cell, group, atoms, notes)


def _info(found: Any, tag: str) -> str:
    return str(found.info[tag]) if tag in found.info else ""


def _group(library: Any, found: Any, file: str) -> SpaceGroup:
    symbol = found.spacegroup_hm
    if not symbol:
        raise ScenarioError(
            "expected a space group after the unit cell, there is none; add its Hermann-Mauguin "
            "symbol, such as P 21 21 21",
            file=file,
            field="CRYST1",
        )
    entry = library.find_spacegroup_by_name(symbol, found.cell.alpha, found.cell.gamma)
    try:
        return space_group(symbol if entry is None else entry.xhm())
    except CrystalError as error:
        raise ScenarioError(str(error), file=file, field="CRYST1") from None


def _atoms(library: Any, found: Any, file: str, frame: tuple[Array, Array]) -> Atoms:
    """The atoms of the first model that count, moved by a rotation and a shift."""
    rows: list[tuple[Any, ...]] = []
    for chain in found[0]:
        for residue in chain:
            rows += _rows(library, chain.name, residue)
    if not rows:
        raise ScenarioError("expected atoms other than of hydrogen and water", file=file)
    columns = list(zip(*rows, strict=True))
    positions = np.array(columns[0], dtype=float)
    if not np.all(np.isfinite(positions)):
        raise ScenarioError("expected finite coordinates of all atoms", file=file)
    positions = positions @ frame[0].T + frame[1]
    numbers = [_read_only(np.array(column, dtype=float)) for column in columns[1:6]]
    texts = [_read_only(np.array(column, dtype=np.str_)) for column in columns[6:9]]
    return Atoms(
        positions=_read_only(positions),
        masses=numbers[0],
        electrons=numbers[1],
        radii=numbers[2],
        occupancies=numbers[3],
        b_factors=numbers[4],
        elements=texts[0],
        names=texts[1],
        chains=texts[2],
        residues=_read_only(np.array(columns[9], dtype=np.int64)),
        insertions=_read_only(np.array(columns[10], dtype=np.str_)),
        polymer=_read_only(np.array(columns[11], dtype=np.bool_)),
    )


def _rows(library: Any, chain: str, residue: Any) -> list[tuple[Any, ...]]:
    """A residue's atoms, in the order of the fields of `Atoms`."""
    if residue.is_water():
        return []
    polymer = residue.entity_type == library.EntityType.Polymer
    factor = _hydrogen_factor(library, residue, polymer)
    atoms = [atom for atom in residue if not atom.element.is_hydrogen and atom.occ > 0.0]
    return [_row(chain, residue, atom, factor, polymer) for atom in atoms]


def _row(chain: str, residue: Any, atom: Any, factor: float, polymer: bool) -> tuple[Any, ...]:
    element = atom.element
    mass = element.weight * factor * atom.occ
    hydrogens = element.weight * (factor - 1.0) / HYDROGEN_MASS
    electrons = (element.atomic_number + hydrogens) * atom.occ
    numbers = mass, electrons, element.vdw_r, atom.occ, atom.b_iso
    texts = element.name, atom.name, chain
    return (
        atom.pos.tolist(),
        *numbers,
        *texts,
        residue.seqid.num,
        residue.seqid.icode.strip(),
        polymer,
    )


def _hydrogen_factor(library: Any, residue: Any, polymer: bool) -> float:
    """A residue's mass over that without hydrogens; 1 for those that are not tabulated."""
    known = library.find_tabulated_residue(residue.name)
    if not known.found() or known.weight <= 0.0:
        return 1.0
    mass = known.weight - (WATER_MASS if polymer else 0.0)
    hydrogens = known.hydrogen_count - (LOST_HYDROGENS if polymer else 0)
    heavy = mass - HYDROGEN_MASS * hydrogens
    return float(mass / heavy) if heavy > 0.0 and hydrogens > 0 else 1.0


def _read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.setflags(write=False)
    return array
