"""The frame of a file's coordinates against that of its cell."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, ScenarioError

Array = NDArray[np.float64]

# SCALE has six decimals, so that a cell of 1000 Å is off by 5e-4 of its size.
CONTRADICTION = 3e-3


def read_cell(found: Any, file: str) -> UnitCell:
    """The cell of a gemmi structure, by lengths and angles, with a along x and b in the xy-plane.

    Raises:
        ScenarioError: there is none, or the numbers make none.
    """
    if not found.cell.is_crystal():
        raise ScenarioError(
            "expected a unit cell, there is none; structures that are not from crystals have no "
            "packing. Add the line CRYST1 (in mmCIF: _cell) from the original entry",
            file=file,
            field="CRYST1",
        )
    try:
        return UnitCell.from_parameters(found.cell.parameters[:3], found.cell.parameters[3:])
    except CrystalError as error:
        raise ScenarioError(str(error), file=file, field="CRYST1") from None


def into_cell_frame(found: Any, cell: UnitCell, file: str) -> tuple[Array, Array]:
    """The rotation (3, 3) and shift (3,) that bring a file's coordinates into its cell's frame.

    Records SCALE give fractional coordinates S x + s with few digits. Lengths and angles are
    those of the cell; only the rotation, the nearest one to B S, is taken from S.

    Args:
        found: gemmi's structure.
        cell: its cell, with basis B.
        file: the file's path, for messages.

    Raises:
        ScenarioError: S belongs to another cell, or is no rotation of it.
    """
    if not found.cell.explicit_matrices:
        return np.eye(3), np.zeros(3)
    scale = np.array(found.cell.frac.mat.tolist())
    turn = cell.basis @ scale
    if not np.all(np.isfinite(turn)):
        raise _contradiction(file)
    left, _, right = np.linalg.svd(turn)
    rotation = left @ right
    if np.linalg.det(rotation) < 0.0 or np.abs(turn - rotation).max() > CONTRADICTION:
        raise _contradiction(file)
    return rotation, cell.cartesian(found.cell.frac.vec.tolist())


def _contradiction(file: str) -> ScenarioError:
    return ScenarioError(
        "expected the cell of CRYST1 in another frame, these numbers (in mmCIF: "
        "_atom_sites.fract_transf_matrix) make another cell, or a left-handed one; correct them, "
        "or remove them if the coordinates are in the usual frame (a along x, b in the xy-plane)",
        file=file,
        field="SCALE",
    )
