"""A plan among thousands of obstacles looks at as much as one among few; counted, not timed."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scale_scenes import scale_scenario
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.roadmap.highway import SOLVED, HighwayRoadmap
from ellipsoid_planning.world import World

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def solved(cspace, scenario):
    planner = HighwayRoadmap(cspace)
    outcome = planner.solve(scenario.start[None], scenario.goal[None], lambda: False)
    assert outcome.status == SOLVED
    assert cspace.are_motions_valid(outcome.path[:-1], outcome.path[1:]).all()
    return planner, outcome.path


@DIMENSIONS
@pytest.mark.parametrize("seed", [1, 2, 5])
def test_the_size_of_the_world_does_not_matter(dimension, seed):
    found = []
    for count in (1000, 10_000):
        scenario = scale_scenario(count, dimension, seed)
        planner, path = solved(scenario.cspace(), scenario)
        found.append(planner.statistics)
        assert len(path) > 2
        assert planner.levels[0].box is not None
    # The tolerances grow with the world's size, which may shift an interval's end by rounding.
    for name, count in found[0].items():
        assert found[1][name] == pytest.approx(count, rel=0.05), name


@DIMENSIONS
def test_a_long_way_round_is_found_by_looking_farther(dimension):
    """A wall as wide as many first boxes, open at its ends only."""
    wall = Ellipsoid.from_semi_axes([0.3, 12.0, 12.0][:dimension])
    low, high = np.full(dimension, -40.0), np.full(dimension, 40.0)
    if dimension == 3:  # nothing passes above or below
        low[2], high[2] = -1.0, 1.0
    scenario = scale_scenario(10, dimension)
    cspace = CSpace(World(low, high, (wall,)), scenario.robot)
    planner, path = solved(cspace, scenario)
    assert np.abs(path[:, 1]).max() > 10.0
    assert planner.levels[0].box is not None
    assert {level.refinement for level in planner.levels} == {0}
    assert len(planner.levels) > dimension


def test_queries_in_other_places_have_levels_of_their_own():
    scenario = scale_scenario(10_000, 2)
    cspace = scenario.cspace()
    planner, _ = solved(cspace, scenario)
    lines = planner.statistics["lines"]
    rng = np.random.default_rng(1)
    ends = rng.uniform([29.0, 29.0, -3.0], [33.0, 33.0, 3.0], size=(100, 3))
    ends = ends[cspace.are_valid(ends)]
    outcome = planner.solve(ends[:1], ends[1:2], lambda: False)
    assert outcome.status == SOLVED
    assert planner.levels[0].statistics["lines"] == lines
    again = planner.solve(scenario.start[None], scenario.goal[None], lambda: False)
    assert again.status == SOLVED
    boxes = [level.box for level in planner.levels]
    assert not np.array_equal(boxes[0], boxes[1])
    assert len(boxes) == 2
