"""Verification of articulated paths: its own arithmetic, good paths, and each thing gone wrong."""

from dataclasses import replace

import numpy as np
import pytest

from ellipsoid_planning.metric import base_travel, path_length
from ellipsoid_planning.result import PathResult, PlanResult
from planners.solve import plan
from planners.verify import verify_result
from planners.verify.motion import interpolate, joint_speeds, lengths, speeds
from planners.verify.placement import part_placements
from planners.verify.self_collision import SelfTester, self_pairs
from tests.planners.articulated_scenes import ROBOTS, random_configurations, robot_of, scenario_of


def pairs_of(robot):
    """Pairs of configurations, the last of which turn by less than OMPL interpolates."""
    first = random_configurations(robot, 40, seed=6)
    second = random_configurations(robot, 40, seed=7)
    second[30:] = first[30:] + 1e-5 * np.random.default_rng(8).normal(size=first[30:].shape)
    return first, second


@pytest.mark.parametrize("kind", ROBOTS)
def test_parts_and_lengths_are_the_package_s(kind):
    robot = robot_of(kind)
    first, _ = pairs_of(robot)
    centres, matrices = part_placements(robot, first)
    for row, centre, matrix in zip(first, centres, matrices, strict=True):
        for k, body in enumerate(robot.bodies_at(row)):
            assert centre[k] == pytest.approx(body.centre, abs=1e-12)
            assert matrix[k] == pytest.approx(body.matrix, abs=1e-12)
    length, travel = lengths(robot, first)
    assert length == pytest.approx(path_length(robot, first))
    assert travel == pytest.approx(base_travel(robot, first))


@pytest.mark.parametrize("kind", ROBOTS)
def test_interpolation_is_the_package_s(kind):
    scenario = scenario_of(kind)
    cspace, robot = scenario.cspace(), scenario.robot
    first, second = pairs_of(robot)
    s = np.random.default_rng(9).uniform(0, 1, len(first))
    found = part_placements(robot, interpolate(robot, first, second, s))
    rows = [cspace.interpolate(*row) for row in zip(first, second, s, strict=True)]
    wanted = part_placements(robot, np.array(rows))
    assert found[0] == pytest.approx(wanted[0], abs=1e-11)
    assert found[1] == pytest.approx(wanted[1], abs=1e-11)


@pytest.mark.parametrize("kind", ROBOTS)
def test_no_point_travels_further_than_the_speeds(kind):
    robot = robot_of(kind)
    first, second = pairs_of(robot)
    bound, inner = speeds(robot, first, second), joint_speeds(robot, first, second)
    surfaces = np.array([part.surface_points(30) - part.centre for part in robot.parts])
    ball = np.array(
        [np.linalg.solve(p.matrix, x.T).T for p, x in zip(robot.parts, surfaces, strict=True)]
    )
    s = np.linspace(0, 1, 21)
    for k in range(len(first)):
        many = [np.repeat(rows[k : k + 1], len(s), axis=0) for rows in (first, second)]
        centres, matrices = part_placements(robot, interpolate(robot, *many, s))
        points = centres[:, :, None] + np.einsum("spij,pmj->spmi", matrices, ball)
        moved = np.linalg.norm(np.diff(points, axis=0), axis=-1)
        assert np.max(moved) <= bound[k] / 20 * (1 + 1e-9) + 1e-12
    assert np.all(inner <= bound)


def test_pairs_leave_out_neighbours_fixed_links_and_ignored_ones():
    assert self_pairs(robot_of("snake")) == [(0, 2), (0, 3), (1, 3)]
    assert self_pairs(robot_of("mixed planar")) == [(0, 2), (0, 3), (1, 3)]
    ignoring = replace(robot_of("snake"), ignored=frozenset([frozenset(("l0", "l3"))]))
    assert self_pairs(ignoring) == [(0, 2), (1, 3)]


@pytest.mark.parametrize("kind", ROBOTS)
def test_self_collision_agrees_with_the_cspace(kind):
    scenario = scenario_of(kind)
    robot, cspace = scenario.robot, scenario.cspace()
    rows = random_configurations(robot, 300, seed=10)
    found = SelfTester(robot).test(rows, np.full(len(rows), 1e-6))
    meets = np.zeros(len(rows), dtype=bool)
    meets[[meeting.row for meeting in found.meetings]] = True
    for row, met, lower in zip(rows, meets, found.lower, strict=True):
        if abs(lower) > 1e-9:
            assert met == any(contact.kind == "self" for contact in cspace.explain(row))


@pytest.fixture(scope="module", params=ROBOTS)
def planned(request):
    """A planned result of each kind of robot."""
    return plan(scenario_of(request.param, 0.02), "RRTConnect", seed=2)


def with_path(result, path):
    """The result with another path, its length measured."""
    robot = result.scenario.robot
    found = PathResult.from_configurations(robot, path, min_clearance=-1.0, certified=True)
    return replace(result, path=found)


def failures(result):
    """What fails, by name."""
    return {check.name: check.detail for check in verify_result(result).failures}


def test_a_planned_path_passes_and_is_resolved(planned):
    report = verify_result(planned)
    assert report.passed, report.failures
    assert report.resolved == 1.0
    assert report.fcl_samples > 50
    assert report.sampled_clearance >= planned.path.min_clearance
    names = [check.name for check in report.checks]
    assert "self-collision" in names or not self_pairs(planned.scenario.robot)


def test_a_start_elsewhere_fails(planned):
    path = planned.path.configurations.copy()
    path[0] += 1e-3
    assert "start" in failures(with_path(planned, path))


def snake_through(*middle):
    """A result whose path goes through configurations of the snake's joints."""
    scenario = scenario_of("snake")
    path = np.array([scenario.start, *([*scenario.start[:3], *row] for row in middle)])
    scenario = replace(scenario, goal=path[-1])
    found = PathResult.from_configurations(scenario.robot, path, min_clearance=-1.0, certified=True)
    return PlanResult(scenario=scenario, planner="by hand", status="solved", path=found)


def test_a_robot_that_meets_itself_fails():
    found = snake_through([1.0, 2.0, 1.0], [1.0, 2.0, 2.0], [1.0, 2.0, 1.0])
    detail = failures(found)["self-collision"]
    assert detail.startswith("part 'l0 1' meets 'l3 1'")
    found = snake_through([1.0, 1.9, 1.0], [1.0, 1.9, 1.2])
    assert failures(found) == {}


def test_a_joint_beyond_its_limits_fails():
    found = snake_through([0.0, 2.1, 0.0], [0.0, 1.9, 0.0])
    assert "'j1' is beyond its own by 0.1" in failures(found)["limits"]


def test_a_ball_joint_s_quaternion_off_unit_length_fails():
    scenario = scenario_of("chain")
    path = np.array([scenario.start, scenario.goal])
    path[1, 3:7] *= 1.001
    found = PathResult.from_configurations(
        scenario.robot, path, min_clearance=-1.0, certified=False
    )
    result = PlanResult(scenario=scenario, planner="by hand", status="solved", path=found)
    assert "quaternions" in failures(result)


def test_the_jump_after_a_tiny_turn_of_a_ball_joint_is_tested_at_both_ends():
    scenario = scenario_of("chain")
    turned = scenario.start.copy()
    turned[3:7] = [0.0, 0.0, np.sin(4e-5), np.cos(4e-5)]
    halfway = interpolate(scenario.robot, scenario.start[None], turned[None], np.array([0.5]))
    assert np.array_equal(halfway[0], scenario.start)
    assert scenario.cspace().is_motion_valid(scenario.start, turned)
    path = np.array([scenario.start, turned])
    found = PathResult.from_configurations(scenario.robot, path, min_clearance=-1.0, certified=True)
    scenario = replace(scenario, goal=turned)
    result = PlanResult(scenario=scenario, planner="by hand", status="solved", path=found)
    assert verify_result(result).passed
