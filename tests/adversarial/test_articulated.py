"""Joint motions aimed at rounding: no false certificate, and what is free by 1e-9 is proved."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.adversarial import articulated_judge as judge
from tests.adversarial.articulated_cases import KINDS, TWISTS, draw
from tests.adversarial.articulated_judge import Aim
from tests.adversarial.articulated_search import search
from tests.adversarial.outcome import Outcome


@pytest.mark.parametrize("kind", KINDS)
def test_no_motion_is_certified_that_touches(kind: str) -> None:
    total = sum((search(kind, twist, seed) for twist in TWISTS for seed in range(1)), Outcome())
    assert total.tried >= 8
    assert not total.false, total.false[0].what
    assert not total.refused, total.refused[0].what


def test_the_judge_tells_a_scene_that_touches_by_its_own_measure() -> None:
    """Gaps of bodies in closed form: a disc on an arm that passes a disc."""
    rng = np.random.default_rng(3)
    for twist in ("plain", "offset"):
        case = next(c for _ in range(9) if (c := draw(rng, "obstacle", twist, 2, True, 1e-10)))
        assert case.truth.value == pytest.approx(1e-10 * case.scale, rel=1e-2)
        q = judge.configurations(case.space.articulated, case.first, case.second, [case.truth.s])
        body = case.space.robot.bodies_at(q[0].astype(float))[case.aim.part]
        ((c, m),) = judge.bodies(case.space.articulated, q, [case.aim.part])
        assert np.allclose(body.centre, c[0].astype(float), rtol=1e-12)
        assert np.allclose(body.matrix @ body.matrix.T, (m[0] @ m[0].T).astype(float), atol=1e-14)


# --------------------------------------------------------------------------- built to be off


def ball(radius: float, *position: float) -> Ellipsoid:
    """A disc or ball."""
    return Ellipsoid.from_semi_axes([radius] * len(position), position=position)


def certified(
    robot: ArticulatedRobot, obstacle: Ellipsoid, first: Any, second: Any, rigid: bool = False
) -> bool:
    """Whether the motion past an obstacle is proved, in a box of half-width 3.

    A ``rigid`` robot is the base alone, and the last number is not its.
    """
    n = robot.dimension
    world = World(np.full(n, -3.0), np.full(n, 3.0), (obstacle,))
    if rigid:
        single, first, second = RigidRobot(robot.parts), first[:-1], second[:-1]
    space = CSpace(world, single) if rigid else ArticulatedCSpace(world, robot)
    assert space.are_valid([first, second]).all()
    return space.is_motion_valid(first, second)


def least(robot: ArticulatedRobot, obstacle: Ellipsoid, first: Any, second: Any) -> float:
    """The judge's least gap."""
    aim = Aim("obstacle", 0, obstacle)
    return float(judge.least(robot, aim, np.array(first), np.array(second)).value)


def lowered(robot: ArticulatedRobot, under: Any, first: Any, second: Any, gap: float) -> Ellipsoid:
    """A small ball under what moves, with this least gap along the motion."""
    n, height = robot.dimension, -1.0
    for _ in range(6):
        body = ball(0.1, *under, height) if n == 2 else ball(0.1, *under[:1], height, *under[1:])
        height += least(robot, body, first, second) - gap
    return body


def test_joints_far_from_zero_are_off_by_their_own_rounding() -> None:
    """At 4e3 rad a turn is off by up to 5e-13 rad, here and in OMPL.

    A tip that hangs from an arm swings past the lowest place of its arc, where the arm stands
    half a spacing lower than the closest number says; the tip touches by less than that.
    """
    links = (Link("post"), Link("arm"), Link("tip", (ball(0.01, 0.0, -1.0),)))
    joints = (
        Joint.of("turn", "post", "arm", "revolute", [0.0, 0.0], lower=-6e3, upper=6e3),
        Joint.of("swing", "arm", "tip", "revolute", [1.0, 0.0], lower=-1.0, upper=1.0),
    )
    robot = ArticulatedRobot(links, joints, "fixed")
    start = 4373.096973796992  # 1392 π, less half a spacing
    ends = [start, -0.27], [np.nextafter(start, 0.0), 0.33]
    assert not certified(robot, lowered(robot, [1.0], *ends, -2e-13), *ends)
    assert certified(robot, lowered(robot, [1.0], *ends, 2e-10), *ends)


@pytest.mark.parametrize("place", ["base", "joint", "rigid"])
def test_quaternions_a_little_longer_than_1_turn_unevenly(place: str) -> None:
    """OMPL takes squares of 1 ± 1e-9 and mixes quaternions as they are.

    So a lever is up to 1e-9 rad elsewhere half-way, which counts where a slide makes up for it.
    """
    tip = Link("tip", (ball(0.01, 1.0, 0.0, 0.0),))
    slide = Joint.of("slide", "rail", "post", "prismatic", [0, 0, 0], None, [0, -1, 0], -3, 3)
    hinge = Joint.of("hinge", "post", "tip", "ball", [0.0, 0.0, 0.0])
    robot = ArticulatedRobot((Link("rail"), Link("post"), tip), (slide, hinge), "fixed")
    if place != "joint":
        other = Joint.of("other", "tip", "end", "prismatic", [0.0, 0.0, 0.0], lower=-1, upper=1)
        robot = ArticulatedRobot((tip, Link("end")), (other,))

    def at(shift: float, angle: float, square: float) -> list[float]:
        q = np.sqrt(square) * np.array([0, 0, np.sin(angle / 2), np.cos(angle / 2)])
        return [shift, *q] if place == "joint" else [0.0, -shift, 0.0, *q, 0.0]

    found = []
    for sign in (1.0, -1.0):
        ends = at(0.0, -1.4, 1 - sign * 9e-10), at(2.0, 1.4, 1 + sign * 9e-10)
        even = at(0.0, -1.4, 1.0), at(2.0, 1.4, 1.0)
        body = lowered(robot, [0.7, 0.0], *ends, -1e-11)
        found.append(least(robot, body, *even))
        assert not certified(robot, body, *ends, place == "rigid")
        assert certified(robot, lowered(robot, [0.7, 0.0], *ends, 2e-8), *ends, place == "rigid")
    assert max(found) > 1e-11  # even quaternions would not touch: the test is about these


def test_fixed_joints_round_as_others_do() -> None:
    """A proof's margin is a share of the scene's scale, and that has a share for each joint."""
    turn = [[np.cos(2.1), -np.sin(2.1)], [np.sin(2.1), np.cos(2.1)]]
    links = tuple(Link(f"l{k}", (ball(0.1, 1, 0),) if k == 30 else ()) for k in range(31))
    world, scales = World(np.full(2, -3.0), np.full(2, 3.0)), []
    for kind in ("fixed", "continuous"):
        kinds = ["revolute", *[kind] * 29]
        joints = tuple(
            Joint.of(f"j{k}", f"l{k}", f"l{k + 1}", kinds[k], [1.0, 0.0], turn, None, -3.0, 3.0)
            for k in range(30)
        )
        robot = ArticulatedRobot(links, joints, "translating")
        scales.append(float(ArticulatedCSpace(world, robot).scene[layout.SCALE]))
    assert scales[0] == scales[1]
