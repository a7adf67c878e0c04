"""Validity of articulated states: against slow twins, against FCL, and a hair from contact."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.world import World
from tests import oracles
from tests.articulated import random_robots, twin
from tests.articulated.changed import all_ignored, from_outside, with_link_scaled
from tests.random_scenes import embedded, unit_vector

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def crowded(rng: Any, dimension: int) -> tuple[World, ArticulatedRobot]:
    """A random world with a random robot, of which some states are free."""
    robot = random_robots.random_robot(
        rng,
        dimension,
        links=int(rng.integers(2, 9)),
        size=rng.uniform(0.15, 0.5),
        ignored=int(rng.integers(3)),
    )
    count = int(rng.integers(1, 8)) if dimension == 2 else 15
    return random_robots.random_world(rng, dimension, count), robot


@DIMENSIONS
def test_states_against_twins_with_the_reasons(dimension: int) -> None:
    rng = np.random.default_rng(1)
    counts = {True: 0, False: 0}
    kinds: list[str] = []
    for k in range(15):
        world, robot = crowded(rng, dimension)
        space = random_robots.cspace(world, robot)
        configurations = random_robots.random_configurations(rng, robot, 30)
        valid = space.are_valid(configurations)
        truth = {
            "obstacle": twin.obstacle_gaps(world, robot, configurations, 0.2),
            "self": twin.self_gaps(robot, configurations, 0.2),
        }
        for m, configuration in enumerate(configurations):
            wrong = {kind for kind in truth if truth[kind][m] <= 0}
            assert valid[m] == (not wrong), (k, m)
            assert {contact.kind for contact in space.explain(configuration)} == wrong, (k, m)
            counts[bool(valid[m])] += 1
            kinds += wrong
    assert min(counts.values()) > 60
    assert min(kinds.count("obstacle"), kinds.count("self")) > 30


def fcl_meets(world: World, robot: ArticulatedRobot, configuration: Any) -> bool:
    """Whether FCL finds any part of the robot in contact with an obstacle or another part."""
    import fcl

    def thing(centre: Any, matrix: Any) -> Any:
        body = oracles.Body(np.array(centre), np.array(matrix))
        return oracles.fcl_object(body if len(centre) == 3 else embedded(body))

    parts = [thing(c[0], a[0]) for c, a in twin.placed(robot, configuration[None])]
    bodies = [thing(body.centre, body.matrix) for body in world.obstacles]
    pairs = [(part, body) for part in parts for body in bodies]
    pairs += [(parts[i], parts[j]) for i, j in twin.self_pairs(robot)]
    return any(
        fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult()) > 0 for a, b in pairs
    )


@DIMENSIONS
def test_states_against_fcl(dimension: int) -> None:
    """FCL overlooks contacts shallower than 1e-6; it must agree wherever the gap is more."""
    rng = np.random.default_rng(2)
    checked = 0
    for k in range(15):
        world, robot = crowded(rng, dimension)
        space = random_robots.cspace(world, robot)
        configurations = random_robots.random_configurations(rng, robot, 60)
        gaps = np.minimum(
            twin.obstacle_gaps(world, robot, configurations, 0.1),
            twin.self_gaps(robot, configurations, 0.1),
        )
        for configuration, gap in zip(configurations, gaps, strict=True):
            if abs(gap) > 1e-5:
                checked += 1
                assert space.is_valid(configuration) != fcl_meets(world, robot, configuration), k
    assert checked > 890


# --------------------------------------------------------------------------- a hair from contact

# relative to the size of the scenes, about 10
HAIRS = (1e-6, 1e-9, -1e-12, -1e-9)


@DIMENSIONS
def test_states_a_hair_from_an_obstacle(dimension: int) -> None:
    rng = np.random.default_rng(3)
    for k in range(6):
        robot = random_robots.random_robot(rng, dimension, links=5, size=0.2)
        silent = all_ignored(robot)
        world = random_robots.random_world(rng, dimension, 1)
        configuration = random_robots.random_configurations(rng, robot, 1, spread=2)
        obstacle = world.obstacles[0]
        at = twin.placed(robot, configuration)[0][0][0]
        away = unit_vector(rng, dimension)

        def scene(t: float, obstacle: Ellipsoid = obstacle, at: Any = at, away: Any = away) -> Any:
            body = Ellipsoid(at + t * away, obstacle.rotation, obstacle.semi_axes)
            return replace(world, obstacles=(body,))  # noqa: B023 (used at once)

        def gap(t: float, robot: Any = robot, q: Any = configuration) -> float:
            return float(twin.obstacle_gaps(scene(t), robot, q, 0.2)[0])

        far = float(np.linalg.norm(configuration)) + 20.0
        t, step = from_outside(gap, far)
        for hair in HAIRS:
            t, step = twin.solved(gap, t, step, 10 * hair), 1e-5
            space = random_robots.cspace(scene(t), silent)
            assert space.is_valid(configuration[0]) == (hair > 0), (k, hair)


@DIMENSIONS
def test_states_a_hair_from_self_collision(dimension: int) -> None:
    rng = np.random.default_rng(4)
    done = 0
    while done < 6:
        robot = random_robots.random_robot(rng, dimension, links=6, size=0.1)
        configuration = random_robots.random_configurations(rng, robot, 1)
        pairs = twin.self_pairs(robot)
        if not pairs or twin.self_gaps(robot, configuration, 0.1)[0] < 0:
            continue
        name = twin.part_links(robot)[pairs[int(rng.integers(len(pairs)))][0]]

        def gap(t: float, robot: Any = robot, name: str = name, q: Any = configuration) -> float:
            return float(twin.self_gaps(with_link_scaled(robot, name, t), q, 0.1)[0])

        start = 1.0
        while gap(start) > 0:
            start *= 1.3
        world = random_robots.random_world(rng, dimension, 0)
        t, step = start, -0.01 * start
        for hair in HAIRS:
            t, step = twin.solved(gap, t, step, 10 * hair), 1e-5
            space = random_robots.cspace(world, with_link_scaled(robot, name, t))
            assert space.is_valid(configuration[0]) == (hair > 0), (done, hair)
        done += 1


@DIMENSIONS
def test_states_a_hair_from_an_arena_s_boundary(dimension: int) -> None:
    rng = np.random.default_rng(5)
    for k in range(8):
        robot = random_robots.random_robot(rng, dimension, links=4, size=0.2)
        configuration = random_robots.random_configurations(rng, robot, 1, spread=1)
        world = random_robots.random_world(rng, dimension, 0, 1)
        reach = twin.arena_reaches(world, robot, configuration, 400)[0]
        for hair in HAIRS:
            arena = world.arenas[0]
            axes = arena.semi_axes * reach * (1 + hair)
            grown = replace(world, arenas=(Ellipsoid(arena.centre, arena.rotation, axes),))
            space = random_robots.cspace(grown, all_ignored(robot))
            assert space.is_valid(configuration[0]) == (hair > 0), (k, hair)


# --------------------------------------------------------------------------- what counts


def stick(length: float = 2.0) -> Ellipsoid:
    """A thin ellipse along x that begins at the origin."""
    return Ellipsoid.from_semi_axes([length / 2, 0.1], position=[length / 2, 0.0])


def folding(*fixed: str, ignored: Any = ()) -> ArticulatedRobot:
    """Three sticks in a row; joints named in ``fixed`` do not move."""
    joints = tuple(
        Joint.of(name, parent, child, "fixed" if name in fixed else "continuous", [2.0, 0.0])
        for name, parent, child in (("first", "a", "b"), ("second", "b", "c"))
    )
    links = tuple(Link(name, (stick(),)) for name in "abc")
    return ArticulatedRobot(links, joints, "fixed", ignored=ignored)


def test_links_joined_directly_may_meet_and_others_not() -> None:
    world = random_robots.random_world(np.random.default_rng(0), 2, 0)
    robot = folding()
    # folded back at both joints the sticks lie on each other
    assert not random_robots.cspace(world, robot).is_valid([np.pi, np.pi])
    assert random_robots.cspace(world, robot).is_valid([2.6, 0.0])
    ignoring = folding(ignored=frozenset({frozenset("ac")}))
    assert random_robots.cspace(world, ignoring).is_valid([np.pi, np.pi])


@pytest.mark.parametrize("fixed", ["first", "second"])
def test_links_joined_through_a_fixed_joint_count(fixed: str) -> None:
    """b and its fixed neighbour are one body; the third link must miss what it does not join."""
    world = random_robots.random_world(np.random.default_rng(0), 2, 0)
    space = random_robots.cspace(world, folding(fixed))
    assert space.is_valid([0.5])
    assert space.is_valid([2.0])
    robot = folding(fixed)
    value = 3.1  # folds the one moving joint: "a" on "b" is fine, beyond it is not
    gap = twin.self_gaps(robot, np.array([[value]]))[0]
    assert space.is_valid([value]) == (gap > 0)


def test_values_out_of_limits_are_told() -> None:
    world = random_robots.random_world(np.random.default_rng(0), 2, 0)
    links = tuple(Link(name, (stick(),)) for name in "abcd")
    joints = (
        Joint.of("turn", "a", "b", "revolute", [2.0, 0.0], lower=-0.5, upper=0.5),
        Joint.of("slide", "b", "c", "prismatic", [2.2, 0.0], lower=0.0, upper=0.5),
        Joint.of("spin", "c", "d", "continuous", [2.2, 0.0]),
    )
    space = random_robots.cspace(world, ArticulatedRobot(links, joints, "fixed"))
    for good in ([0.5, 0.5, np.pi], [-0.5, 0.0, -np.pi]):
        assert space.is_valid(good)
    for k, name in enumerate(("turn", "slide", "spin")):
        for value in (-3.5, 3.5):
            configuration = np.zeros(3)
            configuration[k] = value
            assert not space.is_valid(configuration)
            limits = [c for c in space.explain(configuration) if c.kind == "limits"]
            assert [contact.body for contact in limits] == [name]


def test_quaternions_of_any_length_are_rotations_and_absurd_ones_are_not() -> None:
    rng = np.random.default_rng(6)
    robot = random_robots.random_robot(rng, 3, links=4, base="free", types=("ball",), size=0.2)
    space = random_robots.cspace(random_robots.random_world(rng, 3, 10), robot)
    configurations = random_robots.random_configurations(rng, robot, 100)
    places = [place for kind, place in twin.slices(robot) if kind == "quaternion"]
    valid = space.are_valid(configurations)
    assert 10 < valid.sum() < 90
    for factor in (1e-20, 1e-8, 3.0, 1e20, -1.0):
        changed = configurations.copy()
        for place in places:
            changed[:, place] *= factor
        assert (space.are_valid(changed) == valid).all()
    for place in places:
        for value in (0.0, 1e-170, 1e170):
            changed = configurations.copy()
            changed[:, place] *= value
            assert not space.are_valid(changed).any()
