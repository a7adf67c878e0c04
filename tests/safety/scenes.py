"""Robots whose links have tables of every kind, and worlds full of obstacles."""

import numpy as np

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link, RigidRobot
from ellipsoid_planning.safety import TableParameters
from ellipsoid_planning.world import World
from tests.planners.articulated_scenes import random_configurations, robot_of
from tests.random_scenes import rotation

KINDS = (
    "snake",
    "mixed planar",
    "planar arm",
    "chain",
    "mixed spatial",
    "arm",
    "spheroids",
    "dumbbells",
    "lopsided",
    "discs",
)
"""Those of tests.planners.articulated_scenes, and links that are bodies of revolution."""

COARSE = TableParameters(memory=30_000)

_LINKS = {
    "spheroids": [([0.2, 0.2, 0.6], [0.6, 0.0, 0.0])],
    "dumbbells": [([0.3, 0.2, 0.2], [0.1, 0.0, 0.0]), ([0.3, 0.2, 0.2], [1.0, 0.0, 0.0])],
    "lopsided": [([0.3, 0.3, 0.3], [0.2, 0.0, 0.0]), ([0.5, 0.1, 0.1], [0.7, 0.0, 0.0])],
    "discs": [([0.1, 0.4, 0.4], [0.5, 0.1, 0.0])],
}


def robot(kind):
    """A robot of a kind of KINDS."""
    if kind not in _LINKS:
        return robot_of(kind)
    parts = tuple(Ellipsoid.from_semi_axes(axes, at) for axes, at in _LINKS[kind])
    links = [Link(f"l{i}", parts) for i in range(3)]
    joints = [Joint.of(f"j{i}", f"l{i}", f"l{i + 1}", "ball", [1.3, 0.0, 0.0]) for i in range(2)]
    return ArticulatedRobot(tuple(links), tuple(joints))


def crowd(dimension, count=25, arena=False, seed=5):
    """A world of [-7, 7]ⁿ with obstacles everywhere, maybe within an arena."""
    rng = np.random.default_rng(seed)
    bodies = [
        Ellipsoid.from_semi_axes(
            rng.uniform(0.2, 1.2, dimension),
            rng.uniform(-7.0, 7.0, dimension),
            rotation(rng, dimension),
        )
        for _ in range(count)
    ]
    arenas = [Ellipsoid.from_semi_axes([9.0, 8.0, 7.5][:dimension])] if arena else []
    return World(np.full(dimension, -7.0), np.full(dimension, 7.0), tuple(bodies), tuple(arenas))


def crowded(kind, arena=False, clearance=0.0):
    """The C-space of a robot of KINDS in a crowd."""
    own = robot(kind)
    return CSpace(crowd(own.dimension, arena=arena), own, clearance)


def rigid(dimension, rotates=True):
    """The C-space of a rigid robot of two parts in a crowd."""
    axes = [[0.6, 0.2, 0.3], [0.2, 0.3, 0.2]]
    parts = [
        Ellipsoid.from_semi_axes(own[:dimension], [x, 0.1, 0.0][:dimension])
        for own, x in zip(axes, (0.0, 0.5), strict=True)
    ]
    turned = None if rotates else rotation(np.random.default_rng(3), dimension)
    return CSpace(crowd(dimension), RigidRobot(tuple(parts), rotates, turned))


def states(cspace, count, seed=1):
    """Configurations (count, d) all over the world."""
    own = cspace.robot
    if own.joints:
        return random_configurations(own, count, seed)
    rng = np.random.default_rng(seed)
    rows = np.zeros((count, own.configuration_size))
    rows[:, : own.dimension] = rng.uniform(-7.0, 7.0, (count, own.dimension))
    if own.rotates and own.dimension == 2:
        rows[:, 2] = rng.uniform(-np.pi, np.pi, count)
    elif own.rotates:
        rows[:, 3:] = rng.normal(size=(count, 4))
        rows[:, 3:] /= np.linalg.norm(rows[:, 3:], axis=1, keepdims=True)
    return rows


def near_contact(cspace, count, seed=2):
    """Configurations (k, d) on either side of the border of what is valid, very near to it."""
    free = [row for row in states(cspace, 40 * count, seed) if cspace.is_valid(row)]
    other = [row for row in states(cspace, 40 * count, seed + 1) if not cspace.is_valid(row)]
    found = []
    for good, bad in list(zip(free, other, strict=False))[:count]:
        low, high = 0.0, 1.0
        while high - low > 1e-12:
            middle = 0.5 * (low + high)
            if cspace.is_valid(cspace.interpolate(good, bad, middle)):
                low = middle
            else:
                high = middle
        found += [cspace.interpolate(good, bad, s) for s in (low - 1e-6, low, high, high + 1e-6)]
    return np.array(found)
