"""Reflections: none forgotten, none twice, absences as gemmi has them."""

import itertools

import gemmi
import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.reflections import (
    absent,
    all_reflections,
    representatives,
    unique_reflections,
)
from ellipsoid_planning.crystal.diffraction.structure_factors import reflections_of
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError

CELLS = [
    UnitCell.from_parameters([6.75, 9.0]),
    UnitCell.from_parameters([4.0, 11.0], 37.0),
    UnitCell.from_parameters([14.0, 14.0, 14.0]),
    UnitCell.from_parameters([5.0, 7.0, 9.0], [65.0, 75.0, 110.0]),
    UnitCell.from_parameters([9.0, 3.0, 5.0], [31.0, 40.0, 50.0]),
]
GROUPS = {
    "P212121": [11.0, 13.0, 17.0],
    "C2221": [11.0, 13.0, 17.0],
    "F222": [11.0, 13.0, 17.0],
    "P41212": [11.0, 11.0, 17.0],
    "P61": [11.0, 11.0, 17.0],
    "R32": [11.0, 11.0, 17.0],
    "I4132": [14.0, 14.0, 14.0],
    "Pnma": [11.0, 13.0, 17.0],
}


def hexagonal(name):
    return [90.0, 90.0, 120.0 if name in ("P61", "R32") else 90.0]


@pytest.mark.parametrize("cell", CELLS)
def test_every_lattice_point_of_the_sphere_once(cell):
    n = cell.dimension
    for resolution in (0.9, 1.7):
        found = all_reflections(cell, resolution)
        reach = int(cell.lengths.max() / resolution) + 3
        box = np.array(list(itertools.product(range(-reach, reach + 1), repeat=n)))
        lengths = np.linalg.norm(box @ cell.reciprocal.T, axis=1)
        inside = box[(lengths > 0.0) & (lengths <= 1.0 / resolution * (1.0 + 1e-12))]
        both = {tuple(h) for h in np.vstack([found.indices, -found.indices]).tolist()}
        assert len(found) * 2 == len(inside)
        assert both == {tuple(h) for h in inside.tolist()}
        assert np.allclose(found.vectors, found.indices @ cell.reciprocal.T)
        assert np.all(np.diff(found.spacings) <= 1e-9)
        assert np.all(found.multiplicities == 1)


def test_counts_of_the_bundled_models():
    assert len(reflections_of(load_model("rabbit-p1"))) == 61
    for name in ("rabbit-plane", "rabbit-p212121"):
        model = load_model(name)
        found, whole = reflections_of(model), all_reflections(model.cell, model.resolution)
        assert found.multiplicities.sum() == (~absent(model.group, whole.indices)).sum()
        assert np.all(found.spacings >= model.resolution)


def test_points_on_the_sphere_belong_to_it():
    cell = UnitCell.from_parameters([14.0, 14.0, 14.0])
    assert len(all_reflections(cell, 14.0 / 3.0)) == 61
    assert len(all_reflections(cell, 14.0)) == 3


@pytest.mark.parametrize("name", GROUPS)
def test_unique_ones_and_absences_are_those_of_gemmi(name):
    group = space_group(name)
    cell = UnitCell.from_parameters(GROUPS[name], hexagonal(name))
    found = unique_reflections(cell, group, 2.0)
    whole = all_reflections(cell, 2.0)
    theirs = gemmi.GroupOps([gemmi.Op(op.triplet()) for op in group.operations])
    gone = np.array([theirs.is_systematically_absent(h) for h in whole.indices.tolist()])
    assert np.array_equal(gone, absent(group, whole.indices))
    assert found.multiplicities.sum() == (~gone).sum()
    setting = gemmi.find_spacegroup_by_ops(theirs)
    box = gemmi.UnitCell(*GROUPS[name], *hexagonal(name))
    assert len(found) == len(gemmi.make_miller_array(box, setting, 2.0, unique=True))
    # Each stands for itself, and all equivalents have the same representative.
    assert np.array_equal(representatives(group, found.indices), found.indices)
    for rotation in group.integer_rotations:
        turned = representatives(group, -found.indices @ rotation)
        assert np.array_equal(turned, found.indices)


def test_nonsense_is_refused():
    cell = UnitCell.from_parameters([10.0, 10.0, 10.0])
    for resolution in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(CrystalError, match="positive resolution"):
            all_reflections(cell, resolution)
    with pytest.raises(CrystalError, match="up to 10 apart"):
        all_reflections(cell, 10.5)
    for resolution in (0.01, 1e-300):
        with pytest.raises(CrystalError, match="choose a larger spacing"):
            all_reflections(cell, resolution)
    wrong = UnitCell.from_parameters([10.0, 11.0, 12.0])
    with pytest.raises(CrystalError, match="P41212"):
        unique_reflections(wrong, space_group("P41212"), 2.0)
