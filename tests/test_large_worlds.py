"""A place among thousands of obstacles is as it would be without those far away."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scale_scenes import scale_scenario, side
from ellipsoid_planning.cspace import layer
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.world import World

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])

# Nothing farther out than this within the world of 100 can touch the robot.
INNER = {2: 3.5, 3: 1.0}


@pytest.fixture(scope="module", params=[2, 3])
def spaces(request):
    """The C-space of 100 obstacles, and of the same among 10,000."""
    return tuple(scale_scenario(count, request.param).cspace() for count in (100, 10_000))


def configurations(rng, dimension, half, count):
    places = rng.uniform(-half, half, size=(count, dimension))
    if dimension == 2:
        return np.column_stack([places, rng.uniform(-np.pi, np.pi, size=count)])
    turns = rng.normal(size=(count, 4))
    return np.hstack([places, turns / np.linalg.norm(turns, axis=1, keepdims=True)])


def motions(rng, dimension, half, count):
    first, last = (configurations(rng, dimension, half, count) for _ in range(2))
    last[:, :dimension] = first[:, :dimension] + 0.2 * (last - first)[:, :dimension]
    return first, last


def cut(intervals, low, high):
    """The parts of intervals (k, 2) within [low, high]."""
    clipped = np.clip(intervals, low, high)
    return clipped[clipped[:, 1] > clipped[:, 0]]


def test_states_and_motions_are_as_valid_among_many_as_among_few(spaces):
    few, many = spaces
    n = few.dimension
    first, last = motions(np.random.default_rng(1), n, INNER[n], 2000)
    assert np.array_equal(few.are_valid(first), many.are_valid(first))
    proved = few.are_motions_valid(first, last)
    assert np.array_equal(proved, many.are_motions_valid(first, last))
    assert 0.1 < few.are_valid(first).mean() < 0.9
    assert proved.sum() > 50


def test_free_intervals_are_the_same_among_many_as_among_few(spaces):
    few, many = spaces
    n, half = few.dimension, INNER[few.dimension]
    total = 0
    for row in configurations(np.random.default_rng(2), n, half, 12):
        a, b = few.layer(row), many.layer(row)
        for axis in range(n):
            one, other = (cut(x.free_intervals(row[:n], axis), -half, half) for x in (a, b))
            assert one.shape == other.shape
            # The tolerance grows with the world, and moves ends by more where a line is tangent.
            assert np.allclose(one, other, rtol=0, atol=1e-6)
            total += len(one)
    assert total > 20


def test_a_local_space_decides_as_the_whole(spaces):
    _, whole = spaces
    n = whole.dimension
    rng = np.random.default_rng(3)
    low, high = np.full(n, -1.5), np.full(n, 1.2)
    local = LocalCSpace(whole, low, high)
    first, last = motions(rng, n, 1.2, 2000)
    inside = np.all((last[:, :n] >= low) & (last[:, :n] <= high), axis=1)
    first, last = first[inside], last[inside]
    assert np.array_equal(local.are_valid(first), whole.are_valid(first))
    proved = local.are_motions_valid(first, last)
    assert np.array_equal(proved, whole.are_motions_valid(first, last))
    assert proved.sum() > 50
    for row in first[:30]:
        one, other = local.layer(row), whole.layer(row)
        for axis in range(n):
            expected = cut(other.free_intervals(row[:n], axis), low[axis], high[axis])
            assert np.allclose(one.free_intervals(row[:n], axis), expected, rtol=0, atol=1e-9)


def test_a_local_space_refuses_what_is_outside_its_box(spaces):
    _, whole = spaces
    n = whole.dimension
    local = LocalCSpace(whole, np.full(n, -1.0), np.full(n, 1.0))
    rows = configurations(np.random.default_rng(4), n, 3.0, 500)
    outside = np.any(np.abs(rows[:, :n]) > 1.0, axis=1)
    assert not local.are_valid(rows[outside]).any()
    middle = rows[~outside][:1]
    ends = np.repeat(middle, outside.sum(), axis=0)
    assert not local.are_motions_valid(ends, rows[outside]).any()


def test_clearances_of_a_local_space_are_lower_bounds(spaces):
    _, whole = spaces
    n = whole.dimension
    local = LocalCSpace(whole, np.full(n, -1.0), np.full(n, 1.0))
    rows = configurations(np.random.default_rng(5), n, 2.5, 300)
    for row in rows:
        assert local.clearance(row) <= max(whole.clearance(row), 0.0) + 1e-12
    first, last = motions(np.random.default_rng(6), n, 0.7, 150)
    for a, b in zip(first, last, strict=True):
        assert local.motion_clearance(a, b) <= max(whole.motion_clearance(a, b), 0.0) * 1.002


def test_a_local_space_is_as_small_as_its_box(spaces):
    few, many = spaces
    n = few.dimension
    box = np.full(n, -0.5), np.full(n, 0.5)
    one, other = LocalCSpace(few, *box), LocalCSpace(many, *box)
    assert {b.name for b in one.world.obstacles} == {b.name for b in other.world.obstacles}
    assert 0 < len(other.world.obstacles) < 100
    assert other.scene.nbytes < 2 * one.scene.nbytes < 0.1 * many.scene.nbytes
    assert other.scene[layout.OBSTACLE_COUNT] == len(other.world.obstacles)


@DIMENSIONS
@pytest.mark.parametrize("clearance", [0.0, 0.1])
def test_a_local_space_keeps_arenas_and_the_clearance(dimension, clearance):
    rng = np.random.default_rng(8)
    scenario = scale_scenario(1000, dimension)
    arena = Ellipsoid.from_semi_axes([2.6, 2.3, 2.2][:dimension])
    low, high = scenario.world.low, scenario.world.high
    world = World(low, high, scenario.world.obstacles, (arena,))
    whole = CSpace(world, scenario.robot, clearance)
    local = LocalCSpace(whole, np.full(dimension, -2.5), np.full(dimension, 2.5))
    rows = configurations(rng, dimension, 2.5, 3000)
    assert np.array_equal(local.are_valid(rows), whole.are_valid(rows))
    assert local.are_valid(rows).any()
    assert local.clearance_required == clearance


@DIMENSIONS
def test_a_local_space_where_no_obstacle_is(dimension):
    wall = Ellipsoid.from_semi_axes(np.full(dimension, 0.5), np.full(dimension, 50.0))
    world = World(np.full(dimension, -99.0), np.full(dimension, 99.0), (wall,) * 5)
    whole = CSpace(world, RigidRobot((Ellipsoid.from_semi_axes([0.5, 0.2, 0.2][:dimension]),)))
    local = LocalCSpace(whole, np.full(dimension, -3.0), np.full(dimension, 200.0))
    assert len(local.world.obstacles) == 5
    assert local.world.high.tolist() == [99.0] * dimension
    empty = LocalCSpace(whole, np.full(dimension, -3.0), np.full(dimension, 3.0))
    assert empty.world.obstacles == ()
    rows = configurations(np.random.default_rng(9), dimension, 3.0, 50)
    assert empty.are_valid(rows).all()
    assert all(0.0 < empty.clearance(row) <= whole.clearance(row) for row in rows)
    assert empty.motion_clearance(rows[0], rows[1]) <= whole.motion_clearance(rows[0], rows[1])
    with pytest.raises(GeometryError, match="low < high"):
        LocalCSpace(whole, np.full(dimension, 100.0), np.full(dimension, 101.0))


@DIMENSIONS
def test_a_small_table_of_pairs_changes_no_interval(dimension, monkeypatch):
    cspace = scale_scenario(1000, dimension).cspace()
    rows = configurations(np.random.default_rng(10), dimension, 2.0, 6)
    expected = [cspace.layer(row).free_intervals(row[:dimension]) for row in rows]
    monkeypatch.setattr(layer, "_MOST_WHITENED", 3)
    for row, intervals in zip(rows, expected, strict=True):
        assert np.array_equal(cspace.layer(row).free_intervals(row[:dimension]), intervals)


def test_lines_may_have_any_number_of_intervals():
    places = np.arange(300.0)
    obstacles = tuple(Ellipsoid.from_semi_axes([0.2, 0.2], [0.0, y]) for y in places)
    world = World([-1.0, -0.5], [1.0, 299.5], obstacles)
    robot = RigidRobot((Ellipsoid.from_semi_axes([0.1, 0.1]),))
    intervals = CSpace(world, robot).layer(np.zeros(3)).free_intervals([0.0, 0.0])
    assert len(intervals) == 301
    assert np.allclose(intervals[1:-1, 0], places[:-1] + 0.3, atol=1e-6)


@DIMENSIONS
def test_worlds_hold_each_other(dimension):
    small, large = (scale_scenario(count, dimension) for count in (10, 1000))
    for a, b in zip(small.world.obstacles, large.world.obstacles, strict=False):
        assert np.array_equal(a.matrix, b.matrix)
        assert np.array_equal(a.centre, b.centre)
    assert np.array_equal(small.start, large.start)
    assert np.array_equal(small.goal, large.goal)
    outer = [body.centre for body in large.world.obstacles[10:100]]
    assert np.abs(outer).max(axis=1).min() >= 0.5 * side(10, dimension)
