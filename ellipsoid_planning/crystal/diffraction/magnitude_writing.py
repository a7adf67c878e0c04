"""Magnitudes as MTZ files."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from ellipsoid_planning.atomic import write_bytes
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.symmetry.catalogue import gemmi
from ellipsoid_planning.errors import CrystalError


def write_magnitudes(path: str | Path, magnitudes: Magnitudes, model: PackingModel) -> None:
    """Write magnitudes to an MTZ file: column FP, and SIGFP if there are uncertainties.

    MTZ files hold numbers of single precision. Planar data become reflections with l = 0 of a
    cell in P1 with c = 1.

    Raises:
        CrystalError: if the model's group has no tabulated setting with just its operations, or
            gemmi is missing.
        OSError: if the file cannot be written.
    """
    library = gemmi()
    mtz = library.Mtz(with_base=True)
    mtz.spacegroup = _tabulated(model)
    mtz.set_cell_for_all(library.UnitCell(*_parameters(model)))
    mtz.add_dataset("data")
    mtz.add_column("FP", "F")
    columns = np.zeros((len(magnitudes), 4))
    columns[:, : model.dimension] = magnitudes.indices
    columns[:, 3] = magnitudes.values
    if magnitudes.sigmas is not None:
        mtz.add_column("SIGFP", "Q")
        columns = np.column_stack([columns, magnitudes.sigmas])
    mtz.set_data(columns.astype(np.float32))
    with tempfile.TemporaryDirectory() as folder:
        beside = Path(folder) / "magnitudes.mtz"
        mtz.write_to_file(str(beside))
        write_bytes(path, beside.read_bytes())


def _parameters(model: PackingModel) -> tuple[float, ...]:
    if model.dimension == 2:
        return (*model.cell.lengths.tolist(), 1.0, 90.0, 90.0, *model.cell.angles_deg)
    return (*model.cell.lengths.tolist(), *model.cell.angles_deg)


def _tabulated(model: PackingModel) -> object:
    library = gemmi()
    if model.dimension == 2:
        return library.find_spacegroup_by_name("P 1")
    ops = [library.Op(operation.triplet()) for operation in model.group.operations]
    found = library.find_spacegroup_by_ops(library.GroupOps(ops))
    if found is None:
        raise CrystalError(
            f"{model.group.name}: no tabulated setting has these operations, which an MTZ file "
            "needs; choose the group's standard axes and origin"
        )
    return found
