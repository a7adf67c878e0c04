"""Chords: slightly outer for sums, slightly inner for differences, and tight."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ellipsoid_planning.geometry import dual
from tests import exact, oracles, random_scenes
from tests.oracles import Body

EXAMPLES = settings(max_examples=100, deadline=None, derandomize=True)
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
SEEDS = st.integers(0, 2**32 - 1)

Chord = tuple[float, float] | None


def sum_chord(obstacle: Body, part: Body, origin: np.ndarray, direction: np.ndarray) -> Chord:
    """The package's chord; every end that comes back is proved to be outside or touching."""
    bodies = random_scenes.ellipsoid_of(obstacle), random_scenes.ellipsoid_of(part)
    found = dual.sum_chord(*bodies, origin, direction)
    if found is None:
        return None
    stored = [oracles.body_of(body) for body in bodies]
    for t in found:
        offset = exact.on_line(origin, direction, t, stored[0].centre)
        assert exact.is_separated(stored[0], stored[1], offset), t
    return float(found[0]), float(found[1])


def difference_chord(arena: Body, part: Body, origin: np.ndarray, direction: np.ndarray) -> Chord:
    """The package's chord; every end that comes back is proved to be inside."""
    bodies = random_scenes.ellipsoid_of(arena), random_scenes.ellipsoid_of(part)
    found = dual.difference_chord(*bodies, origin, direction)
    if found is None:
        return None
    stored = [oracles.body_of(body) for body in bodies]
    for t in found:
        offset = exact.on_line(origin, direction, t, stored[0].centre)
        assert exact.is_contained(stored[0], stored[1], offset), t
    assert found[0] <= found[1]
    return float(found[0]), float(found[1])


def sum_points(
    rng: np.random.Generator, obstacle: Body, part: Body, count: int
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Boundary points of the C-obstacle with their outward normals."""
    normals = [random_scenes.unit_vector(rng, len(obstacle.centre)) for _ in range(count)]
    points = [
        obstacle.centre + random_scenes.touching_offset(obstacle.matrix, part.matrix, u, 0.0)
        for u in normals
    ]
    return points, normals


def mild_pair(rng: np.random.Generator, dimension: int) -> tuple[Body, Body]:
    """An obstacle anywhere and a part whose own centre must not matter."""
    obstacle = Body(rng.normal(size=dimension), random_scenes.matrix(rng, dimension))
    part = random_scenes.matrix(rng, dimension, size=10 ** rng.uniform(-2, 1))
    return obstacle, Body(np.zeros(dimension), part)


@DIMENSIONS
def test_sum_chord_between_two_known_ends(dimension: int) -> None:
    rng = np.random.default_rng(1)
    for k in range(60):
        obstacle, part = mild_pair(rng, dimension)
        (start, end), (normal, _) = sum_points(rng, obstacle, part, 2)
        found = sum_chord(obstacle, part, start, end - start)
        assert found is not None, k
        steepness = abs(normal @ (end - start)) / np.linalg.norm(end - start)
        if steepness > 0.05:
            assert found == pytest.approx((0, 1), abs=1e-9), k


@DIMENSIONS
def test_sum_chord_equals_the_oracle(dimension: int) -> None:
    rng = np.random.default_rng(2)
    hits = 0
    for k in range(60):
        obstacle, part = mild_pair(rng, dimension)
        origin = obstacle.centre + 2 * rng.normal(size=dimension)
        direction = rng.normal(size=dimension) * 10 ** rng.uniform(-2, 2)
        truth = oracles.sum_chord(obstacle, part, origin, direction)
        found = sum_chord(obstacle, part, origin, direction)
        if truth is None:
            assert found is None or found[1] - found[0] < 1e-3 / np.linalg.norm(direction), k
            continue
        hits += 1
        assert found is not None, k
        length = truth[1] - truth[0]
        assert found == pytest.approx(truth, abs=1e-9 * max(length, *map(abs, truth))), k
        assert found[0] <= truth[0] + 1e-12 * length and found[1] >= truth[1] - 1e-12 * length
    assert hits > 20


@DIMENSIONS
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, -1e-12, -1e-9, -1e-6, -1e-3])
def test_tangent_lines(dimension: int, gap: float) -> None:
    rng = np.random.default_rng(3)
    for k in range(40):
        obstacle, part = mild_pair(rng, dimension)
        scale = np.linalg.norm(part.matrix, 2) + 1
        (point,), (u,) = sum_points(rng, obstacle, part, 1)
        across = random_scenes.unit_vector(rng, dimension)
        across -= (across @ u) * u
        across /= np.linalg.norm(across)
        origin = point + gap * scale * u - rng.uniform(-3, 3) * across
        found = sum_chord(obstacle, part, origin, across)
        assert (found is None) == (gap > 0), k
        if found is not None:
            middle = float((point - origin) @ across)
            assert found[0] <= middle <= found[1], k


@EXAMPLES
@given(SEEDS, st.sampled_from([2, 3]), st.floats(0, 6))
def test_sum_chord_of_extreme_shapes_is_outer(seed: int, dimension: int, exponent: float) -> None:
    rng = np.random.default_rng(seed)
    kinds = rng.choice(random_scenes.KINDS, size=2)
    obstacle, part = random_scenes.touching_pair(
        rng, dimension, 0.0, (kinds[0], kinds[1]), 10**exponent
    )
    part = Body(np.zeros(dimension), part.matrix)
    (start, end), _ = sum_points(rng, obstacle, part, 2)
    found = sum_chord(obstacle, part, start, end - start)
    assert found is not None
    for t in (0.01, 0.5, 0.99):
        offset = exact.on_line(start, end - start, t, obstacle.centre)
        if not exact.is_separated(obstacle, part, offset):
            assert found[0] <= t <= found[1]


@DIMENSIONS
def test_needle_chords_are_tight(dimension: int) -> None:
    rng = np.random.default_rng(4)
    for ratio in (1e3, 1e6):
        for k in range(20):
            a1 = random_scenes.matrix(rng, dimension, "needle", ratio)
            a2 = random_scenes.matrix(rng, dimension, "needle", ratio)
            obstacle, part = Body(np.zeros(dimension), a1), Body(np.zeros(dimension), a2)
            direction = random_scenes.unit_vector(rng, dimension)
            found = sum_chord(obstacle, part, np.zeros(dimension), direction)
            assert found is not None
            for t in found:  # pulled in by 1e-9 of the length, the end must be in collision
                offset = exact.on_line(
                    np.zeros(dimension), direction, t * (1 - 1e-9), obstacle.centre
                )
                shorter = exact.on_line(
                    np.zeros(dimension), direction, t - np.sign(t) * 1e-9, obstacle.centre
                )
                assert not (
                    exact.is_separated(obstacle, part, offset)
                    and exact.is_separated(obstacle, part, shorter)
                ), (ratio, k, t)


@DIMENSIONS
def test_lines_far_away_and_long(dimension: int) -> None:
    rng = np.random.default_rng(5)
    for k in range(40):
        obstacle, part = mild_pair(rng, dimension)
        (start, end), (normal, _) = sum_points(rng, obstacle, part, 2)
        direction = (end - start) / np.linalg.norm(end - start)
        if abs(normal @ direction) < 0.1:
            continue
        origin = start - 1e3 * direction
        found = sum_chord(obstacle, part, origin, direction)
        assert found is not None
        assert found[0] == pytest.approx(1e3, abs=1e-9), k
        assert found[1] == pytest.approx(1e3 + np.linalg.norm(end - start), abs=1e-9), k


@DIMENSIONS
def test_difference_chord_equals_the_oracle(dimension: int) -> None:
    rng = np.random.default_rng(6)
    hits = 0
    for k in range(60):
        arena = Body(rng.normal(size=dimension), random_scenes.matrix(rng, dimension, size=3))
        size = 10 ** rng.uniform(-1.5, 0.3)
        part = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, size=size))
        origin = arena.centre + arena.matrix @ random_scenes.unit_vector(rng, dimension) * 0.7
        direction = rng.normal(size=dimension) * 10 ** rng.uniform(-1, 1)
        truth = oracles.difference_chord(arena, part, origin, direction)
        found = difference_chord(arena, part, origin, direction)
        if truth is None:
            assert found is None, k
            continue
        length = truth[1] - truth[0]
        if length * np.linalg.norm(direction) < 0.05:
            continue
        hits += 1
        assert found == pytest.approx(truth, abs=1e-9 * max(length, *map(abs, truth))), k
    assert hits > 15


@DIMENSIONS
def test_difference_chord_may_not_run_past_a_known_end(dimension: int) -> None:
    """Lines from a position known to be inside through one where the part touches the arena."""
    rng = np.random.default_rng(7)
    for k in range(40):
        arena = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, ratio=3, size=2))
        part = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, size=0.2))
        direction = random_scenes.unit_vector(rng, dimension)
        found = difference_chord(arena, part, np.zeros(dimension), direction)
        assert found is not None and found[0] < 0 < found[1], k
        assert found[0] == pytest.approx(-found[1], rel=1e-9)
        for t in found:
            beyond = exact.on_line(np.zeros(dimension), direction, t * (1 + 2e-9), arena.centre)
            assert not exact.is_contained(arena, part, beyond), k


@EXAMPLES
@given(SEEDS, st.sampled_from([2, 3]), st.floats(0, 5))
def test_difference_chord_of_extreme_shapes_is_inner(
    seed: int, dimension: int, exponent: float
) -> None:
    rng = np.random.default_rng(seed)
    kinds = rng.choice(random_scenes.KINDS, size=2)
    arena = Body(
        rng.normal(size=dimension), random_scenes.matrix(rng, dimension, kinds[0], 10**exponent)
    )
    size = 10 ** rng.uniform(-6, 0)
    part = Body(
        np.zeros(dimension), random_scenes.matrix(rng, dimension, kinds[1], 10**exponent, size)
    )
    direction = random_scenes.unit_vector(rng, dimension)
    found = difference_chord(arena, part, arena.centre, direction)
    extent = oracles.containment_value(arena, Body(arena.centre, part.matrix))
    if extent > 1 + 1e-9:
        assert found is None
    elif extent < 1 - 1e-3:
        assert found is not None


@DIMENSIONS
@pytest.mark.parametrize("room", [1e-3, 1e-6, -1e-12, -1e-6])
def test_arena_hardly_larger_than_the_part(dimension: int, room: float) -> None:
    rng = np.random.default_rng(8)
    for k in range(30):
        a = random_scenes.matrix(rng, dimension)
        arena, part = Body(rng.normal(size=dimension), a), Body(np.zeros(dimension), a * (1 - room))
        direction = random_scenes.unit_vector(rng, dimension)
        found = difference_chord(arena, part, arena.centre, direction)
        assert (found is not None) == (room > 0), k
        if found is not None:
            longest = room / np.linalg.norm(np.linalg.solve(a, direction))
            assert found == pytest.approx((-longest, longest), abs=1e-9), k


@DIMENSIONS
def test_difference_chord_that_misses(dimension: int) -> None:
    arena, part = (
        Body(np.zeros(dimension), 2 * np.eye(dimension)),
        Body(np.zeros(dimension), np.eye(dimension)),
    )
    along, across = np.eye(dimension)[0], np.eye(dimension)[1]
    assert difference_chord(arena, part, 1.001 * across, along) is None
    assert difference_chord(arena, part, 5.0 * across, along) is None
    found = difference_chord(arena, part, 0.6 * across, along)
    assert found == pytest.approx((-0.8, 0.8), abs=1e-9)


@DIMENSIONS
@pytest.mark.parametrize("turned", [False, True])
def test_difference_chord_past_the_hard_case(dimension: int, turned: bool) -> None:
    """Lines that just miss the free region of a part aligned with its arena.

    Where the part is centred on the arena's long axis the best multiplier sits in the limit, and
    a sum of large terms of either sign must not be taken for a small one.
    """
    rng = np.random.default_rng(10)
    inside = 0
    for k in range(250):
        frame = random_scenes.rotation(rng, dimension) if turned else np.eye(dimension)
        arena = Body(np.zeros(dimension), frame * np.array([2.5, 2.1, 2.3])[:dimension])
        part = Body(np.zeros(dimension), frame * np.array([0.9, 0.15, 0.25])[:dimension])
        origin = frame @ np.array([rng.uniform(-1, 1), rng.uniform(1.85, 2.1), 0.0])[:dimension]
        # difference_chord proves the ends that come back
        found = difference_chord(arena, part, origin, frame[:, 0])
        truth = oracles.difference_chord(arena, part, origin, frame[:, 0])
        assert truth is not None or found is None, k
        if truth is not None and truth[1] - truth[0] > 1e-3:
            inside += 1
            assert found == pytest.approx(truth, abs=1e-8), k
    assert inside > 20


def test_planar_equals_embedded() -> None:
    rng = np.random.default_rng(9)
    for k in range(30):
        obstacle, part = mild_pair(rng, 2)
        origin, direction = obstacle.centre + rng.normal(size=2), rng.normal(size=2)
        planar = sum_chord(obstacle, part, origin, direction)
        deep = sum_chord(
            random_scenes.embedded(obstacle),
            random_scenes.embedded(part, 0.5),
            np.append(origin, 0.0),
            np.append(direction, 0.0),
        )
        assert (planar is None) == (deep is None), k
        if planar is not None:
            assert planar == pytest.approx(deep, abs=1e-8), k
