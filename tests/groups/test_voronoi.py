"""Voronoi cells: exact, of the published sizes, and inside the published polyhedra."""

import math

import numpy as np
import pytest

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import (
    VoronoiCell,
    cyclic,
    dihedral,
    icosahedral,
    octahedral,
    single_coset,
    tetrahedral,
)
from ellipsoid_planning.groups.distortion import (
    distortion,
    distortion_of_jacobian,
    euler_distortion,
)
from ellipsoid_planning.groups.published_cells import published_cell
from ellipsoid_planning.groups.quaternions import exponential, logarithm, product, rodrigues
from ellipsoid_planning.groups.voronoi import ALL_ROTATIONS, polyhedron_edges
from tests.groups.checks import angles, probes

SOLIDS = {"tetrahedral": tetrahedral(), "octahedral": octahedral(), "icosahedral": icosahedral()}
# faces, vertices, circumradius, largest C; the thesis prints 0.73 and 3.52 % for the last, which
# are those of the farthest node of a grid of step pi / 30.
CELLS = {
    "tetrahedral": (8, 6, math.pi / 2.0, 0.1547),
    "octahedral": (14, 24, 1.09606, 0.0785),
    "icosahedral": (12, 20, 0.776279, 0.0402),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_cells_have_the_checked_sizes(name):
    cell = VoronoiCell.of_group(SOLIDS[name])
    faces, vertices, radius, largest = CELLS[name]
    assert (len(cell.normals), len(cell.vertices)) == (faces, vertices)
    assert cell.circumradius == pytest.approx(radius, abs=1e-5)
    assert distortion(cell.circumradius) == pytest.approx(largest, abs=5e-5)
    assert cell.volume == pytest.approx(ALL_ROTATIONS / len(SOLIDS[name]))
    edges = polyhedron_edges(cell.normals, cell.offsets, cell.vertices)
    assert len(vertices := cell.vertices) - len(edges) + faces == 2
    assert len(vertices) == CELLS[name][1]


def test_printed_distortion_is_that_of_a_node_of_a_grid_with_step_pi_over_30():
    cell, step = VoronoiCell.of_group(icosahedral()), math.pi / 30.0
    axis = step * np.arange(-8, 9)
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    farthest = np.linalg.norm(points[cell.contains(exponential(points))], axis=1).max()
    assert farthest == pytest.approx(0.73, abs=0.005)
    assert distortion(farthest) == pytest.approx(0.0352, abs=5e-5)


@pytest.mark.parametrize(
    "group", [*SOLIDS.values(), cyclic(1), cyclic(3), dihedral(4)], ids=lambda g: g.name
)
def test_membership_is_nearness_to_the_identity(group):
    q = probes(5000)
    away = angles(q, group.quaternions)
    inside = VoronoiCell.of_group(group).contains(q)
    assert np.array_equal(inside, away[:, 0] <= away.min(axis=1))
    assert np.mean(inside) == pytest.approx(1.0 / len(group), abs=0.03)


@pytest.mark.parametrize("name", SOLIDS)
def test_reach_ends_on_the_border(name):
    group = SOLIDS[name]
    cell, axes = VoronoiCell.of_group(group), np.random.default_rng(1).normal(size=(200, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    away = np.sort(angles(exponential(cell.reach(axes)[:, None] * axes), group.quaternions), axis=1)
    np.testing.assert_allclose(away[:, 0], away[:, 1], atol=1e-7)


@pytest.mark.parametrize("name", SOLIDS)
def test_published_polyhedra_enclose_the_cells(name):
    published, group = published_cell(name), SOLIDS[name]
    gaps = published.vertices @ published.normals.T - published.offsets
    assert np.all(gaps < 1e-12)
    assert np.all(np.count_nonzero(np.abs(gaps) < 1e-12, axis=1) >= 3)
    assert np.all(np.count_nonzero(np.abs(gaps) < 1e-12, axis=0) >= 3)
    inside = logarithm(single_coset(group, probes(20000)).rotations)
    assert np.all(published.contains(inside))
    # Faces touch the cell in the middle, on the way to the neighbouring elements.
    near = logarithm(group.quaternions[1:]) / 2.0
    near = np.vstack([near, -near])
    touching = np.abs(near @ published.normals.T - published.offsets).min(axis=0)
    np.testing.assert_allclose(touching, 0.0, atol=1e-12)


def test_the_octahedral_corner_is_the_corrected_one():
    corner = np.sort(np.abs(published_cell("octahedral").vertices), axis=1)[:, 0]
    np.testing.assert_allclose(corner, math.pi / 4.0 * (1.0 - 0.6906), atol=1e-4)


def test_unknown_cells_are_refused():
    with pytest.raises(GridError, match="tetrahedral, octahedral, icosahedral"):
        published_cell("cubic")
    with pytest.raises(GridError, match="identity once"):
        VoronoiCell.of_centres(probes(4))
    with pytest.raises(GridError, match="no finite vertices"):
        _ = VoronoiCell.of_group(cyclic(4)).vertices
    assert VoronoiCell.of_group(cyclic(4)).circumradius == math.pi


def numeric_metric(rotation_of, coordinates, step=1e-6):
    """The metric tensor's Jacobian by differences of rotations, columns as rotation vectors."""
    columns = []
    for i in range(3):
        shift = step * np.eye(3)[i]
        ahead, behind = rotation_of(coordinates + shift), rotation_of(coordinates - shift)
        relative = product(ahead, behind * [-1, -1, -1, 1])
        columns.append(logarithm(relative) / (2.0 * step))
    return np.column_stack(columns)


def test_distortion_is_that_of_the_jacobian():
    for x in np.random.default_rng(0).normal(size=(20, 3)):
        expected = distortion_of_jacobian(numeric_metric(exponential, x))
        assert distortion(float(np.linalg.norm(x))) == pytest.approx(float(expected), abs=1e-7)
    assert distortion(0.0) == 0.0


def test_euler_angles_distort_by_up_to_81_65_percent():
    def zxz(angles_):
        a, b, c = angles_
        first, last = exponential([0.0, 0.0, a]), exponential([0.0, 0.0, c])
        return product(product(first, exponential([b, 0.0, 0.0])), last)

    for beta in (0.1, 1.0, 2.0, 3.0):
        jacobian = numeric_metric(zxz, np.array([0.3, beta, -1.0]))
        assert float(euler_distortion(beta)) == pytest.approx(
            float(distortion_of_jacobian(jacobian)), abs=1e-7
        )
    assert float(euler_distortion(math.pi)) == pytest.approx(0.8165, abs=5e-5)


def test_rodrigues_vertices_are_as_far_from_several_elements():
    cell = VoronoiCell.of_group(icosahedral())
    q = np.column_stack([cell.vertices, np.ones(20)])
    q /= np.linalg.norm(q, axis=1)[:, None]
    np.testing.assert_allclose(rodrigues(q), cell.vertices)
    away = np.sort(angles(q, icosahedral().quaternions), axis=1)
    np.testing.assert_allclose(away[:, 3], away[:, 0], atol=1e-7)  # four cells meet
