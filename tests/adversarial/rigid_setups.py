"""Rigid robots of one part and their motions, as a search for false certificates wants them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from tests import random_scenes
from tests.random_scenes import Rng

Array = NDArray[np.float64]


class Setup(NamedTuple):
    """A robot, its motion from ``first`` to ``last``, and the clearance it has to keep."""

    robot: RigidRobot
    first: Array
    last: Array
    clearance: float

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.robot.dimension

    @property
    def scale(self) -> float:
        """At least the scene's scale in the packed scene, for bodies near the motion."""
        part, n = self.robot.parts[0], self.dimension
        ends = np.abs([self.first[:n], self.last[:n]]).max(axis=0)
        reach = np.linalg.norm(part.centre) + part.semi_axes.max()
        return float(np.linalg.norm(ends) + 2.0 * reach + self.clearance)

    def scenario(
        self,
        obstacles: tuple[Ellipsoid, ...] = (),
        arenas: tuple[Ellipsoid, ...] = (),
        wider: float = 0.0,
    ) -> Scenario:
        """The motion in a world of these bodies, whose bounds are hardly wider than the motion.

        Bounds that are ``wider`` make the scene larger, and with it what a proof has to exceed.
        """
        n = self.dimension
        ends = np.array([self.first[:n], self.last[:n]])
        room = 1e-3 * max(np.ptp(ends), float(self.robot.parts[0].semi_axes.max()))
        room += wider
        world = World(ends.min(axis=0) - room, ends.max(axis=0) + room, obstacles, arenas)
        return Scenario("case", world, self.robot, self.first, self.last, self.clearance)


def margin(scenario: Scenario) -> float:
    """By how much a gap has to exceed the clearance at least for a proof along a motion."""
    return 2.0 * layout.ROUNDING * float(scenario.cspace().scene[layout.SCALE])


def ellipsoid(
    rng: Rng, n: int, ratio: float, size: float, centre: Array | None = None
) -> Ellipsoid:
    """A body of any kind with axis ratios of up to ``ratio``."""
    kind = str(rng.choice(random_scenes.KINDS))
    axes = size * random_scenes.semi_axes(rng, n, kind, ratio)
    turn = random_scenes.rotation(rng, n)
    return Ellipsoid(np.zeros(n) if centre is None else centre, turn, axes)


def setup(
    rng: Rng,
    n: int,
    *,
    ratio: float = 10.0,
    lever: float = 1.0,
    angle: float | None = None,
    far: float = 1.0,
    clearance: float = 0.0,
    step: float | None = None,
) -> Setup:
    """A random part (size 1), ``lever`` from its base, on a motion that turns by ``angle``."""
    turn = rng.uniform(0.2, np.pi) if angle is None else angle
    part = ellipsoid(rng, n, ratio, 1.0, lever * rng.uniform() * random_scenes.unit_vector(rng, n))
    position = far * random_scenes.unit_vector(rng, n)
    length = rng.choice([0.0, 0.3, 2.0]) * rng.uniform() if step is None else step
    after = position + length * random_scenes.unit_vector(rng, n)
    if n == 2:
        yaw = rng.uniform(-np.pi, np.pi)
        ends = [np.append(position, yaw), np.append(after, yaw + rng.choice([-1, 1]) * turn)]
    else:
        begin = random_scenes.unit_vector(rng, 4)
        axis = np.sin(turn / 2) * random_scenes.unit_vector(rng, 3)
        end = random_scenes.quaternion_product(np.append(axis, np.cos(turn / 2)), begin)
        ends = [np.append(position, begin), np.append(after, end)]
    if rng.uniform() < 0.5:
        ends.reverse()
    plain = Setup(RigidRobot((part,)), *ends, clearance)
    # A scenario brings headings and quaternions into their ranges.
    stored = plain.scenario()
    return Setup(stored.robot, stored.start, stored.goal, clearance)


def lever_past_a_post(rng: Rng) -> tuple[Setup, Ellipsoid]:
    """A planar hand on a lever that hardly moves half-way, close by a thin post.

    The base moves against the turn. One of 40 gave a false certificate where a reach was the
    quotient of a difference.
    """
    width = rng.choice([0.02, 0.1, 0.3])

    def about(value: float) -> float:
        return float(value * (1.0 + width * rng.uniform(-1, 1)))

    hand = Ellipsoid.from_semi_axes([about(0.143), about(0.042)], [-about(3.0), about(0.0286)])
    first = np.array([about(3.5), -about(4.28), -about(1.328)])
    last = np.array([about(2.23), about(4.26), about(1.414)])
    middle = 0.5 * (first + last)
    c, s = np.cos(middle[2]), np.sin(middle[2])
    place = middle[:2] + np.array([[c, -s], [s, c]]) @ hand.centre
    offset = np.array([about(-0.1321), about(-0.1096)])
    post = Ellipsoid.from_semi_axes([about(0.0073), about(0.0876)], place - offset)
    return Setup(RigidRobot((hand,)), first, last, 0.0), post
