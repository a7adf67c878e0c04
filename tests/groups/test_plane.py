"""Wallpaper groups of planar motions: groups, exact prisms, and grids without seams."""

import math

import numpy as np
import pytest

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import plane_grid, plane_group
from ellipsoid_planning.groups.plane_groups import PLANE_GROUPS, compose, wrapped

GROUPS = [
    *(plane_group(name, 1.3) for name in PLANE_GROUPS),
    plane_group("p1", 2.0, 0.5, 0.3),
    plane_group("p2", 1.0, 1.4, 1.9),
    plane_group("p6", 2.0, angle=math.pi / 3.0),
]
CORNERS = {"p1": 4, "p2": 4, "p3": 6, "p4": 4, "p6": 6}


def elements(group, reach=9):
    axis = np.arange(-reach, reach + 1)
    steps = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.concatenate(
        [group.element(steps, k * np.ones(len(steps))) for k in range(group.order)]
    )


def squared_distances(motions, others):
    """Thesis (4.3) with W = 1: the squared Frobenius norm of differences of matrices."""
    flat = np.sum((motions[:, None, :2] - others[None, :, :2]) ** 2, axis=-1)
    return flat + 4.0 * (1.0 - np.cos(motions[:, None, 2] - others[None, :, 2]))


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_products_of_elements_are_elements(group):
    some = elements(group, 2)
    products = compose(some[:, None], some[None]).reshape(-1, 3)
    steps, turns = group.nearest(products)
    difference = products - group.element(steps, turns)
    difference[:, 2] = wrapped(difference[:, 2])
    np.testing.assert_allclose(difference, 0.0, atol=1e-12)


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_cells_are_exact_prisms(group):
    rng = np.random.default_rng(0)
    motions = rng.uniform(-1.5, 1.5, size=(5000, 3)) * [1.0, 1.0, math.pi / 1.5]
    every = elements(group)
    squared = squared_distances(motions, every)
    identity = np.flatnonzero(np.all(np.abs(every) < 1e-12, axis=1))[0]
    expected = squared[:, identity] <= squared.min(axis=1) + 1e-12
    assert np.array_equal(group.cell.contains(motions), expected)
    found = group.element(*group.nearest(motions))
    own = np.diag(squared_distances(motions[:500], found[:500]))
    np.testing.assert_allclose(own, squared[:500].min(axis=1), atol=1e-12)


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_cells_have_the_thesis_shape(group):
    cell, corners = group.cell, group.cell.polygon
    expected = 6 if abs(group.basis[:, 0] @ group.basis[:, 1]) > 1e-9 else 4
    assert len(corners) == expected
    x, y = corners.T
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert area * 2.0 * math.pi / group.order == pytest.approx(cell.volume)
    assert cell.half_height == math.pi / group.order


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_grids_are_replicated_by_their_group(group):
    grid = plane_grid(group, divisions=3, headings=2, cells=(4, 5), origin=(-2, -2))
    every = grid[:]
    assert len(grid) == len(every) == 4 * 5 * 9 * 2 * group.order
    assert np.all(group.cell.contains(grid.cell_nodes))
    shifted = compose(elements(group, 6)[:, None], grid.cell_nodes[None]).reshape(-1, 3)
    gaps = squared_distances(every, shifted)
    np.testing.assert_allclose(gaps.min(axis=1), 0.0, atol=1e-12)
    assert np.all(np.count_nonzero(gaps < 1e-12, axis=1) == 1)
    np.testing.assert_allclose(np.array(list(grid)), every, atol=1e-14)
    np.testing.assert_allclose(grid[-1], every[-1], atol=1e-14)


@pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
def test_neighbours_and_nearest_are_those_of_brute_force(group):
    grid = plane_grid(group, divisions=2, headings=3, cells=(3, 3), origin=(-1, -1))
    every = grid[:]
    assert np.array_equal(grid.nearest(every), np.arange(len(grid)))
    rng = np.random.default_rng(3)
    for index in rng.integers(len(grid), size=10):
        turned = wrapped(every[:, 2] - every[index, 2])
        away = np.hypot(np.linalg.norm(every[:, :2] - every[index, :2], axis=1), 0.7 * turned)
        expected = np.flatnonzero((away <= 0.83) & (np.arange(len(grid)) != index))
        assert np.array_equal(grid.neighbours(int(index), 0.83, 0.7), expected)
    near = every[rng.integers(len(grid), size=50)] + rng.uniform(-0.02, 0.02, size=(50, 3))
    away = squared_distances(near, every)
    assert np.array_equal(grid.nearest(near), away.argmin(axis=1))


@pytest.mark.parametrize(
    "arguments",
    [
        ("p5",),
        ("p4", 1.0, 2.0),
        ("p3", 1.0, 1.0, math.pi / 2.0),
        ("p1", -1.0),
        ("p2", 1.0, 1.0, 0.0),
        ("p1", math.inf),
    ],
)
def test_lattices_that_do_not_fit_are_refused(arguments):
    with pytest.raises(GridError):
        plane_group(*arguments)


def test_empty_grids_are_refused():
    with pytest.raises(GridError, match="positive"):
        plane_grid(plane_group("p1"), headings=0)
    with pytest.raises(IndexError):
        plane_grid(plane_group("p1"))[1]
