"""Long lists of bodies, built at once where all of them are in order.

Validating and building bodies one by one takes a thousandth of a second each. Here nothing is
explained: where anything is not as it should be, the list is left to the format's models, which
say what and where.
"""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.many_ellipsoids import many_ellipsoids
from ellipsoid_planning.orientation_forms import (
    PLANAR_FORMS,
    SPATIAL_FORMS,
)
from ellipsoid_planning.orientation_lists import rotations_from_forms
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
    names, axes, centres = [], [], []
    turned: dict[str, tuple[list[int], list[Any]]] = {}
    for index, body in enumerate(data):
        if type(body) is not dict or not body.keys() <= KEYS:
            raise _OddError
        name = body.get("name", "")
        if type(name) is not str:
            raise _OddError
        names.append(name or f"{kind} {index + 1}")
        axes.append(body["semi_axes"])
        centres.append(body.get("position", origin))
        if "orientation" in body:
            form, value = _form(body["orientation"], dimension)
            places, values = turned.setdefault(form, ([], []))
            places.append(index)
            values.append(value)
    shape = (len(names), dimension)
    rotations = np.tile(np.eye(dimension), (len(names), 1, 1))
    for form, (places, values) in turned.items():
        rotations[places] = rotations_from_forms(form, values)
    made = many_ellipsoids(
        _numbers(centres, dimension, -MOST_LENGTH).reshape(shape),
        rotations,
        _numbers(axes, dimension, LEAST_LENGTH).reshape(shape),
        names,
    )
    written = [
        (made[place], {form: value})
        for form, (places, values) in turned.items()
        for place, value in zip(places, values, strict=True)
    ]
    return made, written


def _numbers(vectors: list[Any], size: int, least: float) -> NDArray[np.float64]:
    """The numbers of lists of ``size`` ones from ``least`` to the greatest length."""
    if not set(map(type, vectors)) <= {list} or not set(map(len, vectors)) <= {size}:
        raise _OddError
    numbers = list(chain.from_iterable(vectors))
    if not set(map(type, numbers)) <= NUMBERS:
        raise _OddError
    array = np.array(numbers, dtype=float)
    if not ((array >= least) & (array <= MOST_LENGTH)).all():
        raise _OddError
    return array


def _form(orientation: Any, dimension: int) -> tuple[str, Any]:
    """The form of an orientation, and its value with numbers as floats."""
    if type(orientation) is not dict or len(orientation) != 1:
        raise _OddError
    ((form, value),) = orientation.items()
    if form not in (PLANAR_FORMS if dimension == 2 else SPATIAL_FORMS):
        raise _OddError
    if form == "yaw_deg":
        return form, _vector([value], 1)[0]
    if form == "axis_angle":
        if type(value) is not dict or value.keys() != {"axis", "angle_deg"}:
            raise _OddError
        (angle,) = _vector([value["angle_deg"]], 1)
        return form, {"axis": _vector(value["axis"], 3), "angle_deg": angle}
    return form, _vector(value, VECTOR_FORMS[form])


def _vector(value: Any, size: int) -> list[float]:
    if type(value) is not list or len(value) != size or not set(map(type, value)) <= NUMBERS:
        raise _OddError
    numbers = list(map(float, value))
    # The difference is 0 but for infinity and nan.
    if any(number - number for number in numbers):
        raise _OddError
    return numbers
