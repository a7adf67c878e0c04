"""Minkowski sum and difference: axioms, known cases, agreement of the parametrisations."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.minkowski import (
    difference_contains,
    minkowski_difference_boundary,
    minkowski_difference_boundary_by_offset,
    minkowski_sum_boundary,
    minkowski_sum_boundary_by_offset,
    offset_normals,
)

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])


def random_rotation(rng, dimension):
    orthogonal, _ = np.linalg.qr(rng.standard_normal((dimension, dimension)))
    orthogonal[:, 0] *= np.linalg.det(orthogonal)
    return orthogonal


def random_ellipsoid(rng, dimension, low=0.1, high=3.0):
    axes = np.exp(rng.uniform(math.log(low), math.log(high), dimension))
    centre = rng.uniform(-5.0, 5.0, dimension)
    return Ellipsoid.from_semi_axes(axes, centre, random_rotation(rng, dimension))


def ball(radius, dimension, centre=None):
    return Ellipsoid.from_semi_axes([radius] * dimension, centre)


def dense_excess(arena, part, points):
    """The largest u.x + h_part(u) - h_arena(u) over many u: the slow definition."""
    directions = unit_directions(arena.dimension, 4000)
    slack = part.support(directions) - arena.support(directions)
    return np.max(points @ directions.T + slack, axis=1)


@given(seeds, dimensions)
def test_sum_is_symmetric_and_adds_support_functions(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    directions = unit_directions(dimension, 50)
    points = minkowski_sum_boundary(first, second, directions)
    np.testing.assert_array_equal(points, minkowski_sum_boundary(second, first, directions))
    total = first.support(directions) + second.support(directions)
    np.testing.assert_allclose(np.sum(points * directions, axis=1), total, atol=1e-12)
    assert np.all(points @ directions.T <= total + 1e-12)


@given(seeds, dimensions)
def test_sum_is_equivariant_under_rigid_motion(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    turn, shift = random_rotation(rng, dimension), rng.standard_normal(dimension)
    directions = unit_directions(dimension, 20)
    moved = minkowski_sum_boundary(
        first.transform(turn, shift),
        second.transform(turn, np.zeros(dimension)),
        directions @ turn.T,
    )
    expected = minkowski_sum_boundary(first, second, directions) @ turn.T + shift
    np.testing.assert_allclose(moved, expected, atol=1e-12)


@given(seeds, dimensions)
def test_both_parametrisations_of_the_sum_agree_to_rounding(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    parameters = unit_directions(dimension, 40)
    by_offset = minkowski_sum_boundary_by_offset(first, second, parameters)
    normals = offset_normals(first, second, parameters)
    by_normal = minkowski_sum_boundary(first, second, normals)
    np.testing.assert_allclose(by_offset, by_normal, atol=1e-12)


@given(seeds, dimensions)
def test_both_parametrisations_of_the_difference_agree_to_rounding(seed, dimension):
    rng = np.random.default_rng(seed)
    arena = random_ellipsoid(rng, dimension, 4.0, 9.0)
    part = random_ellipsoid(rng, dimension, 0.1, 0.3)  # small enough for no swallow-tail
    parameters = unit_directions(dimension, 40)
    by_offset = minkowski_difference_boundary_by_offset(arena, part, parameters)
    normals = offset_normals(arena, part, parameters)
    by_normal = minkowski_difference_boundary(arena, part, normals)
    assert len(by_offset) == len(by_normal) == 40
    np.testing.assert_allclose(by_offset, by_normal, atol=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_balls_add_and_subtract_radii(dimension):
    first = ball(3.0, dimension, np.arange(1.0, dimension + 1.0))
    second = ball(1.0, dimension, np.full(dimension, 0.5))
    for sign, construct in (
        (1.0, minkowski_sum_boundary),
        (1.0, minkowski_sum_boundary_by_offset),
        (-1.0, minkowski_difference_boundary),
        (-1.0, minkowski_difference_boundary_by_offset),
    ):
        points = construct(first, second, 60)
        assert points.shape == (60, dimension)
        radii = np.linalg.norm(points - first.centre - sign * second.centre, axis=1)
        np.testing.assert_allclose(radii, 3.0 + sign, atol=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
def test_similar_ellipsoids_give_ellipsoids(dimension):
    rng = np.random.default_rng(5)
    body = random_ellipsoid(rng, dimension)
    half = Ellipsoid(body.centre, body.rotation, 0.5 * body.semi_axes)
    directions = unit_directions(dimension, 30)
    offsets = body.support_points(directions) - body.centre
    total = minkowski_sum_boundary(body, half, directions)
    np.testing.assert_allclose(total - 2.0 * body.centre, 1.5 * offsets, atol=1e-13)
    rest = minkowski_difference_boundary(body, half, directions)
    np.testing.assert_allclose(rest, 0.5 * offsets, atol=1e-13)


@settings(deadline=None, max_examples=30)
@given(seeds, dimensions)
def test_difference_keeps_true_points_and_drops_swallow_tails(seed, dimension):
    rng = np.random.default_rng(seed)
    arena = random_ellipsoid(rng, dimension, 1.0, 6.0)
    part = random_ellipsoid(rng, dimension, 0.05, 0.9)
    directions = unit_directions(dimension, 300)
    candidates = arena.support_points(directions) - part.support_points(directions)
    kept = difference_contains(arena, part, candidates)
    excess = dense_excess(arena, part, candidates)
    assert np.all(excess[kept] <= 1e-10)
    # A dropped point sticks out; the dense search may only see a little less of it.
    assert np.all(excess[~kept] >= -1e-2 * np.max(arena.semi_axes))
    points = minkowski_difference_boundary(arena, part, directions)
    np.testing.assert_array_equal(points, candidates[kept])
    # Boundary points, so that a hair farther out along the normal is outside.
    outside = points + 1e-6 * directions[kept]
    assert not np.any(difference_contains(arena, part, outside))


def test_a_swallow_tail_exists_and_is_dropped():
    arena = Ellipsoid.from_semi_axes([4.0, 1.0])
    part = ball(0.9, 2)
    points = minkowski_difference_boundary(arena, part, 400)
    assert 0 < len(points) < 400
    # The lens ends in a corner on the long axis: radius^2 = b^2 + x^2 b^2/(b^2 - a^2) there.
    corner = math.sqrt((1.0 - 0.9**2) * (4.0**2 - 1.0))
    assert np.max(np.abs(points[:, 0])) < corner
    assert bool(difference_contains(arena, part, [[corner * (1 - 1e-9), 0.0]])[0])
    assert not bool(difference_contains(arena, part, [[corner * (1 + 1e-9), 0.0]])[0])
    offsets = minkowski_difference_boundary_by_offset(arena, part, 400)
    assert np.all(dense_excess(arena, part, offsets) < 1e-9)


def test_needle_sum_is_exact_across_the_needle():
    needle = Ellipsoid.from_semi_axes([1.0, 1e-6, 1e-6])
    points = minkowski_sum_boundary(needle, needle, [[0.0, 1.0, 0.0]])
    np.testing.assert_allclose(points, [[0.0, 2e-6, 0.0]], rtol=1e-14, atol=1e-30)


@pytest.mark.parametrize(
    "construct", [minkowski_difference_boundary, minkowski_difference_boundary_by_offset]
)
def test_an_empty_difference_says_where_and_by_how_much(construct):
    arena = Ellipsoid.from_semi_axes([5.0, 2.0], name="ring")
    part = Ellipsoid.from_semi_axes([1.0, 2.5], name="face")
    with pytest.raises(GeometryError) as caught:
        construct(arena, part)
    message = str(caught.value)
    for piece in ("ring", "face", "1.0]", "2.5 exceeds the arena's 2 by 0.5"):
        assert piece in message


def test_mixed_dimensions_are_refused():
    with pytest.raises(GeometryError, match="one dimension"):
        minkowski_sum_boundary(ball(1.0, 2), ball(1.0, 3))
