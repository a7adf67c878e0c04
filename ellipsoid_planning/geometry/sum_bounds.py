"""Bounds and estimates of the volume of a Minkowski sum (thesis 5.4.3, 5.4.4).

All replace the perimeter, or the surface and the total mean curvature, in Steiner's formula for
the first body where the second is the unit ball. Exchanging the bodies changes them, but not
the exact volume. The exponents of (5.78) and (5.83) are n, not 1/n.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry import intrinsic_estimates as estimates
from ellipsoid_planning.geometry.affine import (
    Body,
    cofactors,
    determinants,
    matrices_of,
    relative_axes,
)
from ellipsoid_planning.geometry.bound import Bound, Kind
from ellipsoid_planning.geometry.optimal_members import least_outer_sum
from ellipsoid_planning.geometry.sum_volume import UNIT_BALL, sum_volume

Array = NDArray[np.float64]


def sum_volume_bounds(first: Body, second: Body) -> dict[str, Bound]:
    """Return the exact volume (area) of first ⊕ second and every bound and estimate, by name.

    - exact; brunn_minkowski (5.78, 5.83), lower;
    - lower, upper (5.79, 5.80; 5.84, 5.85): by the best bounds of L, or of F and M;
    - arithmetic_mean, geometric_mean (5.90, 5.91) of these, estimates;
    - estimate: Ramanujan's L (5.92), or Thomsen's F (5.93) and M_est (5.94);
    - in space also lower_exact_surface, upper_exact_surface (5.86, 5.87): exact F, bounds of M;
      upper_cauchy_schwarz: as upper with F_ub1 (5.75) alone;
    - offset_ellipsoid (5.23), lower: the volume of the ellipsoid with semi-axes a' + r;
      gaussian_ellipsoid (5.33) and kurzhanski_ellipsoid, the least of its family, upper.

    Args:
        first: an `Ellipsoid`, or matrices A1 (..., n, n).
        second: likewise, the body that is made the unit ball.
    """
    axes = relative_axes(first, second)
    one, two = matrices_of(first, second)
    det_one, det_two = (determinants(matrix, cofactors(matrix)) for matrix in (one, two))
    n = axes.shape[-1]
    ball = UNIT_BALL[n]
    root = (ball * det_one) ** (1.0 / n) + (ball * det_two) ** (1.0 / n)
    ends = ball * (np.prod(axes, axis=-1) + 1.0)
    middles = _plane(axes) if n == 2 else _space(axes)
    values: dict[str, Bound] = {
        "exact": Bound(sum_volume(one, two), "exact", "(5.81)" if n == 2 else "(5.88)"),
        "brunn_minkowski": Bound(root**n, "lower", "(5.78)" if n == 2 else "(5.83)"),
    }
    for name, (middle, kind, source) in middles.items():
        values[name] = Bound(np.asarray(det_two * (ends + middle)), kind, source)
    low, high = values["lower"].value, values["upper"].value
    values["arithmetic_mean"] = Bound(0.5 * (low + high), "estimate", "(5.90)")
    values["geometric_mean"] = Bound(np.sqrt(low * high), "estimate", "(5.91)")
    unit = ball * det_two
    return values | {name: _scaled(bound, unit) for name, bound in _ellipsoids(axes).items()}


def _ellipsoids(axes: Array) -> dict[str, Bound]:
    """Products of semi-axes of approximating ellipsoids where the second body is the unit ball."""
    p = least_outer_sum(axes)[..., None]
    return {
        "offset_ellipsoid": Bound(np.prod(axes + 1.0, axis=-1), "lower", "(5.23)"),
        "gaussian_ellipsoid": Bound(
            np.prod(math.sqrt(2.0) * np.hypot(axes, 1.0), axis=-1), "upper", "(5.33)"
        ),
        "kurzhanski_ellipsoid": Bound(
            np.prod(np.sqrt(1.0 + p) * np.hypot(axes / np.sqrt(p), 1.0), axis=-1),
            "upper",
            "Kurzhanski",
        ),
    }


def _scaled(bound: Bound, factor: Array) -> Bound:
    return Bound(np.asarray(bound.value * factor), bound.kind, bound.source)


def _plane(axes: Array) -> dict[str, tuple[Array, Kind, str]]:
    length = estimates.perimeter_bounds(axes)
    return {
        "lower": (length["isoperimetric"].value, "lower", "(5.79)"),
        "upper": (length["legendre"].value, "upper", "(5.80)"),
        "estimate": (length["ramanujan"].value, "estimate", "(5.92)"),
    }


def _space(axes: Array) -> dict[str, tuple[Array, Kind, str]]:
    surface = {k: v.value for k, v in estimates.surface_bounds(axes).items()}
    bend = {k: v.value for k, v in estimates.mean_curvature_bounds(axes).items()}
    exact = surface["exact"]
    return {
        "lower": (surface["lower"] + bend["lower"], "lower", "(5.84)"),
        "upper": (surface["upper"] + bend["upper"], "upper", "(5.85)"),
        "upper_cauchy_schwarz": (surface["cauchy_schwarz"] + bend["upper"], "upper", "(5.75)"),
        "lower_exact_surface": (exact + bend["lower"], "lower", "(5.86)"),
        "upper_exact_surface": (exact + bend["upper"], "upper", "(5.87)"),
        "estimate": (surface["thomsen"] + bend["estimate"], "estimate", "(5.93), (5.94)"),
    }
