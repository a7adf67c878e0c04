"""The 230 space groups and the 17 plane groups: operations, axioms, kinds, names."""

from collections import Counter

import gemmi
import numpy as np
import pytest
import spglib

from ellipsoid_planning.crystal import Operation, SpaceGroup, space_group
from ellipsoid_planning.errors import CrystalError

# spglib warns of how it reports errors, which it does not do here.
pytestmark = pytest.mark.filterwarnings("ignore:.*OLD_ERROR_HANDLING:DeprecationWarning")

PLANE = dict.fromkeys(("p1",), 1) | dict.fromkeys(("p2", "pm", "pg"), 2) | {"p3": 3}
PLANE |= dict.fromkeys(("cm", "p2mm", "p2mg", "p2gg", "p4"), 4)
PLANE |= dict.fromkeys(("p3m1", "p31m", "p6"), 6) | {"p6mm": 12}
PLANE |= dict.fromkeys(("c2mm", "p4mm", "p4gm"), 8)


@pytest.fixture(scope="module")
def all_groups():
    return {number: space_group(number) for number in range(1, 231)}


def test_counts_of_the_thesis_check(all_groups):
    groups = all_groups.values()
    sohncke = [group for group in groups if group.sohncke]
    assert len(sohncke) == 65
    assert sum(group.symmorphic for group in sohncke) == 24
    assert sum(group.symmorphic for group in groups) == 73
    assert sum(group.enantiomorphic for group in groups) == 22
    torsion_free = [group.name for group in sohncke if group.bieberbach]
    assert torsion_free == ["P1", "P21", "P212121", "P41", "P43", "P31", "P32", "P61", "P65"]
    assert sum(group.bieberbach for group in groups) == 13


def test_operations_and_kinds_are_gemmi_s(all_groups):
    for number, group in all_groups.items():
        other = gemmi.get_spacegroup_reference_setting(number)
        theirs = [Operation.parse(op.triplet()) for op in other.operations()]
        assert list(group.operations) == [operation.modulo() for operation in theirs]
        assert group.symmorphic == other.is_symmorphic()
        assert group.enantiomorphic == other.is_enantiomorphic()


def test_operations_of_the_sohncke_groups_are_spglib_s(all_groups):
    settings = {spglib.get_spacegroup_type(i).number: i for i in range(530, 0, -1)}
    for number, group in all_groups.items():
        if not group.sohncke:
            continue
        theirs = spglib.get_symmetry_from_database(settings[number])
        shifts = np.rint(theirs["translations"] * group.denominator * 24).astype(int)
        pairs = zip(theirs["rotations"].tolist(), shifts.tolist(), strict=True)
        keys = {(str(w), str([s % (24 * group.denominator) for s in t])) for w, t in pairs}
        own = zip(
            group.integer_rotations.tolist(), group.integer_translations.tolist(), strict=True
        )
        assert keys == {(str(w), str([24 * s for s in t])) for w, t in own}


def test_tables_are_group_tables(all_groups):
    for group in [*all_groups.values(), *map(space_group, PLANE)]:
        table, order = group.table, group.order
        assert np.array_equal(table[0], np.arange(order))
        assert np.all(np.sort(table, axis=0) == np.arange(order)[:, None])
        assert np.all(table[np.arange(order), group.inverses] == 0)
        some = np.arange(0, order, max(1, order // 12))
        i, j, k = np.meshgrid(some, some, some, indexing="ij")
        assert np.array_equal(table[table[i, j], k], table[i, table[j, k]])
        # A homomorphism: entry i, j composes i after j.
        first, second = group.operations[-1], group.operations[order // 2]
        product = group.operations[table[order - 1, order // 2]]
        assert (first @ second).modulo() == product
        assert group.index(first @ second) == table[order - 1, order // 2]


def test_plane_groups():
    assert {name: space_group(name).order for name in PLANE} == PLANE
    groups = [space_group(name) for name in PLANE]
    assert sorted(group.number for group in groups) == list(range(1, 18))
    assert all(group.dimension == 2 and not group.enantiomorphic for group in groups)
    kinds = Counter((group.symmorphic, group.bieberbach) for group in groups)
    assert [group.name for group in groups if group.bieberbach] == ["p1", "pg"]
    assert kinds[True, False] + kinds[True, True] == 13
    assert {group.name for group in groups if group.sohncke} == {"p1", "p2", "p3", "p4", "p6"}
    short = {"pmm": "p2mm", "pmg": "p2mg", "cmm": "c2mm", "p4g": "p4gm", "p6m": "p6mm"}
    assert all(space_group(one).name == two for one, two in short.items())


def test_groups_without_tables_have_the_same_kinds(all_groups):
    for number in (1, 19, 76, 92, 154, 213, 225):
        known = all_groups[number]
        own = SpaceGroup("own", None, known.operations)
        kinds = ("symmorphic", "bieberbach", "sohncke", "enantiomorphic")
        assert all(getattr(own, kind) == getattr(known, kind) for kind in kinds)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("P212121", "P212121"),
        ("P 21 21 21", "P212121"),
        ("p212121", "P212121"),
        ("P2_12_12_1", "P212121"),
        ("P2(1)2(1)2(1)", "P212121"),
        ("P\N{MINUS SIGN}1", "P-1"),
        ("P2₁2₁2₁", "P212121"),
        ("P2_{1}/c", "P21/c"),
        ("19", "P212121"),
        (19, "P212121"),
        ("P2", "P2"),
        ("p2", "p2"),
        ("R32", "R32"),
        ("R32:R", "R32:R"),
        ("Fd-3m", "Fd-3m"),
        ("Fd3\N{COMBINING OVERLINE}m", "Fd-3m"),
        ("Fd-3m:1", "Fd-3m:1"),
        ("P 1 1 2", "P112"),
    ],
)
def test_spellings(name, expected):
    assert space_group(name).name == expected


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("P2121", "did you mean P"),
        ("p4gg", "did you mean p4gm"),
        ("quartz", "expected a symbol such as"),
        ("", "expected a symbol such as"),
        (0, "number from 1 to 230"),
        (231, "number from 1 to 230"),
        ("-3", "number from 1 to 230"),
    ],
)
def test_unknown_groups(name, words):
    with pytest.raises(CrystalError, match=words):
        space_group(name)


def test_without_gemmi_the_plane_groups_remain(monkeypatch):
    from ellipsoid_planning.crystal.symmetry import catalogue

    monkeypatch.setitem(__import__("sys").modules, "gemmi", None)
    for cached in (catalogue.reference_group, catalogue._by_symbol):
        cached.cache_clear()
    assert space_group("p6").order == 6
    for name in ("P212121", 19):
        with pytest.raises(CrystalError, match=r"pip install 'ellipsoid-planning\[crystal\]'"):
            space_group(name)
