"""The thesis' bounds and estimates of perimeter, surface and total mean curvature (5.4).

They were made before the exact values (`geometry.intrinsic`) were known, and stay as history and
as checks. Each function takes semi-axes (..., n) in any order and returns named bounds, with the
misprints corrected: (5.43) squares its binomials, (5.45) is 1 - w^2/4 - 3 w^4/64, in
(5.64)-(5.67) alpha' belongs to the upper bound and alpha'' to the lower one, the prefactor is
2 pi a b c, a >= b >= c, alpha_4 = a^2 - c^2 and beta_4 = b^2 + c^2.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.bound import Bound
from ellipsoid_planning.geometry.intrinsic import (
    checked_axes,
    mean_curvature,
    perimeter,
    surface_area,
)
from ellipsoid_planning.geometry.uniaxial import (
    arctangent_quotient,
    uniaxial_mean_curvature,
    uniaxial_surface_area,
)

Array = NDArray[np.float64]
THOMSEN = 1.6075


def perimeter_bounds(semi_axes: ArrayLike) -> dict[str, Bound]:
    """Return exact, isoperimetric (lower), legendre (upper) and ramanujan (estimate) of L.

    Args:
        semi_axes: (..., 2).
    """
    axes = np.sort(checked_axes(semi_axes, 2), axis=-1)
    b, a = axes[..., 0], axes[..., 1]
    squared = (a - b) * (a + b) / a**2  # w^2, the squared eccentricity (5.44)
    legendre = 2.0 * math.pi * a * (1.0 - squared / 4.0 - 3.0 * squared**2 / 64.0)
    h = ((a - b) / (a + b)) ** 2
    ramanujan = math.pi * (a + b) * (1.0 + 3.0 * h / (10.0 + np.sqrt(4.0 - 3.0 * h)))
    isoperimetric = np.sqrt(4.0 * math.pi**2 * a * b + 4.0 * math.pi * (a - b) ** 2)
    return {
        "exact": Bound(perimeter(axes), "exact", "(5.42)"),
        "isoperimetric": Bound(isoperimetric, "lower", "(5.46)"),
        "legendre": Bound(legendre, "upper", "(5.45)"),
        "ramanujan": Bound(ramanujan, "estimate", "(5.92)"),
    }


def legendre_perimeter(semi_axes: ArrayLike, terms: int) -> Array:
    """Return Legendre's series (5.43) of L to w^(2 terms), an upper bound; axes (..., 2)."""
    axes = np.sort(checked_axes(semi_axes, 2), axis=-1)
    b, a = axes[..., 0], axes[..., 1]
    squared = (a - b) * (a + b) / a**2
    total = np.ones_like(a)
    for k in range(1, terms + 1):
        total = total - math.comb(2 * k, k) ** 2 * (squared / 16.0) ** k / (2 * k - 1)
    return np.asarray(2.0 * math.pi * a * total)


def surface_bounds(semi_axes: ArrayLike) -> dict[str, Bound]:
    """Return exact, lower, upper and estimates of F for semi-axes (..., 3).

    Names: schwarz (5.4.2.2, the better Schwarz symmetrisation), cauchy_schwarz (5.75),
    circumscribed (the tighter uniaxial ellipsoid around), lower, upper (the best of these,
    (5.77) with its min), thomsen (5.93).
    """
    axes = np.sort(checked_axes(semi_axes, 3), axis=-1)
    a, b, c = (axes[..., i] for i in range(3))
    products = axes * np.roll(axes, 1, axis=-1)
    cauchy = 4.0 * math.pi / math.sqrt(3.0) * np.linalg.norm(products, axis=-1)
    thomsen = 4.0 * math.pi * np.mean(products**THOMSEN, axis=-1) ** (1.0 / THOMSEN)
    schwarz = np.maximum(
        uniaxial_surface_area(np.sqrt(b * c), a), uniaxial_surface_area(np.sqrt(a * b), c)
    )
    circumscribed = np.minimum(uniaxial_surface_area(b, c), uniaxial_surface_area(c, a))
    return {
        "exact": Bound(surface_area(axes), "exact", "(5.73)"),
        "schwarz": Bound(schwarz, "lower", "Schwarz symmetrisation"),
        "cauchy_schwarz": Bound(cauchy, "upper", "(5.75)"),
        "circumscribed": Bound(circumscribed, "upper", "uniaxial ellipsoid around"),
        "lower": Bound(schwarz, "lower", "(5.74)"),
        "upper": Bound(np.minimum(cauchy, circumscribed), "upper", "(5.77)"),
        "thomsen": Bound(thomsen, "estimate", "(5.93)"),
    }


def mean_curvature_bounds(semi_axes: ArrayLike) -> dict[str, Bound]:
    """Return exact, lower, upper and an estimate of M for semi-axes (..., 3).

    Names: integral_lower (5.66), integral_upper (5.67), schwarz and circumscribed (5.68),
    inscribed (weaker than schwarz), lower, upper (5.71), estimate (5.94).
    """
    axes = np.sort(checked_axes(semi_axes, 3), axis=-1)
    a, b, c = (axes[..., i] for i in range(3))
    low, high = _integral_bounds(axes)
    schwarz = np.maximum(
        uniaxial_mean_curvature(np.sqrt(b * c), a), uniaxial_mean_curvature(np.sqrt(a * b), c)
    )
    inscribed = np.maximum(uniaxial_mean_curvature(b, a), uniaxial_mean_curvature(a, c))
    circumscribed = np.minimum(uniaxial_mean_curvature(b, c), uniaxial_mean_curvature(c, a))
    lower, upper = np.maximum(low, schwarz), np.minimum(high, circumscribed)
    return {
        "exact": Bound(mean_curvature(axes), "exact", "(5.54)"),
        "integral_lower": Bound(low, "lower", "(5.66)"),
        "integral_upper": Bound(high, "upper", "(5.67)"),
        "schwarz": Bound(schwarz, "lower", "(5.68)"),
        "inscribed": Bound(inscribed, "lower", "uniaxial ellipsoid inside"),
        "circumscribed": Bound(circumscribed, "upper", "(5.68)"),
        "lower": Bound(lower, "lower", "(5.71)"),
        "upper": Bound(upper, "upper", "(5.71)"),
        "estimate": Bound(0.5 * (lower + upper), "estimate", "(5.94)"),
    }


def _integral_bounds(ascending: Array) -> tuple[Array, Array]:
    """M_lb1 and M_ub1: the integrand's denominators replaced by quadratics (5.61).

    With the longest axis a = 1; 2 pi a b c is spread over the terms so that nothing underflows.
    """
    size = ascending[..., 2]
    c, b = ascending[..., 0] / size, ascending[..., 1] / size
    alpha_2, alpha_3 = (b - c) * (b + c), b**2 * (1.0 - c) * (1.0 + c)
    beta_2, beta_3 = c**2, (b * c) ** 2
    constant = b * c**2  # sqrt(beta_2 beta_3) is both beta' and beta''
    slope_upper = np.sqrt(alpha_2 * alpha_3)
    slope_lower = 0.5 * (alpha_2 * b + alpha_3 / b)
    bounds = []
    for slope in (slope_lower, slope_upper):
        first = _mean_ratio((b - c) * (b + c), 1.0 + c**2, alpha_2 + slope, beta_2 + constant)
        second = _mean_ratio((1.0 - c) * (1.0 + c), b**2 + c**2, alpha_3 + slope, beta_3 + constant)
        bounds.append(np.asarray(2.0 * math.pi * size * b * c * (first + second)))
    return bounds[0], bounds[1]


def _mean_ratio(p: Array, q: Array, slope: Array, constant: Array) -> Array:
    """The integral of (p t^2 + q) / (slope t^2 + constant) over t from 0 to 1."""
    x = slope / constant
    quotient = arctangent_quotient(x)
    near = x < 1e-4  # (1 - atan(sqrt x) / sqrt x) / x loses its digits here
    safe = np.where(near, 1.0, x)
    square = np.where(near, 1.0 / 3.0 - x / 5.0 + x**2 / 7.0 - x**3 / 9.0, (1.0 - quotient) / safe)
    return np.asarray((p * square + q * quotient) / constant)
