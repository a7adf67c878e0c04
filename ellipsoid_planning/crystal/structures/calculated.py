"""Structure factors of real atoms, the data that a packing model is compared with."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning import atomic
from ellipsoid_planning.crystal.structures.solvent import solvent_factors
from ellipsoid_planning.crystal.structures.structure import CrystalStructure
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError

Array = NDArray[np.float64]

AT_ONCE = 1 << 18  # waves that are summed together
MOST_REFLECTIONS = 1_000_000


@dataclass(frozen=True, eq=False)
class CalculatedFactors:
    """Structure factors of a crystal's unique reflections.

    Attributes:
        cell: the unit cell.
        group: its group.
        hkl: indices, shape (m, 3), without (0, 0, 0) and the group's absences.
        values: complex, shape (m,) [electrons].
    """

    cell: UnitCell
    group: SpaceGroup
    hkl: NDArray[np.int64]
    values: NDArray[np.complex128]

    @property
    def amplitudes(self) -> Array:
        """The magnitudes, shape (m,) [electrons]."""
        return np.abs(self.values)

    @property
    def spacings(self) -> Array:
        """Of the lattice planes, shape (m,) [Å]."""
        return np.asarray(1.0 / np.linalg.norm(self.hkl @ self.cell.reciprocal.T, axis=1))


def calculated_factors(
    structure: CrystalStructure, resolution: float, *, solvent: bool = False
) -> CalculatedFactors:
    """The structure factors of a structure to a resolution [Å]; see `factors_at`.

    Args:
        structure: the molecule.
        resolution: smallest spacing of the lattice planes [Å].
        solvent: fill the space between the molecules with flat solvent, as in real crystals: it
            leaves only a fifth of the contrast. Otherwise there is a vacuum.

    Raises:
        CrystalError: the resolution is not positive, leaves no reflections or too many.
    """
    if not (math.isfinite(resolution) and resolution > 0.0):
        raise CrystalError(f"resolution {resolution:g}: expected a positive length in ångström")
    hkl = _reflections(structure, resolution)
    values = factors_at(structure, hkl)
    if solvent:
        values += solvent_factors(structure, hkl)
    return CalculatedFactors(structure.cell, structure.group, hkl, values)


def factors_at(structure: CrystalStructure, hkl: NDArray[np.int64]) -> NDArray[np.complex128]:
    """The structure factors (m,) [electrons] of a structure's atoms at indices (m, 3).

    The sum over all atoms, exactly, with their occupancies, isotropic B factors and X-ray form
    factors. Hydrogens ride on the other atoms of their residues.
    """
    atoms, group = structure.atoms, structure.group
    squares = 0.25 * np.sum((hkl @ structure.cell.reciprocal.T) ** 2, axis=1)
    weights = atoms.occupancies * _form_factors(structure, squares)
    fractional = structure.cell.fractional(atoms.positions)
    total = np.zeros(len(hkl), dtype=np.complex128)
    for rotation, translation in zip(group.rotations, group.translations, strict=True):
        # h · (W x + w) for all atoms x: the waves of the indices h W.
        phase = np.exp(2j * math.pi * (hkl @ translation))
        total += phase * _waves(hkl @ rotation, fractional, weights)
    return total


def _reflections(structure: CrystalStructure, resolution: float) -> NDArray[np.int64]:
    expected = 2.1 * structure.cell.volume / resolution**3 / structure.group.order
    if expected > MOST_REFLECTIONS:
        raise CrystalError(
            f"resolution {resolution:g}: there are about {expected:.0f} unique reflections, "
            f"expected at most {MOST_REFLECTIONS}; choose a coarser one"
        )
    library = gemmi()
    made = library.UnitCell(*structure.cell.lengths, *structure.cell.angles_deg)
    entry = library.find_spacegroup_by_name(structure.group.name, prefer="2H")
    hkl = np.array(library.make_miller_array(made, entry, resolution), dtype=np.int64)
    hkl = hkl.reshape(-1, 3)
    hkl = hkl[np.any(hkl != 0, axis=1)]
    if not len(hkl):
        raise CrystalError(
            f"resolution {resolution:g}: there are no reflections; choose one below "
            f"{structure.cell.lengths.max():g}"
        )
    return hkl


def _form_factors(structure: CrystalStructure, squares: Array) -> Array:
    """X-ray form factors with B factors for (sin θ/λ)² of (m,) reflections, shape (m, atoms)."""
    library = gemmi()
    atoms = structure.atoms
    kinds, which = np.unique(atoms.elements, return_inverse=True)
    found = [library.Element(symbol) for symbol in kinds.tolist()]
    table = np.empty((len(squares), len(kinds)))
    for column, element in enumerate(found):
        if element.it92 is None:
            raise CrystalError(f"{structure.file}: there is no form factor of {element.name!r}")
        table[:, column] = [element.it92.calculate_sf(square) for square in squares]
    hydrogen = library.Element("H").it92
    riding = np.array([hydrogen.calculate_sf(square) for square in squares])
    bare = np.array([element.atomic_number for element in found], dtype=float)[which]
    whole = table[:, which] + np.outer(riding, atoms.electrons / atoms.occupancies - bare)
    return np.asarray(whole * np.exp(-np.outer(squares, atoms.b_factors)))


def _waves(hkl: Array, points: Array, weights: Array) -> NDArray[np.complex128]:
    """The sums over points x (a, 3) of weights (m, a) times exp(2πi h·x), for integers h."""
    places = np.rint(hkl).astype(np.int64)
    reach = int(np.abs(places).max())
    # Few different waves along each axis; the others are their products.
    steps = 2j * math.pi * np.arange(-reach, reach + 1)
    along = [np.exp(np.outer(steps, points[:, axis])) for axis in range(3)]
    found = np.empty(len(places), dtype=np.complex128)
    step = max(1, AT_ONCE // len(points))
    for start in range(0, len(places), step):
        rows = slice(start, start + step)
        first, second, third = (places[rows] + reach).T
        waves = along[0][first] * along[1][second]
        waves *= along[2][third]
        found[rows] = np.einsum("ma,ma->m", weights[rows], waves)
    return found


def write_mtz(factors: CalculatedFactors, path: str | Path, title: str = "") -> None:
    """Write magnitudes FC and phases PHIC [degree] as an MTZ file.

    Raises:
        CrystalError: the file cannot be written.
    """
    library = gemmi()
    cell = library.UnitCell(*factors.cell.lengths, *factors.cell.angles_deg)
    mtz = library.Mtz(with_base=True)
    mtz.title = title[:70]
    mtz.spacegroup = library.find_spacegroup_by_name(factors.group.name, prefer="2H")
    mtz.set_cell_for_all(cell)
    mtz.add_dataset("calculated")
    mtz.set_cell_for_all(cell)
    mtz.add_column("FC", "F")
    mtz.add_column("PHIC", "P")
    phases = np.degrees(np.angle(factors.values))
    columns = [factors.hkl.T, factors.amplitudes[None], phases[None]]
    mtz.set_data(np.ascontiguousarray(np.concatenate(columns).T, dtype=np.float32))
    try:
        atomic.write_bytes(path, mtz.write_to_bytes())
    except OSError as error:
        raise CrystalError(f"{path}: cannot write the file: {error.strerror}") from None
