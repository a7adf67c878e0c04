"""Roadmaps that are kept in files, as OMPL planners and whole plans use them."""

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.errors import PlannerError, RoadmapError
from ellipsoid_planning.scenario import Scenario
from planners import bindings
from planners.highway import HighwayRoadmap
from planners.setup import simple_setup
from planners.solve import plan
from planners.spaces import state_access
from tests.planners.planner_scenes import scenario_of

SOLVED = ob.PlannerStatus.PlannerStatusType.EXACT_SOLUTION


@pytest.fixture(autouse=True)
def silent():
    with bindings.ompl_output("silent"):
        yield


def planner_for(scenario):
    setup = simple_setup(scenario, seed=1)
    planner = HighwayRoadmap(setup.getSpaceInformation())
    setup.setPlanner(planner)
    return setup, planner


def path_of(setup, scenario):
    access = state_access(scenario.cspace())
    return bindings.configurations_of_path(setup.getSolutionPath(), access)


@pytest.mark.parametrize("kind", ["planar", "spatial"])
def test_a_planner_goes_on_with_a_roadmap_from_a_file(kind, tmp_path):
    scenario, file = scenario_of(kind), tmp_path / "a.roadmap"
    setup, planner = planner_for(scenario)
    assert setup.solve(10.0).getStatus() == SOLVED
    planner.save_roadmap(file)
    statistics = planner.statistics
    other_setup, other = planner_for(scenario)
    other.load_roadmap(file)
    assert other.statistics == statistics
    # A kept roadmap plans again as the loaded one plans for the first time.
    planner.clearQuery()
    setup.getProblemDefinition().clearSolutionPaths()
    for each in (setup, other_setup):
        assert each.solve(10.0).getStatus() == SOLVED
    np.testing.assert_array_equal(path_of(setup, scenario), path_of(other_setup, scenario))
    assert other.statistics == planner.statistics
    assert other.statistics["expansions"] > statistics["expansions"]
    assert len(other.roadmap_graph().edges) == len(planner.roadmap_graph().edges)
    other.clear()
    assert other.statistics == {}


def test_parameters_of_the_planner_count(tmp_path):
    scenario, file = scenario_of("planar"), tmp_path / "a.roadmap"
    setup, planner = planner_for(scenario)
    planner.lines = 30
    setup.solve(5.0)
    planner.save_roadmap(file)
    _, other = planner_for(scenario)
    with pytest.raises(RoadmapError, match=r"lines 30 \(here 24\)"):
        other.load_roadmap(file)
    other.lines, other.inflation = 30, 1.0
    other.load_roadmap(file)
    assert other.statistics == planner.statistics


def between(scenario, first, last):
    """The same scene with other ends."""
    return Scenario("other ends", scenario.world, scenario.robot, first, last, scenario.clearance)


def test_a_plan_keeps_its_roadmap(tmp_path):
    scenario, file = scenario_of("spatial"), tmp_path / "a.roadmap"
    results, files = [], []
    for _ in range(3):
        results.append(plan(scenario, seed=1, roadmap=file))
        files.append(file.read_bytes())
    assert all(result.path.certified for result in results)
    expansions = [result.statistics["expansions"] for result in results]
    assert sorted(set(expansions)) == expansions
    assert len(set(files)) == 3
    back = between(scenario, scenario.goal, scenario.start)
    again, alone = plan(back, seed=1, roadmap=str(file)), plan(back, seed=1)
    assert again.path.certified
    new = again.statistics["lines"] - results[-1].statistics["lines"]
    assert new < alone.statistics["lines"]


def test_no_path_is_worth_keeping_too(tmp_path):
    scenario, file = scenario_of("planar", blocked=True), tmp_path / "a.roadmap"
    given = {"refine": 0, "axis": 0}
    first = plan(scenario, parameters=given, roadmap=file)
    again = plan(scenario, parameters=given, roadmap=file)
    assert first.status == again.status == "exhausted"
    assert again.statistics["lines"] == first.statistics["lines"] > 0


def test_what_cannot_keep_a_roadmap_says_so(tmp_path, monkeypatch):
    scenario, file = scenario_of("planar"), tmp_path / "a.roadmap"
    for name in ("RRTConnect", "FreeIntervalRRTConnect"):
        with pytest.raises(PlannerError, match=f"roadmap: {name} keeps no roadmap in a file"):
            plan(scenario, name, roadmap=file)
    with pytest.raises(RoadmapError, match="does not exist; create it first"):
        plan(scenario, roadmap=tmp_path / "missing" / "a.roadmap")
    file.write_text("mine", encoding="utf-8")
    with pytest.raises(RoadmapError, match="expected a roadmap, this file is another one"):
        plan(scenario, roadmap=file)
    assert file.read_text(encoding="utf-8") == "mine"
    monkeypatch.setattr("os.access", lambda *_: False)
    with pytest.raises(RoadmapError, match="the folder cannot be written to"):
        plan(scenario, roadmap=tmp_path / "new.roadmap")


def test_another_scene_is_refused_and_its_file_stays(tmp_path):
    file = tmp_path / "a.roadmap"
    plan(scenario_of("planar"), seed=1, roadmap=file)
    kept = file.read_bytes()
    with pytest.raises(RoadmapError, match=r"clearance 0.0 \(here 0.01\)"):
        plan(scenario_of("planar", clearance=0.01), seed=1, roadmap=file)
    with pytest.raises(RoadmapError, match="another world, another robot"):
        plan(scenario_of("spatial"), seed=1, roadmap=file)
    assert file.read_bytes() == kept
