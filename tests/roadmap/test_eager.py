"""The eager roadmap of a layer, and the removal of its redundant nodes (thesis 6.3.2)."""

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError, PlannerError
from ellipsoid_planning.roadmap.eager import eager_roadmap, layer_orientations
from ellipsoid_planning.roadmap.graph import RoadmapGraph
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.roadmap.prune import without_redundant_nodes
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.roadmap.scenes import body, cage, components, configuration, pillars

CASES = {
    "one planar layer": (pillars(2), False, RoadmapParameters(lines=60)),
    "one planar layer swept along x": (pillars(2), False, RoadmapParameters(lines=60, axis=0)),
    "with clearance": (pillars(2, clearance=0.3), False, RoadmapParameters(lines=60)),
    "planar translation": (pillars(2, rotates=False), True, RoadmapParameters(lines=50)),
    "all planar layers": (pillars(2), True, RoadmapParameters(lines=16)),
    "one spatial layer": (pillars(3), False, RoadmapParameters(lines=14)),
    "spatial, swept along x": (pillars(3), False, RoadmapParameters(lines=14, axis=0)),
    "spatial translation": (pillars(3, rotates=False), True, RoadmapParameters(lines=14)),
    "all spatial layers": (pillars(3), True, RoadmapParameters(lines=5)),
    "components that do not meet": (cage(2, 9.0), False, RoadmapParameters(lines=40)),
}


@pytest.fixture(scope="module", params=CASES)
def case(request):
    cspace, every, parameters = CASES[request.param]
    if every:
        layers = layer_orientations(cspace)
    else:
        layers = configuration(cspace, *[0.0] * cspace.dimension, yaw=0.4)[0]
    return cspace, parameters, layers, eager_roadmap(cspace, layers, parameters)


def all_edges_are_proved(graph, cspace):
    first, last = graph.configurations[graph.edges.T]
    return bool(cspace.are_motions_valid(first, last).all())


def test_vertices_are_the_midpoints_of_all_free_intervals(case):
    cspace, parameters, layers, graph = case
    axis = parameters.checked_axis(cspace.dimension)
    n = cspace.dimension
    assert cspace.are_valid(graph.configurations).all()
    for row in graph.configurations[:: max(len(graph.configurations) // 50, 1)]:
        intervals = cspace.layer(row).free_intervals(row[:n], axis)
        assert np.min(np.abs(intervals.mean(axis=1) - row[axis])) < 1e-12
        same = np.all(np.delete(graph.configurations, axis, axis=1) == np.delete(row, axis), axis=1)
        assert np.count_nonzero(same) == len(intervals)
    assert set(graph.layers) <= set(range(len(np.atleast_2d(layers))))
    assert not graph.configurations.flags.writeable


def test_every_edge_is_proved_and_joins_neighbours(case):
    cspace, parameters, _, graph = case
    assert len(graph.edges) > 30
    assert np.all(graph.edges[:, 0] < graph.edges[:, 1])
    assert len(np.unique(graph.edges, axis=0)) == len(graph.edges)
    assert all_edges_are_proved(graph, cspace)
    n, axis = cspace.dimension, parameters.checked_axis(cspace.dimension)
    first, last = graph.configurations[graph.edges.T]
    across = np.delete(np.arange(n), axis)
    moved = np.abs(first[:, across] - last[:, across]) > 0.0
    turned = graph.layers[graph.edges[:, 0]] != graph.layers[graph.edges[:, 1]]
    np.testing.assert_array_equal(moved.sum(axis=1), np.where(turned, 0, 1))


def test_fewer_vertices_and_the_same_connectivity(case):
    cspace, parameters, _, graph = case
    pruned = without_redundant_nodes(graph, cspace, parameters.axis)
    assert len(pruned.configurations) < 0.75 * len(graph.configurations)
    assert all_edges_are_proved(pruned, cspace)
    old = {row.tobytes(): k for k, row in enumerate(graph.configurations)}
    kept = np.array([old[row.tobytes()] for row in pruned.configurations])
    np.testing.assert_array_equal(graph.layers[kept], pruned.layers)
    before = components(len(graph.configurations), graph.edges)
    after = components(len(kept), pruned.edges)
    # Every component is still there, and vertices share one exactly if they did.
    assert set(before[kept]) == set(before)
    assert len(set(zip(before[kept], after, strict=True))) == len(set(before)) == len(set(after))


def test_junctions_and_ends_stay():
    cspace = pillars(2)
    graph = eager_roadmap(cspace, configuration(cspace, 0.0, 0.0), RoadmapParameters(lines=60))
    pruned = without_redundant_nodes(graph, cspace)
    degree = np.bincount(graph.edges.ravel(), minlength=len(graph.configurations))
    kept = {row.tobytes() for row in pruned.configurations}
    assert np.count_nonzero(degree > 2) >= 4
    for row in graph.configurations[degree != 2]:
        assert row.tobytes() in kept


def test_an_open_hall_is_one_route_of_two_ends():
    world = World(np.array([-9.0, -9.0]), np.array([9.0, 9.0]))
    cspace = CSpace(world, RigidRobot((body([1.0, 0.5]),)))
    graph = eager_roadmap(cspace, [0.0, 0.0, 0.3], RoadmapParameters(lines=20))
    assert len(graph.configurations) == 20
    pruned = without_redundant_nodes(graph, cspace)
    np.testing.assert_array_equal(pruned.configurations, graph.configurations[[0, -1]])
    np.testing.assert_array_equal(pruned.edges, [[0, 1]])


def test_a_ring_without_junctions_keeps_its_component():
    cspace = pillars(2)
    around = cspace.world.obstacles[0].centre + 3.2 * np.column_stack(
        [np.cos(np.arange(12) * np.pi / 6), np.sin(np.arange(12) * np.pi / 6)]
    )
    rows = np.column_stack([around, np.zeros(12)])
    edges = np.column_stack([np.arange(12), (np.arange(12) + 1) % 12])
    proved = cspace.are_motions_valid(rows[edges[:, 0]], rows[edges[:, 1]])
    graph = RoadmapGraph(rows, edges[proved], np.zeros(12, dtype=np.int64))
    pruned = without_redundant_nodes(graph, cspace)
    assert 2 <= len(pruned.configurations) < 12
    assert all_edges_are_proved(pruned, cspace)
    before = components(12, graph.edges)
    assert len(set(before)) == len(set(components(len(pruned.configurations), pruned.edges)))


def test_a_blocked_layer_has_an_empty_roadmap():
    cspace = pillars(2, clearance=6.0)
    graph = eager_roadmap(cspace, [0.0, 0.0, 0.0])
    assert graph.configurations.shape == (0, 3)
    assert graph.edges.shape == (0, 2)
    assert len(without_redundant_nodes(graph, cspace).configurations) == 0


def test_the_planner_s_own_layers():
    assert layer_orientations(pillars(2)).shape == (36, 3)
    assert layer_orientations(pillars(3)).shape == (60, 7)
    assert layer_orientations(pillars(3), 9).shape == (9, 7)
    assert layer_orientations(pillars(3, rotates=False)).shape == (1, 3)


def test_bad_layers_and_parameters_are_refused():
    with pytest.raises(GeometryError, match="configurations of 3 finite numbers"):
        eager_roadmap(pillars(2), [0.0, 0.0])
    with pytest.raises(PlannerError, match="axis: expected 0 to 1, got 2"):
        eager_roadmap(pillars(2), [0.0, 0.0, 0.0], RoadmapParameters(axis=2))
