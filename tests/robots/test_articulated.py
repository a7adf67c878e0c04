"""Articulated robots: forward kinematics against scipy, trees that are none, reaches."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import GeometryError, RobotError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.robots.coordinates import headings, limits, quaternions
from ellipsoid_planning.robots.reach import joint_reaches, robot_reach
from tests.random_trees import random_configuration, random_tree

BALL = Ellipsoid.from_semi_axes([1.0, 1.0])
CASES = [(n, base) for n in (2, 3) for base in ("free", "translating", "fixed")]


def lifted(matrix):
    """A rotation (n, n) as scipy's, a planar one about z."""
    full = np.eye(3)
    full[: len(matrix), : len(matrix)] = matrix
    return Rotation.from_matrix(full)


def in_space(vector):
    return np.append(vector, np.zeros(3 - len(vector)))


def chain(robot, name):
    """The joints from the root to a link."""
    for joint in robot.joints:
        if joint.child == name:
            return [*chain(robot, joint.parent), joint]
    return []


def moved(joint, values):
    """Rotation and shift of a joint's own motion."""
    if joint.type == "ball":
        return Rotation.from_quat(values), np.zeros(3)
    if joint.type == "prismatic":
        return Rotation.identity(), values[0] * in_space(joint.axis)
    if joint.type == "fixed":
        return Rotation.identity(), np.zeros(3)
    axis = np.array([0.0, 0.0, 1.0]) if joint.axis is None else joint.axis
    return Rotation.from_rotvec(values[0] * axis), np.zeros(3)


def base_pose(robot, values):
    n = robot.dimension
    at = in_space(robot.position if robot.base == "fixed" else values[:n])
    if not robot.rotates:
        return lifted(robot.orientation), at
    if n == 2:
        return Rotation.from_rotvec([0.0, 0.0, values[2]]), at
    return Rotation.from_quat(values[3:7]), at


def slow_position(robot, values, name, point):
    """Where a point of a link's frame is, carried up through the joints one after another."""
    point = in_space(point)
    for joint in reversed(chain(robot, name)):
        own = values[robot.joint_slices.get(joint.name, slice(0, 0))]
        turn, shift = moved(joint, own)
        point = in_space(joint.position) + lifted(joint.rotation).apply(turn.apply(point) + shift)
    turn, at = base_pose(robot, values)
    return at + turn.apply(point)


@pytest.mark.parametrize(("n", "base"), CASES)
def test_link_poses_follow_the_joints_one_by_one(n, base):
    rng = np.random.default_rng(5)
    for _ in range(10):
        robot = random_tree(rng, n, base)
        values = random_configuration(rng, robot)
        for name, (position, rotation) in robot.link_poses(values).items():
            for point in (np.zeros(n), *np.eye(n)):
                slow = slow_position(robot, values, name, point)
                np.testing.assert_allclose(position + rotation @ point, slow[:n], atol=1e-12)


def test_bodies_are_where_their_links_are():
    rng = np.random.default_rng(6)
    robot = random_tree(rng, 3, "free")
    values = random_configuration(rng, robot)
    poses = robot.link_poses(values)
    bodies = robot.bodies_at(values)
    for body, part, link in zip(bodies, robot.parts, robot.part_links, strict=True):
        position, rotation = poses[link]
        np.testing.assert_allclose(body.centre, position + rotation @ part.centre, atol=1e-14)
        np.testing.assert_allclose(body.rotation, rotation @ part.rotation, atol=1e-14)


@pytest.mark.parametrize(("n", "base"), CASES)
def test_no_point_is_beyond_its_reach(n, base):
    rng = np.random.default_rng(7)
    for _ in range(5):
        robot = random_tree(rng, n, base)
        whole, reaches = robot_reach(robot), joint_reaches(robot)
        for _ in range(10):
            values = random_configuration(rng, robot)
            poses, bodies = robot.link_poses(values), robot.bodies_at(values)
            for body, link in zip(bodies, robot.part_links, strict=True):
                points = body.surface_points(40)
                origins = {joint.child: reaches.get(joint.name) for joint in chain(robot, link)}
                for name, reach in {**origins, robot.root: whole}.items():
                    if reach is not None:
                        apart = np.linalg.norm(points - poses[name][0], axis=1)
                        assert np.max(apart) <= reach + 1e-12


def test_weights_are_reaches_halved_for_turns():
    links = (Link("base", (BALL,)), Link("arm", (BALL.transform(np.eye(2), [3.0, 0.0]),)))
    tool = Link("tool")
    joints = (
        Joint.of("turn", "base", "arm", "continuous", [1.0, 0.0]),
        Joint.of("slide", "arm", "tool", "prismatic", [0.0, 0.0], lower=-1.0, upper=2.0),
    )
    robot = ArticulatedRobot((*links, tool), joints)
    assert robot_reach(robot) == 5.0
    np.testing.assert_allclose(robot.joint_weights, [2.0, 1.0])
    assert not robot.joint_weights.flags.writeable


def test_joints_that_move_no_part_still_count():
    joint = Joint.of("turn", "base", "tool", "revolute", [1.0, 0.0], lower=0.0, upper=1.0)
    robot = ArticulatedRobot((Link("base", (BALL,)), Link("tool")), (joint,))
    assert 0.0 < robot.joint_weights[0] < 0.01


def test_numbers_of_a_configuration_are_told_apart():
    rng = np.random.default_rng(8)
    robot = random_tree(rng, 3, "free", links=9)
    places = quaternions(robot)
    assert places[0] == slice(3, 7)
    balls = [joint.name for joint in robot.joints if joint.type == "ball"]
    assert [robot.joint_slices[name] for name in balls] == list(places[1:])
    turning = [joint.name for joint in robot.joints if joint.type == "continuous"]
    assert [robot.joint_slices[name].start for name in turning] == list(headings(robot))
    low, high = limits(robot)
    assert np.all(np.isinf(low[:7])) and np.all(np.isinf(high[:7]))
    for joint in robot.joints:
        if joint.type in {"revolute", "prismatic"}:
            place = robot.joint_slices[joint.name]
            assert (low[place][0], high[place][0]) == (joint.lower, joint.upper)


def hinge(name, parent, child):
    return Joint.of(name, parent, child, "revolute", [0.0, 0.0], lower=-1.0, upper=1.0)


@pytest.mark.parametrize(
    ("joints", "path", "words"),
    [
        ([("a", "one", "two")], ("links", 2), "'one', 'three' are not connected"),
        ([("a", "one", "two"), ("b", "two", "one")], ("joints", 1), "cycle"),
        ([("a", "two", "three"), ("b", "three", "two")], ("joints", 1), "two -> three -> two"),
        ([("a", "one", "one")], ("joints", 0), "one -> one"),
        ([("a", "one", "two"), ("b", "one", "two")], ("joints", 1, "child"), "two joints"),
        ([("a", "one", "tow")], ("joints", 0, "child"), "did you mean 'two'"),
        ([("a", "zero", "two")], ("joints", 0, "parent"), "is no link"),
        ([("a", "one", "two"), ("a", "one", "three")], ("joints", 1, "name"), "two joints"),
    ],
)
def test_joints_that_make_no_tree_are_refused_with_their_place(joints, path, words):
    links = tuple(Link(name, (BALL,)) for name in ("one", "two", "three"))
    with pytest.raises(RobotError, match=words) as caught:
        ArticulatedRobot(links, tuple(hinge(*joint) for joint in joints))
    assert caught.value.path == path


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"base": "flying"}, "a base of free"),
        ({"orientation": np.eye(2)}, "free base"),
        ({"position": np.zeros(2)}, "only a fixed base"),
        ({"ignored": [("one", "three")]}, "'three' is no link"),
        ({"ignored": [("one", "one")]}, "two different links"),
        ({"links": (Link("one"), Link("two"))}, "at least one part"),
        ({"links": (Link("one", (BALL,)), Link("one"))}, "two links are called"),
        ({"base": "fixed", "position": np.zeros(3)}, "2 numbers"),
        ({"base": "fixed", "joints": (), "links": (Link("one", (BALL,)),)}, "a joint that moves"),
    ],
)
def test_impossible_robots_are_refused(changes, words):
    fields = {
        "links": (Link("one", (BALL,)), Link("two")),
        "joints": (hinge("a", "one", "two"),),
        **changes,
    }
    with pytest.raises(GeometryError, match=words):
        ArticulatedRobot(**fields)
