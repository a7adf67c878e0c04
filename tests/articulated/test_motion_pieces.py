"""How many pieces a proof takes: second order in the gap."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from tests.articulated.test_motion_corners import ball, world


def orbit(dimension: int, against: str, gap: float) -> tuple[ArticulatedCSpace, list[float]]:
    """A ball on an arm that keeps the same gap from something all the way round."""
    z = [0.0] * dimension

    def at(x: float) -> list[float]:
        return [x, *z[1:]]

    def hinge(name: str, parent: str, child: str, x: float) -> Joint:
        axis = None if dimension == 2 else [0.0, 0.0, 1.0]
        return Joint.of(name, parent, child, "revolute", at(x), axis=axis, lower=-3, upper=3)

    if against == "itself":
        # Without something that they do meet in the end, the links would be proved apart for good.
        stop = ball(0.5, *[2.0 * np.cos(3.0), 2.0 * np.sin(3.0), 0.0][:dimension])
        links = (Link("a", (ball(1.0, *z), stop)), Link("b"), Link("c", (ball(1.0 - gap, *z),)))
        joints = (hinge("first", "a", "b", 0.0), hinge("second", "b", "c", 2.0))
        return ArticulatedCSpace(world(dimension), ArticulatedRobot(links, joints, "fixed")), [1, 1]
    inner = against == "obstacle"
    tip = ball(1.0 - gap, *at(2.0)) if inner else ball(1.0, *at(2.0 - gap))
    robot = ArticulatedRobot((Link("a"), Link("b", (tip,))), (hinge("j", "a", "b", 0.0),), "fixed")
    scene = world(dimension, *([ball(1.0, *z)] if inner else []))
    if not inner:
        scene = type(scene)(scene.low, scene.high, (), (ball(3.0, *z),))
    return ArticulatedCSpace(scene, robot), [1]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("against", ["obstacle", "arena", "itself"])
def test_pieces_grow_with_the_square_root(dimension: int, against: str) -> None:
    counts = []
    for gap in (1e-2, 1e-4, 1e-6):
        space, end = orbit(dimension, against, gap)
        counts.append(int(space.motion_proofs(-1.0 * np.array(end), end)[0]))
    assert counts[0] > 0
    # halving makes powers of two: up to a factor of two either way
    for fewer, more in itertools.pairwise(counts):
        assert 5 * fewer <= more <= 20 * fewer, counts
    space, end = orbit(dimension, against, -1e-12)
    assert space.motion_proofs(-1.0 * np.array(end), end)[0] < 0
