"""The type of a space group, whatever its axes and origin."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from math import gcd
from typing import Any

from ellipsoid_planning.crystal.symmetry.catalogue import (
    TYPES,
    gemmi,
    plane_space_group,
    reference_group,
    symbol_of,
)
from ellipsoid_planning.crystal.symmetry.exact_matrix import (
    Matrix,
    Number,
    apply,
    determinant,
    inverse,
    multiply,
)
from ellipsoid_planning.crystal.symmetry.flags import fixing_rows, has_torsion
from ellipsoid_planning.crystal.symmetry.integer_linear import solve_modulo_one
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.plane_catalogue import PLANE_GROUPS
from ellipsoid_planning.crystal.symmetry.primitive import PrimitiveGroup, primitive
from ellipsoid_planning.crystal.symmetry.standard_axes import (
    axis_changes,
    crystal_system,
    standard_axes,
)

Fingerprint = frozenset[tuple[tuple[int, ...], int]]
Classes = frozenset[tuple[tuple[int, int], int]]


def type_number(operations: Sequence[Operation]) -> int | None:
    """The number in the International Tables of the type of these operations.

    Two groups are of one type when a change of axes and origin, in space one that keeps the
    handedness, makes one of the other. All arithmetic is exact.

    Args:
        operations: coset representatives modulo the integer translations, closed.

    Returns:
        1 to 230, in the plane 1 to 17; None if no type fits, which is not known to happen.

    Raises:
        CrystalError: gemmi is missing (for space groups only).
    """
    group = primitive(operations)
    own = _fingerprint(group)
    for number in _candidates(group):
        model = _model(group.dimension, number)
        if _model_fingerprint(group.dimension, number) == own and _is_same_type(group, model):
            return number
    return None


def type_name(operations: Sequence[Operation]) -> str | None:
    """The symbol, such as ``P212121``, of the type of these operations; see `type_number`."""
    number = type_number(operations)
    if number is None:
        return None
    if operations[0].dimension == 2:
        return PLANE_GROUPS[number - 1][1]
    return symbol_of(gemmi().get_spacegroup_reference_setting(number)).partition(":")[0]


def setting_name(operations: Sequence[Operation]) -> str | None:
    """The symbol of the tabulated setting that has just these operations; None: there is none.

    Raises:
        CrystalError: gemmi is missing.
    """
    if operations[0].dimension == 2:
        return None
    library = gemmi()
    if any(library.Op.DEN % t.denominator for op in operations for t in op.translation):
        return None
    ops = [library.Op(operation.triplet()) for operation in operations]
    found = library.find_spacegroup_by_ops(library.GroupOps(ops))
    return symbol_of(found) if found is not None else None


def _is_same_type(group: PrimitiveGroup, model: PrimitiveGroup) -> bool:
    """Whether a change of axes maps the model to the group, up to the origin."""
    rotations = [operation.rotation for operation in group.operations]
    axes = standard_axes(rotations)
    back = inverse(_axes_of(model))
    return any(
        _matches(group, model, multiply(multiply(axes, change), back))
        for change in axis_changes(group.dimension, crystal_system(rotations))
    )


def _matches(group: PrimitiveGroup, model: PrimitiveGroup, change: Matrix) -> bool:
    """Whether this change of the model's primitive axes, and some origin, give the group.

    With the origin's shift s, Q t + (1 - W) s = w modulo the lattice for the generators.
    """
    if any(entry.denominator != 1 for row in change for entry in row):
        return False
    if abs(determinant(change)) != 1:
        return False
    back = inverse(change)
    rows: list[list[int]] = []
    values: list[Number] = []
    for generator in model.generators:
        rotation = multiply(multiply(change, generator.rotation), back)
        image = group.by_rotation.get(rotation)
        if image is None:
            return False
        rows += fixing_rows(image)
        moved = apply(change, generator.translation)
        values += [b - a for a, b in zip(moved, image.translation, strict=True)]
    return not rows or solve_modulo_one(rows, values) is not None


@lru_cache(maxsize=256)
def _axes_of(model: PrimitiveGroup) -> Matrix:
    return standard_axes([operation.rotation for operation in model.operations])


@lru_cache(maxsize=256)
def _model(dimension: int, number: int) -> PrimitiveGroup:
    group = plane_space_group(number) if dimension == 2 else reference_group(number)
    return primitive(group.operations)


@lru_cache(maxsize=256)
def _model_fingerprint(dimension: int, number: int) -> Fingerprint:
    return _fingerprint(_model(dimension, number))


def _fingerprint(group: PrimitiveGroup) -> Fingerprint:
    """What is the same for groups of one type, and differs for most others, at little cost."""
    return frozenset(Counter(_kind(operation) for operation in group.operations).items())


def _kind(operation: Operation) -> tuple[int, ...]:
    rows = fixing_rows(operation)
    entries = gcd(*(entry for row in rows for entry in row))
    torsion = int(has_torsion(operation))
    return (*_class_of(operation.rotation), entries, _minors(rows), torsion)


def _minors(rows: list[list[int]]) -> int:
    """The greatest common divisor of the (2, 2) minors, an invariant of the lattice."""
    pairs = [(i, j) for i in range(len(rows)) for j in range(i)]
    return gcd(
        *(rows[i][k] * rows[j][m] - rows[i][m] * rows[j][k] for i, j in pairs for k, m in pairs)
    )


def _class_of(rotation: Matrix) -> tuple[int, int]:
    trace = sum(rotation[i][i] for i in range(len(rotation)))
    return int(determinant(rotation)), int(trace)


def _candidates(group: PrimitiveGroup) -> tuple[int, ...]:
    """The numbers of the types with the same numbers of linear parts of each kind."""
    counts = Counter(_class_of(operation.rotation) for operation in group.operations)
    return _by_classes(group.dimension).get(frozenset(counts.items()), ())


@lru_cache(maxsize=2)
def _by_classes(dimension: int) -> dict[Classes, tuple[int, ...]]:
    found: dict[Classes, tuple[int, ...]] = {}
    for number in range(1, 1 + (len(PLANE_GROUPS) if dimension == 2 else TYPES)):
        key = _plane_classes(number) if dimension == 2 else _space_classes(number)
        found[key] = (*found.get(key, ()), number)
    return found


def _plane_classes(number: int) -> Classes:
    model = _model(2, number)
    return frozenset(Counter(_class_of(op.rotation) for op in model.operations).items())


def _space_classes(number: int) -> Classes:
    # From gemmi's integers: reading all 230 groups exactly would take a second.
    found = gemmi().get_spacegroup_reference_setting(number).operations()
    return frozenset(Counter(_gemmi_class(op) for op in found.sym_ops).items())


def _gemmi_class(op: Any) -> tuple[int, int]:
    size = op.DEN
    trace = sum(op.rot[i][i] for i in range(3)) // size
    return op.det_rot() // size**3, trace
