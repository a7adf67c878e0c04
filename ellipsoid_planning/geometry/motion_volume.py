"""Volumes of motions: closed forms where they hold, quadrature over rotations elsewhere.

A motion is a translation times a rotation of the moving body; the volume integrates that of
the Minkowski sum (motions that meet) or difference (motions that stay inside) over rotations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.affine import relative_axes
from ellipsoid_planning.geometry.difference_volume import difference_volume
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.kinematic import containment_formula, principal_formula
from ellipsoid_planning.geometry.minkowski import check_same_dimension
from ellipsoid_planning.geometry.rolling import rolls_at_every_orientation
from ellipsoid_planning.geometry.rotation_ranges import RotationRange, all_rotations
from ellipsoid_planning.geometry.sum_volume import sum_volume

Array = NDArray[np.float64]
COUNTS = {2: (360, 720), 3: (12, 18)}  # of angles, coarse and fine
ORDER = 12


@dataclass(frozen=True, eq=False)
class MotionVolume:
    """The volume of a set of motions.

    Attributes:
        value: in lengths^n times radians (n = 2) or the measure of SO(3), 8 pi^2 in all (n = 3).
        method: "closed form" or "quadrature".
        error: an estimate of the absolute error of quadrature from two resolutions; 0 for closed
            forms, nan where a given range of rotations leaves it unknown.
    """

    value: float
    method: Literal["closed form", "quadrature"]
    error: float = 0.0


def meeting_motions(
    fixed: Ellipsoid, moving: Ellipsoid, rotations: RotationRange | None = None
) -> MotionVolume:
    """Return the volume of the motions with which `moving` meets `fixed`.

    Args:
        fixed: an ellipsoid.
        moving: another of the same dimension, at its orientation before it is rotated.
        rotations: a restricted range; None for all, by (5.95), (5.96).

    Raises:
        GeometryError: if the dimensions differ.
    """
    check_same_dimension(fixed, moving)
    if rotations is None:
        exact = principal_formula(fixed.semi_axes, moving.semi_axes)
        return MotionVolume(float(exact), "closed form")
    volumes = sum_volume(fixed.matrix, rotations.turned(moving))
    return _over(volumes, rotations, exact=True)


def contained_motions(
    outer: Ellipsoid, inner: Ellipsoid, rotations: RotationRange | None = None
) -> MotionVolume:
    """Return the volume of the motions that keep `inner` inside `outer`.

    Args:
        outer: an ellipsoid.
        inner: another of the same dimension, at its orientation before it is rotated.
        rotations: a restricted range; None for all: by (5.97), (5.98) if the inner body rolls
            freely at every orientation, else by quadrature.

    Raises:
        GeometryError: if the dimensions differ.
    """
    check_same_dimension(outer, inner)
    if rotations is not None:
        placed = rotations.turned(inner)
        rolls = bool(np.all(_roll(outer, placed)))
        return _over(difference_volume(outer, placed), rotations, exact=rolls)
    if rolls_at_every_orientation(outer.semi_axes, inner.semi_axes):
        exact = containment_formula(outer.semi_axes, inner.semi_axes)
        return MotionVolume(float(exact), "closed form")
    one, two = np.diag(outer.semi_axes), np.diag(inner.semi_axes)
    values = []
    for count in COUNTS[outer.dimension]:
        every = all_rotations(outer.dimension, count)
        volumes = difference_volume(one, every.rotations @ two, ORDER)
        values.append(float(volumes @ every.weights))
    return MotionVolume(values[1], "quadrature", abs(values[1] - values[0]))


def _over(volumes: Array, rotations: RotationRange, *, exact: bool) -> MotionVolume:
    """Integrate over rotations; a single one keeps what is known about its volume."""
    value = float(volumes @ rotations.weights)
    if len(rotations.weights) > 1:
        return MotionVolume(value, "quadrature", float("nan"))
    return MotionVolume(
        value, "closed form" if exact else "quadrature", 0.0 if exact else float("nan")
    )


def _roll(outer: Ellipsoid, inner: Array) -> NDArray[np.bool_]:
    axes = relative_axes(outer, inner)
    return np.asarray(axes[..., -1] ** 2 >= axes[..., 0])
