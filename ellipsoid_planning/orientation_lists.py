"""Many orientations at once, the same to the last bit as one by one in `orientation_forms`.

Products and sums of numpy's arrays round as Python's numbers do. Sines come from the same library
one by one, and scalar products from the same routine, since others may round another way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.orientation_forms import (
    UNIT_ROUNDING,
    UNIT_TOLERANCE,
    heading_from_degrees,
    quaternion_from_form,
)

Array = NDArray[np.float64]

X, Y, Z = 0, 1, 2


def rotations_from_forms(form: str, values: Sequence[Any]) -> Array:
    """Return the rotations (m, n, n) of m values of one form.

    Raises:
        GeometryError: if one of them is no orientation; take them one by one to hear of which.
    """
    if form == "yaw_deg":
        return _planar([heading_from_degrees(value) for value in values])
    return _rotations(_quaternions(form, values))


def _planar(headings: Sequence[float]) -> Array:
    rows = [(math.cos(yaw), math.sin(yaw)) for yaw in headings]
    cosines, sines = np.array(rows).T
    return np.stack([cosines, -sines, sines, cosines], axis=-1).reshape(-1, 2, 2)


def _quaternions(form: str, values: Sequence[Any]) -> Array:
    """Unit quaternions (m, 4)."""
    if form == "quaternion":
        return _unit(np.array(values, dtype=float))
    if form == "axis_angle":
        return np.array([quaternion_from_form(form, value) for value in values])
    first, second, third = zip(*values, strict=True)
    if form == "euler_zxz_deg":
        return _product(_about(Z, first), _about(X, second), _about(Z, third))
    return _product(_about(Z, third), _about(Y, second), _about(X, first))


def _unit(quaternions: Array) -> Array:
    lengths = _lengths(quaternions)
    off = np.abs(lengths - 1.0)
    if not (off <= UNIT_TOLERANCE).all():
        raise GeometryError("expected unit quaternions")
    return np.where(off <= UNIT_ROUNDING, quaternions, quaternions / lengths)


def _about(axis: int, degrees: Sequence[float]) -> Array:
    halves = [math.radians(math.remainder(value, 720.0)) / 2.0 for value in degrees]
    sines = np.array([math.sin(half) for half in halves])
    quaternions = np.empty((len(halves), 4))
    quaternions[:, :3] = sines[:, None] * np.eye(3)[axis]
    quaternions[:, 3] = [math.cos(half) for half in halves]
    return quaternions


def _product(*quaternions: Array) -> Array:
    result = quaternions[0]
    for second in quaternions[1:]:
        a, b, c, d = result.T
        x, y, z, w = second.T
        result = np.stack(
            [
                d * x + w * a + (b * z - c * y),
                d * y + w * b + (c * x - a * z),
                d * z + w * c + (a * y - b * x),
                d * w - _scalar_products(result[:, :3], second[:, :3])[:, 0],
            ],
            axis=-1,
        )
    return result / _lengths(result)


def _lengths(rows: Array) -> Array:
    return np.sqrt(_scalar_products(rows, rows))


def _scalar_products(first: Array, second: Array) -> Array:
    """Of the rows (m, k) of two arrays, (m, 1)."""
    return np.asarray(first[:, None, :] @ second[:, :, None])[:, :, 0]


def _rotations(quaternions: Array) -> Array:
    """See `geometry.orientation.rotation_from_quaternion`."""
    x, y, z, w = (quaternions / _lengths(quaternions)).T
    entries = [
        *(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        *(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        *(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    ]
    return np.stack(entries, axis=-1).reshape(-1, 3, 3)
