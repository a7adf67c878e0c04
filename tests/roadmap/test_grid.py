"""The columns and layers of a level, their neighbours, and those that queries bring."""

import numpy as np
import pytest

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.kernels.grid import UNKNOWN
from ellipsoid_planning.kernels.roadmap_metric import METRIC
from ellipsoid_planning.roadmap.grid import QUERY_ROOM, SPARE_ROWS, Grid, grid_columns, swept_box
from ellipsoid_planning.roadmap.orientations import spread_orientations
from ellipsoid_planning.world import World

NO_JOINTS = np.empty((0, METRIC))


def world(n=3, arenas=()):
    return World(np.array([-4.0, -2.0, -1.0])[:n], np.array([4.0, 2.0, 5.0])[:n], (), arenas)


def grid(lines=6, layers=60, joined=12):
    columns, neighbours = grid_columns(world(), 2, lines)
    return Grid(columns, neighbours, spread_orientations(3, layers), joined, NO_JOINTS, 1.0)


@pytest.mark.parametrize(
    ("n", "axis", "lines", "count"),
    [(2, 1, 8, 8), (2, 0, 5, 5), (3, 2, 8, 32), (3, 0, 6, 24), (3, 1, 8, 48), (3, 2, 1, 1)],
)
def test_columns_stand_at_the_middles_of_square_cells(n, axis, lines, count):
    columns, neighbours = grid_columns(world(n), axis, lines)
    assert columns.shape == (count, 3)
    assert neighbours.shape == (count, 2 * (n - 1))
    assert np.all(columns[:, axis] == 0.0)
    low, high = swept_box(world(n))
    for k in set(range(n)) - {axis}:
        places = np.unique(columns[:, k])
        assert places[0] - low[k] == pytest.approx(high[k] - places[-1])
        assert places[0] - low[k] == pytest.approx(0.5 * (high[k] - low[k]) / len(places))


@pytest.mark.parametrize(("n", "axis", "lines"), [(2, 1, 9), (3, 2, 7), (3, 0, 5), (3, 1, 1)])
def test_neighbouring_columns_are_symmetric_and_one_cell_apart(n, axis, lines):
    columns, neighbours = grid_columns(world(n), axis, lines)
    pairs = {(a, int(b)) for a, row in enumerate(neighbours) for b in row if b >= 0}
    assert pairs == {(b, a) for a, b in pairs}
    for a, b in pairs:
        moved = np.flatnonzero(columns[a] != columns[b])
        assert len(moved) == 1
        between = np.unique(columns[:, moved[0]])
        assert abs(np.subtract(*np.searchsorted(between, columns[[a, b], moved[0]]))) == 1
    counts = [len(np.unique(columns[:, k])) for k in range(3)]
    edges = sum((c - 1) * len(columns) // c for c in counts)
    assert len(pairs) == 2 * edges


def test_the_box_is_cut_by_arenas_that_cannot_be_left():
    arena = Ellipsoid.from_semi_axes([2.0, 9.0, 1.0], [1.0, 0.0, 0.0])
    low, high = swept_box(world(arenas=(arena,)))
    np.testing.assert_allclose(low, [-1.0, -2.0, -1.0])
    np.testing.assert_allclose(high, [3.0, 2.0, 1.0])


def test_an_arena_out_of_bounds_leaves_one_line_not_an_error():
    arena = Ellipsoid.from_semi_axes([1.0, 1.0, 1.0], [50.0, 50.0, 50.0])
    columns, neighbours = grid_columns(world(arenas=(arena,)), 2, 10)
    assert columns.shape == (1, 3)
    assert np.all(neighbours == -1)


def test_too_many_lines_are_refused():
    with pytest.raises(PlannerError, match="lines: 5000 a side make 12500000 lines"):
        grid_columns(world(), 2, 5000)


def test_a_known_column_is_found_and_a_new_one_is_joined_both_ways():
    level = grid()
    count = level.column_count
    at = level.columns[5].copy()
    at[2] = 3.21
    assert level.column_of(at, 2) == 5
    new = level.column_of(np.array([0.1, 0.2, 9.0]), 2)
    assert (new, level.column_count) == (count, count + 1)
    np.testing.assert_array_equal(level.columns[new], [0.1, 0.2, 0.0])
    assert level.column_of(np.array([0.1, 0.2, -1.0]), 2) == new
    row = level.column_neighbours[new]
    joined = row[row >= 0]
    away = np.linalg.norm(level.columns[:count] - level.columns[new], axis=1)
    assert set(joined) == set(np.argsort(away)[:4])
    assert all(new in level.column_neighbours[other] for other in joined)


def test_a_known_layer_is_found_and_a_new_one_is_joined_both_ways():
    level = grid()
    assert level.layer_of(level.orientations[7].copy()) == 7
    quaternion = np.array([0.1, 0.2, 0.3, 0.9])
    quaternion /= np.linalg.norm(quaternion)
    new = level.layer_of(quaternion)
    assert (new, level.layer_count) == (60, 61)
    assert level.layer_of(quaternion) == new
    row = level.layer_neighbours[new]
    joined = row[row >= 0]
    closeness = np.abs(level.orientations[:60] @ quaternion)
    assert set(joined) == set(np.argsort(-closeness, kind="stable")[:12])
    assert all(new in level.layer_neighbours[other] for other in joined)
    # Rows that the search has not needed yet say so still.
    assert np.all(level.layer_neighbours[:60, 0] == UNKNOWN)


def test_rows_that_overflow_keep_the_grid_and_the_latest():
    level = grid(lines=2, layers=1, joined=3)
    own = level.column_neighbours[0][level.column_neighbours[0] >= 0].copy()
    place = level.columns[0].copy()
    random = np.random.default_rng(1)
    for _ in range(5 * QUERY_ROOM):
        new = level.column_of(place + random.uniform(-1e-3, 1e-3, 3), 2)
        row = level.column_neighbours[new]
        assert len(row[row >= 0]) >= min(4, new)
        assert np.all(level.column_neighbours < level.column_count)
    assert set(own) <= set(level.column_neighbours[0])


def test_tables_grow_when_queries_fill_their_spare_rows():
    level = grid(lines=2, layers=4, joined=3)
    columns, layers = level.column_count, level.layer_count
    random = np.random.default_rng(2)
    for k in range(3 * SPARE_ROWS):
        quaternion = random.normal(size=4)
        assert level.layer_of(quaternion / np.linalg.norm(quaternion)) == layers + k
        assert level.column_of(random.uniform(-1.0, 1.0, 3), 2) == columns + k
    assert len(level.columns) > 3 * SPARE_ROWS
    assert len(level.layer_neighbours) == len(level.orientations) > 3 * SPARE_ROWS
