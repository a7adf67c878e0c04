"""Whether a unit cell fits a group: its metric tensor must be invariant under the group."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.unit_cell import ANGLES, LENGTHS, UnitCell
from ellipsoid_planning.errors import CrystalError

TOLERANCE = 1e-6  # relative; cells in files are rounded
ROUNDING = 1e-15  # the same of numbers that are not
FIXED_ANGLES = (60.0, 90.0, 120.0)


def check_cell(name: str, rotations: NDArray[np.int64], cell: UnitCell) -> None:
    """Check that the linear parts (m, n, n) of a group are isometries of the cell.

    Raises:
        CrystalError: names the group and the length or angle that does not fit.
    """
    dimension = rotations.shape[1]
    if cell.dimension != dimension:
        raise CrystalError(
            f"{name}: expected a cell in {dimension} dimensions, got one in {cell.dimension}"
        )
    moved = rotations.transpose(0, 2, 1) @ cell.metric @ rotations
    scale = np.outer(cell.lengths, cell.lengths)
    errors = np.max(np.abs(moved - cell.metric) / scale, axis=(1, 2))
    if np.max(errors) <= TOLERANCE:
        return
    worst = rotations[int(np.argmax(errors))].tolist()
    general = f"its linear part {worst} does not keep the cell's lengths and angles"
    problems = _problems(_generic_cell(rotations), cell) or [general]
    raise CrystalError(
        f"{name}: {'; '.join(problems)}; change the cell or choose the group that it fits"
    )


def fitted_cell(rotations: NDArray[np.int64], cell: UnitCell) -> UnitCell:
    """The cell whose metric is the mean over the linear parts (m, n, n): they are its isometries.

    A cell that fits already is given back; one that was rounded in a file changes in its last
    digits.
    """
    metric = np.mean(rotations.transpose(0, 2, 1) @ cell.metric @ rotations, axis=0)
    lengths = np.sqrt(np.diag(metric))
    scale = np.outer(lengths, lengths)
    if np.max(np.abs(metric - cell.metric) / scale) <= ROUNDING:
        return cell
    upright = np.linalg.cholesky(cell.metric).T
    turn = cell.basis @ np.linalg.inv(upright)
    return UnitCell(turn @ np.linalg.cholesky(metric).T)


def _generic_cell(rotations: NDArray[np.int64]) -> UnitCell:
    """A cell that fits the group, and has no equal lengths or special angles by accident."""
    dimension = rotations.shape[1]
    start = np.diag([1.0, 1.7, 2.9][:dimension])
    start += 0.1 * np.array([[0, 1, 3], [1, 0, 2], [3, 2, 0]])[:dimension, :dimension]
    metric = np.mean(rotations.transpose(0, 2, 1) @ start @ rotations, axis=0)
    return UnitCell(np.linalg.cholesky(metric).T)


def _problems(model: UnitCell, cell: UnitCell) -> list[str]:
    """What all cells of the group have in common, and this cell has not."""
    return [
        *_unequal(LENGTHS, model.lengths.tolist(), cell.lengths.tolist(), ""),
        *_wrong_angles(model, cell),
        *_unequal(_angle_names(cell), _free_angles(model), list(cell.angles_deg), " degrees"),
    ]


def _unequal(
    names: tuple[str, ...], model: list[float], found: list[float], unit: str
) -> list[str]:
    """Pairs that are equal in the model and not in what was found."""
    equal = [
        f"expected {names[i]} = {names[j]}, got {names[i]} = {found[i]:.10g} and "
        f"{names[j]} = {found[j]:.10g}{unit}"
        for i, j in combinations(range(len(found)), 2)
        if _close(model[i], model[j]) and not _close(found[i], found[j])
    ]
    return equal[:2] if len(equal) == 3 else equal


def _wrong_angles(model: UnitCell, cell: UnitCell) -> list[str]:
    problems = []
    named = zip(_angle_names(cell), model.angles_deg, cell.angles_deg, strict=True)
    for name, expected, found in named:
        special = _special_angle(expected)
        if special is not None and not _close(special, found):
            problems.append(f"expected {name} = {special:g}, got {found:.10g} degrees")
    return problems


def _free_angles(model: UnitCell) -> list[float]:
    """The model's angles, those with a fixed value replaced by numbers that equal nothing."""
    angles = model.angles_deg
    return [-i if _special_angle(angle) else angle for i, angle in enumerate(angles, start=1)]


def _special_angle(angle: float) -> float | None:
    return next((special for special in FIXED_ANGLES if _close(special, angle)), None)


def _angle_names(cell: UnitCell) -> tuple[str, ...]:
    return ANGLES[2:] if cell.dimension == 2 else ANGLES


def _close(first: float, second: float) -> bool:
    return abs(first - second) <= TOLERANCE * max(abs(first), abs(second))
