"""Small problems for articulated robots: one for each kind of base, and every kind of joint."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

ROBOTS = ("snake", "mixed planar", "planar arm", "chain", "mixed spatial", "arm")
"""Free planar, translating planar, fixed planar; translating spatial, free spatial, fixed."""


def robot_of(kind: str) -> ArticulatedRobot:
    """The robot of a kind of `ROBOTS`."""
    return _ROBOTS[kind]()


def _limb(name: str, n: int) -> Link:
    return Link(name, (Ellipsoid.from_semi_axes([0.5, 0.15, 0.2][:n], np.eye(n)[0] * 0.5),))


def _revolute(i: int, n: int, limit: float = 2.0, axis: Array | None = None) -> Joint:
    at = np.eye(n)[0] * 1.0
    return Joint.of(f"j{i}", f"l{i}", f"l{i + 1}", "revolute", at, None, axis, -limit, limit)


def _snake() -> ArticulatedRobot:
    return ArticulatedRobot(
        [_limb(f"l{i}", 2) for i in range(4)], [_revolute(i, 2) for i in range(3)]
    )


def _mixed_planar() -> ArticulatedRobot:
    joints = (
        Joint.of("slide", "l0", "l1", "prismatic", [0.5, 0.0], None, [1.0, 1.0], -0.2, 0.7),
        Joint.of("wheel", "l1", "l2", "continuous", [0.9, 0.1]),
        Joint.of("bolt", "l2", "l3", "fixed", [0.3, 0.0]),
    )
    turned = np.array([[0.6, -0.8], [0.8, 0.6]])
    links = [_limb(f"l{i}", 2) for i in range(4)]
    return ArticulatedRobot(links, joints, "translating", orientation=turned)


def _planar_arm() -> ArticulatedRobot:
    robot = _snake()
    return ArticulatedRobot(robot.links, robot.joints, "fixed", position=[-2.0, 0.5])


def _chain() -> ArticulatedRobot:
    joints = [Joint.of(f"j{i}", f"l{i}", f"l{i + 1}", "ball", [1.0, 0.0, 0.0]) for i in range(3)]
    return ArticulatedRobot([_limb(f"l{i}", 3) for i in range(4)], joints, "translating")


def _mixed_spatial() -> ArticulatedRobot:
    turned = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    joints = (
        Joint.of("lift", "l0", "l1", "prismatic", [0.6, 0.0, 0.2], turned, [0, 0, 1.0], 0.0, 0.8),
        Joint.of("head", "l0", "l2", "ball", [-0.3, 0.0, 0.3], np.diag([-1.0, -1.0, 1.0])),
        Joint.of("wheel", "l1", "l3", "continuous", [0.9, 0.0, 0.0], None, [0.0, 1.0, 1.0]),
    )
    return ArticulatedRobot([_limb(f"l{i}", 3) for i in range(4)], joints)


def _arm() -> ArticulatedRobot:
    axes = np.array([[0.0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]])
    joints = [_revolute(i, 3, 2.5, axes[i]) for i in range(6)]
    return ArticulatedRobot([_limb(f"l{i}", 3) for i in range(7)], joints, "fixed")


_ROBOTS = {
    "snake": _snake,
    "mixed planar": _mixed_planar,
    "planar arm": _planar_arm,
    "chain": _chain,
    "mixed spatial": _mixed_spatial,
    "arm": _arm,
}


def world_of(robot: ArticulatedRobot, blocked: bool = False) -> World:
    """Two pillars with a way between them (a wall if ``blocked``) in a hall."""
    n = robot.dimension
    pillars = [
        Ellipsoid.from_semi_axes([0.6, 2.0, 2.5][:n], [0.5, y, 0.3][:n], name=f"pillar at {y}")
        for y in (-4.0, 4.0)
    ]
    if blocked:
        pillars.append(Ellipsoid.from_semi_axes([0.3, 20.0, 20.0][:n], [0.5, 0.0, 0.0][:n]))
    hall = Ellipsoid.from_semi_axes([14.0, 13.0, 12.0][:n], name="hall")
    return World(np.full(n, -7.0), np.full(n, 7.0), tuple(pillars), (hall,))


def home(robot: ArticulatedRobot) -> Array:
    """The configuration at which everything stands at zero."""
    values = np.zeros(robot.configuration_size)
    if robot.base == "free" and robot.dimension == 3:
        values[6] = 1.0
    for joint in robot.moving_joints:
        if joint.type == "ball":
            values[robot.joint_slices[joint.name].stop - 1] = 1.0
    return values


def scenario_of(kind: str, clearance: float = 0.0, blocked: bool = False) -> Scenario:
    """From one side of the pillars to the other, with every joint moved; arms only move joints."""
    robot = robot_of(kind)
    start, goal = home(robot), home(robot)
    if robot.base != "fixed":
        start[0], goal[0] = -5.0, 2.5
    for index, joint in enumerate(robot.moving_joints):
        place = robot.joint_slices[joint.name]
        if joint.type == "ball":
            goal[place] = [0.0, math.sin(0.3), 0.0, math.cos(0.3)]
        elif joint.type == "prismatic":
            goal[place] = 0.5
        else:
            start[place], goal[place] = 0.1, 0.6 * (-1) ** index
    return Scenario(kind, world_of(robot, blocked), robot, start, goal, clearance)


def random_configurations(
    robot: ArticulatedRobot, count: int, seed: int, reach: float = 6.5
) -> Array:
    """Configurations (count, d) with base positions up to ``reach``, and joints in their limits."""
    random = np.random.default_rng(seed)
    rows = np.tile(home(robot), (count, 1))
    if robot.base != "fixed":
        rows[:, : robot.dimension] = random.uniform(-reach, reach, (count, robot.dimension))
    quaternions = []
    if robot.base == "free" and robot.dimension == 2:
        rows[:, 2] = random.uniform(-math.pi, math.pi, count)
    elif robot.base == "free":
        quaternions.append(slice(3, 7))
    for joint in robot.moving_joints:
        place = robot.joint_slices[joint.name]
        if joint.type == "ball":
            quaternions.append(place)
        else:
            rows[:, place.start] = random.uniform(joint.lower, joint.upper, count)
    for place in quaternions:
        drawn = random.normal(size=(count, 4))
        rows[:, place] = drawn / np.linalg.norm(drawn, axis=1, keepdims=True)
    return rows
