"""Thesis 5.4.1, 5.4.2: perimeter, surface and total mean curvature; Figs. 5.5 to 5.8."""

import itertools
import math
from decimal import Decimal, getcontext

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipeinc, ellipkinc

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.carlson import mean_length
from ellipsoid_planning.geometry.intrinsic import (
    area,
    mean_curvature,
    perimeter,
    surface_area,
    volume,
)
from ellipsoid_planning.geometry.intrinsic_estimates import (
    legendre_perimeter,
    mean_curvature_bounds,
    perimeter_bounds,
    surface_bounds,
)
from ellipsoid_planning.geometry.uniaxial import uniaxial_mean_curvature, uniaxial_surface_area
from tests.geometry.chapter5 import TRIALS, mean_length_twin, sphere_quadrature

SHAPES = [
    (1.0, 1.0, 1.0),
    (1.0, 1.0, 1.0 + 1e-9),
    (3.0, 2.0, 1.0),
    (1.0, 1e-6, 2e-6),  # needle
    (1.0, 1e-6, 1e-6),
    (1.0, 0.7, 1e-6),  # disc
    (1e6, 1.0, 1e-6),
    (2e-150, 3e-150, 5e-150),
    (2e150, 3e150, 5e150),
]
ROUNDING = 3e-14


def relative(value, exact):
    return np.asarray(value) / np.asarray(exact) - 1.0


def agm_perimeter(a, b):
    """4 a E(m) by the arithmetic-geometric mean in 60 digits."""
    getcontext().prec = 60
    x, y = Decimal(max(a, b)), Decimal(min(a, b))
    pi = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
    total, power = x * x, Decimal(1) / 2
    c = (x * x - y * y).copy_abs()
    total -= power * c
    for _ in range(40):
        power *= 2
        half = (x - y) / 2
        x, y = (x + y) / 2, (x * y).sqrt()
        total -= power * half * half
    return float(2 * pi * total / x)


@pytest.mark.parametrize("axes", [(1, 1), (3, 2), (1, 5), (1, 1e-6), (1e6, 1.0), (1, 1 - 1e-9)])
def test_perimeter_is_exact_for_circles_and_needles(axes):
    assert abs(relative(perimeter(axes), agm_perimeter(*axes))) < 4e-15
    # (5.42) with its modulus read as the parameter m = 1 - a^2 / b^2.
    small, large = min(axes), max(axes)
    twin = 4.0 * large * ellipe((large - small) * (large + small) / large**2)
    assert abs(relative(perimeter(axes), twin)) < 1e-14


@pytest.mark.parametrize("axes", SHAPES)
def test_surface_and_mean_curvature_match_slow_quadrature(axes):
    _a, _b, _c = axes
    scale = max(axes)
    unit = np.array(axes) / scale
    mean = 4.0 * math.pi * mean_length_twin(unit) * scale
    assert abs(relative(mean_curvature(axes), mean)) < ROUNDING
    products = np.array([unit[1] * unit[2], unit[0] * unit[2], unit[0] * unit[1]])
    largest = products.max()
    surface = 4.0 * math.pi * mean_length_twin(products / largest) * largest
    assert abs(relative(surface_area(unit), surface)) < ROUNDING
    if scale < 1e100:
        assert abs(relative(surface_area(axes), surface * scale**2)) < ROUNDING


def test_surface_and_mean_curvature_match_the_surface_integrals():
    a, b, c = 3.0, 2.0, 1.2
    unit, weights = sphere_quadrature(3, 160)
    lengths = np.linalg.norm(unit / [a, b, c], axis=1)  # |x / a^2| at x = a unit
    surface = float(np.sum(a * b * c * lengths * weights))  # (5.49)
    assert abs(relative(surface_area([a, b, c]), surface)) < 1e-13
    inverse = np.array([a, b, c]) ** -2.0
    cubes = np.sum(unit**2 * inverse**2, axis=1)
    m = (lengths**2 * inverse.sum() - cubes) / (2.0 * lengths**3)  # (5.53)
    bend = float(np.sum(m * a * b * c * lengths * weights))  # (5.54)
    assert abs(relative(mean_curvature([a, b, c]), bend)) < 1e-13


def test_mean_curvature_is_half_the_divergence_of_the_normal():
    """(5.50): its second line lacks the factor 1/2."""
    axes = np.array([3.0, 2.0, 1.2])
    point = axes * np.array([0.48, 0.6, 0.64])

    def normal(x):
        gradient = x / axes**2
        return gradient / np.linalg.norm(gradient)

    step = 1e-5
    divergence = sum(
        (normal(point + step * e)[i] - normal(point - step * e)[i]) / (2.0 * step)
        for i, e in enumerate(np.eye(3))
    )
    a = np.diag(axes**-2.0)
    square = point @ a @ a @ point
    m = (square * np.trace(a) - point @ a @ a @ a @ point) / (2.0 * square**1.5)
    assert abs(0.5 * divergence / m - 1.0) < 1e-8


def test_surface_matches_legendre_integrals_whose_w_is_the_parameter():
    """(5.73), where w, called an eccentricity, is m = k^2."""
    a, b, c = 1.0, 1.7, 2.9
    phi = math.asin(math.sqrt(1.0 - a**2 / c**2))
    w = c**2 * (b**2 - a**2) / (b**2 * (c**2 - a**2))
    root = math.sqrt(c**2 - a**2)
    thesis = a**2 + b * a**2 / root * ellipkinc(phi, w) + b * root * ellipeinc(phi, w)
    assert abs(relative(surface_area([c, a, b]), 2.0 * math.pi * thesis)) < 1e-14


@pytest.mark.parametrize(
    ("axes", "value"),
    # B. C. Carlson, Numerical computation of real or complex elliptic integrals (1995).
    [((0, 16, 16), math.pi), ((2, 3, 4), 1.7255030280692), ((0, 0.0796, 4), 1.0284758090288)],
)
def test_carlsons_own_numbers(axes, value):
    assert abs(relative(mean_length(np.sqrt(np.array(axes, dtype=float))), value)) < 1e-13


def test_spheres_are_exact():
    assert float(mean_curvature([2.5] * 3)) == pytest.approx(4 * math.pi * 2.5, rel=1e-15)
    assert float(surface_area([2.5] * 3)) == pytest.approx(4 * math.pi * 2.5**2, rel=1e-15)
    assert float(volume([2.5] * 3)) == pytest.approx(4 / 3 * math.pi * 2.5**3, rel=1e-15)
    assert float(perimeter([2.5] * 2)) == pytest.approx(2 * math.pi * 2.5, rel=1e-15)
    assert float(area([2.5] * 2)) == pytest.approx(math.pi * 2.5**2, rel=1e-15)


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 0.5, 0.98, 1 - 1e-5, 1 + 1e-9, 1.02, 3.0, 1e3, 1e6])
def test_uniaxial_formulas_are_stable_across_the_sphere(ratio):
    axes = [1.3, 1.3, 1.3 * ratio]
    radius, height = np.array(1.3), np.array(1.3 * ratio)
    assert abs(relative(uniaxial_mean_curvature(radius, height), mean_curvature(axes))) < 1e-14
    assert abs(relative(uniaxial_surface_area(radius, height), surface_area(axes))) < 1e-14


@pytest.mark.parametrize(
    ("function", "n"), [(perimeter_bounds, 2), (surface_bounds, 3), (mean_curvature_bounds, 3)]
)
def test_bounds_bound_from_spheres_to_needles_and_discs(function, n):
    rng = np.random.default_rng(7)
    axes = 10.0 ** rng.uniform(-6.0, 0.0, (20000, n))
    axes[:200] = axes[:200, :1] * (1.0 + 1e-9 * rng.uniform(-1.0, 1.0, (200, n)))
    axes[200:400, 1] = axes[200:400, 0]
    bounds = function(axes)
    exact = bounds["exact"].value
    for name, bound in bounds.items():
        error = relative(bound.value, exact)
        assert np.all(np.isfinite(error)), name
        if bound.kind == "lower":
            assert error.max() < 1e-13, name
        elif bound.kind == "upper":
            assert error.min() > -1e-13, name
        # All are exact for spheres.
        assert np.max(np.abs(error[:200])) < 1e-8, name


@pytest.mark.parametrize("axes", [(3.0, 2.0, 1.2), (5.0, 4.9, 0.3), (2.0, 2.0, 1.999)])
def test_the_thesis_integral_bounds_of_mean_curvature(axes):
    """(5.58)-(5.67), a >= b >= c, prefactor 2 pi a b c, alpha' above and alpha'' below."""
    a, b, c = axes
    alpha = {1: b**2 - c**2, 2: a**2 * (b**2 - c**2), 3: b**2 * (a**2 - c**2), 4: a**2 - c**2}
    beta = {1: a**2 + c**2, 2: a**2 * c**2, 3: b**2 * c**2, 4: b**2 + c**2}
    root = math.sqrt(beta[2] * beta[3])

    def product(t):
        return math.sqrt((alpha[2] * t * t + beta[2]) * (alpha[3] * t * t + beta[3]))

    slopes = {
        "integral_upper": math.sqrt(alpha[2] * alpha[3]),
        "integral_lower": (alpha[2] * beta[3] + alpha[3] * beta[2]) / (2.0 * root),
    }
    roots = {name: lambda t, s=slope: s * t * t + root for name, slope in slopes.items()}
    bounds = mean_curvature_bounds(axes)
    for name, middle in (("exact", product), *roots.items()):

        def integrand(t, middle=middle):
            return sum(
                (alpha[i] * t * t + beta[i]) / (alpha[j] * t * t + beta[j] + middle(t))
                for i, j in ((1, 2), (4, 3))
            )

        value = 2.0 * math.pi * a * b * c * quad(integrand, 0.0, 1.0, epsabs=0, epsrel=1e-13)[0]
        assert float(bounds[name]) == pytest.approx(value, rel=1e-12), name


def test_orders_of_axes_do_not_matter():
    shuffled = [[3.0, 1.0, 2.0], [2.0, 3.0, 1.0], [1.0, 2.0, 3.0]]
    for function in (surface_bounds, mean_curvature_bounds):
        for bound in function(shuffled).values():
            np.testing.assert_allclose(bound.value, bound.value[0], rtol=2e-15)


def test_legendres_series_falls_to_the_perimeter():
    """(5.43) with its binomials squared; (5.45) is its beginning, exponents corrected."""
    axes = [4.0, 2.5]
    sums = [float(legendre_perimeter(axes, k)) for k in range(60)]
    assert all(a >= b for a, b in itertools.pairwise(sums))
    assert abs(sums[-1] / float(perimeter(axes)) - 1.0) < 1e-14
    assert sums[2] == pytest.approx(float(perimeter_bounds(axes)["legendre"]), rel=1e-15)


def test_figure_5_5_and_5_6_mean_curvature():
    """-4.15 % and +5.35 % on the grid; the thesis says below 5 %."""
    rng = np.random.default_rng(55)
    for axes in (rng.uniform(*TRIALS, (100, 3)), ratio_grid()):
        bounds = mean_curvature_bounds(axes)
        exact = bounds["exact"].value
        assert relative(bounds["lower"].value, exact).min() > -0.042
        assert relative(bounds["upper"].value, exact).max() < 0.054
    assert relative(bounds["lower"].value, exact).min() == pytest.approx(-0.0415, abs=5e-5)
    assert relative(bounds["upper"].value, exact).max() == pytest.approx(0.0535, abs=5e-5)


def test_figure_5_7_and_5_8_surface():
    """-5.7 % and +9.3 % on the grid; (5.77) with min where max is printed."""
    rng = np.random.default_rng(57)
    for axes in (rng.uniform(*TRIALS, (100, 3)), ratio_grid()):
        bounds = surface_bounds(axes)
        exact = bounds["exact"].value
        errors = [relative(bounds[name].value, exact) for name in ("lower", "upper", "thomsen")]
        assert errors[0].min() > -0.058
        assert errors[1].max() < 0.095
        assert np.max(np.abs(errors[2])) < 0.0106  # Thomsen's own claim is 1.061 %
    assert errors[0].min() == pytest.approx(-0.057, abs=5e-4)
    assert errors[1].max() == pytest.approx(0.093, abs=6e-4)


def test_uniaxial_ellipsoids_have_exact_bounds():
    for axes in ([2.0, 2.0, 5.0], [2.0, 5.0, 5.0]):
        for function in (mean_curvature_bounds, surface_bounds):
            bounds = function(axes)
            for name in ("lower", "upper"):
                assert abs(relative(bounds[name].value, bounds["exact"].value)) < 1e-14


def test_a_million_perimeters_are_one_call():
    axes = np.random.default_rng(1).uniform(1.0, 2.0, (3, 4, 5, 3))
    assert surface_area(axes).shape == mean_curvature(axes).shape == (3, 4, 5)
    assert surface_area(axes)[1, 2, 3] == surface_area(axes[1, 2, 3])


@pytest.mark.parametrize(
    ("function", "n"), [(perimeter, 2), (surface_area, 3), (surface_bounds, 3)]
)
@pytest.mark.parametrize("wrong", [0.0, -1.0, math.nan, math.inf])
def test_axes_must_be_positive(function, n, wrong):
    with pytest.raises(GeometryError, match="positive semi-axes"):
        function([wrong] + [1.0] * (n - 1))
    with pytest.raises(GeometryError, match=f"expected {n} semi-axes"):
        function([1.0] * (5 - n))


def ratio_grid():
    ratios = np.linspace(1.0, 5.0, 81)
    b, c = np.meshgrid(ratios, ratios)
    return np.stack([np.ones_like(b), b, c], axis=-1)
