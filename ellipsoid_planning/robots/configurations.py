"""Configurations that come from outside: arrays of the right shape, of finite numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError

Array = NDArray[np.float64]

_MOST_SHOWN = 60


def checked_configuration(values: ArrayLike, size: int) -> Array:
    """One configuration (d,) as an array of its own, d = ``size``.

    Raises:
        GeometryError: if it has another shape, or is not made of finite numbers.
    """
    found = as_numbers(values, f"a configuration of {size} finite numbers")
    if found.shape != (size,):
        raise GeometryError(
            f"expected a configuration of {size} finite numbers, got shape {found.shape}"
            + ("; are_valid and the like take rows" if found.ndim == 2 else "")
        )
    if not np.isfinite(found).all():
        raise GeometryError(
            f"expected a configuration of {size} finite numbers, got {found.tolist()}"
        )
    return found.copy()


def checked_configurations(values: ArrayLike, size: int) -> Array:
    """Configurations (m, d), d = ``size``; a single one (d,) is taken for (1, d).

    Raises:
        GeometryError: if they have another shape, or are not made of finite numbers.
    """
    found = np.atleast_2d(as_numbers(values, f"configurations of {size} finite numbers"))
    if found.ndim != 2 or found.shape[1] != size:
        raise GeometryError(
            f"expected configurations of {size} finite numbers, shape (m, {size}) or ({size},), "
            f"got shape {np.shape(values)}"
        )
    finite = np.isfinite(found)
    if not finite.all():
        row = int(np.flatnonzero(~finite.all(axis=1))[0])
        raise GeometryError(
            f"expected configurations of {size} finite numbers, got {found[row].tolist()} in row "
            f"{row}"
        )
    return found


def as_numbers(values: ArrayLike, expected: str) -> Array:
    """The values as float64; text, booleans and complex numbers are no numbers here.

    Raises:
        GeometryError: if they are not numbers; ``expected`` says what they should have been.
    """
    try:
        found: NDArray[Any] = np.asarray(values)
    except ValueError:  # rows of different lengths
        found = np.empty(0, dtype=object)
    if found.dtype.kind not in "iuf":
        shown = repr(values)
        shown = shown if len(shown) <= _MOST_SHOWN else shown[:_MOST_SHOWN] + "..."
        raise GeometryError(f"expected {expected}, got {shown}")
    return found.astype(np.float64, copy=False)
