"""Kinematic formulas: how large is the set of motions with which a body meets, or fits?

Motions are measured by translations times rotations with the usual measures: all of SO(2) has
2 pi, all of SO(3) has 8 pi^2. In one orientation ("translative") they are volumes of a Minkowski
sum and a difference.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.intrinsic import (
    area,
    checked_axes,
    mean_curvature,
    perimeter,
    surface_area,
    volume,
)

Array = NDArray[np.float64]
ALL_ROTATIONS = {2: 2.0 * math.pi, 3: 8.0 * math.pi**2}


def principal_formula(first_axes: ArrayLike, second_axes: ArrayLike) -> Array:
    """Return the measure (...) of the rigid motions with which two ellipsoids meet.

    Blaschke's and Santaló's principal kinematic formula, thesis eq. (5.95) and (5.96), always
    exact.

    Args:
        first_axes: semi-axes (..., n), n = 2 or 3.
        second_axes: semi-axes (..., n).
    """
    one, two = _pair(first_axes, second_axes)
    if one.shape[-1] == 2:
        mixed = perimeter(one) * perimeter(two)
        return np.asarray(2.0 * math.pi * (area(one) + area(two)) + mixed)
    mixed = surface_area(one) * mean_curvature(two) + surface_area(two) * mean_curvature(one)
    return np.asarray(8.0 * math.pi**2 * (volume(one) + volume(two)) + 2.0 * math.pi * mixed)


def containment_formula(outer_axes: ArrayLike, inner_axes: ArrayLike) -> Array:
    """Return the measure (...) of the rigid motions that keep one ellipsoid inside another.

    Thesis eq. (5.97) and (5.98), exact where the inner body rolls freely in the outer one at
    every orientation (`rolls_at_every_orientation`). Where it does not, the value means little;
    use `contained_motions`, which integrates then.

    Args:
        outer_axes: semi-axes (..., n), n = 2 or 3.
        inner_axes: semi-axes (..., n).
    """
    outer, inner = _pair(outer_axes, inner_axes)
    if outer.shape[-1] == 2:
        mixed = perimeter(outer) * perimeter(inner)
        return np.asarray(2.0 * math.pi * (area(outer) + area(inner)) - mixed)
    mixed = surface_area(inner) * mean_curvature(outer) - surface_area(outer) * mean_curvature(
        inner
    )
    return np.asarray(8.0 * math.pi**2 * (volume(outer) - volume(inner)) + 2.0 * math.pi * mixed)


def _pair(first_axes: ArrayLike, second_axes: ArrayLike) -> tuple[Array, Array]:
    one, two = checked_axes(first_axes), checked_axes(second_axes)
    if one.shape[-1] != two.shape[-1]:
        raise GeometryError(
            f"expected two bodies of one dimension, got {one.shape[-1]} and {two.shape[-1]}"
        )
    return one, two
