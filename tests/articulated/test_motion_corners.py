"""Certified joint motions in the corners: OMPL's held rotations, half turns, limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.world import World

UNIT = [0.0, 0.0, 0.0, 1.0]


def ball(radius: float, *position: float) -> Ellipsoid:
    """A disc or ball."""
    return Ellipsoid.from_semi_axes([radius] * len(position), position=position)


def world(n: int, *obstacles: Ellipsoid) -> World:
    """A box of half-width 20 with obstacles."""
    return World(np.full(n, -20.0), np.full(n, 20.0), obstacles)


def about_x(angle: float) -> list[float]:
    """The quaternion of a turn about x."""
    return [np.sin(angle / 2), 0.0, 0.0, np.cos(angle / 2)]


# --------------------------------------------------------------------------- tiny rotations

# OMPL holds rotations below about 9e-5 rad until the end.
HELD = (2e-5, 5e-5, 8e-5, 1e-4, 1.9e-4)


def lever(place: str) -> tuple[ArticulatedRobot, Any]:
    """A small ball at the end of a lever of length 10 along y, that a base or ball joint turns.

    With it comes a function from (x, angle about x, s) to a configuration.
    """
    tip = Link("tip", (ball(1e-4, 0.0, 10.0, 0.0),))
    if place == "base":
        slide = Joint.of("slide", "tip", "other", "prismatic", [0.0, 0.0, 0.0], lower=0, upper=1)
        robot = ArticulatedRobot((tip, Link("other", (ball(0.1, 0.0, 0.0, 5.0),))), (slide,))
        return robot, lambda x, angle: [x, 0, 0, *about_x(angle), 0.5]
    hinge = Joint.of("hinge", "root", "tip", "ball", [0.0, 0.0, 0.0])
    base = Link("root", (ball(0.1, 0.0, 0.0, 5.0),))
    if place == "joint":
        robot = ArticulatedRobot((base, tip), (hinge,), "translating")
        return robot, lambda x, angle: [x, 0, 0, *about_x(angle)]
    slide = Joint.of("slide", "rail", "root", "prismatic", [0.0, 0.0, 0.0], lower=-5, upper=5)
    robot = ArticulatedRobot((Link("rail"), base, tip), (hinge, slide), "fixed")
    return robot, lambda x, angle: [*about_x(angle), x]


@pytest.mark.parametrize("place", ["base", "joint", "rail"])
@pytest.mark.parametrize("angle", HELD)
def test_tiny_rotations_that_ompl_may_hold(place: str, angle: float) -> None:
    """The tip rises by 10 angle; held it stays at z = 0 until the end."""
    robot, at = lever(place)
    ends = at(0.0, 0.0), at(1.0, angle)
    rise = 10.0 * angle
    assert ArticulatedCSpace(world(3), robot).is_motion_valid(*ends)
    low = ball(1e-3, 0.9, 10.0, -1.1e-3 + 0.4 * rise)  # met while held, missed while turning
    between = ball(1e-5, 1.0, 10.0, 0.5 * rise)  # met by the jump at the end alone
    high = ball(1e-3, 0.5, 10.0, 1.1e-3 + 0.4 * rise)  # missed while held, met while turning
    for obstacle in (low, between, high):
        if obstacle is between and rise < 3e-4:
            continue  # then the ends meet it, too
        space = ArticulatedCSpace(world(3, obstacle), robot)
        assert space.are_valid(np.array(ends)).all()
        assert not space.is_motion_valid(*ends)
        assert not space.is_motion_valid(ends[1], ends[0])


@pytest.mark.parametrize("place", ["base", "joint", "rail"])
def test_small_rotations_that_ompl_surely_turns(place: str) -> None:
    robot, at = lever(place)
    rise = 2.1e-3
    ends = at(0.0, 0.0), at(1.0, rise / 10.0)
    low = ball(1e-3, 0.9, 10.0, -1.1e-3 + 0.4 * rise)
    space = ArticulatedCSpace(world(3, low), robot)
    assert space.is_motion_valid(*ends)


def test_several_tiny_rotations() -> None:
    """All surely held: proved. Some perhaps: refused, as mixtures would have to be proved."""
    links = (Link("a", (ball(0.1, 0.0, 0.0, 0.0),)), Link("b"), Link("c", (ball(0.1, 1, 0, 0),)))
    joints = (
        Joint.of("first", "a", "b", "ball", [1.0, 0.0, 0.0]),
        Joint.of("second", "b", "c", "ball", [1.0, 0.0, 0.0]),
    )
    robot = ArticulatedRobot(links, joints, "translating")
    space = ArticulatedCSpace(world(3), robot)
    start = [0.0, 0.0, 0.0, *UNIT, *UNIT]

    def end(first: float, second: float, length: float = 1.0) -> list[float]:
        return [1.0, 0.0, 0.0, *about_x(first), *(length * np.array(about_x(second)))]

    assert space.is_motion_valid(start, end(5e-5, 4e-5))
    assert space.is_motion_valid(start, end(1e-4, 0.5))
    assert not space.is_motion_valid(start, end(1e-4, 5e-5))
    # OMPL's test is of a product: a length that is off by 1e-9 decides
    assert not space.is_motion_valid(start, end(5e-5, 4e-5, 1 - 1e-9))


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("angle", [5e-5, 1e-4])
def test_half_turn_with_a_tiny_rotation(sign: int, angle: float) -> None:
    """Either way round, with the tiny rotation made or held until the end."""
    tip = Link("tip", (ball(1.0, 10.0, 0.0, 0.0),))
    joints = (
        Joint.of("turn", "post", "arm", "continuous", [0.0, 0.0, 0.0], axis=[0.0, 0.0, 1.0]),
        Joint.of("hinge", "arm", "tip", "ball", [0.0, 0.0, 0.0]),
    )
    robot = ArticulatedRobot((Link("post"), Link("arm"), tip), joints, "fixed")
    tilt = [0.0, np.sin(angle / 2), 0.0, np.cos(angle / 2)]  # lowers the tip by 10 angle
    first, second = [-np.pi / 2, *UNIT], [np.pi / 2, *tilt]
    assert ArticulatedCSpace(world(3), robot).is_motion_valid(first, second)
    turn = -np.pi / 2 + sign * 0.9 * np.pi
    height = 1.5 - 4.0 * angle  # 4 angle too low for the tip held, 5 angle high enough turned
    obstacle = ball(0.5, 10 * np.cos(turn), 10 * np.sin(turn), height)
    space = ArticulatedCSpace(world(3, obstacle), robot)
    assert space.are_valid(np.array([first, second])).all()
    assert not space.is_motion_valid(first, second)


def test_unnormalised_quaternions_turn_all_the_same() -> None:
    """However short: a rotation is not taken for none because its quaternion is small."""
    bar = Ellipsoid.from_semi_axes([2.0, 0.2, 0.2])
    turned = np.array([0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)])
    hinge = Joint.of("hinge", "a", "b", "ball", [0.0, 0.0, 3.0])
    for base in (True, False):
        links = (Link("a", (bar,)), Link("b")) if base else (Link("a"), Link("b", (bar,)))
        robot = ArticulatedRobot(links, (hinge,))
        obstacle = ball(0.3, 1.2, 1.2, 0.0 if base else 3.0)
        space = ArticulatedCSpace(world(3, obstacle), robot)
        for length in (1.0, 1e-8, 1e-30, 1e8):
            q = (length * np.array(UNIT), length * turned)
            ends = [[0, 0, 0, *v, *UNIT] if base else [0, 0, 0, *UNIT, *v] for v in q]
            assert space.are_valid(np.array(ends)).all()
            assert not space.is_motion_valid(*ends)


# --------------------------------------------------------------------------- half turns


def turning(kind: str) -> tuple[ArticulatedRobot, Any]:
    """A ball on an arm of length 3 that turns about z, and configurations of its angle."""
    n = 2 if kind.startswith("planar") else 3
    at = [0.0] * n
    tip = Link("tip", (ball(0.5, 3.0, *at[1:]),))

    def turn(angle: float) -> list[float]:
        return [0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2)]

    if kind.endswith("base"):
        joint = Joint.of("slide", "tip", "end", "prismatic", at, lower=0.0, upper=1.0)
        robot = ArticulatedRobot((tip, Link("end", (ball(0.1, *at),))), (joint,))
        if n == 2:
            return robot, lambda angle: [0, 0, np.remainder(angle + np.pi, 2 * np.pi) - np.pi, 0.5]
        return robot, lambda angle: [0, 0, 0, *turn(angle), 0.5]
    type_ = kind.rsplit("-", maxsplit=1)[-1]
    axis = [0.0, 0.0, 1.0] if n == 3 else None
    joint = Joint.of("turn", "post", "tip", type_, at, axis=axis, lower=-6.0, upper=6.0)
    robot = ArticulatedRobot((Link("post"), tip), (joint,), "fixed")
    if type_ == "ball":
        return robot, turn
    if type_ == "revolute":
        return robot, lambda angle: [angle]
    return robot, lambda angle: [np.remainder(angle + np.pi, 2 * np.pi) - np.pi]


ROUND = ("planar-base", "planar-continuous", "base", "continuous", "ball")


@pytest.mark.parametrize("kind", ROUND)
@pytest.mark.parametrize("start", [0.3, -2.0])
@pytest.mark.parametrize("off", [0.0, 1e-12, -1e-12])
def test_half_turns_are_proved_both_ways(kind: str, start: float, off: float) -> None:
    robot, at = turning(kind)
    n = robot.dimension
    ends = at(start), at(start + np.pi + off)
    assert ArticulatedCSpace(world(n), robot).is_motion_valid(*ends)
    for side in (0.5 * np.pi, -0.5 * np.pi):
        place = 3.0 * np.array([np.cos(start + side), np.sin(start + side), 0.0])[:n]
        space = ArticulatedCSpace(world(n, ball(0.3, *place)), robot)
        assert space.are_valid(np.array(ends)).all()
        assert not space.is_motion_valid(*ends)
        assert not space.is_motion_valid(ends[1], ends[0])


@pytest.mark.parametrize("kind", ROUND)
def test_less_than_half_a_turn_goes_the_shorter_way(kind: str) -> None:
    robot, at = turning(kind)
    n = robot.dimension
    for start in (0.3, 2.5, -3.0):
        for turn in (np.pi - 1e-3, -np.pi + 1e-3, 1.0):
            for side in (0.5, -0.5):
                angle = start + side * np.pi if abs(turn) > 2 else start + side
                place = 3.0 * np.array([np.cos(angle), np.sin(angle), 0.0])[:n]
                space = ArticulatedCSpace(world(n, ball(1e-3, *place)), robot)
                valid = space.is_motion_valid(at(start), at(start + turn))
                # a small turn meets what stands ahead, and the tip's own radius is 0.17 rad
                assert valid == (side * turn < 0), (start, turn, side)


@pytest.mark.parametrize("kind", ["planar-revolute", "revolute"])
def test_bounded_joints_go_straight_however_far(kind: str) -> None:
    robot, at = turning(kind)
    n = robot.dimension
    for first, second, angle, free in (
        (-3.0, 3.0, 0.0, False),
        (-2.6, 2.6, np.pi, True),
        (-6.0, 6.0, 2.0, False),
        (-6.0, -0.5, 0.0, True),
        (-6.0, -0.5, 3.0, False),
    ):
        place = 3.0 * np.array([np.cos(angle), np.sin(angle), 0.0])[:n]
        space = ArticulatedCSpace(world(n, ball(0.1, *place)), robot)
        assert space.are_valid(np.array([at(first), at(second)])).all()
        assert space.is_motion_valid(at(first), at(second)) == free, (first, second)
        assert space.is_motion_valid(at(second), at(first)) == free, (first, second)
    space = ArticulatedCSpace(world(n), robot)
    assert space.is_motion_valid(at(-6.0), at(6.0))
    assert not space.is_motion_valid(at(-6.0), at(6.0 + 1e-6))


def test_two_half_turns_are_refused() -> None:
    robot, _ = turning("planar-continuous")
    joints = (*robot.joints, Joint.of("more", "tip", "end", "continuous", [0.0, 0.0]))
    both = ArticulatedRobot((*robot.links, Link("end", (ball(0.1, 0.0, 0.0),))), joints, "fixed")
    space = ArticulatedCSpace(world(2), both)
    assert space.is_motion_valid([0.0, 0.0], [np.pi, 1.0])
    assert not space.is_motion_valid([0.0, 0.0], [np.pi, np.pi])
