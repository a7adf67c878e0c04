"""The robots of the thesis' section 6.4 in worlds like its own, and snakes of any length."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

SNAKE, CHAIN = "snake-7dof-maze", "chain-18dof"
_HALF, _WIDTH = 0.5, 0.15
"""Semi-axes of a snake's links."""
_APART = 2.04 * _HALF


def scene(name: str) -> CSpace:
    """The C-space of a bundled scenario."""
    return load_scenario(name).cspace()


def snake(links: int, bend: float = 2.0) -> ArticulatedRobot:
    """A planar robot of identical elliptical links, each turning by at most ``bend`` [rad]."""
    bodies = [Link(f"link {i}", (Ellipsoid.from_semi_axes([_HALF, _WIDTH]),)) for i in range(links)]
    joints = [
        Joint.of(
            f"joint {i}", f"link {i}", f"link {i + 1}", "revolute", [_APART, 0.0],
            lower=-bend, upper=bend,
        )
        for i in range(links - 1)
    ]  # fmt: skip
    return ArticulatedRobot(tuple(bodies), tuple(joints))


def maze(count: int, side: float, seed: int = 0) -> World:
    """A square with ``count`` elliptical obstacles."""
    random = np.random.default_rng(seed)
    obstacles = [
        Ellipsoid.from_semi_axes(
            [random.uniform(0.2, 1.0), random.uniform(0.1, 0.4)],
            random.uniform(0.0, side, 2),
            float(random.uniform(0.0, math.pi)),
        )
        for _ in range(count)
    ]
    return World([0.0, 0.0], [side, side], tuple(obstacles))


def configurations(cspace: CSpace, count: int, seed: int = 1) -> Array:
    """Configurations (count, d), uniform within bounds and limits."""
    robot, random = cspace.robot, np.random.default_rng(seed)
    n = cspace.dimension
    rows = np.zeros((count, robot.configuration_size))
    rows[:, :n] = random.uniform(cspace.world.low, cspace.world.high, (count, n))
    turns = [slice(3, 7)] if cspace.rotates and n == 3 else []
    if cspace.rotates and n == 2:
        rows[:, 2] = random.uniform(-math.pi, math.pi, count)
    for joint in robot.moving_joints:
        place = robot.joint_slices[joint.name]
        if joint.type == "ball":
            turns.append(place)
        else:
            rows[:, place.start] = random.uniform(joint.lower, joint.upper, count)
    for place in turns:
        drawn = random.normal(size=(count, 4))
        rows[:, place] = drawn / np.linalg.norm(drawn, axis=1, keepdims=True)
    return rows
