"""Cosets, double cosets and wedges tile the rotations."""

import numpy as np
import pytest

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import (
    DoubleCosets,
    Wedge,
    cyclic,
    double_coset_grid,
    icosahedral,
    octahedral,
    single_coset,
    tetrahedral,
    wedge_grid,
)
from ellipsoid_planning.groups.distortion import distortion
from ellipsoid_planning.groups.group_grids import icosahedral_cosets
from ellipsoid_planning.groups.quaternions import angle, inverse, logarithm, product
from tests.groups.checks import angles, probes


def test_single_cosets_put_rotations_together_again():
    q = probes(1000)
    for group in (tetrahedral(), octahedral(), icosahedral()):
        elements, rest = single_coset(group, q)
        again = product(group.quaternions[elements], rest)
        assert angle(again, q).max() < 1e-12
        assert np.all(angles(rest, group.quaternions).argmin(axis=1) == 0)


@pytest.mark.parametrize("left", [tetrahedral(), octahedral(), icosahedral()], ids=lambda g: g.name)
def test_double_cosets_put_rotations_together_again(left):
    cosets = DoubleCosets(left.conjugate(probes(1, 7)[0]), icosahedral())
    assert len(cosets.centres) == len(left) * 60
    q = probes(500)
    h, rest, k = cosets.divide(q)
    again = product(product(cosets.left.quaternions[h], rest), cosets.right.quaternions[k])
    assert angle(again, q).max() < 1e-12
    assert np.all(cosets.cell.contains(rest, 1e-12))


def test_icosahedral_double_cosets_are_3600_with_a_distortion_of_1_percent():
    # Printed: 0.0074, which no conjugation reaches.
    cosets = icosahedral_cosets()
    away = angles(cosets.centres[:1], cosets.centres)[0]
    assert len(cosets.centres) == 3600 and np.sort(away)[1] > 0.01
    assert cosets.cell.circumradius == pytest.approx(0.38821, abs=1e-5)
    assert distortion(cosets.cell.circumradius) == pytest.approx(0.0102, abs=5e-5)


def test_groups_that_share_rotations_have_no_double_cosets():
    with pytest.raises(GridError, match="share 12 rotations"):
        DoubleCosets(octahedral(), icosahedral())


@pytest.mark.parametrize(
    "group", [tetrahedral(), octahedral(), icosahedral()], ids=lambda g: g.name
)
def test_wedges_tile_the_cell(group):
    wedge = Wedge.of_group(group)
    inside = single_coset(group, probes(3000)).rotations
    turned = product(
        product(group.quaternions[:, None], inside), inverse(group.quaternions)[:, None]
    )
    assert np.all(wedge.contains(turned, 1e-9).sum(axis=0) >= 1)
    assert np.mean(wedge.contains(turned, 0.0).sum(axis=0) == 1) > 0.99
    assert np.all(wedge.contains(wedge.vertices, 1e-9))
    assert wedge.contains(wedge.centre)


def test_the_icosahedral_wedge_is_a_tetrahedron():
    lengths = np.linalg.norm(logarithm(Wedge.of_group(icosahedral()).vertices), axis=1)
    np.testing.assert_allclose(np.sort(lengths), [0.0, np.pi / 5.0, 0.776279, 0.776279], atol=1e-6)


def test_grids_of_double_cosets_and_wedges_have_3600_different_rotations():
    for grid in (double_coset_grid(), wedge_grid()):
        away = angles(grid.quaternions(0, 1), grid.quaternions())[0]
        assert grid.count == 3600 and np.sort(away)[1] > 0.01
    centres = icosahedral_cosets().centres
    assert np.all(angles(double_coset_grid().quaternions(), centres).min(axis=1) < 1e-6)


def test_wedges_with_corners_have_each_corner_once():
    grid = wedge_grid(corners=True)
    # Of 60 cells: 60 centres, 1 identity, 12 faces of two cells each, 20 corners of four.
    assert grid.count == 60 * (60 + 1 + 12 // 2 + 20 // 4)
    assert len(np.unique(np.round(angles(grid.cell_nodes, grid.cell_nodes), 6), axis=0)) <= 72


def test_cyclic_groups_have_no_wedges():
    with pytest.raises(GridError, match="no wedges"):
        Wedge.of_group(cyclic(5))
