"""Small C-spaces for the roadmap's tests."""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World

body = Ellipsoid.from_semi_axes


def pillars(n=2, *, rotates=True, clearance=0.0):
    """A hall with four pillars and a robot of two parts."""
    robot = RigidRobot((body([1.0, 0.4, 0.4][:n]), body([0.5, 0.3, 0.3][:n], [0.8, 0.4, 0][:n])))
    if not rotates:
        robot = RigidRobot(robot.parts, rotates=False)
    places = [(-4.0, -3.0), (-3.0, 4.0), (3.0, -2.0), (4.0, 4.5)]
    obstacles = tuple(body([1.5, 2.0, 20.0][:n], [x, y, 0][:n]) for x, y in places)
    world = World(np.full(n, -9.0), np.full(n, 9.0), obstacles, (body([12.0, 11.0, 10.0][:n]),))
    return CSpace(world, robot, clearance)


def cage(n=3, reach=30.0):
    """A small closed room in a wide world, which nothing leaves."""
    walls = []
    for k in range(n):
        for side in (-1.0, 1.0):
            axes, place = np.full(n, 6.0), np.zeros(n)
            axes[k], place[k] = 0.5, 3.0 * side
            walls.append(body(axes, place))
    robot = RigidRobot((body([1.0, 0.5, 0.4][:n]),))
    return CSpace(World(np.full(n, -reach), np.full(n, reach), tuple(walls)), robot)


def configuration(cspace, *position, yaw=0.0):
    """A configuration (1, d) at a position, turned about the last axis."""
    turn = []
    if cspace.rotates:
        turn = [yaw] if cspace.dimension == 2 else [0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)]
    return np.array([[*position, *turn]])


def components(count, edges):
    """The number (count,) of each vertex's connected component, the smallest vertex in it."""
    label = np.arange(count)
    while len(edges):
        lower = np.minimum(label[edges[:, 0]], label[edges[:, 1]])
        new = label.copy()
        np.minimum.at(new, edges[:, 0], lower)
        np.minimum.at(new, edges[:, 1], lower)
        new = np.minimum(new, new[new])
        if np.array_equal(new, label):
            break
        label = new
    return label
