"""Bounds of the volume of a Minkowski difference, beside the exact one."""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.geometry.affine import cofactors, determinants, relative_axes
from ellipsoid_planning.geometry.bound import Bound, Kind
from ellipsoid_planning.geometry.difference_volume import difference_volume
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_fits
from ellipsoid_planning.geometry.optimal_members import greatest_inner_difference
from ellipsoid_planning.geometry.rolling import rolls_freely
from ellipsoid_planning.geometry.sum_volume import UNIT_BALL, mixed_volumes


def difference_volume_bounds(arena: Ellipsoid, part: Ellipsoid) -> dict[str, Bound]:
    """Return the volume (area) of arena ⊖ part and bounds of it, by name.

    - exact: by Steiner's formula if the part rolls freely, else by quadrature;
    - steiner: that formula with changed signs, exact if the part rolls freely; else a lower
      bound in the plane (G. Matheron, 1978), and an estimate in space;
    - brunn_minkowski, upper: V^(1/n) <= V1^(1/n) - V2^(1/n);
    - offset_ellipsoid, upper (5.23); kurzhanski_ellipsoid, lower: the greatest inner member.

    Raises:
        GeometryError: if the dimensions differ or the difference is empty.
    """
    check_fits(arena, part)
    n = arena.dimension
    axes = np.maximum(relative_axes(arena, part), 1.0)
    signs = (-1.0) ** np.arange(n + 1)
    steiner = np.asarray(mixed_volumes(arena, part) @ signs)
    rolls = rolls_freely(arena, part).holds
    kind: Kind = "exact" if rolls else "lower" if n == 2 else "estimate"
    unit = float(UNIT_BALL[n] * determinants(part.matrix, cofactors(part.matrix)))
    m = greatest_inner_difference(axes)
    inner = np.prod(np.sqrt(np.maximum((1.0 - m) * (axes**2 - 1.0 / m), 0.0)))
    root = np.prod(axes) ** (1.0 / n) - 1.0
    return {
        "exact": Bound(difference_volume(arena, part), "exact", "(5.88), r < 0"),
        "steiner": Bound(steiner, kind, "(5.88), r < 0"),
        "brunn_minkowski": Bound(np.asarray(unit * root**n), "upper", "(5.34)"),
        "offset_ellipsoid": Bound(np.asarray(unit * np.prod(axes - 1.0)), "upper", "(5.23)"),
        "kurzhanski_ellipsoid": Bound(np.asarray(unit * inner), "lower", "Kurzhanski"),
    }
