"""Random trees of links, worlds about them, and configurations within their limits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.world import World
from tests import random_scenes
from tests.articulated import twin
from tests.oracles import Body
from tests.random_scenes import unit_vector

Array = NDArray[np.float64]
Rng = np.random.Generator

TYPES = ("revolute", "continuous", "prismatic", "fixed", "ball")


def random_link(rng: Rng, dimension: int, name: str, parts: int, size: float) -> Link:
    """A link of `parts` mild ellipsoids about its frame."""
    bodies = [
        Body(
            rng.uniform(-0.4, 0.4, size=dimension),
            random_scenes.matrix(rng, dimension, "mild", 3.0, size * rng.uniform(0.5, 1.0)),
        )
        for _ in range(parts)
    ]
    return Link(name, tuple(random_scenes.ellipsoid_of(body) for body in bodies))


def random_joint(rng: Rng, dimension: int, name: str, parent: str, child: str, kind: str) -> Joint:
    """A joint of one type, about an arm's length from its parent's frame."""
    lower, upper = -rng.uniform(0.2, 3.1), rng.uniform(0.2, 3.1)
    if kind == "prismatic":
        lower, upper = 0.3 * lower, 0.3 * upper
    return Joint.of(
        name,
        parent,
        child,
        kind,
        rng.uniform(0.8, 1.6) * unit_vector(rng, dimension),
        random_scenes.rotation(rng, dimension),
        None if rng.uniform() < 0.2 else rng.normal(size=dimension),
        lower,
        upper,
    )


def random_robot(
    rng: Rng,
    dimension: int,
    links: int = 5,
    base: str | None = None,
    types: tuple[str, ...] = TYPES,
    size: float = 0.5,
    ignored: int = 0,
) -> ArticulatedRobot:
    """A random tree; links and joints stand in any order, and some links have no parts."""
    if dimension == 2:
        types = tuple(kind for kind in types if kind != "ball")
    names = [f"link{k}" for k in range(links)]
    bodies = [
        random_link(rng, dimension, name, int(rng.choice([0, 1, 2], p=[0.15, 0.6, 0.25])), size)
        for name in names
    ]
    bodies[0] = random_link(rng, dimension, names[0], 1, size)
    kinds = [str(rng.choice(types)) for _ in range(links - 1)]
    kinds[0] = next(kind for kind in types if kind != "fixed")
    joints = [
        random_joint(rng, dimension, f"joint{k}", names[rng.integers(k)], names[k], kinds[k - 1])
        for k in range(1, links)
    ]
    base = str(rng.choice(["free", "translating", "fixed"])) if base is None else base
    pairs = [rng.choice(links, 2, replace=False) for _ in range(ignored)]
    return ArticulatedRobot(
        tuple(bodies[k] for k in rng.permutation(links)),
        tuple(joints[k] for k in rng.permutation(links - 1)),
        base,
        rng.uniform(-1, 1, size=dimension) if base == "fixed" else None,
        None if base == "free" else random_scenes.rotation(rng, dimension),
        frozenset(frozenset((names[a], names[b])) for a, b in pairs),
    )


def random_world(
    rng: Rng, dimension: int, obstacles: int = 5, arenas: int = 0, radius: float = 9.0
) -> World:
    """A box of half-width 6 with ellipsoids in it, perhaps in arenas of about `radius`."""

    def bodies(count: int, spread: float, low: float, high: float) -> tuple[Any, ...]:
        return tuple(
            random_scenes.ellipsoid_of(
                Body(
                    rng.uniform(-spread, spread, size=dimension),
                    random_scenes.matrix(rng, dimension, "mild", 3.0, rng.uniform(low, high)),
                )
            )
            for _ in range(count)
        )

    box = np.full(dimension, 6.0)
    return World(
        -box, box, bodies(obstacles, 5.0, 0.5, 1.8), bodies(arenas, 0.5, radius, 1.3 * radius)
    )


def random_configurations(rng: Rng, robot: Any, count: int, spread: float = 4.0) -> Array:
    """Configurations (count, d), uniform within limits and over rotations."""
    d = robot.configuration_size
    out = np.empty((count, d))
    for kind, place in twin.slices(robot):
        if kind == "linear":
            out[:, place] = rng.uniform(-spread, spread, size=(count, place.stop - place.start))
        elif kind == "angle":
            out[:, place] = rng.uniform(-np.pi, np.pi, size=(count, 1))
        else:
            q = rng.normal(size=(count, 4))
            out[:, place] = q / np.linalg.norm(q, axis=1, keepdims=True)
    for joint in robot.joints:
        if joint.type in ("revolute", "prismatic"):
            place = robot.joint_slices[joint.name]
            out[:, place] = rng.uniform(joint.lower, joint.upper, size=(count, 1))
    return out


def nearby(rng: Rng, robot: Any, first: Array, step: float, turn: float) -> Array:
    """A configuration at most `step` away in lengths and `turn` [rad] in angles, in limits."""
    second = first.copy()
    for kind, place in twin.slices(robot):
        size = place.stop - place.start
        if kind == "linear":
            second[place] += step * rng.uniform(-1, 1, size=size)
        elif kind == "angle":
            value = first[place] + rng.uniform(-turn, turn)
            second[place] = np.remainder(value + np.pi, 2 * np.pi) - np.pi
        else:
            half = 0.5 * turn * rng.uniform()
            spin = np.append(np.sin(half) * unit_vector(rng, 3), np.cos(half))
            second[place] = random_scenes.quaternion_product(spin, first[place])
            second[place] *= rng.choice([-1.0, 1.0]) / np.linalg.norm(second[place])
    for joint in robot.joints:
        if joint.type in ("revolute", "prismatic"):
            place = robot.joint_slices[joint.name]
            reach = turn if joint.type == "revolute" else step
            value = first[place] + rng.uniform(-reach, reach)
            second[place] = np.clip(value, joint.lower, joint.upper)
    return second


def cspace(world: World, robot: ArticulatedRobot, clearance: float = 0.0) -> ArticulatedCSpace:
    """The C-space under test."""
    return ArticulatedCSpace(world, robot, clearance)
