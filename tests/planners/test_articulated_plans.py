"""Whole plans for articulated robots: every planner, both checkers, and those that cannot."""

from itertools import pairwise

import numpy as np
import pytest
from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners import bindings
from planners.highway import HighwayRoadmap
from planners.registry import find_planner, planner_names
from planners.setup import simple_setup
from planners.solve import plan
from planners.spaces import state_access, state_space
from tests.planners.articulated_scenes import ROBOTS, scenario_of

INFORMED = ("AORRTC", "BITstar", "InformedRRTstar", "SORRTstar")
ABLE = [name for name in planner_names() if hasattr(og, name) and name not in INFORMED]


@pytest.mark.parametrize("name", ABLE)
def test_every_other_bound_planner_plans_for_joints(name):
    result = plan(scenario_of("mixed planar"), name, time_limit=600.0, seed=1)
    assert result.solved
    assert result.path.certified


@pytest.mark.parametrize("kind", ROBOTS)
@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_plans_are_certified_and_measured_as_by_ompl(kind, checker):
    scenario = scenario_of(kind, clearance=0.02)
    result = plan(scenario, "RRTConnect", checker, time_limit=600.0, seed=1)
    assert result.solved
    assert result.path.certified
    path = result.path.configurations
    assert np.array_equal(path[0], scenario.start)
    assert np.array_equal(path[-1], scenario.goal)
    cspace = scenario.cspace()
    si = ob.SpaceInformation(state_space(cspace))
    states = [si.allocState() for _ in path]
    for state, row in zip(states, path.tolist(), strict=True):
        state_access(cspace).write(state, row)
    length = sum(si.distance(first, second) for first, second in pairwise(states))
    assert result.path.length == pytest.approx(length, rel=1e-12)
    assert (result.path.base_travel == 0.0) == (scenario.robot.base == "fixed")


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic"])
def test_one_joint_on_a_fixed_base(kind):
    """Its configurations are shorter than the positions of a base."""
    limits = {} if kind == "continuous" else {"lower": -1.0, "upper": 1.0}
    arm = Link("arm", (Ellipsoid.from_semi_axes([0.6, 0.1], [0.7, 0.0]),))
    joint = Joint.of("turn", "base", "arm", kind, [0.0, 0.0], **limits)
    robot = ArticulatedRobot((Link("base"), arm), (joint,), "fixed")
    box = World(np.full(2, -3.0), np.full(2, 3.0))
    scenario = Scenario("one joint", box, robot, np.array([-0.9]), np.array([1.0]))
    result = plan(scenario, time_limit=600.0, seed=1)
    assert result.solved
    assert result.path.certified


@pytest.mark.parametrize("name", INFORMED)
def test_planners_of_informed_samples_say_that_they_cannot(name):
    with pytest.raises(PlannerError, match=f"{name} does not plan for articulated robots"):
        plan(scenario_of("snake"), name)


@pytest.mark.parametrize("name", INFORMED)
def test_those_planners_fail_in_ompl_itself(name):
    setup = simple_setup(scenario_of("mixed planar"), seed=1)
    si = setup.getSpaceInformation()
    setup.setOptimizationObjective(bindings.path_length_objective(si, first_path_suffices=False))

    def attempt():
        setup.setPlanner(bindings.allocate_bound_planner(name, si))
        setup.solve(bindings.stop_after(1.0))

    with bindings.ompl_output("silent"), pytest.raises(RuntimeError, match="only supports"):
        attempt()
    bindings.clear_sampler(si)


@pytest.mark.parametrize("parameter", ["informed_sampling", "ordered_sampling", "focus_search"])
def test_rrtstar_is_refused_the_parameters_that_make_it_one_of_them(parameter):
    scenario = scenario_of("snake")
    with pytest.raises(PlannerError, match=f"RRTstar.{parameter}: not for articulated"):
        plan(scenario, "RRTstar", parameters={parameter: True})
    assert plan(scenario, "RRTstar", parameters={parameter: False}, seed=1).solved


def test_a_rigid_planner_says_so_before_it_plans_and_inside_ompl():
    scenario = scenario_of("snake")
    rigid = [name for name in planner_names() if _rigid_only(name)]
    for name in rigid:
        with pytest.raises(PlannerError, match=f"{name} plans for rigid robots only"):
            plan(scenario, name)
    if "HighwayRoadmap" in rigid:
        setup = simple_setup(scenario)
        with pytest.raises(PlannerError, match="rigid robots only"):
            HighwayRoadmap(setup.getSpaceInformation()).setup()


def _rigid_only(name):
    entry = find_planner(name)
    return hasattr(entry, "load") and getattr(entry.load(), "RIGID_ONLY", False)
