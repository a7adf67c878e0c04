"""Separation and gap: never a false separation, never more than the distance, and tight."""

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
SEEDS = st.integers(0, 2**32 - 1)


def package_gap(first: Body, second: Body) -> tuple[float, np.ndarray]:
    """Value and direction from the package."""
    found = dual.gap(random_scenes.ellipsoid_of(first), random_scenes.ellipsoid_of(second))
    return float(found.value), np.asarray(found.direction)


def proof(first: Body, second: Body, direction: np.ndarray) -> float:
    """What a direction proves, in long double, whichever of the two it points at."""
    u = direction.astype(np.longdouble)
    u = u / np.sqrt((u * u).sum())
    return float(max(oracles.support_gap(first, second, u), oracles.support_gap(first, second, -u)))


def same(body: Body) -> Body:
    """The body as the package stores it, so that both sides speak of the same float64s."""
    return oracles.body_of(random_scenes.ellipsoid_of(body))


def size(*bodies: Body) -> float:
    """The longest semi-axis."""
    return max(float(np.linalg.norm(body.matrix, 2)) for body in bodies)


@EXAMPLES
@given(random_scenes.shapes(1e6))
def test_value_is_a_proved_lower_bound(shape: random_scenes.Shape) -> None:
    first, second = map(same, random_scenes.pair_of(shape))
    value, direction = package_gap(first, second)
    assert abs(np.linalg.norm(direction) - 1) < 1e-12
    assert value <= proof(first, second, direction) + 1e-15 * size(first, second)
    if value > 0:
        assert exact.is_separated(first, second)
        assert value <= oracles.distance_bounds(first, second)[1]


@EXAMPLES
@given(random_scenes.shapes(1e6), st.floats(-15, -3))
def test_no_false_separation_by_a_hair(shape: random_scenes.Shape, exponent: float) -> None:
    first, second = random_scenes.pair_of(shape)
    depth = 10**exponent * size(first, second)
    first, second = map(same, random_scenes.pair_of(shape, -depth))
    value, _ = package_gap(first, second)
    assert value <= 0 or exact.is_separated(first, second)


@EXAMPLES
@given(random_scenes.shapes(1e6), st.floats(-9, 0))
def test_every_separation_is_found(shape: random_scenes.Shape, exponent: float) -> None:
    first, second = random_scenes.pair_of(shape)
    distance = 10**exponent * size(first, second)
    first, second = random_scenes.pair_of(shape, distance)
    value, _ = package_gap(first, second)
    assert 0 < value <= distance * (1 + 1e-9)


@EXAMPLES
@given(random_scenes.shapes(10), st.floats(-6, 2))
def test_mild_shapes_give_the_distance_itself(shape: random_scenes.Shape, exponent: float) -> None:
    distance = 10**exponent
    first, second = random_scenes.pair_of(shape, distance)
    value, _ = package_gap(first, second)
    slack = 1e-13 * (size(first, second) + distance)
    assert distance * (1 - 1e-9) - slack <= value <= distance + 1e-15 * size(first, second) + slack


@pytest.mark.parametrize("relative", [1e-6, 1e-9])
@pytest.mark.parametrize("exponent", [3.0, 4.0, 5.0, 6.0])
def test_crossing_needles(relative: float, exponent: float) -> None:
    rng = np.random.default_rng(int(exponent))
    for k in range(250):
        gap = relative if k % 2 else -relative
        first, second = random_scenes.crossing_needles(rng, 10**exponent, gap)
        value, direction = package_gap(first, second)
        assert (value > 0) == (gap > 0), (k, value)
        assert value <= gap * (1 + 1e-5) or gap < 0
        assert proof(first, second, direction) == pytest.approx(value, abs=2e-14)


@pytest.mark.parametrize("exponent", [3.0, 6.0])
def test_crossing_needles_overlapping_by_rounding(exponent: float) -> None:
    rng = np.random.default_rng(17)
    for k in range(150):
        depth = 10 ** rng.uniform(-17, -12)
        pair = random_scenes.crossing_needles(rng, 10**exponent, -depth)
        first, second = map(same, pair)
        value, _ = package_gap(first, second)
        assert value <= 0 or exact.is_separated(first, second), (k, value)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("ratio", [1e3, 1e6])
def test_nearly_parallel_needles(angle: float, ratio: float) -> None:
    rng = np.random.default_rng(23)
    for k in range(40):
        a1 = random_scenes.matrix(rng, 3, "needle", ratio)
        turn = random_scenes.rotation_of(
            np.append(np.sin(angle / 2) * random_scenes.unit_vector(rng, 3), np.cos(angle / 2))
        )
        u = random_scenes.normal_at(a1, random_scenes.unit_vector(rng, 3))
        for gap in (1e-9, -1e-9, -1e-12):
            offset = random_scenes.touching_offset(a1, turn @ a1, u, gap)
            first, second = map(same, (Body(np.zeros(3), a1), Body(offset, turn @ a1)))
            value, _ = package_gap(first, second)
            if gap > 0:
                assert value > 0, (k, gap)
            else:
                assert value <= 0 or exact.is_separated(first, second), (k, gap, value)


@DIMENSIONS
@pytest.mark.parametrize("kind", random_scenes.KINDS)
def test_concentric_bodies_are_never_separated(dimension: int, kind: str) -> None:
    rng = np.random.default_rng(5)
    for ratio in (1.0, 10.0, 1e6):
        centre = rng.normal(size=dimension)
        first = Body(centre, random_scenes.matrix(rng, dimension, kind, ratio))
        second = Body(centre, random_scenes.matrix(rng, dimension, "mild", 4, 1e-3))
        value, direction = package_gap(first, second)
        assert value < 0
        assert abs(np.linalg.norm(direction) - 1) < 1e-12


@DIMENSIONS
def test_spheres(dimension: int) -> None:
    one, centre = np.eye(dimension), np.zeros(dimension)
    offset = np.eye(dimension)[0]
    for distance in (2.5, 3.0, 1000.0):
        value, direction = package_gap(Body(centre, one), Body(distance * offset, one))
        assert value == pytest.approx(distance - 2, rel=1e-12)
        assert abs(direction @ offset) == pytest.approx(1, abs=1e-12)
    assert package_gap(Body(centre, one), Body(2 * offset, one))[0] <= 0
    assert package_gap(Body(centre, one), Body(1.5 * offset, one))[0] == pytest.approx(-0.5)


@EXAMPLES
@given(random_scenes.shapes(10), st.floats(-3, 1))
def test_symmetric_and_equivariant(shape: random_scenes.Shape, exponent: float) -> None:
    distance = 10**exponent
    first, second = random_scenes.pair_of(shape, distance)
    rng = np.random.default_rng(shape.seed)
    turn, shift = random_scenes.rotation(rng, shape.dimension), rng.normal(size=shape.dimension)
    moved = [Body(turn @ body.centre + shift, turn @ body.matrix) for body in (first, second)]
    value = package_gap(first, second)[0]
    assert package_gap(second, first)[0] == pytest.approx(value, rel=1e-9)
    assert package_gap(*moved)[0] == pytest.approx(value, rel=1e-9)


@EXAMPLES
@given(SEEDS, st.floats(-9, 1), st.sampled_from([1e-6, 1e-2, 1.0, 1e3]))
def test_planar_equals_embedded(seed: int, exponent: float, thickness: float) -> None:
    rng = np.random.default_rng(seed)
    pair = random_scenes.touching_pair(rng, 2, 10**exponent)
    deep = [random_scenes.embedded(body, thickness) for body in pair]
    value = package_gap(*deep)[0]
    assert package_gap(*pair)[0] == pytest.approx(value, rel=1e-9, abs=1e-14 * (10 + thickness))


@DIMENSIONS
@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_scales(dimension: int, scale: float) -> None:
    rng = np.random.default_rng(11)
    for gap in (1e-9, 1e-3, 1.0, -1e-9, -1e-12):
        first, second = random_scenes.touching_pair(rng, dimension, gap)
        scaled = [Body(body.centre * scale, body.matrix * scale) for body in (first, second)]
        value = package_gap(*scaled)[0] / scale
        assert (value > 0) == (gap > 0)
        assert value <= max(gap, 0) + 1e-14


@DIMENSIONS
@pytest.mark.parametrize("sizes", [(1.0, 1e-6), (1e-6, 1.0), (1.0, 1e-3)])
def test_very_different_sizes(dimension: int, sizes: tuple[float, float]) -> None:
    rng = np.random.default_rng(13)
    for gap in (1e-9, 1e-3, 1.0, -1e-9, -1e-12):
        pair = random_scenes.touching_pair(rng, dimension, gap, sizes=sizes)
        value = package_gap(*pair)[0]
        assert (value > 0) == (gap > 0)
        assert value <= max(gap, 0) + 1e-14


@DIMENSIONS
def test_fcl_agrees_on_thousands_of_pairs(dimension: int) -> None:
    pytest.importorskip("fcl")
    rng = np.random.default_rng(29)
    disagreements = 0
    for k in range(2500):
        gap = rng.choice([-1, 1]) * 10 ** rng.uniform(-5, 0)
        first, second = random_scenes.touching_pair(
            rng, dimension, gap if gap > 0 or k % 2 else 0.1 * gap, ratio=rng.choice([1, 4, 20])
        )
        value, _ = package_gap(first, second)
        if oracles.fcl_collides(first, second) != (value <= 0):
            disagreements += 1
            assert abs(value) < 1e-5, (k, gap, value)
    assert disagreements < 125
