"""Thesis 5.3: ellipsoids in and around sums and differences, and which they are."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize, minimize_scalar
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.approximations import (
    gaussian_difference,
    gaussian_sum,
    kurzhanski_difference,
    kurzhanski_sum,
    offset_difference,
    offset_sum,
)
from ellipsoid_planning.geometry.boundary_mesh import difference_mesh, difference_polygon
from ellipsoid_planning.geometry.directions import unit_directions
from tests.geometry.chapter5 import ball, random_ellipsoid, random_rotation

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])
MEMBERS = ["trace", "volume", "direction"]
TINY = 1e-12


def member_of(name, rng, dimension):
    return rng.normal(size=dimension) if name == "direction" else name


def pair(rng, dimension):
    """An arena and a part that fits, with room for every inner member."""
    arena = random_ellipsoid(rng, dimension, 4.0, 9.0)
    return arena, random_ellipsoid(rng, dimension, 0.1, 1.2)


def boundary_of_difference(arena, part):
    if arena.dimension == 2:
        return difference_polygon(arena, part, 400)
    return difference_mesh(arena, part, 20, 60).vertices


def is_inner_of_sum(approximation, first, second, slack):
    u = unit_directions(first.dimension, 1500)
    exact = first.support(u) + second.support(u)
    return bool(np.all(approximation.ellipsoid.support(u) <= exact + slack))


def is_outer_of_sum(approximation, first, second, slack):
    u = unit_directions(first.dimension, 1500)
    exact = first.support(u) + second.support(u)
    return bool(np.all(approximation.ellipsoid.support(u) >= exact - slack))


def sums(first, second, rng):
    yield offset_sum(first, second)
    yield gaussian_sum(first, second)
    for side in ("inner", "outer"):
        for name in MEMBERS:
            yield kurzhanski_sum(first, second, member_of(name, rng, first.dimension), side)


def differences(arena, part, rng):
    yield offset_difference(arena, part)
    yield gaussian_difference(arena, part)
    for side in ("inner", "outer"):
        for name in MEMBERS:
            member = member_of(name, rng, arena.dimension)
            try:
                yield kurzhanski_difference(arena, part, member, side)
            except GeometryError as error:
                # Inside a thin difference the best member by another measure may be flat.
                if (side, name == "volume") != ("inner", False) or "'volume'" not in str(error):
                    raise


@settings(deadline=None, max_examples=60)
@given(seeds, dimensions, st.sampled_from([1.0, 1e-3, 1e-6]))
def test_approximations_of_sums_are_what_they_say(seed, dimension, thinness):
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    thin = np.ones(dimension)
    thin[rng.integers(dimension)] = thinness  # needles in the plane, discs in space
    first = Ellipsoid(first.centre, first.rotation, first.semi_axes * thin)
    kinds = []
    for approximation in sums(first, second, rng):
        check = is_inner_of_sum if approximation.kind == "inner" else is_outer_of_sum
        assert check(approximation, first, second, TINY), approximation.name
        kinds.append(approximation.kind)
    assert kinds == ["inner", "outer"] + ["inner"] * 3 + ["outer"] * 3


@settings(deadline=None, max_examples=60)
@given(seeds, dimensions)
def test_approximations_of_differences_are_what_they_say(seed, dimension):
    rng = np.random.default_rng(seed)
    arena, part = pair(rng, dimension)
    u = unit_directions(dimension, 1500)
    exact = arena.support(u) - part.support(u)
    points = boundary_of_difference(arena, part)
    kinds = []
    for approximation in differences(arena, part, rng):
        body = approximation.ellipsoid
        if approximation.kind == "inner":
            assert np.all(body.support(u) <= exact + TINY), approximation.name
        else:
            ball_points = (points - body.centre) @ body.rotation / body.semi_axes
            assert np.all(np.linalg.norm(ball_points, axis=1) <= 1.0 + TINY), approximation.name
        kinds.append(approximation.kind)
    inner = kinds.count("inner") - 1
    assert 1 <= inner <= 3
    assert kinds == ["outer", "inner"] + ["inner"] * inner + ["outer"] * 3


@pytest.mark.parametrize("dimension", [2, 3])
def test_outer_differences_hold_where_the_boundary_has_a_rim(dimension):
    arena = Ellipsoid.from_semi_axes([5.0, 2.0, 1.5][:dimension])
    part = Ellipsoid.from_semi_axes([1.4, 0.9, 1.2][:dimension])
    points = boundary_of_difference(arena, part)
    for member in ("trace", "volume", np.ones(dimension)):
        outer = kurzhanski_difference(arena, part, member, "outer").ellipsoid
        seen = (points - outer.centre) @ outer.rotation / outer.semi_axes
        assert np.all(np.linalg.norm(seen, axis=1) <= 1.0 + TINY)


@settings(deadline=None, max_examples=30)
@given(seeds, dimensions)
def test_directions_are_touched(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = pair(rng, dimension)
    u = rng.normal(size=dimension)
    u /= np.linalg.norm(u)
    exact = float(first.support(u) + second.support(u))
    for side in ("inner", "outer"):
        body = kurzhanski_sum(first, second, u, side).ellipsoid
        assert float(body.support(u)) == pytest.approx(exact, rel=1e-13)
        if side == "inner" and not inner_member_exists(first, second, u):
            with pytest.raises(GeometryError, match="not between"):
                kurzhanski_difference(first, second, u, side)
            continue
        body = kurzhanski_difference(first, second, u, side).ellipsoid
        gap = float(first.support(u) - second.support(u))
        assert float(body.support(u)) == pytest.approx(gap, rel=1e-13)


def inner_member_exists(arena, part, u):
    """Whether (1 - m)(S1 - S2 / m) is an ellipsoid at the m that touches in the direction u."""
    m = np.linalg.norm(part.matrix.T @ u) / np.linalg.norm(arena.matrix.T @ u)
    stretch = np.linalg.norm(np.linalg.solve(arena.matrix, part.matrix), ord=2)
    return stretch**2 < m < 1.0


def test_no_inner_member_touches_where_the_part_is_thin_and_the_arena_is_not():
    arena = Ellipsoid.from_semi_axes([8.0, 5.0])
    part = Ellipsoid.from_semi_axes([2.0, 0.1])
    u = np.array([0.0, 1.0])
    assert not inner_member_exists(arena, part, u)
    with pytest.raises(GeometryError, match="not between"):
        kurzhanski_difference(arena, part, u, "inner")


@settings(deadline=None, max_examples=15)
@given(seeds, dimensions)
def test_outer_sums_and_inner_differences_are_optimal(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = pair(rng, dimension)
    one, two = first.shape_matrix, second.shape_matrix

    def best(shape, limits):
        goals = (np.trace, lambda s: np.linalg.slogdet(s)[1])
        return [
            minimize_scalar(
                lambda x, goal=goal: goal(shape(x)),
                bounds=limits,
                method="bounded",
                options={"xatol": 1e-12},
            ).fun
            for goal in goals
        ]

    def outer(x):
        return (1 + math.exp(-x)) * one + (1 + math.exp(x)) * two

    trace, log_volume = best(outer, (-8.0, 8.0))
    by_trace = kurzhanski_sum(first, second, "trace").ellipsoid
    by_volume = kurzhanski_sum(first, second, "volume").ellipsoid
    assert np.trace(by_trace.shape_matrix) == pytest.approx(trace, rel=1e-12)
    assert 2 * np.log(by_volume.semi_axes).sum() == pytest.approx(log_volume, rel=1e-12)
    # p = sqrt(tr S1 / tr S2) gives the least trace, (tr^(1/2) + tr^(1/2))^2.
    closed = (np.linalg.norm(first.semi_axes) + np.linalg.norm(second.semi_axes)) ** 2
    assert trace == pytest.approx(closed, rel=1e-12)

    least = float(np.max(np.linalg.eigvals(np.linalg.solve(one, two)).real))
    largest = {}
    for name, goal in (("trace", np.trace), ("volume", lambda s: np.linalg.slogdet(s)[1])):
        found = minimize_scalar(
            lambda m, goal=goal: -goal((1 - m) * (one - two / m)),
            bounds=(least * (1 + 1e-9), 1 - 1e-9),
            method="bounded",
            options={"xatol": 1e-12},
        )
        largest[name] = -found.fun
    by_trace = kurzhanski_difference(first, second, "trace").ellipsoid
    by_volume = kurzhanski_difference(first, second, "volume").ellipsoid
    assert np.trace(by_trace.shape_matrix) == pytest.approx(largest["trace"], rel=1e-10)
    assert 2 * np.log(by_volume.semi_axes).sum() == pytest.approx(largest["volume"], rel=1e-10)


@pytest.mark.parametrize("dimension", [2, 3])
def test_inner_sums_and_outer_differences_are_optimal_over_rotations(dimension):
    rng = np.random.default_rng(3)
    first, second = pair(rng, dimension)

    def turn(x):
        if dimension == 3:
            return Rotation.from_rotvec(x).as_matrix()
        return np.array([[math.cos(x[0]), -math.sin(x[0])], [math.sin(x[0]), math.cos(x[0])]])

    def factor(x, sign):
        return first.matrix + sign * second.matrix @ turn(x) @ first.rotation.T

    goals = {
        "trace": lambda f: np.sum(f**2),
        "volume": lambda f: np.linalg.slogdet(f)[1],
    }
    for sign, side, build in ((1, "inner", kurzhanski_sum), (-1, "outer", kurzhanski_difference)):
        for name, goal in goals.items():
            starts = rng.normal(size=(12, 3 if dimension == 3 else 1)) * 2.0
            best = min(
                minimize(lambda x, g=goal, s=sign: -s * g(factor(x, s)), start, tol=1e-14).fun
                for start in starts
            )
            value = goal(build(first, second, name, side).ellipsoid.matrix)
            assert value == pytest.approx(-sign * best, rel=1e-8)


@settings(deadline=None, max_examples=30)
@given(seeds, dimensions)
def test_the_thesis_approximations_are_members(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = pair(rng, dimension)
    one, two = first.shape_matrix, second.shape_matrix
    offset = offset_sum(first, second).ellipsoid
    largest = kurzhanski_sum(first, second, "volume", "inner").ellipsoid
    np.testing.assert_allclose(offset.shape_matrix, largest.shape_matrix, rtol=1e-11, atol=1e-11)
    offset = offset_difference(first, second).ellipsoid
    least = kurzhanski_difference(first, second, "volume", "outer").ellipsoid
    np.testing.assert_allclose(offset.shape_matrix, least.shape_matrix, rtol=1e-11, atol=1e-11)
    # (5.33): the region is mu^T (S1 + S2)^-1 mu <= 2.
    gaussian = gaussian_sum(first, second).ellipsoid
    np.testing.assert_allclose(gaussian.shape_matrix, 2.0 * (one + two), rtol=1e-12)
    inverse = np.linalg.inv(two)
    inner = np.linalg.inv(np.linalg.inv(one) + inverse)
    printed = 0.5 * (inverse - inverse @ inner @ inverse)  # the thesis' Sigma''
    np.testing.assert_allclose(np.linalg.inv(printed), 2.0 * (one + two), rtol=1e-7, atol=1e-8)
    # Its counterpart: the Gaussian sum of the Gaussian difference with the part is the arena.
    rest = gaussian_difference(first, second).ellipsoid
    np.testing.assert_allclose(2.0 * (rest.shape_matrix + two), one, rtol=1e-11, atol=1e-11)


@settings(deadline=None, max_examples=30)
@given(seeds, dimensions)
def test_the_thesis_implicit_equation_of_the_offset_ellipsoid(seed, dimension):
    """x^T T^-T R Delta^-1 R^T T^-1 x = 1 (after (5.20), corrected); (5.23) with A = T R'."""
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    r = float(np.min(second.semi_axes))
    stretch = second.rotation @ np.diag(second.semi_axes / r) @ second.rotation.T
    rotation, axes, _ = np.linalg.svd(np.linalg.inv(stretch) @ first.matrix)
    body = offset_sum(first, second).ellipsoid
    points = body.surface_points(40) - body.centre
    seen = points @ np.linalg.inv(stretch).T @ rotation / (axes + r)
    np.testing.assert_allclose(np.linalg.norm(seen, axis=1), 1.0, rtol=1e-11)
    a = stretch @ rotation
    determinant = np.prod(second.semi_axes) / r**dimension
    assert abs(np.linalg.det(a)) == pytest.approx(determinant, rel=1e-12)
    assert np.prod(body.semi_axes) == pytest.approx(determinant * np.prod(axes + r), rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_balls_and_similar_bodies_are_exact(dimension):
    rng = np.random.default_rng(2)
    body = random_ellipsoid(rng, dimension)
    half = Ellipsoid(body.centre, body.rotation, 0.5 * body.semi_axes)
    for approximation in (
        offset_sum(body, half),
        *(
            kurzhanski_sum(body, half, m, s)
            for m in ("trace", "volume", [1.0] * dimension)
            for s in ("inner", "outer")
        ),
    ):
        expected = 2.25 * body.shape_matrix
        np.testing.assert_allclose(approximation.ellipsoid.shape_matrix, expected, rtol=1e-11)
    for approximation in (
        offset_difference(body, half),
        *(
            kurzhanski_difference(body, half, m, s)
            for m in ("trace", "volume", [1.0] * dimension)
            for s in ("inner", "outer")
        ),
    ):
        expected = 0.25 * body.shape_matrix
        np.testing.assert_allclose(
            approximation.ellipsoid.shape_matrix, expected, rtol=1e-10, atol=1e-12
        )


@pytest.mark.parametrize("room", [1e-3, 1e-6, 1e-9])
def test_a_difference_that_hardly_exists_keeps_its_members(room):
    arena = Ellipsoid.from_semi_axes([3.0, 2.0, 1.0 + room])
    part = ball(1.0, 3)
    for side in ("inner", "outer"):
        body = kurzhanski_difference(arena, part, "volume", side).ellipsoid
        assert 0.0 < np.min(body.semi_axes) <= 1.01 * room
    with pytest.raises(GeometryError, match="not between"):
        gaussian_difference(arena, part)


def test_bad_requests_are_refused():
    arena, part = Ellipsoid.from_semi_axes([3.0, 2.0, 1.0]), ball(1.5, 3)
    for build in (offset_difference, gaussian_difference, kurzhanski_difference):
        with pytest.raises(GeometryError, match=r"direction \[0.*exceeds the arena's 1 by 0.5"):
            build(arena, part)
        with pytest.raises(GeometryError, match="one dimension"):
            build(arena, ball(1.0, 2))
    for build in (offset_sum, gaussian_sum, kurzhanski_sum):
        with pytest.raises(GeometryError, match="one dimension"):
            build(arena, ball(1.0, 2))
    for wrong, message in (
        ("best", "trace"),
        ([1.0, 0.0], "3 finite"),
        ([0.0, 0.0, 0.0], "not zero"),
        ([math.nan, 0.0, 0.0], "3 finite"),
    ):
        with pytest.raises(GeometryError, match=message):
            kurzhanski_sum(arena, part, wrong)
    with pytest.raises(GeometryError, match="inner"):
        kurzhanski_sum(arena, part, "trace", "both")
    for member in ([1.0, 0.0, 0.0], "trace"):
        with pytest.raises(GeometryError, match="not between"):
            kurzhanski_difference(arena, ball(0.95, 3), member)


def test_random_rotations_are_rotations():
    rng = np.random.default_rng(0)
    for dimension in (2, 3):
        assert np.linalg.det(random_rotation(rng, dimension)) == pytest.approx(1.0)
