"""Worlds of any number of ellipsoids at one density, each within the next.

A smaller world is the middle of every larger one: the same bodies, the same robot, the same start
and goal, one body to each unit of volume. So whatever a larger world costs more is the price of
bodies that are far away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

SIZES = (10, 100, 1_000, 10_000)
"""Numbers of obstacles."""

_AXES = {2: (0.14, 0.42), 3: (0.25, 0.7)}
"""Shortest and longest semi-axis of an obstacle; neighbours are a distance of about 1 apart."""
_END = 0.42
"""Start and goal stand at minus and plus this fraction of the smallest world's sides."""
_KEPT_FREE = 0.95
"""No obstacle is centred within this distance of start or goal."""


def side(count: int, dimension: int) -> float:
    """Side of the box that holds ``count`` bodies."""
    return float(count ** (1.0 / dimension))


def scale_scenario(count: int, dimension: int, seed: int = 1) -> Scenario:
    """``count`` obstacles, one of SIZES, with start and goal as far apart as in every other."""
    half = 0.5 * side(count, dimension)
    world = World(
        np.full(dimension, -half), np.full(dimension, half), _obstacles(count, dimension, seed)
    )
    start, goal = _ends(dimension)
    return Scenario(
        name=f"scale-{dimension}d-{count}-{seed}",
        description=f"{count} ellipsoids at one density, in {dimension} dimensions",
        world=world,
        robot=_robot(dimension),
        clearance=0.0,
        start=start,
        goal=goal,
        planner={},
    )


def _robot(dimension: int) -> RigidRobot:
    body = Ellipsoid.from_semi_axes([0.3, 0.12, 0.1][:dimension], name="body")
    head = Ellipsoid.from_semi_axes(
        [0.12, 0.08, 0.07][:dimension], [0.26, 0.12, 0.05][:dimension], name="head"
    )
    return RigidRobot((body, head))


def _ends(dimension: int) -> tuple[Array, Array]:
    place = np.full(dimension, _END * side(SIZES[0], dimension))
    if dimension == 2:
        return np.append(-place, 0.3), np.append(place, 1.9)
    first, last = np.array([0.1, 0.2, 0.3, 0.9]), np.array([0.5, -0.4, 0.6, 0.3])
    return (
        np.concatenate([-place, first / np.linalg.norm(first)]),
        np.concatenate([place, last / np.linalg.norm(last)]),
    )


def _obstacles(count: int, dimension: int, seed: int) -> tuple[Ellipsoid, ...]:
    random = np.random.default_rng([seed, dimension])
    found: list[Ellipsoid] = []
    inner = 0.0
    for size in SIZES:
        if size > count:
            break
        outer = 0.5 * side(size, dimension)
        found += [_obstacle(random, dimension, inner, outer) for _ in range(size - len(found))]
        inner = outer
    return tuple(found)


def _obstacle(random: np.random.Generator, dimension: int, inner: float, outer: float) -> Ellipsoid:
    """A body centred between two boxes about the origin, away from start and goal."""
    ends = [end[:dimension] for end in _ends(dimension)]
    while True:
        centre = random.uniform(-outer, outer, size=dimension)
        if np.abs(centre).max() < inner:
            continue
        if min(float(np.linalg.norm(centre - end)) for end in ends) >= _KEPT_FREE:
            break
    rotation, upper = np.linalg.qr(random.normal(size=(dimension, dimension)))
    rotation = rotation * np.sign(np.diag(upper))
    if np.linalg.det(rotation) < 0.0:
        rotation[:, -1] *= -1.0
    return Ellipsoid(centre, rotation, random.uniform(*_AXES[dimension], size=dimension))
