"""The ways in which a scenario file writes an orientation, read and written without loss.

In the plane: ``yaw_deg``. In space: ``quaternion`` (x, y, z, w); ``rpy_deg``, roll, pitch and yaw
about the fixed x, y and z axes in this order, R = Rz(yaw) Ry(pitch) Rx(roll); ``axis_angle``;
``euler_zxz_deg``, R = Rz(alpha) Rx(beta) Rz(gamma) (thesis eq. 2.19). Angles are in degrees in
files and in radians here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.orientation import (
    normalised_heading,
    quaternion_from_rotation,
    rotation_from_quaternion,
    rotation_from_yaw,
    yaw_from_rotation,
)

PLANAR_FORMS = ("yaw_deg",)
SPATIAL_FORMS = ("quaternion", "rpy_deg", "axis_angle", "euler_zxz_deg")
UNIT_TOLERANCE = 1e-3
UNIT_ROUNDING = 4.0 * float(np.finfo(float).eps)
NEIGHBOURS = 8
TINY = 1e-100
_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def heading_from_degrees(degrees: float) -> float:
    """Return the heading in [-pi, pi) [rad] of an angle in degrees."""
    # The remainder of degrees is exact, that of radians is not.
    inside = -180.0 < degrees <= 180.0
    return normalised_heading(math.radians(degrees if inside else math.remainder(degrees, 360.0)))


def unit_quaternion(quaternion: ArrayLike) -> NDArray[np.float64]:
    """Return the quaternion (x, y, z, w) at unit length.

    Its bits are kept when it is unit to rounding, so that written ones read back as they were.

    Raises:
        GeometryError: if its length differs from 1 by more than 1e-3.
    """
    values = np.array(quaternion, dtype=float)
    length = math.sqrt(values.dot(values))
    if not abs(length - 1.0) <= UNIT_TOLERANCE:
        raise GeometryError(
            f"expected a unit quaternion [x, y, z, w], got {_plain(values)} "
            f"of length {length:.6g}; divide it by its length"
        )
    return values if abs(length - 1.0) <= UNIT_ROUNDING else values / length


def quaternion_from_form(form: str, value: Any) -> NDArray[np.float64]:
    """Return the unit quaternion (x, y, z, w) of a spatial form's value.

    Raises:
        GeometryError: if a quaternion or a rotation axis is far from what it should be.
    """
    if form == "quaternion":
        return unit_quaternion(value)
    if form == "axis_angle":
        return _about(_unit_axis(value["axis"]), value["angle_deg"])
    first, second, third = value
    if form == "euler_zxz_deg":
        return _product(_about(_Z, first), _about(_X, second), _about(_Z, third))
    return _product(_about(_Z, third), _about(_Y, second), _about(_X, first))


def rotation_from_form(form: str, value: Any) -> NDArray[np.float64]:
    """Return the (2, 2) rotation of ``yaw_deg`` or the (3, 3) rotation of a spatial form."""
    if form == "yaw_deg":
        return rotation_from_yaw(heading_from_degrees(value))
    return rotation_from_quaternion(quaternion_from_form(form, value))


def form_of_heading(yaw: float) -> dict[str, Any]:
    """Return ``{"yaw_deg": …}`` that reads back as the heading `yaw` [rad].

    It does so to the last bit wherever degrees in double precision can.
    """
    for degrees in _degree_candidates(yaw):
        if heading_from_degrees(degrees) == yaw:
            return {"yaw_deg": degrees}
    return {"yaw_deg": math.degrees(yaw)}


def degrees_from_radians(angle: float) -> float:
    """Return degrees that `math.radians` makes the angle [rad] again, turns included.

    It does so to the last bit wherever degrees in double precision can.
    """
    for degrees in _degree_candidates(angle):
        if math.radians(degrees) == angle:
            return degrees
    return math.degrees(angle)


def form_of_rotation(rotation: NDArray[np.float64]) -> dict[str, Any]:
    """Return the form that reads back as a rotation (n, n): yaw_deg in 2-D, quaternion in 3-D."""
    if len(rotation) == 3:
        return {"quaternion": quaternion_from_rotation(rotation).tolist()}
    yaw = yaw_from_rotation(rotation)
    for degrees in _degree_candidates(yaw):
        if np.array_equal(rotation_from_yaw(heading_from_degrees(degrees)), rotation):
            return {"yaw_deg": degrees}
    return {"yaw_deg": math.degrees(yaw)}


def _degree_candidates(yaw: float) -> Iterator[float]:
    """Yield angles in degrees at or beside `yaw` [rad], the shortest decimals first."""
    degrees = math.degrees(yaw)
    for decimals in range(14):
        yield round(degrees, decimals) + 0.0
    yield degrees
    above = below = degrees
    for _ in range(NEIGHBOURS):
        above, below = math.nextafter(above, math.inf), math.nextafter(below, -math.inf)
        yield above
        yield below


def _about(axis: Sequence[float], degrees: float) -> NDArray[np.float64]:
    half = math.radians(math.remainder(degrees, 720.0)) / 2.0
    sine = math.sin(half)
    return np.array([sine * axis[0], sine * axis[1], sine * axis[2], math.cos(half)])


def _unit_axis(axis: Sequence[float]) -> list[float]:
    values = np.array(axis, dtype=float)
    largest = float(np.max(np.abs(values)))
    if 0.0 < largest < math.inf and not TINY < largest < 1.0 / TINY:
        values /= largest  # squares of its numbers would vanish, or overflow
    length = float(np.linalg.norm(values))
    if not 0.0 < length < math.inf:
        raise GeometryError(f"expected a rotation axis other than zero, got {_plain(values)}")
    unit: list[float] = (values / length).tolist()
    return unit


def _product(*quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """The product of unit quaternions, in numbers of Python: numpy's take ten times as long."""
    result = quaternions[0]
    for second in quaternions[1:]:
        a, b, c, d = result.tolist()
        x, y, z, w = second.tolist()
        inner = float(result[:3] @ second[:3])
        result = np.array(
            [
                d * x + w * a + (b * z - c * y),
                d * y + w * b + (c * x - a * z),
                d * z + w * c + (a * y - b * x),
                d * w - inner,
            ]
        )
    return result / math.sqrt(result.dot(result))


def _plain(values: NDArray[np.float64]) -> str:
    return "[" + ", ".join(f"{value:.10g}" for value in values) + "]"
