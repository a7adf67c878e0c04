"""Subgroups, normality, cosets: the table of the thesis' check, and brute force."""

from itertools import combinations

import numpy as np
import pytest

from ellipsoid_planning.crystal import space_group
from ellipsoid_planning.crystal.symmetry.cosets import coset_spaces
from ellipsoid_planning.crystal.symmetry.elements import is_normal, is_subgroup
from ellipsoid_planning.crystal.symmetry.subgroups import all_subgroups, class_count
from ellipsoid_planning.errors import CrystalError

# Order, subgroups, conjugacy classes, normal subgroups.
COUNTS = {
    "P212121": (4, 5, 5, 5),
    "C2221": (8, 16, 16, 16),
    "I222": (8, 16, 16, 16),
    "F222": (16, 67, 67, 67),
    "P41212": (8, 10, 8, 6),
    "P43212": (8, 10, 8, 6),
    "I422": (16, 35, 27, 19),
    "P321": (6, 6, 4, 3),
    "P3121": (6, 6, 4, 3),
    "R32": (18, 28, 12, 7),
    "P622": (12, 16, 10, 7),
    "P6122": (12, 16, 10, 7),
    "P23": (12, 10, 5, 3),
    "P213": (12, 10, 5, 3),
    "I23": (24, 26, 12, 6),
    "I213": (24, 26, 12, 6),
    "P432": (24, 30, 11, 4),
    "P4132": (24, 30, 11, 4),
    "P4332": (24, 30, 11, 4),
    "I432": (48, 98, 33, 9),
    "I4132": (48, 98, 33, 9),
    "F432": (96, 250, 56, 7),
    "F4132": (96, 250, 56, 7),
}


@pytest.mark.parametrize("name", COUNTS)
def test_counts_of_the_thesis_check(name):
    group = space_group(name)
    found = all_subgroups(group)
    normal = sum(subgroup.normal for subgroup in found)
    assert (group.order, len(found), class_count(found), normal) == COUNTS[name]


@pytest.mark.parametrize("name", ["P212121", "P41212", "R3", "P622", "P23", "p6mm", "c2mm", "C2/c"])
def test_subgroups_are_those_among_all_sets(name):
    group = space_group(name)
    brute = {
        (0, *others)
        for size in range(group.order)
        if group.order % (size + 1) == 0
        for others in combinations(range(1, group.order), size)
        if is_subgroup(group, (0, *others)).holds
    }
    assert {subgroup.elements for subgroup in all_subgroups(group)} == brute


@pytest.mark.parametrize("name", ["P4132", "I422", "Fddd", "P6/mmm", "F432"])
def test_generators_classes_and_normality(name):
    group = space_group(name)
    found = all_subgroups(group)
    members = {}
    for subgroup in found:
        assert _generated(group, subgroup.generators) == set(subgroup.elements)
        assert 2 ** len(subgroup.generators) <= subgroup.order
        assert is_normal(group, subgroup.elements).holds == subgroup.normal
        members.setdefault(subgroup.conjugacy_class, set()).add(subgroup.elements)
    for one in members.values():
        assert _conjugates(group, min(one)) == one
    orders = [subgroup.order for subgroup in found]
    assert orders == sorted(orders)
    assert sorted(members) == list(range(class_count(found)))


def test_counter_examples_are_correct():
    group = space_group("P4132")
    table, inverses = group.table, group.inverses
    random = np.random.default_rng(5)
    seen = {"product": 0, "conjugate": 0, "yes": 0}
    subgroups = [subgroup.elements for subgroup in all_subgroups(group)]
    chosen = [random.choice(24, size=random.integers(1, 6), replace=False) for _ in range(40)]
    for elements in [*chosen, *subgroups]:
        verdict = is_normal(group, elements)
        inside = set(map(int, elements))
        if verdict.product is not None:
            i, j, k = verdict.product
            assert table[i, j] == k and {i, j} <= inside and k not in inside
            assert f"g_{i + 1} o g_{j + 1} = g_{k + 1} " in verdict.message
            seen["product"] += 1
        elif verdict.conjugate is not None:
            g, h, k = verdict.conjugate
            assert table[table[g, h], inverses[g]] == k and h in inside and k not in inside
            assert f"g_{g + 1} o g_{h + 1} o g_{g + 1}^-1 = g_{k + 1} " in verdict.message
            seen["conjugate"] += 1
        else:
            assert verdict.message == "Yes, it is a normal subgroup of P4132."
            seen["yes"] += 1
    assert min(seen.values()) >= 4


@pytest.mark.parametrize("name", ["P4132", "R32", "P212121"])
def test_coset_spaces_agree_for_normal_subgroups_only(name):
    group = space_group(name)
    for subgroup in all_subgroups(group):
        spaces = coset_spaces(group, subgroup.elements)
        assert spaces.agree == subgroup.normal
        for side in (spaces.left, spaces.right):
            assert sorted(element for coset in side for element in coset) == list(
                range(group.order)
            )
            assert side[0] == subgroup.elements
            assert len(side) == group.order // subgroup.order
        g = spaces.left[-1][0]
        assert set(spaces.left[-1]) == {int(group.table[g, h]) for h in subgroup.elements}
        assert tuple(sorted(int(group.table[h, g]) for h in subgroup.elements)) in spaces.right
        for left, match in zip(spaces.left, spaces.matches, strict=True):
            assert (match is None) == (left not in spaces.right)


@pytest.mark.parametrize(
    ("elements", "words"),
    [
        ([], "at least one"),
        ([0, 4], "no element 5"),
        ([-1], "no element 0"),
        ([1, 1], "2 is given"),
    ],
)
def test_bad_elements(elements, words):
    group = space_group("P212121")
    for question in (is_subgroup, is_normal, coset_spaces):
        with pytest.raises(CrystalError, match=words):
            question(group, elements)


def test_only_subgroups_have_cosets():
    with pytest.raises(CrystalError, match=r"g_2 o g_3 = g_4 .* is not among them"):
        coset_spaces(space_group("P222"), [0, 1, 2])


def _generated(group, generators):
    reached = [0]
    for element in reached:
        following = {int(group.table[generator, element]) for generator in generators}
        reached += sorted(following.difference(reached))
    return set(reached)


def _conjugates(group, elements):
    table, inverses = group.table, group.inverses
    return {
        tuple(sorted(int(table[table[g, h], inverses[g]]) for h in elements))
        for g in range(group.order)
    }
