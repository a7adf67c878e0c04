"""Rigid robots and worlds."""

import math

import numpy as np
import pytest

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.world import World

EAR = Ellipsoid.from_semi_axes([3.0, 1.5], [-5.0, 3.0], math.radians(135), name="ear")
FACE = Ellipsoid.from_semi_axes([5.0, 3.0])
BALL = Ellipsoid.from_semi_axes([1.0, 1.0, 1.0], [2.0, 0.0, 0.0])


def test_planar_bodies_follow_the_heading():
    robot = RigidRobot((FACE, EAR))
    face, ear = robot.bodies_at([1.0, 2.0, math.pi / 2])
    np.testing.assert_allclose(face.centre, [1.0, 2.0])
    np.testing.assert_allclose(ear.centre, [1.0 - 3.0, 2.0 - 5.0], atol=1e-14)
    assert (face.name, ear.name) == ("part 1", "ear")
    assert (robot.dimension, robot.configuration_size) == (2, 3)


def test_spatial_bodies_follow_the_quaternion_of_any_length():
    robot = RigidRobot((BALL,))
    quarter_turn = [0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)]
    for scale in (1.0, 3.0):
        (ball,) = robot.bodies_at([0.0, 0.0, 5.0, *(scale * np.array(quarter_turn))])
        np.testing.assert_allclose(ball.centre, [0.0, 2.0, 5.0], atol=1e-14)
    assert robot.configuration_size == 7


def test_translating_robot_keeps_its_orientation():
    half_turn = np.array([[-1.0, 0.0], [0.0, -1.0]])
    robot = RigidRobot((EAR,), rotates=False, orientation=half_turn)
    (ear,) = robot.bodies_at([1.0, 1.0])
    np.testing.assert_allclose(ear.centre, [6.0, -2.0])
    assert robot.configuration_size == 2
    plain = RigidRobot((BALL,), rotates=False)
    np.testing.assert_array_equal(plain.pose([1.0, 2.0, 3.0])[1], np.eye(3))


def test_impossible_robots_are_refused():
    with pytest.raises(GeometryError, match="at least one part"):
        RigidRobot(())
    with pytest.raises(GeometryError, match="one dimension"):
        RigidRobot((FACE, BALL))
    with pytest.raises(GeometryError, match="no fixed orientation"):
        RigidRobot((FACE,), orientation=np.eye(2))


@pytest.mark.parametrize("configuration", [[0.0, 0.0], [0.0, 0.0, math.nan], [[0.0, 0.0, 0.0]]])
def test_configurations_of_the_wrong_kind_are_refused(configuration):
    with pytest.raises(GeometryError, match="3 finite numbers"):
        RigidRobot((FACE,)).pose(configuration)


def test_a_zero_quaternion_is_refused():
    with pytest.raises(GeometryError, match="quaternion"):
        RigidRobot((BALL,)).pose(np.zeros(7))


def test_world_names_its_bodies_and_is_read_only():
    world = World([-1, -2], [1, 2], obstacles=(FACE, EAR), arenas=(FACE,))
    assert [body.name for body in world.obstacles] == ["obstacle 1", "ear"]
    assert world.arenas[0].name == "arena 1"
    assert world.dimension == 2
    with pytest.raises(ValueError, match="read-only"):
        world.low[0] = 3.0


def test_impossible_worlds_are_refused():
    with pytest.raises(GeometryError, match="low < high"):
        World([0, 1], [1, 1])
    with pytest.raises(GeometryError, match="shapes"):
        World([0, 1], [1, 1, 1])
    with pytest.raises(GeometryError, match="dimension 3"):
        World([0, 0], [1, 1], obstacles=(BALL,))


def test_a_rigid_robot_is_one_link_without_joints():
    robot = RigidRobot((FACE, EAR))
    assert (robot.root, robot.part_links) == ("base", ("base", "base"))
    assert (robot.base_size, robot.joints, dict(robot.joint_slices)) == (3, (), {})
    ((position, rotation),) = robot.link_poses([1.0, 2.0, 0.5]).values()
    np.testing.assert_array_equal(position, [1.0, 2.0])
    np.testing.assert_array_equal(rotation, robot.pose([1.0, 2.0, 0.5])[1])
