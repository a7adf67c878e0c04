"""Random articulated robots with joints of every kind, and random configurations of them."""

import numpy as np

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from tests.random_scenes import rotation, unit_vector

PLANAR_TYPES = ("revolute", "continuous", "prismatic", "fixed")
SPATIAL_TYPES = (*PLANAR_TYPES, "ball")


def random_tree(rng, dimension, base, links=6):
    """A robot whose joints are of random kinds, in another order than the tree's."""
    names = [f"link {index}" for index in range(links)]
    parents = [int(rng.integers(index)) for index in range(1, links)]
    kinds = PLANAR_TYPES if dimension == 2 else SPATIAL_TYPES
    joints = [
        _joint(rng, dimension, "revolute" if index == 0 else str(rng.choice(kinds)), *pair)
        for index, pair in enumerate(zip([names[i] for i in parents], names[1:], strict=True))
    ]
    rng.shuffle(joints)
    bodies = [
        Link(name, _parts(rng, dimension, count=index % 3)) for index, name in enumerate(names)
    ]
    position = rng.normal(size=dimension) if base == "fixed" else None
    turned = None if base == "free" else rotation(rng, dimension)
    ignored = frozenset({frozenset(names[1:3])})
    return ArticulatedRobot(tuple(bodies), tuple(joints), base, position, turned, ignored)


def _joint(rng, n, kind, parent, child):
    low, high = sorted(rng.uniform(-2.0, 2.0, size=2))
    axis = None if kind in ("ball", "fixed") else rng.normal(size=n)
    return Joint.of(
        f"to {child}",
        parent,
        child,
        kind,
        rng.normal(size=n),
        rotation(rng, n),
        axis,
        lower=low if kind in ("revolute", "prismatic") else 0.0,
        upper=high if kind in ("revolute", "prismatic") else 0.0,
    )


def _parts(rng, n, count):
    return tuple(
        Ellipsoid.from_semi_axes(rng.uniform(0.1, 1.0, n), rng.normal(size=n), rotation(rng, n))
        for _ in range(count)
    )


def random_configuration(rng, robot):
    """A configuration (d,) within all limits."""
    n = robot.dimension
    values = [] if robot.base == "fixed" else list(rng.normal(size=n))
    if robot.rotates:
        values += [rng.uniform(-np.pi, np.pi)] if n == 2 else list(unit_vector(rng, 4))
    for joint in robot.moving_joints:
        if joint.type == "ball":
            values += list(unit_vector(rng, 4))
        else:
            values.append(rng.uniform(joint.lower, joint.upper))
    return np.array(values)
