"""Conventional axes of a group, found from its linear parts alone.

The axes are unique up to a few rotations, which `axis_changes` lists, so that two groups of one
type differ, apart from the origin, by one of these (the idea of R. W. Grosse-Kunstleve, Acta
Cryst. A55 (1999) 383-395).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import product

from ellipsoid_planning.crystal.symmetry.exact_matrix import (
    Matrix,
    Number,
    Vector,
    apply,
    determinant,
    dot,
    matrix_order,
    multiply,
    power_sum,
    unit_matrix,
)
from ellipsoid_planning.crystal.symmetry.integer_linear import integer_kernel

System = str
# Generators of the rotations that may still change the axes, as rows.
CHANGES: dict[tuple[int, System], tuple[tuple[tuple[int, ...], ...], ...]] = {
    (3, "triclinic"): (),
    (3, "orthorhombic"): (((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0), (0, 1, 0))),
    (3, "tetragonal"): (((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((1, 0, 0), (0, -1, 0), (0, 0, -1))),
    (3, "hexagonal"): (((1, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 1, 0), (1, 0, 0), (0, 0, -1))),
    (3, "cubic"): (((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0), (0, 1, 0))),
    (2, "oblique"): (),
    (2, "rectangular"): (((0, -1), (1, 0)),),
    (2, "square"): (((0, -1), (1, 0)),),
    (2, "hexagonal"): (((1, -1), (1, 0)),),
}


def crystal_system(rotations: Sequence[Matrix]) -> System:
    """The system of the axes: trigonal groups count as hexagonal."""
    orders = [matrix_order(proper(rotation)) for rotation in rotations]
    flat = len(rotations[0]) == 2
    if 3 in orders:
        turns = {proper(rotation) for rotation in rotations}
        cubic = sum(matrix_order(turn) == 3 for turn in turns) > 2
        return "cubic" if cubic else "hexagonal"
    if 4 in orders:
        return "square" if flat else "tetragonal"
    if flat:
        mirrors = any(determinant(rotation) < 0 for rotation in rotations)
        return "rectangular" if mirrors else "oblique"
    twofold = len({proper(rotation) for rotation in rotations}) - 1
    return {0: "triclinic", 1: "monoclinic"}.get(twofold, "orthorhombic")


def standard_axes(rotations: Sequence[Matrix]) -> Matrix:
    """Right-handed conventional axes of a primitive group, as columns of whole numbers."""
    system = crystal_system(rotations)
    columns = _columns(system, rotations)
    axes: Matrix = tuple(zip(*columns, strict=True))
    if determinant(axes) > 0:
        return axes
    columns[-1] = tuple(-entry for entry in columns[-1])
    return tuple(zip(*columns, strict=True))


@lru_cache(maxsize=16)
def axis_changes(dimension: int, system: System) -> tuple[Matrix, ...]:
    """The changes of axes, in units of these, that standard axes leave open."""
    if system == "monoclinic":
        return _monoclinic_changes()
    generators = [_tuples(rows) for rows in CHANGES[dimension, system]]
    found = [unit_matrix(dimension)]
    for known in found:
        for generator in generators:
            following = multiply(generator, known)
            if following not in found:
                found.append(following)
    return tuple(found)


def proper(rotation: Matrix) -> Matrix:
    """The rotation of a rotation or rotoinversion; in the plane the matrix itself."""
    if len(rotation) == 2 or determinant(rotation) > 0:
        return rotation
    return tuple(tuple(-entry for entry in row) for row in rotation)


def _columns(system: System, rotations: Sequence[Matrix]) -> list[Vector]:
    turns = [proper(rotation) for rotation in rotations]
    dimension = len(turns[0])
    if system in ("triclinic", "oblique"):
        return list(unit_matrix(dimension))
    if system == "rectangular":
        mirror = next(turn for turn in turns if determinant(turn) < 0)
        return [_axis(mirror), _plane(mirror)[0]]
    if system == "monoclinic":
        turn = next(turn for turn in turns if matrix_order(turn) == 2)
        first, second = _reduced(_plane(turn), rotations)
        return [first, _axis(turn), second]
    if system in ("orthorhombic", "cubic"):
        return _three_axes(turns)
    order = 3 if system == "hexagonal" else 4
    turn = next(turn for turn in turns if matrix_order(turn) == order and determinant(turn) == 1)
    shortest = _reduced(_plane(turn), rotations)[0]
    plane = [shortest, apply(turn, shortest)]
    return plane if dimension == 2 else [*plane, _axis(turn)]


def _three_axes(turns: Sequence[Matrix]) -> list[Vector]:
    orders = [matrix_order(turn) for turn in turns]
    order = 4 if 4 in orders else 2
    along = {_axis(turn) for turn, its in zip(turns, orders, strict=True) if its == order}
    return sorted(along, reverse=True)


def _axis(turn: Matrix) -> Vector:
    """The shortest lattice vector along the axis, its first entry other than zero positive."""
    (vector,) = integer_kernel(_plus(turn, -1))
    leading = next(entry for entry in vector if entry)
    return tuple(entry if leading > 0 else -entry for entry in vector)


def _plane(turn: Matrix) -> list[Vector]:
    """A basis of the lattice vectors that the sum of the rotation's powers annihilates."""
    rows = [[int(entry) for entry in row] for row in power_sum(turn)]
    return [tuple(vector) for vector in integer_kernel(rows)]


def _reduced(pair: list[Vector], rotations: Sequence[Matrix]) -> tuple[Vector, Vector]:
    """A reduced basis of a plane's lattice, in a metric that the rotations keep."""
    first, second = pair
    while True:
        if _product(first, first, rotations) > _product(second, second, rotations):
            first, second = second, first
        length = Fraction(_product(first, first, rotations))
        steps = round(_product(first, second, rotations) / length)
        if not steps:
            return first, second
        second = tuple(b - steps * a for a, b in zip(first, second, strict=True))


def _product(first: Vector, second: Vector, rotations: Sequence[Matrix]) -> Number:
    """The scalar product, averaged over the group; up to a factor."""
    return sum(dot(apply(turn, first), apply(turn, second)) for turn in rotations)


def _plus(turn: Matrix, factor: int) -> list[list[int]]:
    return [
        [int(entry) + factor * (i == j) for j, entry in enumerate(row)]
        for i, row in enumerate(turn)
    ]


def _monoclinic_changes() -> tuple[Matrix, ...]:
    """Changes of a and c that represent all of them modulo two, in which glides differ."""
    found: dict[tuple[int, ...], Matrix] = {}
    for a, b, c, d in product((0, 1, -1), repeat=4):
        if a * d - b * c == 1:
            rows = ((a, 0, b), (0, 1, 0), (c, 0, d))
            found.setdefault((a % 2, b % 2, c % 2, d % 2), _tuples(rows))
    return tuple(found.values())


def _tuples(rows: Sequence[Sequence[int]]) -> Matrix:
    return tuple(tuple(row) for row in rows)
