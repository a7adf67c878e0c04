"""Layers from grids of rotations: by name, with the grid's neighbours, finer level by level."""

import numpy as np
import pytest

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.layer_grids import grid_layers
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.scenario import load_scenario


def never():
    return False


def planner(name, orientations, **others):
    cspace = load_scenario(name).cspace()
    return HighwayRoadmap(cspace, RoadmapParameters(orientations=orientations, **others))


@pytest.mark.parametrize(
    ("grid", "joined"), [("600-cell", 12), ("octahedral", 6), ("super-fibonacci", 4)]
)
def test_neighbours_are_near_and_mutual(grid, joined):
    size = {"count": 500} if grid == "super-fibonacci" else {"resolution_deg": 20.0}
    layers, table = grid_layers(3, {"grid": grid, **size}, 1.0)
    degrees = np.array([np.count_nonzero(row >= 0) for row in table])
    assert joined <= np.median(degrees) <= 18
    for node in range(0, len(layers), 37):
        for other in table[node][table[node] >= 0]:
            assert node in table[other]
            angle = 2.0 * np.arccos(min(1.0, abs(layers[node] @ layers[other])))
            assert angle < 1.36 * (8.0 * np.pi**2 / len(layers)) ** (1.0 / 3.0)


def test_finer_levels_have_about_as_many_layers_as_they_should():
    asked = {"grid": "600-cell", "resolution_deg": 40.0}
    counts = [len(grid_layers(3, asked, finer)[0]) for finer in (1.0, 2.5, 6.25)]
    assert counts[0] < counts[1] < counts[2] < 12 * counts[0]
    fixed = {"grid": "icosahedral-wedge", "count": 3600}
    assert len(grid_layers(3, fixed, 2.5)[0]) == 3600


def test_headings_form_a_ring():
    layers, table = grid_layers(2, {"grid": "headings", "resolution_deg": 10.0}, 1.0)
    assert len(layers) == 36
    assert table[0].tolist() == [35, 1]


@pytest.mark.parametrize(
    ("name", "orientations"),
    [
        ("rabbit-3d-narrow", {"grid": "600-cell", "count": 420}),
        ("rabbit-3d-cluttered", {"grid": "icosahedral-bcc", "resolution_deg": 30.0}),
        ("rabbit-2d-narrow", {"grid": "headings", "count": 24}),
    ],
)
def test_scenes_are_solved_on_them(name, orientations, tmp_path):
    scenario, roadmap = load_scenario(name), planner(name, orientations)
    outcome = roadmap.solve(scenario.start[None], scenario.goal[None], never)
    assert outcome.status == SOLVED
    assert roadmap.cspace.are_motions_valid(outcome.path[:-1], outcome.path[1:]).all()
    roadmap.save(tmp_path / "roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "roadmap", scenario.cspace())
    again = loaded.solve(scenario.start[None], scenario.goal[None], never)
    assert again.status == SOLVED


@pytest.mark.parametrize(
    ("orientations", "said"),
    [
        ("600-cell", "expected {grid"),
        ({"grid": "600-cell"}, "neither"),
        ({"grid": "600-cell", "count": 60, "resolution_deg": 30}, "count and resolution_deg"),
        ({"grid": "cell", "count": 60}, "expected one of headings, 600-cell"),
        ({"grid": "600-cell", "count": -1}, "positive"),
        ({"grid": "600-cell", "size": 60}, "unknown key 'size'"),
    ],
)
def test_wrong_values_are_refused_at_once(orientations, said):
    with pytest.raises(PlannerError, match=said):
        RoadmapParameters(orientations=orientations)


def test_a_grid_must_fit_the_robot():
    with pytest.raises(PlannerError, match="'headings' in the plane"):
        planner("rabbit-2d-open", {"grid": "600-cell", "count": 60}).prepare()
    with pytest.raises(PlannerError, match="grid of rotations in space"):
        planner("rabbit-3d-open", {"grid": "headings", "count": 60}).prepare()
    with pytest.raises(PlannerError, match="cannot have 61"):
        planner("rabbit-3d-open", {"grid": "600-cell", "count": 61}).prepare()
    with pytest.raises(PlannerError, match="joints"):
        planner("chain-18dof", {"grid": "600-cell", "count": 60}).prepare()
