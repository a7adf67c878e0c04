"""The disordered solvent between the molecules of a crystal: its mask's structure factors."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.structures.structure import CrystalStructure
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi

# The mean over many entries of the flat model; Fokine and Urzhumtsev, Acta Cryst. D58 (2002) 1387.
DENSITY = 0.35  # [electrons/Å³]
B_FACTOR = 46.0  # [Å²]
SPACING = 0.7  # of the mask's grid [Å], in cells that are not huge
MOST_POINTS = 3e7


def solvent_factors(structure: CrystalStructure, hkl: NDArray[np.int64]) -> NDArray[np.complex128]:
    """The structure factors (m,) [electrons] of flat solvent around a structure's atoms.

    Args:
        structure: the molecule.
        hkl: indices (m, 3), in gemmi's asymmetric unit.
    """
    library = gemmi()
    whole = _gemmi_structure(library, structure)
    grid = library.FloatGrid()
    grid.setup_from(whole, spacing=max(SPACING, (structure.cell.volume / MOST_POINTS) ** (1 / 3)))
    masker = library.SolventMasker(library.AtomicRadiiSet.Cctbx)
    masker.put_mask_on_float_grid(grid, whole[0])
    lengths = np.linalg.norm(hkl @ structure.cell.reciprocal.T, axis=1)
    waves = library.transform_map_to_f_phi(grid)
    data = waves.prepare_asu_data(dmin=0.999 / float(lengths.max()))
    places = {tuple(place): k for k, place in enumerate(data.miller_array.tolist())}
    rows = [places[tuple(place)] for place in hkl.tolist()]
    smooth = DENSITY * np.exp(-0.25 * B_FACTOR * lengths**2)
    return np.asarray(smooth * np.array(data.value_array)[rows], dtype=np.complex128)


def _gemmi_structure(library: Any, structure: CrystalStructure) -> Any:
    """The atoms as one residue of gemmi's."""
    whole = library.Structure()
    whole.cell = library.UnitCell(*structure.cell.lengths, *structure.cell.angles_deg)
    group = library.find_spacegroup_by_name(structure.group.name, prefer="2H")
    whole.spacegroup_hm = group.xhm()
    whole.setup_cell_images()
    atoms, residue = structure.atoms, library.Residue()
    for place, symbol in zip(atoms.positions.tolist(), atoms.elements.tolist(), strict=True):
        atom = library.Atom()
        atom.element, atom.pos = library.Element(symbol), library.Position(*place)
        residue.add_atom(atom)
    chain, model = library.Chain("A"), library.Model(1)
    chain.add_residue(residue)
    model.add_chain(chain)
    whole.add_model(model)
    return whole
