"""Lengths of articulated robots' paths against OMPL's own state spaces."""

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.metric import base_travel, path_length, turn_length
from ellipsoid_planning.robots.reach import robot_reach
from tests.random_trees import random_configuration, random_tree

CASES = [(n, base) for n in (2, 3) for base in ("free", "translating", "fixed")]


def apart(space, write, first, second):
    """OMPL's distance in one space; `write` sets a state to plain numbers."""
    states = [space.allocState() for _ in range(2)]
    for state, values in zip(states, (first, second), strict=True):
        write(state, [float(value) for value in values])
    return space.distance(*states)


def write_reals(state, values):
    for index, value in enumerate(values):
        state[index] = value


def write_heading(state, values):
    (state.value,) = values


def write_quaternion(state, values):
    state.x, state.y, state.z, state.w = values


def write_planar(state, values):
    state.setXY(*values[:2])
    state.setYaw(values[2])


def write_spatial(state, values):
    state.setXYZ(*values[:3])
    write_quaternion(state.rotation(), values[3:])


def base_apart(robot, first, second):
    if robot.base == "fixed":
        return 0.0
    if robot.base == "translating":
        return apart(ob.RealVectorStateSpace(robot.dimension), write_reals, first, second)
    if robot.dimension == 2:
        return apart(ob.SE2StateSpace(), write_planar, first, second)
    return apart(ob.SE3StateSpace(), write_spatial, first, second)


def joint_apart(joint, first, second):
    if joint.type == "ball":
        return apart(ob.SO3StateSpace(), write_quaternion, first, second)
    if joint.type == "continuous":
        return apart(ob.SO2StateSpace(), write_heading, first, second)
    return apart(ob.RealVectorStateSpace(1), write_reals, first, second)


def ompl_distance(robot, first, second):
    size = robot.base_size
    total = base_apart(robot, first[:size], second[:size])
    for joint, weight in zip(robot.moving_joints, robot.joint_weights, strict=True):
        place = robot.joint_slices[joint.name]
        total += weight * joint_apart(joint, first[place], second[place])
    return total


@pytest.mark.parametrize(("n", "base"), CASES)
def test_lengths_are_those_of_ompl(n, base):
    rng = np.random.default_rng(11)
    for _ in range(5):
        robot = random_tree(rng, n, base)
        path = np.array([random_configuration(rng, robot) for _ in range(4)])
        path[3] = path[2]
        steps = [ompl_distance(robot, *path[k : k + 2]) for k in range(3)]
        assert path_length(robot, path) == pytest.approx(sum(steps), rel=1e-14)
        assert path_length(robot, path[:1]) == 0.0


@pytest.mark.parametrize("n", [2, 3])
def test_the_base_travels_only_with_the_base(n):
    rng = np.random.default_rng(12)
    for base in ("free", "translating"):
        robot = random_tree(rng, n, base)
        path = np.array([random_configuration(rng, robot) for _ in range(3)])
        expected = np.sum(np.linalg.norm(np.diff(path[:, :n], axis=0), axis=1))
        assert base_travel(robot, path) == pytest.approx(expected)
    robot = random_tree(rng, n, "fixed")
    path = np.array([random_configuration(rng, robot) for _ in range(3)])
    assert base_travel(robot, path) == 0.0
    assert path_length(robot, path) > 0.0


def test_a_turn_counts_for_half_the_reach():
    robot = random_tree(np.random.default_rng(13), 3, "free")
    assert turn_length(robot) == 0.5 * robot_reach(robot)
