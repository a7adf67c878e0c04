"""Motions that were once certified although they collide.

Found by the search where the reach of a proof was 2·value/(root − slope): each has a first proof
that exceeds what it must by the last bit, so that root − slope is 0.
"""

from __future__ import annotations

import numpy as np
import pytest

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from tests.adversarial.rigid_motion import closest, is_proved_closer

# Bounds, post (centre, semi-axes), hand (centre, semi-axes), start and goal.
FOUND = (
    (
        ([2.2241164354405414, -4.339758172577872], [3.556362993104438, 4.21318494052095]),
        ([0.046025748818455836, -0.07463353348115498], [0.007267924971260228, 0.08865575758146682]),
        ([-2.9801343847773514, 0.028392581586246343], [0.1432927035871778, 0.04156973217088178]),
        [3.5432131730354093, -4.326608352508844, -1.306455742958226],
        [2.23726625550957, 4.200035120451922, 1.4070912738593628],
    ),
    (
        ([2.2638220391416706, -4.309985590499214], [3.531335947430705, 4.356021548087653]),
        (
            [0.01381992966891873, 0.00021672577422306125],
            [0.007429694068234171, 0.08886109109970168],
        ),
        ([-3.0204572987988563, 0.028469966855790625], [0.14328581205047844, 0.0424009311663089]),
        [3.522664056863286, -4.301313699931795, -1.3132944054837907],
        [2.2724939297090896, 4.347349657520233, 1.420622750337402],
    ),
)


@pytest.mark.parametrize("numbers", FOUND)
def test_it_is_refused(numbers: tuple) -> None:
    (low, high), post, hand, start, goal = numbers
    obstacle = Ellipsoid.from_semi_axes(post[1], post[0])
    world = World(np.array(low), np.array(high), (obstacle,))
    robot = RigidRobot((Ellipsoid.from_semi_axes(hand[1], hand[0]),))
    scenario = Scenario("found", world, robot, np.array(start), np.array(goal))
    place = closest(scenario, scenario.start, scenario.goal)
    assert place.gap < -0.1 and is_proved_closer(scenario, place)
    assert not scenario.cspace().is_motion_valid(scenario.start, scenario.goal)
