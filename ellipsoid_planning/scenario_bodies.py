"""Long lists of bodies, built at once where all of them are in order.

Validating and building bodies one by one takes a thousandth of a second each. Here nothing is
explained: where anything is not as it should be, the list is left to the format's models, which
say what and where.
"""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.many_ellipsoids import many_ellipsoids
from ellipsoid_planning.geometry.orientation import rotation_from_quaternion, rotation_from_yaw
from ellipsoid_planning.orientation_forms import (
    PLANAR_FORMS,
    SPATIAL_FORMS,
    heading_from_degrees,
    quaternion_from_form,
)
from ellipsoid_planning.sizes import LEAST_LENGTH, MOST_LENGTH

KEYS = frozenset({"name", "semi_axes", "position", "orientation"})
VECTOR_FORMS = {"quaternion": 4, "rpy_deg": 3, "euler_zxz_deg": 3}
NUMBERS = frozenset({float, int})


class _OddError(Exception):
    """Something that the format's models have to look at."""


QuickBodies = tuple[tuple[Ellipsoid, ...], list[tuple[Ellipsoid, dict[str, Any]]]]


def quick_bodies(data: Any, dimension: Any, kind: str) -> QuickBodies | None:
    """The ellipsoids of a list in the scenario format, and orientations as they were written.

    Args:
        data: the list as it was read.
        dimension: of the document.
        kind: what bodies without a name are called, with a number.

    Returns:
        None where the list has to be validated entry by entry.
    """
    if type(data) is not list or type(dimension) is not int or dimension not in (2, 3):
        return None
    try:
        return _bodies(data, dimension, kind)
    except (_OddError, GeometryError, KeyError, TypeError, ValueError, OverflowError):
        return None


def _bodies(data: list[Any], dimension: int, kind: str) -> QuickBodies:
    origin = [0.0] * dimension
    straight = np.eye(dimension)
    names, axes, centres, turns, written = [], [], [], [], []
    for index, body in enumerate(data, start=1):
        if type(body) is not dict or not body.keys() <= KEYS:
            raise _OddError
        name = body.get("name", "")
        if type(name) is not str:
            raise _OddError
        names.append(name or f"{kind} {index}")
        axes.append(body["semi_axes"])
        centres.append(body.get("position", origin))
        form = _form(body["orientation"], dimension) if "orientation" in body else {}
        written.append(form)
        turns.append(_rotation(form) if form else straight)
    _check_numbers(axes, dimension, LEAST_LENGTH)
    _check_numbers(centres, dimension, -MOST_LENGTH)
    shape = (len(names), dimension)
    made = many_ellipsoids(
        np.array(centres, dtype=float).reshape(shape),
        np.array(turns, dtype=float).reshape(*shape, dimension),
        np.array(axes, dtype=float).reshape(shape),
        names,
    )
    return made, [(body, form) for body, form in zip(made, written, strict=True) if form]


def _check_numbers(vectors: list[Any], size: int, least: float) -> None:
    """Check lists of ``size`` numbers from ``least`` to the greatest length."""
    if not set(map(type, vectors)) <= {list} or not set(map(len, vectors)) <= {size}:
        raise _OddError
    numbers = list(chain.from_iterable(vectors))
    if not set(map(type, numbers)) <= NUMBERS:
        raise _OddError
    array = np.array(numbers, dtype=float)
    if not ((array >= least) & (array <= MOST_LENGTH)).all():
        raise _OddError


def _form(orientation: Any, dimension: int) -> dict[str, Any]:
    """An orientation as it was written, its numbers as floats."""
    if type(orientation) is not dict or len(orientation) != 1:
        raise _OddError
    ((form, value),) = orientation.items()
    if form not in (PLANAR_FORMS if dimension == 2 else SPATIAL_FORMS):
        raise _OddError
    if form == "yaw_deg":
        return {form: _number(value)}
    if form == "axis_angle":
        if type(value) is not dict or value.keys() != {"axis", "angle_deg"}:
            raise _OddError
        angle = _number(value["angle_deg"])
        return {form: {"axis": _vector(value["axis"], 3), "angle_deg": angle}}
    return {form: _vector(value, VECTOR_FORMS[form])}


def _rotation(form: dict[str, Any]) -> Any:
    ((kind, value),) = form.items()
    if kind == "yaw_deg":
        return rotation_from_yaw(heading_from_degrees(value))
    return rotation_from_quaternion(quaternion_from_form(kind, value))


def _vector(value: Any, size: int) -> list[float]:
    if type(value) is not list or len(value) != size:
        raise _OddError
    return [_number(number) for number in value]


def _number(value: Any) -> float:
    # The difference is 0 but for infinity and nan.
    if type(value) not in NUMBERS or value - value != 0:
        raise _OddError
    return float(value)
