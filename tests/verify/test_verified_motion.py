"""The verification's own interpolation and lengths, against OMPL's."""

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.metric import base_travel, path_length
from planners.spaces import state_access, state_space, write_configuration
from planners.verify.motion import interpolate, lengths, speeds
from planners.verify.placement import placements
from tests.planners.planner_scenes import KINDS, scenario_of


def random_configurations(scenario, rng, count):
    """Configurations (count, d), anywhere."""
    rows = rng.uniform(-9, 9, (count, scenario.robot.configuration_size))
    if scenario.robot.configuration_size == 7:
        rows[:, 3:] = rng.normal(size=(count, 4))
        rows[:, 3:] /= np.linalg.norm(rows[:, 3:], axis=1, keepdims=True)
    elif scenario.robot.rotates:
        rows[:, 2] = rng.uniform(-np.pi, np.pi, count)
    return rows


def pairs_of(scenario):
    """Pairs of configurations, the last of which turn by less than OMPL interpolates."""
    rng = np.random.default_rng(7)
    first = random_configurations(scenario, rng, 60)
    second = random_configurations(scenario, rng, 60)
    if scenario.robot.configuration_size == 7:
        second[50:, 3:] = first[50:, 3:] + 1e-5 * rng.normal(size=(10, 4))
        second[50:, 3:] /= np.linalg.norm(second[50:, 3:], axis=1, keepdims=True)
    return first, second


def ompl_interpolation(scenario, first, second, s):
    """The configuration at s of OMPL's own motion."""
    cspace = scenario.cspace()
    si = ob.SpaceInformation(state_space(cspace))
    si.getStateSpace().setup()
    states = [si.allocState() for _ in range(3)]
    write_configuration(states[0], first, cspace)
    write_configuration(states[1], second, cspace)
    si.getStateSpace().interpolate(states[0], states[1], s, states[2])
    return np.array(state_access(cspace).read(states[2]))


@pytest.mark.parametrize("kind", KINDS)
def test_interpolation_is_ompl_s(kind):
    scenario = scenario_of(kind)
    first, second = pairs_of(scenario)
    s = np.random.default_rng(8).uniform(0, 1, len(first))
    found = interpolate(scenario.robot, first, second, s)
    expected = [ompl_interpolation(scenario, *row) for row in zip(first, second, s, strict=True)]
    position, turn = placements(scenario.robot, found)
    wanted = placements(scenario.robot, np.array(expected))
    assert position == pytest.approx(wanted[0], abs=1e-12)
    assert turn == pytest.approx(wanted[1], abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_placements_and_lengths_are_the_package_s(kind):
    scenario = scenario_of(kind)
    first, _ = pairs_of(scenario)
    positions, rotations = placements(scenario.robot, first)
    for row, position, rotation in zip(first, positions, rotations, strict=True):
        expected = scenario.robot.pose(row)
        assert position == pytest.approx(expected[0])
        assert rotation == pytest.approx(expected[1], abs=1e-12)
    length, travel = lengths(scenario.robot, first)
    assert length == pytest.approx(path_length(scenario.robot, first))
    assert travel == pytest.approx(base_travel(scenario.robot, first))


@pytest.mark.parametrize("kind", KINDS)
def test_no_point_travels_further_than_the_speed(kind):
    scenario = scenario_of(kind)
    robot = scenario.robot
    first, second = pairs_of(scenario)
    bound = speeds(robot, first, second)
    surface = np.concatenate([part.surface_points(40) for part in robot.parts])
    steps = 20
    s = np.linspace(0, 1, steps + 1)
    for k in range(len(first)):
        many = [np.repeat(rows[k : k + 1], len(s), axis=0) for rows in (first, second)]
        position, rotation = placements(robot, interpolate(robot, *many, s))
        points = position[:, None] + np.einsum("sij,pj->spi", rotation, surface)
        moved = np.linalg.norm(np.diff(points, axis=0), axis=2)
        assert np.max(moved) <= bound[k] / steps * (1 + 1e-9) + 1e-12
