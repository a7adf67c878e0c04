"""The oracles against each other: a test is worth what its judge is worth."""

from __future__ import annotations

import numpy as np
import pytest

from tests import exact, oracles, random_scenes
from tests.oracles import Body

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


@DIMENSIONS
def test_distance_oracles_agree(dimension: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(12):
        gap = 10 ** rng.uniform(-3, 1)
        first, second = random_scenes.touching_pair(rng, dimension, gap)
        lower, upper = oracles.distance_bounds(first, second)
        assert lower == pytest.approx(gap, rel=1e-11)
        assert lower * (1 - 1e-14) <= upper <= lower * (1 + 1e-11)
        assert oracles.signed_gap_by_search(first, second) == pytest.approx(gap, rel=1e-9)
        assert oracles.distance_by_points(first, second) == pytest.approx(gap, rel=1e-6)


@DIMENSIONS
@pytest.mark.parametrize("gap", [1e-3, 1e-9, 1e-13, -1e-13, -1e-9, -1e-3])
def test_contact_oracles_agree(dimension: int, gap: float) -> None:
    rng = np.random.default_rng(2)
    for _ in range(25):
        first, second = random_scenes.touching_pair(rng, dimension, gap)
        proved = exact.separation(first, second)
        assert (proved > 0) == (gap > 0)
        assert float(proved) <= max(gap, 0) + 1e-14
        value, _ = oracles.combination(first, second)
        assert (value > 1) == (gap > 0)
        c, a1, a2 = second.centre - first.centre, first.matrix, second.matrix
        signed, u = oracles.signed_gaps(c[None], a1[None], a2[None])
        assert signed[0] == pytest.approx(gap, abs=2e-15 + 1e-9 * abs(gap))
        assert np.linalg.norm(u) == pytest.approx(1)


@pytest.mark.parametrize("ratio", [1e3, 1e6])
@pytest.mark.parametrize("gap", [1e-6, 1e-9, 1e-12, -1e-12, -1e-9, -1e-6])
def test_exact_decisions_of_crossing_needles(ratio: float, gap: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(5):
        first, second = random_scenes.crossing_needles(rng, ratio, gap)
        proved = exact.separation(first, second)
        assert (proved > 0) == (gap > 0)
        assert float(proved) <= max(gap, 0) * (1 + 1e-6) + 1e-15


@DIMENSIONS
def test_containment_oracles_agree(dimension: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(10):
        arena = Body(rng.normal(size=dimension), random_scenes.matrix(rng, dimension))
        part = random_scenes.matrix(rng, dimension, size=10 ** rng.uniform(-2, 0))
        part_body = Body(arena.centre + 0.5 * rng.normal(size=dimension), part)
        value = oracles.containment_value(arena, part_body)
        assert value == pytest.approx(oracles.containment_by_search(arena, part_body), rel=1e-10)
        assert exact.is_contained(arena, part_body) == (value <= 1)
        assert (oracles.arena_clearance(arena, part_body) >= 0) == (value <= 1)


@DIMENSIONS
@pytest.mark.parametrize("excess", [-1e-3, -1e-12, 1e-12, 1e-3])
def test_containment_by_a_hair(dimension: int, excess: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(10):
        arena = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension))
        part = Body(rng.normal(size=dimension), random_scenes.matrix(rng, dimension, size=0.7))
        scale = (1 + excess) / np.sqrt(oracles.containment_value(arena, part))
        scaled = Body(part.centre * scale, part.matrix * scale)
        assert exact.is_contained(arena, scaled) == (excess < 0)


@pytest.mark.parametrize("excess", [-1e-9, 1e-9])
def test_containment_in_the_hard_case(excess: float) -> None:
    arena = Body(np.zeros(3), np.diag([2.0, 2.0, 2.0]))
    part = Body(np.array([0.0, 0.3, 0.1]), np.diag([1.5, 0.5, 0.25]))
    root = np.sqrt(oracles.containment_value(arena, part))
    assert root == pytest.approx(np.sqrt(oracles.containment_by_search(arena, part)), rel=1e-10)
    scale = (1 + excess) / root
    scaled = Body(part.centre * scale, part.matrix * scale)
    assert exact.is_contained(arena, scaled) == (excess < 0)


def test_containment_of_concentric_bodies() -> None:
    arena = Body(np.zeros(3), np.diag([3.0, 2.0, 1.0]))
    assert exact.is_contained(arena, Body(np.zeros(3), np.diag([2.9, 1.9, 0.9])))
    assert not exact.is_contained(arena, Body(np.zeros(3), np.diag([1.0, 1.0, 1.1])))
    assert oracles.containment_value(arena, Body(np.zeros(3), np.diag([1.5, 1, 0.25]))) == 0.25


def test_arena_clearance_of_a_sphere_in_a_sphere() -> None:
    arena = Body(np.zeros(3), 5 * np.eye(3))
    part = Body(np.array([1.0, 2.0, 2.0]), 0.5 * np.eye(3))
    assert oracles.arena_clearance(arena, part) == pytest.approx(1.5, rel=1e-9)


@DIMENSIONS
def test_chord_oracles_hit_constructed_ends(dimension: int) -> None:
    rng = np.random.default_rng(6)
    for _ in range(8):
        obstacle = Body(rng.normal(size=dimension), random_scenes.matrix(rng, dimension))
        part = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, size=0.3))
        first, second = (
            obstacle.centre
            + random_scenes.touching_offset(
                obstacle.matrix, part.matrix, random_scenes.unit_vector(rng, dimension), 0.0
            )
            for _ in range(2)
        )
        ends = oracles.sum_chord(obstacle, part, first, second - first)
        assert ends == pytest.approx((0, 1), abs=1e-10)
        inside = oracles.difference_chord(obstacle, part, obstacle.centre, second - first)
        assert inside is not None
        for t in inside:
            moved = Body(obstacle.centre + t * (second - first), part.matrix)
            assert oracles.containment_by_search(obstacle, moved) == pytest.approx(1, rel=1e-8)


def test_fcl_twin_sees_plain_contacts() -> None:
    ball = Body(np.zeros(3), np.eye(3))
    flat = Body(np.zeros(2), np.eye(2))
    assert oracles.fcl_collides(ball, Body(np.array([1.9, 0, 0]), np.eye(3)))
    assert not oracles.fcl_collides(ball, Body(np.array([2.1, 0, 0]), np.eye(3)))
    assert oracles.fcl_collides(flat, Body(np.array([1.9, 0]), np.eye(2)))
    assert not oracles.fcl_collides(flat, Body(np.array([2.1, 0]), np.eye(2)))
