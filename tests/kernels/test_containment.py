"""Containment: never a false "inside", and the extent g itself to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ellipsoid_planning.geometry import dual
from tests import exact, oracles, random_scenes
from tests.oracles import Body

EXAMPLES = settings(max_examples=150, deadline=None, derandomize=True)
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def package_value(arena: Body, part: Body) -> float:
    """The package's g, after checking that the margin belongs to it."""
    found = dual.containment_of(
        part=random_scenes.ellipsoid_of(part), arena=random_scenes.ellipsoid_of(arena)
    )
    if np.isfinite(found.extent):
        assert found.margin == pytest.approx(1 - np.sqrt(found.extent), abs=1e-12)
    else:
        assert not found.margin > 0
    return float(found.extent)


def same(body: Body) -> Body:
    """The body as the package stores it."""
    return oracles.body_of(random_scenes.ellipsoid_of(body))


def filled(arena: Body, part: Body, excess: float) -> Body:
    """The part scaled about the arena's centre so that its farthest point is at 1 + excess."""
    relative = Body(part.centre - arena.centre, part.matrix)
    root = np.sqrt(oracles.containment_value(Body(0 * arena.centre, arena.matrix), relative))
    scale = (1 + excess) / root
    return Body(arena.centre + relative.centre * scale, part.matrix * scale)


def random_pair(rng: np.random.Generator, dimension: int, ratio: float) -> tuple[Body, Body]:
    """An arena and a part, both of any kind of shape."""
    kinds = rng.choice(random_scenes.KINDS, size=2)
    arena = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, kinds[0], ratio))
    part = random_scenes.matrix(rng, dimension, kinds[1], ratio, 10 ** rng.uniform(-3, 0))
    offset = arena.matrix @ random_scenes.unit_vector(rng, dimension) * rng.uniform(0, 1)
    return arena, Body(offset, part)


@DIMENSIONS
@pytest.mark.parametrize("ratio", [1.0, 3.0, 30.0])
def test_value_equals_the_maximum(dimension: int, ratio: float) -> None:
    rng = np.random.default_rng(1)
    for k in range(60):
        arena, part = random_pair(rng, dimension, ratio)
        truth = oracles.containment_value(arena, part)
        value = package_value(arena, part)
        assert value >= truth * (1 - 1e-12), k
        if truth <= 1:
            assert value <= truth * (1 + 1e-9) + 1e-12, k
        else:
            assert value > 1, k


@DIMENSIONS
@pytest.mark.parametrize("excess", [1e-3, 1e-6, 1e-9, 1e-12, -1e-9, -1e-6, -1e-3])
@pytest.mark.parametrize("ratio", [1.0, 4.0, 30.0])
def test_by_a_hair(dimension: int, excess: float, ratio: float) -> None:
    rng = np.random.default_rng(2)
    for k in range(40):
        arena, part = random_pair(rng, dimension, ratio)
        part = filled(arena, part, excess)
        assert (package_value(arena, part) <= 1) == (excess < 0), k


@EXAMPLES
@given(st.integers(0, 2**32 - 1), st.sampled_from([2, 3]), st.floats(0, 6), st.floats(-9, -1))
def test_never_inside_when_it_sticks_out(
    seed: int, dimension: int, exponent: float, excess: float
) -> None:
    rng = np.random.default_rng(seed)
    arena, part = random_pair(rng, dimension, 10**exponent)
    part = filled(arena, part, 10**excess)
    arena, part = same(arena), same(part)
    assert package_value(arena, part) > 1 or exact.is_contained(arena, part)


@EXAMPLES
@given(st.integers(0, 2**32 - 1), st.sampled_from([2, 3]), st.floats(0, 6))
def test_extreme_shapes_inside_are_found_inside(seed: int, dimension: int, exponent: float) -> None:
    rng = np.random.default_rng(seed)
    arena, part = random_pair(rng, dimension, 10**exponent)
    part = filled(arena, part, -1e-6)
    assert package_value(arena, part) <= 1


@pytest.mark.parametrize("excess", [-1e-9, 1e-12, 1e-9])
@pytest.mark.parametrize("axes", [(1.5, 0.5, 0.25), (1.5, 1.5, 0.25), (1.0, 1.0, 1.0)])
@pytest.mark.parametrize("centre", [(0, 0.3, 0.1), (0, 0, 0.3), (0, 0, 0), (1e-9, 0.3, 0.1)])
def test_hard_case(
    excess: float, axes: tuple[float, float, float], centre: tuple[float, float, float]
) -> None:
    rng = np.random.default_rng(3)
    ball = Body(np.zeros(3), 2 * np.eye(3))
    part = filled(ball, Body(np.array(centre, dtype=float), np.diag(axes)), excess)
    for turn in (np.eye(3), random_scenes.rotation(rng, 3), random_scenes.rotation(rng, 3, "tiny")):
        turned = Body(turn @ part.centre, turn @ part.matrix)
        assert (package_value(ball, turned) <= 1) == (excess < 0)


@DIMENSIONS
@pytest.mark.parametrize("excess", [-1e-9, 1e-12])
def test_hard_case_in_a_stretched_arena(dimension: int, excess: float) -> None:
    rng = np.random.default_rng(4)
    for k in range(40):
        stretch = random_scenes.matrix(rng, dimension)
        axes = np.sort(rng.uniform(0.05, 0.6, size=dimension))[::-1]
        centre = np.append(0.0, rng.uniform(-0.3, 0.3, size=dimension - 1))
        ball = Body(np.zeros(dimension), np.eye(dimension))
        part = filled(ball, Body(centre, np.diag(axes)), excess)
        body = Body(stretch @ part.centre, stretch @ part.matrix)
        left, lengths, _ = np.linalg.svd(body.matrix)
        turned = Body(body.centre, left * lengths)
        value = package_value(Body(ball.centre, stretch), turned)
        assert (value <= 1) == (excess < 0), k


@DIMENSIONS
def test_part_that_is_nearly_the_arena(dimension: int) -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        a = random_scenes.matrix(rng, dimension)
        arena = Body(rng.normal(size=dimension), a)
        for shrink, inside in ((1 - 1e-9, True), (1 + 1e-12, False), (1 + 1e-9, False)):
            assert (package_value(arena, Body(arena.centre, a * shrink)) <= 1) == inside
        off = Body(arena.centre + 1e-9 * random_scenes.unit_vector(rng, dimension), a)
        assert package_value(arena, off) > 1


@DIMENSIONS
def test_sphere_in_sphere(dimension: int) -> None:
    centre = np.zeros(dimension)
    offset = 2 * np.eye(dimension)[0]
    part = Body(offset, 0.5 * np.eye(dimension))
    assert package_value(Body(centre, 5 * np.eye(dimension)), part) == pytest.approx(0.25)
    assert package_value(Body(centre, 2.4 * np.eye(dimension)), part) > 1


@DIMENSIONS
def test_too_long_a_part_never_fits(dimension: int) -> None:
    arena = Body(np.zeros(dimension), np.diag([2.0, 1.0, 1.0][:dimension]))
    for axes in ([1.0, 1.0, 1.1], [2.1, 0.1, 0.1], [1e-6, 1.0 + 1e-9, 1e-6]):
        part = Body(np.zeros(dimension), np.diag(axes[3 - dimension :]))
        if oracles.containment_value(arena, part) > 1:
            assert package_value(arena, part) > 1


@DIMENSIONS
def test_agrees_with_difference_of_supports(dimension: int) -> None:
    rng = np.random.default_rng(6)
    for k in range(25):
        arena, part = random_pair(rng, dimension, 4)
        room = oracles.arena_clearance(arena, part)
        if abs(room) > 1e-7:
            assert (package_value(arena, part) <= 1) == (room > 0), k


def test_planar_equals_embedded() -> None:
    rng = np.random.default_rng(7)
    for _ in range(60):
        arena, part = random_pair(rng, 2, 4)
        planar = package_value(arena, part)
        deep = package_value(random_scenes.embedded(arena, 1.0), random_scenes.embedded(part, 1e-9))
        if planar <= 1:
            assert deep == pytest.approx(planar, rel=1e-9)


@DIMENSIONS
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scales_and_offsets(dimension: int, scale: float) -> None:
    rng = np.random.default_rng(8)
    for _ in range(20):
        arena, part = random_pair(rng, dimension, 4)
        shift = scale * rng.normal(size=dimension)
        for excess in (-1e-8, 1e-12):
            body = filled(arena, part, excess)
            scaled_arena = Body(arena.centre * scale, arena.matrix * scale)
            scaled = Body(body.centre * scale, body.matrix * scale)
            assert (package_value(scaled_arena, scaled) <= 1) == (excess < 0)
            moved_arena = same(Body(scaled_arena.centre + shift, scaled_arena.matrix))
            moved = same(Body(scaled.centre + shift, scaled.matrix))
            value = package_value(moved_arena, moved)
            assert (value <= 1) == (excess < 0) or exact.is_contained(moved_arena, moved)
