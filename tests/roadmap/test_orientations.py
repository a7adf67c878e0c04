"""The layers' orientations: the icosahedral group, headings, spirals, and who is near whom."""

import math

import numpy as np
import pytest

from ellipsoid_planning.groups.finite_groups import icosahedral_rotations
from ellipsoid_planning.groups.standard_grids import super_fibonacci
from ellipsoid_planning.kernels.grid import UNKNOWN, between, find_nearest
from ellipsoid_planning.kernels.roadmap_metric import METRIC
from ellipsoid_planning.roadmap.orientations import (
    headings,
    random_turn,
    spread_orientations,
)


def angles(first, second):
    return 2.0 * np.arccos(np.minimum(np.abs(first @ second.T), 1.0))


def product(p, q):
    x, y, z, w = p
    matrix = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    return matrix @ q


def test_the_icosahedral_rotations_are_a_group():
    group = icosahedral_rotations()
    assert group.shape == (60, 4)
    np.testing.assert_allclose(np.linalg.norm(group, axis=1), 1.0, atol=1e-14)
    products = np.array([product(p, q) for p in group for q in group])
    closeness = np.abs(products @ group.T)
    assert np.all(np.sort(closeness, axis=1)[:, -1] > 1.0 - 1e-12)
    assert np.count_nonzero(angles(group, group) < 1e-6) == 60


def test_twelve_neighbours_are_72_degrees_away():
    away = np.sort(np.degrees(angles(icosahedral_rotations(), icosahedral_rotations())), axis=1)
    np.testing.assert_allclose(away[:, 1:13], 72.0, atol=1e-6)
    assert np.all(away[:, 13:] > 119.0)


def test_headings_are_evenly_spread_round_the_circle():
    yaw = 2.0 * np.arctan2(headings(8)[:, 2], headings(8)[:, 3])
    np.testing.assert_allclose(np.mod(yaw, 2.0 * np.pi), np.arange(8) * np.pi / 4.0, atol=1e-12)


@pytest.mark.parametrize("count", [150, 1000])
def test_super_fibonacci_is_well_spread(count):
    points = super_fibonacci(count)
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1.0, atol=1e-14)
    everywhere = np.random.default_rng(1).normal(size=(4000, 4))
    everywhere /= np.linalg.norm(everywhere, axis=1)[:, None]
    random = np.random.default_rng(2).normal(size=(count, 4))
    random /= np.linalg.norm(random, axis=1)[:, None]
    holes, random_holes = (angles(everywhere, p).min(axis=1).max() for p in (points, random))
    assert holes < 0.8 * random_holes
    # A ball of the covering angle t has the share (t − sin t)/π of all rotations.
    assert count * (holes - math.sin(holes)) / math.pi < 6.0
    apart = np.sort(angles(points, points), axis=1)[:, 1]
    assert apart.min() > 0.35 * apart.mean()


@pytest.mark.parametrize(("dimension", "count"), [(2, 36), (3, 60), (3, 150)])
def test_spread_orientations_are_read_only_and_shared(dimension, count):
    found = spread_orientations(dimension, count)
    assert found.shape == (count, 4)
    assert not found.flags.writeable
    assert spread_orientations(dimension, count) is found


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_random_turn_keeps_all_angles(dimension):
    before = spread_orientations(dimension, 40)
    after = random_turn(before, dimension, np.random.default_rng(3))
    np.testing.assert_allclose(np.abs(after @ after.T), np.abs(before @ before.T), atol=1e-12)
    assert angles(before, after).min() > 1e-4
    if dimension == 2:
        np.testing.assert_allclose(after[:, :2], 0.0, atol=1e-15)


NO_JOINTS = np.empty((0, METRIC))


def test_nearest_layers_agree_with_brute_force():
    points = super_fibonacci(80)
    rows = np.full((80, 12), -1, dtype=np.int64)
    rows[:, 0] = UNKNOWN
    for layer in range(80):
        find_nearest(points, NO_JOINTS, rows, layer, 80, 12, 1.0)
    away = angles(points, points)
    np.fill_diagonal(away, np.inf)
    expected = np.sort(away, axis=1)[:, :12]
    np.testing.assert_allclose(np.take_along_axis(away, rows, axis=1), expected, atol=1e-7)


def test_few_orientations_leave_places_empty():
    points = super_fibonacci(3)
    rows = np.full((3, 5), UNKNOWN, dtype=np.int64)
    find_nearest(points, NO_JOINTS, rows, 1, 3, 5, 1.0)
    assert sorted(rows[1]) == [-1, -1, -1, 0, 2]


def test_between_divides_the_shorter_way_evenly():
    first = np.array([0.0, 0.0, 0.0, 1.0])
    last = -np.array([math.sin(0.6), 0.0, 0.0, math.cos(0.6)])
    out = np.empty((3, 4))
    assert between(first, last, out)
    np.testing.assert_allclose(np.abs(out[:, 0]), np.sin([0.15, 0.3, 0.45]), atol=1e-12)
    assert not between(first, first, out)
    assert not between(first, -first, out)
