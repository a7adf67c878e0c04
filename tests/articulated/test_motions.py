"""Certified joint motions: never a false certificate, and no refusal of what is free."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.world import World
from tests.articulated import random_robots, twin
from tests.articulated.changed import all_ignored, from_outside, with_link_scaled
from tests.random_scenes import unit_vector

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
SIZE = 20.0  # of these scenes, about

# How far lengths and angles [rad] may go in one motion: short ones to nearly half turns.
STRIDES = ((0.3, 0.3), (1.0, 1.0), (3.0, 3.0), (0.1, 3.1))


@DIMENSIONS
def test_random_motions_against_dense_checks(dimension: int) -> None:
    """States along the way decide; `test_validity` checks these against other twins."""
    rng = np.random.default_rng(1)
    counts = {True: 0, False: 0}
    s = np.linspace(0, 1, 200)
    for k in range(60):
        robot = random_robots.random_robot(
            rng, dimension, links=int(rng.integers(2, 9)), size=rng.uniform(0.1, 0.4), ignored=2
        )
        count = int(rng.integers(4)) if dimension == 2 else 6
        world = random_robots.random_world(rng, dimension, count, int(rng.integers(2)), 11.0)
        space = random_robots.cspace(world, robot, float(rng.choice([0.0, 0.05])))
        first = random_robots.random_configurations(rng, robot, 80)
        first = first[space.are_valid(first)][:8]
        if not len(first):
            continue
        stride = STRIDES[k % 4]
        second = np.array([random_robots.nearby(rng, robot, q, *stride) for q in first])
        for a, b, valid in zip(first, second, space.are_motions_valid(first, second), strict=True):
            samples = np.vstack([twin.interpolate(robot, a, b, s), b])
            assert bool(valid) == space.are_valid(samples).all(), (k, a, b)
            counts[bool(valid)] += 1
    assert min(counts.values()) > 25


@DIMENSIONS
def test_batches_equal_single_motions_and_ends_are_checked(dimension: int) -> None:
    rng = np.random.default_rng(2)
    robot = random_robots.random_robot(rng, dimension, links=6, size=0.25)
    space = random_robots.cspace(random_robots.random_world(rng, dimension, 8), robot)
    first = random_robots.random_configurations(rng, robot, 200)
    second = np.array([random_robots.nearby(rng, robot, q, 0.5, 0.5) for q in first])
    proofs = space.motion_proofs(first, second)
    single = [space.is_motion_valid(a, b) for a, b in zip(first, second, strict=True)]
    assert (proofs > 0).tolist() == single
    assert not ((proofs > 0) & ~(space.are_valid(first) & space.are_valid(second))).any()
    still = space.are_motions_valid(first, first)
    assert (still == space.are_valid(first)).all()
    assert 10 < sum(single) < 195


# --------------------------------------------------------------------------- built to touch

Build = Callable[[float], tuple[World, ArticulatedRobot]]


def gap_of(build: Build, measure: Any, first: Any, second: Any) -> Callable[[float], float]:
    """The least gap along the motion as a function of what the scene is built with."""

    def gap(t: float) -> float:
        world, robot = build(t)
        least = twin.least_along(robot, first, second, lambda q: measure(world, robot, q), 61, 2)
        return least.value

    return gap


def check(build: Build, gap: Any, start: float, step: float, ends: Any, why: Any) -> None:
    """Scenes whose least gap is a hair more or less than nothing: certified, refused."""
    for hair in (1e-9, 1e-11, -1e-13, -1e-10):
        start = twin.solved(gap, start, step, SIZE * hair)
        step = 1e-5
        world, robot = build(start)
        assert random_robots.cspace(world, robot).is_motion_valid(*ends) == (hair > 0), (why, hair)


def long_motion(rng: Any, robot: ArticulatedRobot, step: float) -> tuple[Any, Any]:
    """A motion in which angles turn by up to 170 degrees."""
    first = random_robots.random_configurations(rng, robot, 1, 2.0)[0]
    return first, random_robots.nearby(rng, robot, first, step, float(rng.choice([0.6, 2.97])))


@DIMENSIONS
def test_obstacle_moved_to_a_least_gap(dimension: int) -> None:
    rng = np.random.default_rng(3)
    for k in range(3):
        robot = random_robots.random_robot(rng, dimension, links=4, size=0.2)
        silent = all_ignored(robot)
        world = random_robots.random_world(rng, dimension, 1)
        ends = long_motion(rng, robot, 1.0)
        middle = twin.interpolate(robot, *ends, np.array([rng.uniform(0.2, 0.8)]))
        at, away = twin.placed(robot, middle)[-1][0][0], unit_vector(rng, dimension)
        shape = world.obstacles[0]

        def build(t: float, x: Any = (world, silent, shape, at, away)) -> Any:
            body = Ellipsoid(x[3] + t * x[4], x[2].rotation, x[2].semi_axes)
            return replace(x[0], obstacles=(body,)), x[1]

        gap = gap_of(build, lambda w, r, q: twin.obstacle_gaps(w, r, q, 0.3), *ends)
        check(build, gap, *from_outside(gap, 20.0), ends, k)


@DIMENSIONS
def test_links_grown_to_a_least_gap(dimension: int) -> None:
    rng = np.random.default_rng(4)
    done = 0
    while done < 3:
        robot = random_robots.random_robot(rng, dimension, links=5, size=0.1)
        ends, pairs = long_motion(rng, robot, 0.5), twin.self_pairs(robot)
        if not pairs:
            continue
        name = twin.part_links(robot)[pairs[int(rng.integers(len(pairs)))][0]]
        world = random_robots.random_world(rng, dimension, 0)

        def build(t: float, x: Any = (world, robot, name)) -> Any:
            return x[0], with_link_scaled(x[1], x[2], t)

        gap = gap_of(build, lambda _, r, q: twin.self_gaps(r, q, 0.1), *ends)
        if gap(1.0) < 0:
            continue
        start = 1.0
        while gap(start) > 0:
            start *= 1.3
        check(build, gap, start, -0.01 * start, ends, done)
        done += 1


@DIMENSIONS
def test_arena_shrunk_to_a_least_room(dimension: int) -> None:
    """The arena's scale is what the robot reaches in its norm: no root to find."""
    rng = np.random.default_rng(5)
    for k in range(4):
        robot = all_ignored(random_robots.random_robot(rng, dimension, links=4, size=0.2))
        world = random_robots.random_world(rng, dimension, 0, 1)
        arena = world.arenas[0]
        ends = long_motion(rng, robot, 1.0)
        least = twin.least_along(
            robot, *ends, lambda q, w=world, r=robot: -twin.arena_reaches(w, r, q), 61, 2
        )
        for hair in (1e-8, 1e-11, -1e-13, -1e-9):
            axes = arena.semi_axes * -least.value * (1 + hair)
            scaled = Ellipsoid(arena.centre, arena.rotation, axes)
            space = random_robots.cspace(replace(world, arenas=(scaled,)), robot)
            assert space.is_motion_valid(*ends) == (hair > 0), (k, hair, least)


# --------------------------------------------------------------------------- clearance


@DIMENSIONS
def test_motion_clearance_is_a_lower_bound_that_is_kept(dimension: int) -> None:
    rng = np.random.default_rng(6)
    proved = 0
    for k in range(12):
        robot = random_robots.random_robot(rng, dimension, links=4, size=0.2)
        world = random_robots.random_world(rng, dimension, 3)
        space = random_robots.cspace(world, robot)
        first = random_robots.random_configurations(rng, robot, 1)[0]
        second = random_robots.nearby(rng, robot, first, 0.5, 1.0)
        value = space.motion_clearance(first, second)
        assert (value > 0) == space.is_motion_valid(first, second), k
        if value > 0:
            proved += 1
            samples = twin.interpolate(robot, first, second, np.linspace(0, 1, 30))
            truth = twin.obstacle_gaps(world, robot, samples).min()
            assert 0.99 * truth - 0.02 <= value <= truth + 1e-12, (k, value, truth)
            kept = random_robots.cspace(world, robot, value * (1 - 1e-9))
            assert kept.is_motion_valid(first, second), k
    assert proved > 4
