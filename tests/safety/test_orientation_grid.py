"""Grids of orientations: every cell is found, and no cell is larger than it says."""

import math

import numpy as np
import pytest

from ellipsoid_planning.geometry.orientation import rotation_from_quaternion
from ellipsoid_planning.kernels import safety_table
from ellipsoid_planning.kernels.linear import product
from ellipsoid_planning.safety.orientation_grid import (
    DIRECTION,
    HEADING,
    NOTHING,
    QUATERNION,
    OrientationGrid,
    smallest_grid,
)

CELL_OF = {
    HEADING: safety_table.heading_cell,
    DIRECTION: safety_table.direction_cell,
    QUATERNION: safety_table.quaternion_cell,
}
GRIDS = [
    OrientationGrid(vector, faces, cells)
    for vector, faces in ((2, 4), (2, 2), (3, 6), (3, 3), (4, 4), (4, 1))
    for cells in (1, 2, 5)
]


def same(grid, vector):
    """All unit vectors (k, n) that a grid does not tell from ``vector``."""
    found = [vector]
    if grid.vector == QUATERNION and grid.faces == 1:
        found += [np.array(product(*vector, *half_turn)) for half_turn in np.eye(4)[:3]]
    opposite = grid.vector in (QUATERNION, grid.faces)
    return np.array([*found, *(-v for v in found)] if opposite else found)


def samples(grid, count):
    """Random unit vectors, and many near the corners and edges of cells."""
    rng = np.random.default_rng(grid.count)
    corners = grid._on_face(np.linspace(-1.0, 1.0, 2 * grid.cells + 1))
    corners = corners[rng.integers(len(corners), size=count // 2)]
    corners = np.array([rng.permutation(row) for row in corners])
    corners *= rng.choice([-1.0, 1.0], size=corners.shape)
    corners += rng.normal(size=corners.shape) * 10.0 ** rng.uniform(-16, -2, (len(corners), 1))
    vectors = np.concatenate([rng.normal(size=(count // 2, grid.vector)), corners])
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_no_orientation_is_farther_from_its_representative_than_the_radius(grid):
    vectors, cell_of, farthest = grid.vectors(), CELL_OF[grid.vector], 0.0
    assert vectors.shape == (grid.count, grid.vector)
    for vector in samples(grid, 4000):
        cell = cell_of(*(3.7 * vector), grid.faces, grid.cells)
        assert 0 <= cell < grid.count
        chord = np.linalg.norm(same(grid, vector) - vectors[cell], axis=1).min()
        farthest = max(farthest, 2.0 * math.asin(0.5 * chord))
    farthest *= 2.0 if grid.vector == QUATERNION else 1.0
    assert 0.85 * grid.radius() < farthest < grid.radius()


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_representatives_lie_in_their_own_cells(grid):
    cell_of = CELL_OF[grid.vector]
    cells = [cell_of(*vector, grid.faces, grid.cells) for vector in grid.vectors()]
    assert cells == list(range(grid.count))


@pytest.mark.parametrize("grid", GRIDS, ids=str)
def test_quaternions_turn_to_what_is_looked_up(grid):
    column = {HEADING: 0, DIRECTION: 2}.get(grid.vector)
    for vector, quaternion in zip(grid.vectors(), grid.quaternions(), strict=True):
        assert np.linalg.norm(quaternion) == pytest.approx(1.0, abs=1e-15)
        if column is None:
            assert quaternion == pytest.approx(vector, abs=0.0)
        else:
            turned = rotation_from_quaternion(quaternion)[: grid.vector, column]
            assert turned == pytest.approx(vector, abs=1e-15)


def test_opposite_directions_turn_the_axis_over():
    grid = OrientationGrid(DIRECTION, 6, 1)
    below = rotation_from_quaternion(grid.quaternions()[5])
    assert below[:, 2] == pytest.approx([0.0, 0.0, -1.0], abs=1e-15)


def test_one_orientation_needs_no_grid():
    grid = OrientationGrid(NOTHING)
    assert grid.count == 1 and grid.radius() == 0.0
    assert grid.quaternions().tolist() == [[0.0, 0.0, 0.0, 1.0]]
    assert smallest_grid(NOTHING, 1, 100) == grid
    assert smallest_grid(QUATERNION, 4, 100).count == 108


def test_quaternions_of_matrices():
    rng = np.random.default_rng(1)
    drawn = rng.normal(size=(500, 4))
    drawn[:8] = np.eye(4).repeat(2, axis=0)
    for quaternion in drawn:
        unit = quaternion / np.linalg.norm(quaternion)
        found = safety_table.matrix_quaternion(*rotation_from_quaternion(unit).ravel())
        found = np.array(found) / np.linalg.norm(found)
        assert abs(float(found @ unit)) == pytest.approx(1.0, abs=1e-14)
