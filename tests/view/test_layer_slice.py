"""The drawn regions of a layer against the C-space's own verdicts."""

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from planners.view.layer_slice import LayerSlice
from tests.view.scenes import planar_scenario, spatial_scenario

CASES = {
    "planar": (planar_scenario, 0, 0.0),
    "planar with clearance": (planar_scenario, 0, 1.5),
    "spatial": (spatial_scenario, 0, 0.0),
    "spatial across y": (spatial_scenario, 1, 0.0),
    "spatial with clearance": (spatial_scenario, 0, 1.5),
}


@pytest.fixture(params=CASES)
def view(request):
    make, across, clearance = CASES[request.param]
    scenario = make(clearance=clearance)
    configuration = np.array(scenario.goal)
    configuration[:2] = [1.0, 2.0]
    return LayerSlice(scenario.cspace(), configuration, across)


def shrunk(polygon, factor):
    middle = 0.5 * (polygon.min(axis=0) + polygon.max(axis=0))
    return middle + factor * (polygon - middle)


def test_c_obstacles_are_where_the_robot_meets_obstacles(view):
    polygons = view.c_obstacles()
    assert len(polygons) == len(view.cspace.robot.parts) * len(view.cspace.world.obstacles)
    required = view.cspace.clearance_required
    touching = [p for polygon in polygons for p in shrunk(polygon, 0.99)[::10]]
    assert all(view.cspace.clearance(view.configuration_at(p)) < required for p in touching)


def test_the_drawn_free_region_is_the_free_region(view):
    blocked = [Outline(polygon) for polygon in view.c_obstacles()]
    allowed = Outline(view.allowed())
    low, high = view.bounds
    points = np.random.default_rng(1).uniform(low, high, (400, 2))
    near = np.zeros(len(points), dtype=bool)
    for outline in [*blocked, allowed]:
        distance = np.linalg.norm(points[:, None] - outline.vertices, axis=2).min(axis=1)
        near |= distance < 1.0
    drawn = allowed.contains_points(points)
    for outline in blocked:
        drawn &= ~outline.contains_points(points)
    free = np.array([view.cspace.is_valid(view.configuration_at(p)) for p in points])
    assert np.count_nonzero(~near) > 150
    assert 0.1 < np.mean(free[~near]) < 0.9
    np.testing.assert_array_equal(drawn[~near], free[~near])


def test_free_intervals_are_the_drawn_ones(view):
    lines = view.sweep_lines(15)
    intervals = view.free_intervals(lines)
    assert len(intervals) == 15
    for line, on_line in zip(lines, intervals, strict=True):
        for height in on_line.mean(axis=1):
            assert view.cspace.is_valid(view.configuration_at(np.array([line, height])))


def test_roadmap_edges_are_certified_and_join_neighbouring_lines(view):
    lines = view.sweep_lines(25)
    intervals = view.free_intervals(lines)
    nodes, edges = view.roadmap(lines, intervals)
    assert len(nodes) == sum(map(len, intervals))
    assert len(edges) > 10
    spacing = lines[1] - lines[0]
    np.testing.assert_allclose(edges[:, 1, 0] - edges[:, 0, 0], spacing)
    for first, second in edges:
        assert view.cspace.is_motion_valid(
            view.configuration_at(first), view.configuration_at(second)
        )


def test_a_layer_without_free_intervals_has_an_empty_roadmap():
    scenario = planar_scenario(clearance=42.0)
    view = LayerSlice(scenario.cspace(), scenario.start)
    lines = view.sweep_lines(5)
    nodes, edges = view.roadmap(lines, view.free_intervals(lines))
    assert nodes.shape == (0, 2)
    assert edges.shape == (0, 2, 2)
    assert len(view.allowed()) == 0
