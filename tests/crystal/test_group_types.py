"""Types of groups in any axes and with any origin, against spglib."""

from fractions import Fraction

import numpy as np
import pytest
import spglib

from ellipsoid_planning.crystal import Operation, space_group
from ellipsoid_planning.crystal.symmetry.names import setting_name, type_name, type_number
from ellipsoid_planning.crystal.symmetry.plane_catalogue import PLANE_GROUPS
from ellipsoid_planning.crystal.symmetry.subgroups import all_subgroups

# spglib warns of how it reports errors, which it does not do here.
pytestmark = pytest.mark.filterwarnings("ignore:.*OLD_ERROR_HANDLING:DeprecationWarning")

SHIFT = (Fraction(1, 7), Fraction(2, 11), Fraction(3, 13))


def test_all_groups_with_another_origin_and_other_axes():
    random = np.random.default_rng(3)
    for number in range(1, 231):
        operations = space_group(number).operations
        assert type_number(_moved(operations, random)) == number


def test_plane_groups_with_another_origin_and_other_axes():
    random = np.random.default_rng(4)
    for number, name, _ in PLANE_GROUPS:
        for _ in range(5):
            operations = _moved(space_group(name).operations, random)
            assert (type_number(operations), type_name(operations)) == (number, name)


@pytest.mark.parametrize(
    "name",
    ["P212121", "C2/c", "R-3m", "P6122", "I41/a", "Pbcn", "Fdd2", "P4132", "F4132", "P-43n"],
)
def test_types_of_subgroups_are_spglib_s(name):
    group = space_group(name)
    for elements in {s.conjugacy_class: list(s.elements) for s in all_subgroups(group)}.values():
        operations = [group.operations[index] for index in elements]
        rotations = np.array(group.integer_rotations[elements], dtype="intc")
        theirs = spglib.get_spacegroup_type_from_symmetry(rotations, group.translations[elements])
        assert type_number(operations) == theirs.number


def test_mirror_images_swap_the_pairs():
    mirror = Operation.parse("y,x,z")
    for one, two in (("P41", "P43"), ("P6122", "P6522"), ("P3121", "P3221"), ("P4132", "P4332")):
        operations = space_group(one).operations
        assert type_name([mirror @ op @ mirror for op in operations]) == two
    same = [mirror @ op @ mirror for op in space_group("P212121").operations]
    assert type_name(same) == "P212121"


def test_supercells_and_settings():
    doubled = list(space_group("P21").operations)
    doubled += [Operation.parse("x+1/2,y,z") @ op for op in space_group("P21").operations]
    assert type_name([op.modulo() for op in doubled]) == "P21"
    assert setting_name(space_group("P112").operations) == "P112"
    assert type_name(space_group("P112").operations) == "P2"
    assert type_name(space_group("R32:R").operations) == "R32"
    shifted = _moved(space_group("P21").operations, np.random.default_rng(0))
    assert setting_name(shifted) is None
    assert setting_name(space_group("p2").operations) is None


def _moved(operations, random):
    """The operations about another origin, in the axes of a random unimodular matrix."""
    dimension = operations[0].dimension
    change = Operation.shift(SHIFT[:dimension])
    for _ in range(4):
        i, j = random.permutation(dimension)[:2]
        rows = np.eye(dimension, dtype=int)
        rows[i, j] = random.integers(-2, 3)
        change = Operation(tuple(map(tuple, rows.tolist())), (0,) * dimension) @ change
    back = change.inverse()
    return [(change @ operation @ back).modulo() for operation in operations]
