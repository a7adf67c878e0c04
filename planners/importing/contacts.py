"""Which links of a robot touch always, and which at its zero pose."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.dual import gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import FIXED

Array = NDArray[np.float64]
Pair = tuple[str, str]

SAMPLES = 300
SEED = 0


def contacts(robot: ArticulatedRobot) -> tuple[list[Pair], list[Pair]]:
    """Pairs of links that touch at every one of many joint values, and at the zero pose only.

    Pairs that self-collision is not about are left out: links joined directly, and links that
    cannot move against each other. The zero pose has every joint at 0, or at its limit next to 0.
    """
    zero = zero_configuration(robot)
    touching = _touching(robot, zero, _candidates(robot))
    always = touching
    rng = np.random.default_rng(SEED)
    for _ in range(SAMPLES):
        if not always:
            break
        always = _touching(robot, random_configuration(robot, zero, rng), always)
    return always, [pair for pair in touching if pair not in always]


def zero_configuration(robot: ArticulatedRobot) -> Array:
    """The base at the origin, every joint at 0 or at its limit next to 0."""
    zero = np.zeros(robot.configuration_size)
    if robot.rotates:
        zero[6] = 1.0
    for joint in robot.moving_joints:
        zero[robot.joint_slices[joint.name]] = np.clip(0.0, joint.lower, joint.upper)
    return zero


def random_configuration(robot: ArticulatedRobot, zero: Array, rng: np.random.Generator) -> Array:
    """Joint values drawn evenly within their limits, the base as at ``zero``."""
    drawn = zero.copy()
    for joint in robot.moving_joints:
        drawn[robot.joint_slices[joint.name]] = rng.uniform(joint.lower, joint.upper)
    return drawn


def _candidates(robot: ArticulatedRobot) -> list[Pair]:
    body = _rigid_bodies(robot)
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    names = [link.name for link in robot.links if link.parts]
    return [
        (first, second)
        for first, second in itertools.combinations(names, 2)
        if body[first] != body[second] and frozenset((first, second)) not in joined
    ]


def _rigid_bodies(robot: ArticulatedRobot) -> dict[str, str]:
    """For each link the first one that it cannot move against."""
    fixed_to = {joint.child: joint.parent for joint in robot.joints if joint.type == FIXED}
    first = {}
    for link in robot.links:
        name = link.name
        while name in fixed_to:
            name = fixed_to[name]
        first[link.name] = name
    return first


def _touching(robot: ArticulatedRobot, configuration: Array, pairs: Iterable[Pair]) -> list[Pair]:
    bodies: dict[str, list[Ellipsoid]] = {}
    for body, link in zip(robot.bodies_at(configuration), robot.part_links, strict=True):
        bodies.setdefault(link, []).append(body)
    return [pair for pair in pairs if _touch(bodies[pair[0]], bodies[pair[1]])]


def _touch(first: list[Ellipsoid], second: list[Ellipsoid]) -> bool:
    return any(gap(a, b).value <= 0.0 for a, b in itertools.product(first, second))
