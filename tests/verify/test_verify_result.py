"""Verification of whole results: good ones pass, and each thing that can be wrong fails."""

from dataclasses import replace

import numpy as np
import pytest

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.solve import plan
from planners.verify import verify_result
from tests.planners.planner_scenes import KINDS, scenario_of

ball = Ellipsoid.from_semi_axes


@pytest.fixture(scope="module", params=KINDS)
def planned(request):
    """A planned result of each kind of scenario."""
    return plan(scenario_of(request.param), "RRTConnect", seed=2)


def with_path(result, configurations, **stated):
    """The result with another path, its length measured, and other statements if given."""
    values = {"min_clearance": -1.0, "certified": True, **stated}
    path = PathResult.from_configurations(
        result.scenario.robot,
        configurations,
        min_clearance=values["min_clearance"],
        certified=values["certified"],
    )
    return replace(result, path=path)


def failed(result):
    """The names of the checks that fail."""
    return {check.name for check in verify_result(result).failures}


def test_a_planned_path_passes_and_is_resolved(planned):
    report = verify_result(planned)
    assert report.passed, report.failures
    assert report.resolved == 1.0
    assert report.fcl_samples > 100
    assert report.sampled_clearance >= planned.path.min_clearance


def test_a_state_pushed_into_an_obstacle_fails(planned):
    path = planned.path.configurations.copy()
    path = np.insert(path, 1, path[0], axis=0)
    n = planned.scenario.dimension
    path[1, :n] = planned.scenario.world.obstacles[1].centre
    report = verify_result(with_path(planned, path))
    assert {"obstacles", "clearance"} <= {check.name for check in report.failures}
    assert report.sampled_clearance < 0.0
    (hit,) = (check for check in report.failures if check.name == "obstacles")
    assert "'pillar at 0.5'" in hit.detail
    assert "part '" in hit.detail


def test_a_path_cut_through_an_obstacle_fails(planned):
    path = planned.path.configurations[[0, -1]]
    assert "obstacles" in failed(with_path(planned, path))


def test_a_path_out_of_the_arena_fails(planned):
    path = np.insert(planned.path.configurations, 1, planned.scenario.start, axis=0)
    path[1, :2] = [-8.9, -8.9]
    assert "arenas" in failed(with_path(planned, path))


def test_a_path_out_of_bounds_fails(planned):
    path = np.insert(planned.path.configurations, 1, planned.scenario.start, axis=0)
    path[1, 0] = -9.0001
    assert failed(with_path(planned, path)) == {"bounds"}


def test_a_wrong_start_or_goal_fails(planned):
    path = planned.path.configurations.copy()
    path[0, 0] += 1e-3
    assert failed(with_path(planned, path)) == {"start"}
    path = planned.path.configurations.copy()
    path[-1, 0] -= 1e-3
    assert failed(with_path(planned, path)) == {"goal"}


def test_an_overstated_clearance_fails(planned):
    least = verify_result(planned).sampled_clearance
    path = planned.path.configurations
    assert failed(with_path(planned, path, min_clearance=least * (1 + 1e-6))) == {
        "stated clearance"
    }
    assert failed(with_path(planned, path, min_clearance=np.inf)) == {"stated clearance"}
    assert failed(with_path(planned, path, min_clearance=np.nan)) == {"stated clearance"}


def test_a_clearance_that_is_not_kept_fails(planned):
    least = verify_result(planned).sampled_clearance
    scenario = planned.scenario
    wanting = Scenario(
        scenario.name, scenario.world, scenario.robot, scenario.start, scenario.goal, least + 1e-6
    )
    assert failed(replace(planned, scenario=wanting)) == {"clearance"}


def test_an_edited_length_fails(planned):
    for change in ({"length": 1.01}, {"base_travel": 0.99}):
        ((name, factor),) = change.items()
        stated = getattr(planned.path, name) * factor
        edited = replace(planned, path=replace(planned.path, **{name: stated}))
        assert failed(edited) == {"length"}


def test_a_quaternion_of_another_length_fails():
    result = plan(scenario_of("spatial"), "RRTConnect", seed=2)
    path = np.insert(result.path.configurations, 1, result.scenario.start, axis=0)
    path[1, 3:] *= 1.001
    assert "quaternions" in failed(with_path(result, path))


def test_a_result_without_a_path_fails():
    result = PlanResult(scenario_of("planar"), "RRT", "timeout")
    assert failed(result) == {"path"}


def line_past(obstacle, n=3):
    """A unit ball that moves along the first axis past an obstacle."""
    world = World(np.full(n, -20.0), np.full(n, 20.0), (obstacle,))
    start, goal = np.zeros(n), np.zeros(n)
    start[0], goal[0] = -10.0, 10.0
    robot = RigidRobot((ball(np.ones(n)),), rotates=False)
    scenario = Scenario("line", world, robot, start, goal)
    path = PathResult.from_configurations(robot, [start, goal], min_clearance=-1.0, certified=False)
    return PlanResult(scenario, "by hand", "solved", path=path)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9])
def test_motions_that_miss_or_touch_by_a_hair_are_told_apart(gap):
    at = [np.pi, 1.0 + 0.5, 0.0]
    missed = verify_result(line_past(ball([0.5, 0.5, 0.5], np.add(at, [0, gap, 0]))))
    assert missed.passed
    assert missed.sampled_clearance == pytest.approx(gap, rel=0.12)
    touched = verify_result(line_past(ball([0.5, 0.5, 0.5], np.subtract(at, [0, gap, 0]))))
    assert not touched.passed


def test_a_blade_thinner_than_the_spacing_is_not_jumped_over():
    blade = ball([1e-5, 3.0, 3.0], [np.pi, 3.5, 0.0])
    assert "obstacles" in failed(line_past(blade))


def test_a_needle_in_the_way_is_found():
    needle = ball([1e-6, 1e-6, 1.0], [np.e, 0.3, 0.2])
    assert "obstacles" in failed(line_past(needle))


def test_an_empty_world_has_infinite_clearance():
    robot = RigidRobot((ball([1.0, 1.0]),))
    world = World(np.full(2, -5.0), np.full(2, 5.0))
    start, goal = np.array([-4.0, 0.0, 0.0]), np.array([4.0, 0.0, 1.0])
    scenario = Scenario("empty", world, robot, start, goal)
    path = PathResult.from_configurations(
        robot, [start, goal], min_clearance=np.inf, certified=True
    )
    report = verify_result(PlanResult(scenario, "by hand", "solved", path=path))
    assert report.passed
    assert report.sampled_clearance == np.inf


def test_a_path_that_stays_where_it_is():
    scenario = scenario_of("planar")
    still = Scenario("still", scenario.world, scenario.robot, scenario.start, scenario.start)
    path = PathResult.from_configurations(
        still.robot, [still.start], min_clearance=0.0, certified=True
    )
    assert verify_result(PlanResult(still, "by hand", "solved", path=path)).passed
