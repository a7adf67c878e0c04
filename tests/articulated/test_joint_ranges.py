"""Which links can meet: against dense sampling, and built to touch by a hair."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.joint_limits import RESOLUTION, excluding_limits
from ellipsoid_planning.cspace.joint_ranges import JointBoxes, never_meeting, pair_verdicts
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.kernels.kinematics import pair_matrix
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.world import World
from tests.articulated import random_robots, twin
from tests.articulated_scenes import snake

SAMPLES = 2000


def only(robot: ArticulatedRobot, first: str, second: str) -> ArticulatedRobot:
    """The robot with all pairs of links ignored but one."""
    names = [link.name for link in robot.links]
    pairs = {frozenset((a, b)) for a in names for b in names if a != b}
    return replace(robot, ignored=frozenset(pairs - {frozenset((first, second))}))


def at_example(robot: ArticulatedRobot, example: dict[str, Any]) -> Any:
    """A configuration with the joint values of an example."""
    configuration = random_robots.random_configurations(np.random.default_rng(0), robot, 1)
    for name, value in example.items():
        configuration[0, robot.joint_slices[name]] = value
    return configuration


@pytest.mark.parametrize("dimension", [2, 3])
def test_verdicts_against_dense_sampling(dimension: int) -> None:
    rng = np.random.default_rng(4)
    counts = {"never": 0, "meet": 0, "undecided": 0}
    for _ in range(15):
        robot = random_robots.random_robot(rng, dimension, 5, size=rng.uniform(0.15, 0.5))
        configurations = random_robots.random_configurations(rng, robot, SAMPLES)
        quick = never_meeting(robot)
        for pair in pair_verdicts(robot, 10_000):
            counts[pair.verdict] += 1
            alone = only(robot, pair.first, pair.second)
            if pair.verdict == "meet":
                example = at_example(robot, pair.example or {})
                assert twin.within_limits(robot, example).all()
                assert twin.self_gaps(alone, example)[0] <= 1e-12
            elif pair.verdict == "never":
                assert twin.self_gaps(alone, configurations, 0.1).min() > 0
            if frozenset((pair.first, pair.second)) in quick:
                assert pair.verdict == "never"
    assert counts["never"] > 20
    assert counts["meet"] > 8
    assert counts["undecided"] < 5


def test_every_rotation_of_ball_joints_is_covered() -> None:
    """A hook that meets the foot at one rotation of many, found both ways along the tree."""
    rng = np.random.default_rng(0)
    for _ in range(10):
        where = rng.normal(size=3)
        where /= np.linalg.norm(where)
        tip = Ellipsoid.from_semi_axes([0.02] * 3, [0.0, 0.0, 1.0])
        knob = Ellipsoid.from_semi_axes([0.02] * 3, where)
        links = (Link("foot", (knob,)), Link("middle"), Link("tip", (tip,)))
        swapped = (links[2], links[1], links[0])
        joints = (
            Joint.of("turn", "foot", "middle", "ball", [0.0, 0.0, 0.0]),
            Joint.of("rest", "middle", "tip", "fixed", [0.0, 0.0, 0.0]),
        )
        for order in (links, swapped):
            robot = ArticulatedRobot(order, joints)
            (pair,) = pair_verdicts(robot)
            assert pair.verdict == "meet"
            example = at_example(robot, pair.example or {})
            assert twin.self_gaps(robot, example)[0] <= 1e-12


TOUCHING = 2.0 * np.arcsin(0.5 * 0.5)  # the angle at which the discs' distance is their radii


def finger(lower: float = -np.pi, upper: float = np.pi) -> ArticulatedRobot:
    """A disc at (0, 1), and an equal one that moves on the unit circle, from (1, 0) at 0."""
    links = (
        Link("a", (Ellipsoid.from_semi_axes([0.25, 0.25], [0.0, 1.0]),)),
        Link("b"),
        Link("c", (Ellipsoid.from_semi_axes([0.25, 0.25], [1.0, 0.0]),)),
    )
    joints = (
        Joint.of("root", "a", "b", "fixed", [0.0, 0.0]),
        Joint.of("bend", "b", "c", "revolute", [0.0, 0.0], lower=lower, upper=upper),
    )
    return ArticulatedRobot(links, joints)


@pytest.mark.parametrize("hair", [1e-3, 1e-6, 1e-8])
def test_a_hair_from_contact(hair: float) -> None:
    """The limit stops the second disc when the gap is a hair, or the overlap."""
    for sign, verdict in ((1.0, "never"), (-1.0, "meet")):
        (pair,) = pair_verdicts(finger(-1.0, np.pi / 2 - TOUCHING - sign * hair))
        assert pair.verdict == verdict
    # Limits are enforced to 1e-9: a contact within that is no proof.
    (pair,) = pair_verdicts(finger(-1.0, np.pi / 2 - TOUCHING - 1e-10))
    assert pair.verdict != "never"


def test_a_hair_from_contact_with_two_joints() -> None:
    """A slide carries a needle past a disc at a known distance."""
    for hair, verdict in ((1e-4, "never"), (-1e-4, "meet")):
        needle = Ellipsoid.from_semi_axes([1.0, 0.05])
        disc = Ellipsoid.from_semi_axes([0.5, 0.5], [0.0, 1.5 + hair])
        joints = (
            Joint.of("x", "a", "b", "prismatic", [0, 0], axis=[1, 0], lower=-2.0, upper=2.5),
            Joint.of("spin", "b", "c", "continuous", [0, 0]),
        )
        robot = ArticulatedRobot((Link("a", (disc,)), Link("b"), Link("c", (needle,))), joints)
        (pair,) = pair_verdicts(robot)
        assert pair.verdict == verdict


def test_limits_that_exclude_are_tight() -> None:
    """The largest range of the hinge of a disc that swings is known."""
    robot = finger()
    around = np.append(np.zeros(3), 0.3)
    (limits,) = excluding_limits(JointBoxes(robot), "a", "c", around)
    assert (limits.joint, limits.around) == ("bend", 0.3)
    room = RESOLUTION * 2.0 * np.pi
    assert np.pi / 2 - TOUCHING - room < limits.upper < np.pi / 2 - TOUCHING
    assert limits.lower == -np.pi
    (other,) = excluding_limits(JointBoxes(robot), "a", "c", np.append(np.zeros(3), 3.0))
    assert np.pi / 2 + TOUCHING < other.lower < np.pi / 2 + TOUCHING + room
    assert other.upper == np.pi
    # At a contact nothing helps.
    assert excluding_limits(JointBoxes(robot), "a", "c", np.append(np.zeros(3), 1.5)) == ()


def test_limits_that_exclude_against_dense_sampling() -> None:
    robot = snake(3)
    rng = np.random.default_rng(2)
    found = excluding_limits(JointBoxes(robot), "l0", "l2")
    assert [limits.joint for limits in found] == ["j0", "j1"]
    dense = np.zeros((20_001, robot.configuration_size))
    dense[:, 3:] = np.linspace(-2.4, 2.4, 20_001)[:, None]
    for limits in found:
        place = robot.joint_slices[limits.joint].start
        narrow = replace(
            robot,
            joints=tuple(
                replace(joint, lower=limits.lower, upper=limits.upper)
                if joint.name == limits.joint
                else joint
                for joint in robot.joints
            ),
        )
        inside = random_robots.random_configurations(rng, narrow, 10_000)
        assert twin.self_gaps(robot, inside).min() > 0
        assert [pair.verdict for pair in pair_verdicts(narrow)] == ["never"]
        # A little beyond either limit, some value of the other joint makes them meet.
        room = 2.0 * RESOLUTION * 4.8
        for value in (limits.lower - room, limits.upper + room):
            beyond = dense.copy()
            beyond[:, place] = value
            assert twin.self_gaps(robot, beyond).min() <= 0


def test_what_is_proved_apart_is_not_tested() -> None:
    joints = tuple(replace(joint, lower=-0.5, upper=0.5) for joint in snake(6).joints)
    robot = replace(snake(6), joints=joints)
    space = ArticulatedCSpace(World(np.full(2, -10.0), np.full(2, 10.0)), robot)
    assert never_meeting(robot) is never_meeting(robot)
    assert frozenset(("l0", "l2")) in never_meeting(robot)
    pairs = pair_matrix(space.kinematics)
    assert pairs[0, 2] == 0.0
    # Out of the limits they do meet, and that is told.
    folded = np.zeros(robot.configuration_size)
    folded[3:5] = [2.6, 2.6]
    kinds = {contact.kind for contact in space.explain(folded)}
    assert kinds == {"limits", "self"}


def test_large_robots_are_left_alone_after_some_work() -> None:
    robot = snake(40)
    assert never_meeting(robot) == frozenset()


@pytest.mark.parametrize("kind", ["prismatic", "revolute"])
@pytest.mark.parametrize("backwards", [False, True])
def test_contacts_at_the_end_of_the_limits(kind: str, backwards: bool) -> None:
    """Tiny bodies that meet at one end alone: there the bound on the motion has nothing to give."""
    upper = 1.0
    start = np.array([2.0, 0.0])
    turned = 2.0 * np.array([np.cos(upper), np.sin(upper)])
    end = turned if kind == "revolute" else start + np.array([upper, 0.0])
    for size, verdict in ((1e-3, "meet"), (1e-6, "meet"), (-1e-6, "never")):
        # A hair short of each other, or overlapping.
        room = (1.8 if size > 0 else 2.2) * abs(size)
        away = end + room * end / np.linalg.norm(end)
        links = (
            Link("a", (Ellipsoid.from_semi_axes([abs(size)] * 2, away),)),
            Link("b"),
            Link("c", (Ellipsoid.from_semi_axes([abs(size)] * 2, start),)),
        )
        joints = (
            Joint.of("rest", "a", "b", "fixed", [0.0, 0.0]),
            Joint.of("move", "b", "c", kind, [0.0, 0.0], axis=[1.0, 0.0], lower=-0.5, upper=upper),
        )
        (pair,) = pair_verdicts(ArticulatedRobot(links[::-1] if backwards else links, joints))
        assert pair.verdict == verdict
