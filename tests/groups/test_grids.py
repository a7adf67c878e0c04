"""Grids: one node an index, neighbours and nearest nodes as brute force finds them."""

import math

import numpy as np
import pytest

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import (
    cyclic,
    dihedral,
    double_coset_grid,
    euler_grid,
    grid_by_name,
    grid_names,
    group_grid,
    hopf_grid,
    icosahedral,
    octahedral,
    random_grid,
    six_hundred_cell_grid,
    super_fibonacci_grid,
    tetrahedral,
    wedge_grid,
)
from ellipsoid_planning.groups.covering import separation
from ellipsoid_planning.groups.standard_grids import healpix_directions
from tests.groups.checks import angles, brute_neighbours, probes

GRIDS = [
    group_grid(icosahedral(), count=480),
    group_grid(icosahedral(), "bcc", count=3900),
    group_grid(octahedral(), "bcc", resolution=0.3),
    group_grid(tetrahedral(), resolution=0.4),
    group_grid(cyclic(3), resolution=0.5),
    group_grid(cyclic(1), "bcc", resolution=0.7),
    group_grid(dihedral(4), resolution=0.4),
    double_coset_grid(),
    wedge_grid(corners=True),
    wedge_grid(octahedral(), resolution=0.35),
    six_hundred_cell_grid(1),
    six_hundred_cell_grid(3),
    hopf_grid(3),
    super_fibonacci_grid(700),
    euler_grid(12, 6, 13),
    random_grid(500, seed=3),
]


@pytest.mark.parametrize("grid", GRIDS, ids=lambda g: g.name)
def test_nodes_come_one_by_one_in_slices_and_together(grid):
    every = grid.quaternions()
    assert every.shape == (len(grid), 4)
    np.testing.assert_allclose(np.linalg.norm(every, axis=1), 1.0, atol=1e-14)
    some = np.random.default_rng(0).integers(len(grid), size=20)
    np.testing.assert_allclose(grid[some], every[some], atol=1e-15)
    np.testing.assert_allclose(np.array(list(grid)), every, atol=1e-15)
    np.testing.assert_allclose(grid[7:40:3], every[7:40:3], atol=1e-15)
    np.testing.assert_allclose(grid.quaternions(5, 50), every[5:50], atol=1e-15)
    np.testing.assert_allclose(grid[-1], every[-1], atol=1e-15)
    assert grid.quaternions(9, 9).shape == (0, 4)
    with pytest.raises(IndexError):
        grid[len(grid)]


@pytest.mark.parametrize("grid", GRIDS, ids=lambda g: g.name)
def test_no_rotation_is_there_twice(grid):
    for index in np.random.default_rng(1).integers(len(grid), size=30):
        assert len(brute_neighbours(grid.quaternions(), index, 1e-6)) == 0


@pytest.mark.parametrize("grid", GRIDS, ids=lambda g: g.name)
def test_neighbours_are_those_of_brute_force(grid):
    every, lists = grid.quaternions(), {}
    for share in (1.21, 1.83):
        radius = share * grid.spacing
        lists = grid.neighbour_lists(radius)
        for index in np.random.default_rng(2).integers(len(grid), size=40):
            expected = brute_neighbours(every, index, radius)
            assert np.array_equal(grid.neighbours(int(index), radius), expected)
            assert np.array_equal(np.sort(lists[index]), expected)
    first = np.repeat(np.arange(len(lists)), np.diff(lists.starts))
    there = set(zip(first.tolist(), lists.nodes.tolist(), strict=True))
    assert all((j, i) in there for i, j in there)
    assert 2 * len(lists.pairs) == len(there)


@pytest.mark.parametrize("grid", GRIDS, ids=lambda g: g.name)
def test_nearest_nodes_are_those_of_brute_force(grid):
    every, border = grid.quaternions(), np.vstack([np.eye(4), icosahedral().quaternions])
    q = np.vstack([probes(1500), border, -every[:20]])
    away = angles(q, every)
    found = grid.nearest(q)
    np.testing.assert_allclose(away[np.arange(len(q)), found], away.min(axis=1), atol=3e-8)
    assert np.array_equal(grid.nearest(every), np.arange(len(grid)))
    assert grid.nearest(q[0]).shape == ()


@pytest.mark.parametrize("count", [480, 30_240])
def test_neighbours_across_cells_are_symmetric_and_connected(count):
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    grid = group_grid(icosahedral(), count=count)
    pairs = grid.neighbour_lists(1.2 * grid.spacing).pairs
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    assert connected_components(graph, directed=False)[0] == 1
    assert 5.0 < 2.0 * len(pairs) / count < 9.0


@pytest.mark.parametrize("divisions", [1, 2, 3, 7])
def test_the_600_cell_grid_has_its_count_and_separation(divisions):
    grid = six_hundred_cell_grid(divisions)
    assert grid.count == 50 * divisions**3 + 10 * divisions
    assert math.degrees(separation(grid)) == pytest.approx(72.0 / divisions, abs=1e-9)


def test_healpix_directions_are_the_published_ones():
    # Górski et al. 2005, section 4: areas are equal, so that heights average to 0; the first and
    # last rings have four pixels; rings of the belt are 2 / (3 side) apart.
    for side in (1, 2, 3, 4):
        z, phi = healpix_directions(side, np.arange(12 * side**2))
        heights, counts = np.unique(np.round(z, 12), return_counts=True)
        caps = 4 * np.arange(1, side)
        assert counts.tolist() == [*caps, *[4 * side] * (2 * side + 1), *caps[::-1]]
        np.testing.assert_allclose(heights, -heights[::-1], atol=1e-12)
        np.testing.assert_allclose(z[:4], 1.0 - 1.0 / (3.0 * side**2))
        np.testing.assert_allclose(phi[:4], np.pi / 4.0 * np.array([1, 3, 5, 7]))
        assert np.all((phi >= 0.0) & (phi < 2.0 * np.pi))


def test_every_grid_has_a_name():
    for name in grid_names():
        grid = grid_by_name(name, resolution_deg=25.0)
        assert grid.spacing <= math.radians(25.0) * (1.0 + 1e-9)
        assert grid_by_name(name, count=grid.count).count == grid.count


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"name": "hexagonal", "count": 60}, "unknown grid 'hexagonal'; known are 600-cell"),
        ({"name": "hopf", "count": 600}, "nearest that it can have: 576 or 1944"),
        ({"name": "600-cell", "count": 10}, "nearest that it can have: 60$"),
        ({"name": "icosahedral", "count": 500}, "nearest that it can have: 480 or "),
        ({"name": "hopf", "count": 0}, "not 0"),
        ({"name": "hopf", "count": 30_000_000}, "not 30000000"),
        ({"name": "hopf", "resolution_deg": 0.0}, "not 0°"),
        ({"name": "hopf", "resolution_deg": math.nan}, "not nan°"),
        ({"name": "hopf", "resolution_deg": 181.0}, "not 181°"),
        ({"name": "icosahedral-wedge", "resolution_deg": 5.0}, "no more than 3600"),
        ({"name": "hopf"}, "either a count or a resolution"),
        ({"name": "hopf", "count": 72, "resolution_deg": 9.0}, "either a count or a resolution"),
    ],
)
def test_bad_requests_say_what_there_is(arguments, message):
    with pytest.raises(GridError, match=message):
        grid_by_name(**arguments)


def test_bad_lattices_are_refused():
    with pytest.raises(GridError, match="known are cubic, bcc"):
        group_grid(icosahedral(), "fcc", count=60)
    with pytest.raises(GridError, match=r"from 0\.3° to 180°"):
        group_grid(icosahedral(), resolution=-1.0)
    for bad in (0, 101):
        with pytest.raises(GridError, match="1 to 100"):
            six_hundred_cell_grid(bad)
    with pytest.raises(GridError):
        hopf_grid(0)
    with pytest.raises(GridError):
        euler_grid(3, 0, 3)
    with pytest.raises(GridError):
        super_fibonacci_grid(0)
