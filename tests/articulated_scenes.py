"""Articulated robots and worlds that several tests use."""

import numpy as np

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.world import World


def snake(links=5, base="free", orientation=None):
    """A planar snake of equal elliptical links on revolute joints."""
    body = Ellipsoid.from_semi_axes([0.5, 0.12], [0.5, 0.0])
    joints = [
        Joint.of(f"j{k}", f"l{k}", f"l{k + 1}", "revolute", [1.0, 0.0], lower=-2.4, upper=2.4)
        for k in range(links - 1)
    ]
    names = tuple(Link(f"l{k}", (body,)) for k in range(links))
    return ArticulatedRobot(names, tuple(joints), base, orientation=orientation)


def chain(links=5):
    """A chain of spheroids on ball joints, 6 + 3 (links − 1) degrees of freedom."""
    body = Ellipsoid.from_semi_axes([1.0, 0.35, 0.35], [1.0, 0.0, 0.0])
    joints = [
        Joint.of(f"j{k}", f"l{k}", f"l{k + 1}", "ball", [2.1, 0.0, 0.0]) for k in range(links - 1)
    ]
    return ArticulatedRobot(tuple(Link(f"l{k}", (body,)) for k in range(links)), tuple(joints))


def scattered(seed=0, count=40, side=10.0):
    """A square with ellipses strewn over it."""
    rng = np.random.default_rng(seed)
    obstacles = tuple(
        Ellipsoid.from_semi_axes(
            rng.uniform(0.2, 0.6, 2), rng.uniform(0, side, 2), rng.uniform(0, 3)
        )
        for _ in range(count)
    )
    return World(np.zeros(2), np.full(2, side), obstacles)


def slit(play):
    """An ellipsoidal arena cut by two discs, with a slit for links of radius 0.35 between them.

    The discs reach far beyond the arena: nothing wider than the slit passes anywhere.
    """
    arena = Ellipsoid.from_semi_axes([16.0, 7.0, 7.0])
    height = 4.5 + 0.35 + play
    walls = tuple(
        Ellipsoid.from_semi_axes([1.5, 600.0, 4.5], [0.0, 0.0, sign * height])
        for sign in (1.0, -1.0)
    )
    return World(np.full(3, -16.0), np.full(3, 16.0), walls, (arena,))


def random_configurations(robot, rng, count, low, high, spread=np.pi):
    """Configurations (count, d); ball joints turn by up to ``spread`` about random axes."""
    n = robot.dimension
    columns = []
    if robot.base_size:
        columns.append(rng.uniform(low, high, (count, n)))
    if robot.rotates:
        columns.append(
            rng.uniform(-np.pi, np.pi, (count, 1)) if n == 2 else quaternions(rng, count, np.pi)
        )
    for joint in robot.moving_joints:
        if joint.type == "ball":
            columns.append(quaternions(rng, count, spread))
        else:
            columns.append(rng.uniform(joint.lower, joint.upper, (count, 1)))
    return np.hstack(columns)


def quaternions(rng, count, spread):
    axes = rng.normal(size=(count, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    half = 0.5 * rng.uniform(0.0, spread, (count, 1))
    return np.hstack([np.sin(half) * axes, np.cos(half)])
