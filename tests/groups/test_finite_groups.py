"""The finite groups of rotations are groups, of the right size, about the right axes."""

import numpy as np
import pytest

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import (
    cyclic,
    dihedral,
    group_by_name,
    icosahedral,
    octahedral,
    tetrahedral,
)
from ellipsoid_planning.groups.finite_groups import FiniteGroup
from ellipsoid_planning.groups.quaternions import angle, product
from tests.groups.checks import probes

GROUPS = [
    tetrahedral(),
    octahedral(),
    icosahedral(),
    cyclic(1),
    cyclic(5),
    dihedral(1),
    dihedral(6),
]
ORDERS = {"tetrahedral": 12, "octahedral": 24, "icosahedral": 60, "cyclic-1": 1, "cyclic-5": 5}
ORDERS |= {"dihedral-1": 2, "dihedral-6": 12}
# Turns of thesis 4.3.0.3: {degrees: how many elements}.
TURNS = {
    "tetrahedral": {0: 1, 120: 8, 180: 3},
    "octahedral": {0: 1, 90: 6, 120: 8, 180: 9},
    "icosahedral": {0: 1, 72: 12, 144: 12, 120: 20, 180: 15},
}


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_tables_are_those_of_groups(group):
    n = len(group)
    assert n == ORDERS[group.name]
    table, inverses = group.table, group.inverses
    assert np.array_equal(table[0], np.arange(n))
    assert np.array_equal(table[:, 0], np.arange(n))
    assert np.array_equal(table[np.arange(n), inverses], np.zeros(n))
    assert np.array_equal(np.sort(table, axis=1), np.tile(np.arange(n), (n, 1)))
    i, j, k = np.random.default_rng(0).integers(n, size=(3, 500))
    assert np.array_equal(table[table[i, j], k], table[i, table[j, k]])


@pytest.mark.parametrize("group", GROUPS[:3], ids=lambda g: g.name)
def test_turns_are_those_of_the_solids(group):
    degrees = np.round(np.degrees(angle(group.quaternions, group.quaternions[0]))).astype(int)
    found, counts = np.unique(degrees, return_counts=True)
    assert dict(zip(found.tolist(), counts.tolist(), strict=True)) == TURNS[group.name]


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_conjugates_have_the_same_table(group):
    other = group.conjugate(probes(1)[0])
    # The order of elements is kept up to ties of the angle; an isomorphism has the same counts.
    assert np.array_equal(np.sort(np.diag(other.table)) == 0, np.sort(np.diag(group.table)) == 0)
    assert other.intersection_order(group) == 1 if len(group) > 1 else True


def test_subgroups():
    assert tetrahedral().is_subgroup_of(octahedral())
    assert tetrahedral().is_subgroup_of(icosahedral())
    assert not octahedral().is_subgroup_of(icosahedral())
    assert octahedral().intersection_order(icosahedral()) == 12


def test_nearest_elements():
    group, q = icosahedral(), probes(500)
    slow = [int(np.argmin([angle(h, r) for h in group.quaternions])) for r in q]
    assert np.array_equal(group.nearest(q), slow)
    assert np.array_equal(
        group.nearest(product(group.quaternions, q[0] * 0 + [0, 0, 0, 1])), range(60)
    )


def test_groups_by_name():
    assert len(group_by_name("dihedral-4")) == 8
    for name in ("", "cubic", "cyclic-0", "cyclic-", "dihedral-x", "cyclic--1"):
        with pytest.raises(GridError, match="known are tetrahedral, octahedral, icosahedral"):
            group_by_name(name)


def test_what_is_no_group_is_refused():
    with pytest.raises(GridError, match="not an element"):
        _ = FiniteGroup("none", np.vstack([[0, 0, 0, 1.0], probes(3)])).table
    for bad in (cyclic, dihedral):
        with pytest.raises(GridError):
            bad(0)
