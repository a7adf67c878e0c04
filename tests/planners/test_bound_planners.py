"""OMPL's own planners with the plug-in: their paths against a dense check, and repeatability."""

import numpy as np
import pytest
from ompl import base as ob
from ompl import geometric as og

from planners import bindings
from planners.certify import is_certified
from planners.motion import CertifiedMotionValidator
from planners.setup import install, simple_setup
from planners.solve import plan
from planners.spaces import state_access, state_space, write_configuration
from tests.planners.planner_scenes import KINDS, least_clearance, scenario_of

PLANNERS = ("PRM", "RRT", "RRTConnect", "RRTstar", "BITstar", "FMT", "KPIECE1")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", PLANNERS)
def test_paths_are_certified_and_pass_a_dense_check(name, kind):
    scenario = scenario_of(kind)
    result = plan(scenario, name, seed=3, time_limit=600.0)
    assert result.status == "solved"
    assert result.path.certified
    path = result.path.configurations
    assert np.array_equal(path[0], scenario.start)
    assert np.array_equal(path[-1], scenario.goal)
    assert 0.0 <= result.path.min_clearance <= least_clearance(scenario, path, count=9) + 1e-9


@pytest.mark.parametrize("name", ["RRTConnect", "PRM"])
def test_a_required_clearance_is_kept(name):
    scenario = scenario_of("planar", clearance=0.2)
    result = plan(scenario, name, seed=3, time_limit=600.0)
    assert result.path.certified
    assert result.path.min_clearance >= 0.2
    assert least_clearance(scenario, result.path.configurations) >= 0.2 - 1e-9


# PRM looks for a path in a thread of its own: on a busy machine it notices it one milestone later.
@pytest.mark.parametrize("name", ["RRTConnect", "RRT", "FMT", "BITstar"])
def test_runs_repeat_exactly_with_a_seed(name):
    scenario = scenario_of("planar")
    first, second, other = (
        plan(scenario, name, seed=seed, time_limit=600.0).path.configurations for seed in (5, 5, 6)
    )
    assert np.array_equal(first, second)
    assert not np.array_equal(first, other)


def test_three_lines_of_ompl_suffice():
    setup = simple_setup(scenario_of("planar"), seed=1)
    setup.setPlanner(og.RRTConnect(setup.getSpaceInformation()))
    with bindings.ompl_output("silent"):
        assert setup.solve(5.0)
        setup.simplifySolution()
    scenario = scenario_of("planar")
    access = state_access(scenario.cspace())
    path = bindings.configurations_of_path(setup.getSolutionPath(), access)
    assert is_certified(scenario.cspace(), path)
    assert setup.getSolutionPath().check()
    assert setup.getSolutionPath().clearance() > 0.0


def test_a_space_information_of_ones_own_needs_no_file():
    scenario = scenario_of("spatial")
    cspace = scenario.cspace()
    si = ob.SpaceInformation(state_space(cspace))
    install(si, cspace)
    si.setup()
    problem = ob.ProblemDefinition(si)
    start, goal = si.allocState(), si.allocState()
    write_configuration(start, scenario.start, cspace)
    write_configuration(goal, scenario.goal, cspace)
    problem.setStartAndGoalStates(start, goal)
    planner = og.RRTConnect(si)
    planner.setProblemDefinition(problem)
    with bindings.ompl_output("silent"):
        planner.setup()
        assert planner.solve(5.0)
    found = bindings.configurations_of_path(problem.getSolutionPath(), state_access(cspace))
    assert is_certified(cspace, found)


def test_simplification_uses_the_certified_validator(monkeypatch):
    scenario = scenario_of("planar")
    setup = simple_setup(scenario, seed=1)
    si = setup.getSpaceInformation()
    cspace = scenario.cspace()
    access = state_access(cspace)
    setup.setPlanner(og.RRT(si))
    with bindings.ompl_output("silent"):
        assert setup.solve(10.0)
    path = bindings.configurations_of_path(setup.getSolutionPath(), access)
    asked = []
    check = CertifiedMotionValidator.checkMotion
    monkeypatch.setattr(
        CertifiedMotionValidator, "checkMotion", lambda *a: asked.append(1) or check(*a)
    )
    shorter = bindings.simplified(si, path, access, bindings.stop_after(1.0))
    assert asked
    assert is_certified(cspace, shorter)
    lengths = [sum(map(cspace.distance, rows[:-1], rows[1:])) for rows in (shorter, path)]
    assert lengths[0] < lengths[1]


def test_planners_that_ask_for_the_last_valid_state_get_a_safe_answer():
    # KPIECE1 asks with three arguments; what it keeps must be free all the same.
    scenario = scenario_of("planar")
    result = plan(
        scenario, "KPIECE1", seed=4, time_limit=600.0, parameters={"min_valid_path_fraction": 1e-3}
    )
    assert result.path.certified
    assert least_clearance(scenario, result.path.configurations) > 0.0
