"""Thesis 5.4.3, 5.4.4: volumes of Minkowski sums; Figs. 5.9 to 5.14."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.approximations import gaussian_sum, kurzhanski_sum, offset_sum
from ellipsoid_planning.geometry.minkowski import minkowski_sum_boundary
from ellipsoid_planning.geometry.sum_bounds import sum_volume_bounds
from ellipsoid_planning.geometry.sum_volume import mixed_volumes, sum_area, sum_volume
from tests.geometry.chapter5 import (
    ball,
    random_ellipsoid,
    random_rotation,
    steiner_twin,
    trials,
)

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])
UNIT_BALL = {2: math.pi, 3: 4.0 / 3.0 * math.pi}
CASE_C = (
    ([7.0, 3.0, 3.0], [-45.0, -22.5, 45.0]),
    ([2.0, 3.0, 4.0], [60.0, 45.0, -30.0]),
)


def zxz(axes, degrees):
    turn = Rotation.from_euler("ZXZ", degrees, degrees=True).as_matrix()
    return Ellipsoid.from_semi_axes(axes, rotation=turn)


def errors(first, second):
    bounds = sum_volume_bounds(first, second)
    exact = bounds["exact"].value
    return {name: (bound.value / exact - 1.0, bound.kind) for name, bound in bounds.items()}


def exact_for_similar(first, second):
    """All bounds but the Gaussian one, which is exact for equal bodies only."""
    bounds = sum_volume_bounds(first, second)
    return [bound for name, bound in bounds.items() if name != "gaussian_ellipsoid"]


def test_figure_5_9_a_circles():
    for bound in exact_for_similar(ball(3.0, 2), ball(1.5, 2)):
        assert float(bound) == pytest.approx(math.pi * 4.5**2, rel=1e-14)


def test_figure_5_9_b_ellipses():
    first = Ellipsoid.from_semi_axes([1.0, 5.0])
    second = Ellipsoid.from_semi_axes([3.0, 6.0], rotation=math.pi / 4)
    bounds = sum_volume_bounds(first, second)
    expected = {"brunn_minkowski": 131.86, "lower": 165.22, "exact": 171.09, "upper": 179.09}
    for name, value in expected.items():
        assert float(bounds[name]) == pytest.approx(value, abs=0.006), name
    assert float(bounds["exact"]) == pytest.approx(
        steiner_twin(first, second, count=400), rel=1e-13
    )


@pytest.mark.statistical
def test_figure_5_10_plane():
    """About -6.5 % and +7.2 % over 20,000 trials; never beyond the crossed extremes."""
    found = errors(*trials(np.random.default_rng(510), 20000, 2))
    extreme = errors(np.diag([10.0, 50.0]), np.diag([50.0, 10.0]))
    assert -0.08 < extreme["lower"][0] <= found["lower"][0].min() < -0.06
    assert 0.068 < found["upper"][0].max() <= extreme["upper"][0] < 0.08
    assert found["brunn_minkowski"][0].min() < -0.4


def test_figure_5_11_a_spheres():
    for bound in exact_for_similar(ball(4.0, 3), ball(2.5, 3)):
        assert float(bound) == pytest.approx(4.0 / 3.0 * math.pi * 6.5**3, rel=1e-14)


def test_figure_5_11_b_a_sphere_and_a_spheroid():
    """The printed 448.1 is a misprint of 488.1; 573.7 uses (5.75) alone, the sphere first."""
    spheroid = Ellipsoid.from_semi_axes([2.0, 2.0, 6.0])
    bounds = sum_volume_bounds(ball(2.0, 3), spheroid)
    assert float(bounds["brunn_minkowski"]) == pytest.approx(488.14, abs=0.006)
    names = ("lower", "lower_exact_surface", "exact", "upper_exact_surface", "upper")
    for name in names:
        assert float(bounds[name]) == pytest.approx(563.31, abs=0.006), name
    assert float(bounds["upper_cauchy_schwarz"]) == pytest.approx(573.69, abs=0.006)


def test_figure_5_11_c_triaxial_ellipsoids():
    """Printed is 1725.9, more than any orientation gives: at most 1710.55."""
    first, second = zxz(*CASE_C[0]), zxz(*CASE_C[1])
    bounds = sum_volume_bounds(first, second)
    assert float(bounds["brunn_minkowski"]) == pytest.approx(1354.37, abs=0.006)
    assert float(bounds["exact"]) == pytest.approx(1626.29, abs=0.006)
    assert float(bounds["exact"]) == pytest.approx(
        steiner_twin(first, second, count=200), rel=1e-12
    )
    turns = Rotation.random(5000, random_state=1).as_matrix()
    volumes = sum_volume(np.diag(CASE_C[0][0]), turns @ np.diag(CASE_C[1][0]))
    across = sum_volume(np.diag([7.0, 3.0, 3.0]), np.diag([2.0, 3.0, 4.0]))
    assert 1700.0 < volumes.max() <= float(across) * (1 + 1e-12)
    assert float(across) == pytest.approx(1710.55, abs=0.006)


@pytest.mark.statistical
def test_figure_5_12_space():
    """Medians of the largest error of 100 trials: about 5.6 %, and 2.3 % with the exact F."""
    found = errors(*trials(np.random.default_rng(512), 20000, 3))

    def median(low, high):
        worst = np.maximum(-found[low][0], found[high][0])
        return float(np.median(worst.reshape(-1, 100).max(axis=1)))

    assert 0.05 < median("lower", "upper") < 0.065
    assert 0.02 < median("lower_exact_surface", "upper_exact_surface") < 0.026


@pytest.mark.statistical
def test_figure_5_13_estimates_in_the_plane():
    found = errors(*trials(np.random.default_rng(513), 20000, 2))
    for name in ("arithmetic_mean", "geometric_mean"):
        assert np.abs(found[name][0]).max() < 0.007
    assert np.abs(found["estimate"][0]).max() < 1e-4


@pytest.mark.statistical
def test_figure_5_14_estimates_in_space():
    """V_AM and V_GM err by up to 4 %, not 1 % as printed; V_est by 1 %."""
    found = errors(*trials(np.random.default_rng(514), 20000, 3))
    for name in ("arithmetic_mean", "geometric_mean"):
        assert 0.03 < np.abs(found[name][0]).max() < 0.041
    assert np.abs(found["estimate"][0]).max() < 0.0102
    assert np.all(found["geometric_mean"][0] <= found["arithmetic_mean"][0] + 1e-15)


@settings(deadline=None, max_examples=40)
@given(seeds, dimensions)
def test_the_exact_volume_matches_quadrature_and_symmetries(seed, dimension):
    rng = np.random.default_rng(seed)
    first = random_ellipsoid(rng, dimension)
    second = random_ellipsoid(rng, dimension)
    exact = float(sum_volume(first, second))
    assert exact == pytest.approx(steiner_twin(first, second, count=120), rel=1e-10)
    assert exact == pytest.approx(float(sum_volume(second, first)), rel=1e-14)
    turn, shift = random_rotation(rng, dimension), rng.normal(size=dimension)
    moved = first.transform(turn, shift), second.transform(turn, -shift)
    assert exact == pytest.approx(float(sum_volume(*moved)), rel=1e-13)
    skew = rng.normal(size=(dimension, dimension)) + 3.0 * np.eye(dimension)
    mapped = float(sum_volume(skew @ first.matrix, skew @ second.matrix))
    assert mapped == pytest.approx(abs(np.linalg.det(skew)) * exact, rel=1e-12)


def test_the_exact_volume_matches_convex_hulls():
    first, second = zxz(*CASE_C[0]), zxz(*CASE_C[1])
    hulls = [
        ConvexHull(minkowski_sum_boundary(first, second, count)).volume for count in (4000, 16000)
    ]
    # Points on the boundary lose volume in proportion to 1 / count.
    assert hulls[0] < hulls[1] < float(sum_volume(first, second))
    extrapolated = (4.0 * hulls[1] - hulls[0]) / 3.0
    assert extrapolated == pytest.approx(float(sum_volume(first, second)), rel=1e-4)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 0.3, math.pi / 2, 2.0, math.pi])
def test_areas_from_axes_and_an_angle(angle):
    first = Ellipsoid.from_semi_axes([1.0, 5.0])
    second = Ellipsoid.from_semi_axes([3.0, 6.0], rotation=angle)
    area = float(sum_area([1.0, 5.0], [3.0, 6.0], angle))
    assert area == pytest.approx(float(sum_volume(first, second)), rel=2e-15)
    many = sum_area(np.ones((7, 1, 2)), [[2.0, 3.0]] * 4, np.full((7, 4), angle))
    assert many.shape == (7, 4)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("thinness", [1.0, 1e-3, 1e-6, 1e-9])
def test_similar_needles_and_discs_are_exact(dimension, thinness):
    for axes in ([1.0] + [thinness] * (dimension - 1), [1.0] * (dimension - 1) + [thinness]):
        for size in (1e-3, 1.0, 40.0):
            one, two = np.diag(axes), size * np.diag(axes)
            expected = UNIT_BALL[dimension] * np.prod(axes) * (1.0 + size) ** dimension
            for bound in exact_for_similar(one, two):
                assert float(bound) == pytest.approx(expected, rel=1e-12)


def test_crossed_needles_span_a_flat_body():
    """Two crossed segments, barely thick: 2 s, the mixed volume of a disc's plane and both."""
    s = 1e-6
    one, two = np.diag([1.0, s, s]), np.diag([s, 1.0, s])
    volume = float(sum_volume(one, two))
    assert volume == pytest.approx(float(sum_volume(two, one)), rel=1e-15)
    # The needles' shadow along z is a square of area 4, the body's thickness there at most 4 s:
    assert 0.0 < volume < 4.0 * 4.0 * s
    scaled = float(sum_volume(1e100 * one, 1e100 * two)) / 1e300
    assert scaled == pytest.approx(volume, rel=1e-13)


@settings(deadline=None, max_examples=60)
@given(seeds, dimensions)
def test_bounds_bound_for_needles_and_discs_at_any_turn(seed, dimension):
    rng = np.random.default_rng(seed)
    axes = 10.0 ** rng.uniform(-6.0, 0.0, (2, dimension))
    turn = random_rotation(rng, dimension) if rng.random() < 0.7 else np.eye(dimension)
    bounds = sum_volume_bounds(np.diag(axes[0]), turn @ np.diag(axes[1]))
    exact = float(bounds["exact"])
    for name, bound in bounds.items():
        assert math.isfinite(float(bound)), name
        slack = 1e-12 * exact
        if bound.kind == "lower":
            assert float(bound) <= exact + slack, name
        elif bound.kind == "upper":
            assert float(bound) >= exact - slack, name
    means = [
        float(bounds[name]) for name in ("lower", "geometric_mean", "arithmetic_mean", "upper")
    ]
    assert means == sorted(means)


@settings(deadline=None, max_examples=20)
@given(seeds, dimensions)
def test_ellipsoids_volumes_are_those_of_the_approximations(seed, dimension):
    rng = np.random.default_rng(seed)
    first, second = random_ellipsoid(rng, dimension), random_ellipsoid(rng, dimension)
    bounds = sum_volume_bounds(first, second)
    for name, approximation in (
        ("offset_ellipsoid", offset_sum(first, second)),
        ("gaussian_ellipsoid", gaussian_sum(first, second)),
        ("kurzhanski_ellipsoid", kurzhanski_sum(first, second, "volume")),
    ):
        volume = UNIT_BALL[dimension] * np.prod(approximation.ellipsoid.semi_axes)
        assert float(bounds[name]) == pytest.approx(volume, rel=1e-12)
        assert (bounds[name].kind == "lower") == (approximation.kind == "inner")


def test_near_identity_rotations_are_smooth():
    axes = np.diag([3.0, 2.0, 1.0])
    angles = np.array([0.0, 1e-12, 1e-9, 1e-6])
    turns = Rotation.from_rotvec(angles[:, None] * [0.6, 0.0, 0.8]).as_matrix()
    volumes = sum_volume(axes, turns @ axes)
    assert volumes[0] == pytest.approx(UNIT_BALL[3] * 48.0, rel=1e-15)
    # Stationary there, so that the change is of second order.
    np.testing.assert_allclose(volumes, volumes[0], rtol=3e-12)


def test_mixed_volumes_are_steiners_polynomial():
    first, second = zxz(*CASE_C[0]), zxz(*CASE_C[1])
    for t in (0.0, 0.3, 1.0, 5.0):
        grown = float(sum_volume(t * first.matrix, second.matrix)) if t else None
        polynomial = float(np.polyval(mixed_volumes(first, second), t))
        expected = UNIT_BALL[3] * 24.0 if grown is None else grown
        assert polynomial == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("function", [sum_volume, sum_volume_bounds, mixed_volumes])
def test_bad_bodies_are_refused(function):
    with pytest.raises(GeometryError, match="one dimension, got 2 and 3"):
        function(ball(1.0, 2), ball(1.0, 3))
    with pytest.raises(GeometryError, match="zero length"):
        function(np.diag([1.0, 0.0]), np.eye(2))
    with pytest.raises(GeometryError, match="finite"):
        function(np.diag([1.0, math.nan]), np.eye(2))
    with pytest.raises(GeometryError, match=r"\(2, 2\) or \(3, 3\)"):
        function([1.0, 2.0], [1.0, 2.0])
