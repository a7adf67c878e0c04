"""Minimum-volume enclosing ellipsoids against slow twins, closed forms and their dual bounds."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.enclosing import THINNEST, enclosing_ellipsoid, grown_around
from ellipsoid_planning.geometry.enclosing_forms import (
    box_semi_axes,
    capsule_semi_axes,
    cylinder_semi_axes,
)
from ellipsoid_planning.geometry.farthest import farthest_points, farthest_squared
from ellipsoid_planning.geometry.optimal_design import (
    ellipsoid_of_design,
    farthest_of_design,
    optimal_design,
)
from ellipsoid_planning.geometry.orientation import (
    quaternion_from_rotation,
    rotation_from_quaternion,
)
from ellipsoid_planning.geometry.rounds import Rounds

NO_POINTS = np.zeros((0, 3))


def cloud(seed, count, n=3):
    rng = np.random.default_rng(seed)
    skew = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-3.0, 3.0)
    return rng.normal(size=(count, n)) @ skew + rng.normal(size=n)


def slow_twin(points):
    """The smallest -log det of B with |B x + b| <= 1, by a general optimiser."""
    n = points.shape[1]
    lower = np.tril_indices(n)
    middle, spread = points.mean(axis=0), points.std()
    z = (points - middle) / spread

    def unpack(v):
        matrix = np.zeros((n, n))
        matrix[lower] = v[: len(lower[0])]
        return matrix, v[len(lower[0]) :]

    def slack(v):
        matrix, shift = unpack(v)
        return 1.0 - np.sum((z @ matrix.T + shift) ** 2, axis=1)

    radius = 1.1 * np.linalg.norm(z, axis=1).max()
    start = np.concatenate([(np.eye(n) / radius)[lower], np.zeros(n)])
    found = minimize(
        lambda v: -np.sum(np.log(np.abs(np.diagonal(unpack(v)[0])))),
        start,
        constraints={"type": "ineq", "fun": slack},
        method="SLSQP",
        options={"maxiter": 500, "ftol": 1e-12},
    )
    return math.exp(found.fun) * spread**n


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("count", [5, 12, 40])
def test_is_as_small_as_a_general_optimiser_makes_it(n, count):
    points = cloud(count, count, n)
    found = enclosing_ellipsoid(points)
    assert found.ellipsoid.contains(points).all()
    assert found.excess < 1e-6
    assert np.prod(found.ellipsoid.semi_axes) == pytest.approx(slow_twin(points), rel=1e-4)


@settings(deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(4, 60), n=st.sampled_from([2, 3]))
def test_contains_every_point_and_is_proved_optimal(seed, count, n):
    points = cloud(seed, count, n)
    found = enclosing_ellipsoid(points)
    assert found.ellipsoid.contains(points).all()
    # The thickness that flat sets get has nothing to do with the method's own excess.
    if found.ellipsoid.semi_axes.min() > 1.001 * THINNEST * found.ellipsoid.semi_axes.max():
        assert found.excess < 1e-6


def test_design_bounds_the_volume_from_below():
    points = cloud(3, 30)
    weights, farthest = optimal_design(points, 1e-9)
    assert weights.sum() == pytest.approx(1.0) and farthest < 1.0 + 1e-8
    best = abs(np.linalg.det(ellipsoid_of_design(points, weights)[1]))
    rng = np.random.default_rng(4)
    for _ in range(20):
        other = rng.dirichlet(np.ones(len(points)))
        assert abs(np.linalg.det(ellipsoid_of_design(points, other)[1])) <= best
        assert farthest_of_design(points, other) >= 1.0


def test_points_of_a_tessellated_cylinder_take_few_steps():
    angles = np.linspace(0.0, 2.0 * math.pi, 3000, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles])
    shift = np.array([0.0, 0.0, 2.0])
    points = np.concatenate([ring + shift, ring - shift])
    found = enclosing_ellipsoid(points)
    assert found.ellipsoid.contains(points).all()
    assert np.sort(found.ellipsoid.semi_axes) == pytest.approx(cylinder_semi_axes(1, 2), rel=1e-4)


def test_inside_after_the_pose_went_through_a_quaternion():
    points = cloud(5, 200) @ np.diag([1.0, 1e-2, 1e-3])
    body = enclosing_ellipsoid(points).ellipsoid
    again = rotation_from_quaternion(quaternion_from_rotation(body.rotation))
    assert Ellipsoid(body.centre, again, body.semi_axes).contains(points).all()


def test_flat_sets_get_the_stated_thickness():
    plane = np.column_stack([cloud(6, 30, 2), np.zeros(30)])
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9]).as_matrix()
    points = plane @ turn.T + [1.0, 2.0, 3.0]
    found = enclosing_ellipsoid(points)
    axes = np.sort(found.ellipsoid.semi_axes)
    inside = np.sort(enclosing_ellipsoid(plane[:, :2]).ellipsoid.semi_axes)
    assert found.ellipsoid.contains(points).all() and found.excess == math.inf
    assert axes[1:] == pytest.approx(inside, rel=1e-6)
    assert axes[0] == pytest.approx(THINNEST * axes[2])


def test_a_segment_and_a_point():
    found = enclosing_ellipsoid([[0, 0, 0], [0, 0, 0], [1, 2, 2]])
    assert np.sort(found.ellipsoid.semi_axes) == pytest.approx([1.5e-3, 1.5e-3, 1.5])
    assert found.ellipsoid.contains([[0, 0, 0], [1, 2, 2]]).all()
    for nothing in ([[1.0, 2.0, 3.0]] * 4, NO_POINTS, [[0, 0, 0], [1, math.nan, 0]]):
        with pytest.raises(GeometryError):
            enclosing_ellipsoid(nothing)


@settings(deadline=None)
@given(seed=st.integers(0, 10**6))
def test_farthest_point_of_an_ellipsoid_is_the_farthest(seed):
    rng = np.random.default_rng(seed)
    stretch = -np.sort(-rng.uniform(0.0, 1.0, size=(1, 3)))
    q = rng.normal(size=(1, 3)) * rng.integers(0, 2, size=(1, 3))
    bound = farthest_squared(q, stretch)[0]
    ball = rng.normal(size=(2000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    assert np.max(np.sum((q + stretch * ball) ** 2, axis=1)) <= bound * (1.0 + 1e-12)
    found = q + stretch * farthest_points(q, stretch)
    assert np.sum(found**2) == pytest.approx(bound, rel=1e-9)


SIZES = st.floats(0.05, 20.0)


@settings(deadline=None, max_examples=15)
@given(radius=SIZES, half=SIZES)
def test_cylinder_and_capsule_in_closed_form(radius, half):
    ends = np.array([[0, 0, half], [0, 0, -half]])
    for shape, axes in (
        ([radius, radius, 0.0], cylinder_semi_axes(radius, half)),
        ([radius, radius, radius], capsule_semi_axes(radius, half)),
    ):
        rounds = Rounds(ends, np.array([np.diag(shape)] * 2))
        # The closed form encloses the whole solid, by maximisation, and touches it.
        form = Ellipsoid.from_semi_axes(axes)
        assert grown_around(form, NO_POINTS, rounds).semi_axes == pytest.approx(axes, rel=1e-9)
        found = enclosing_ellipsoid(NO_POINTS, rounds)
        volume = np.prod(found.ellipsoid.semi_axes)
        assert volume == pytest.approx(np.prod(axes), rel=1e-5)
        assert volume >= np.prod(axes) * (1.0 - 1e-9) and found.excess < 1e-5


def test_box_and_flat_forms():
    half = np.array([1.0, 2.0, 5.0])
    corners = half * np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
    found = enclosing_ellipsoid(corners).ellipsoid
    assert np.sort(found.semi_axes) == pytest.approx(box_semi_axes(half), rel=1e-7)
    assert capsule_semi_axes(2.0, 0.0) == pytest.approx([2.0, 2.0, 2.0])
    for half_length in (0.0, 1e-9, 1e-4, 5e-4, 1e-3):
        across, _, along = cylinder_semi_axes(1.0, half_length)
        assert (1.0 / across) ** 2 + (half_length / along) ** 2 <= 1.0 + 1e-12
        assert along >= 0.8 * THINNEST * across
    assert cylinder_semi_axes(1.0, 0.0)[0] == pytest.approx(1.0)


def test_mixed_points_discs_and_balls_are_inside():
    rng = np.random.default_rng(8)
    balls = Rounds(rng.normal(size=(4, 3)), np.array([np.diag([0.3, 0.3, 0.3])] * 4))
    disc = Rounds(rng.normal(size=(1, 3)), rng.normal(size=(1, 3, 3)) * [1.0, 1.0, 0.0])
    points = rng.normal(size=(10, 3))
    both = Rounds.joined([balls, disc])
    found = enclosing_ellipsoid(points, both)
    unit = rng.normal(size=(3000, 3))
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    surface = both.centres[:, None] + np.einsum("mij,kj->mki", both.matrices, unit)
    assert found.ellipsoid.contains(points).all() and found.ellipsoid.contains(surface).all()
    assert found.excess < 1e-4
