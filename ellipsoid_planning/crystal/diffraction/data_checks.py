"""Whether a file of reflections belongs to a model's crystal."""

from __future__ import annotations

from ellipsoid_planning.crystal.diffraction.reflection_table import ReflectionTable
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.unit_cell import ANGLES
from ellipsoid_planning.errors import ScenarioError

# A model's cell may be rounded, or measured on another crystal of the same kind.
LENGTH_TOLERANCE = 0.005
ANGLE_TOLERANCE_DEG = 0.5


def check_crystal(table: ReflectionTable, model: PackingModel) -> tuple[str, ...]:
    """Check that the cell and the group are the model's, as far as the file tells them.

    A planar model is compared with a, b and gamma only. Returns what could not be checked.

    Raises:
        ScenarioError: names the length or angle, or the groups.
    """
    _check_cell(table, model)
    _check_group(table, model)
    absent = []
    if table.cell is None:
        absent.append("cell")
    if table.operations is None and model.dimension == 3:
        absent.append("space group")
    return tuple(f"the file tells no {what}: the model's is believed" for what in absent)


def _check_cell(table: ReflectionTable, model: PackingModel) -> None:
    if table.cell is None:
        return
    for name, own, theirs in zip("abc", model.cell.lengths, table.cell, strict=False):
        if abs(own - theirs) > LENGTH_TOLERANCE * own:
            raise _cell_error(table, f"{name} = {own:g}", f"{theirs:g}")
    count = len(model.cell.angles_deg)  # in the plane only gamma
    names, angles = ANGLES[-count:], table.cell[-count:]
    for name, own, theirs in zip(names, model.cell.angles_deg, angles, strict=True):
        if abs(own - theirs) > ANGLE_TOLERANCE_DEG:
            raise _cell_error(table, f"{name} = {own:g}", f"{theirs:g}")


def _cell_error(table: ReflectionTable, expected: str, got: str) -> ScenarioError:
    return ScenarioError(
        f"expected the model's cell with {expected}, got {got}; these data are another crystal's, "
        "or the model's cell is wrong",
        file=table.file,
        field="cell",
    )


def _check_group(table: ReflectionTable, model: PackingModel) -> None:
    if table.operations is None or model.dimension == 2:
        return
    theirs = {Operation.parse(triplet).modulo() for triplet in table.operations}
    if theirs != set(model.group.operations):
        raise ScenarioError(
            f"expected the model's space group {model.group.name}, got {table.group}, or another "
            "setting of it; give the model the data's group, or reindex the data",
            file=table.file,
            field="space group",
        )
