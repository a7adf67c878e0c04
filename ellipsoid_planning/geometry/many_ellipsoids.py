"""Many ellipsoids at once, for worlds of thousands of bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import LEAST_SIZE, MOST_SIZE, Ellipsoid
from ellipsoid_planning.geometry.orientation import ORTHONORMALITY_TOLERANCE

Array = NDArray[np.float64]


def many_ellipsoids(
    centres: ArrayLike, rotations: ArrayLike, semi_axes: ArrayLike, names: Sequence[str]
) -> tuple[Ellipsoid, ...]:
    """Build m ellipsoids, the same as one by one, in a hundredth of the time.

    Args:
        centres: (m, n).
        rotations: (m, n, n).
        semi_axes: (m, n).
        names: of each.

    Raises:
        GeometryError: if the shapes do not agree, or numbers describe no ellipsoid; build them one
            by one to hear of which.
    """
    at, turns, axes = (np.array(given, dtype=float) for given in (centres, rotations, semi_axes))
    m, n = len(names), axes.shape[-1]
    if n not in (2, 3) or (axes.shape, at.shape, turns.shape) != ((m, n), (m, n), (m, n, n)):
        raise GeometryError(
            f"expected {m} centres, rotations and semi-axes of one dimension, got shapes "
            f"{at.shape}, {turns.shape} and {axes.shape}"
        )
    _check(at, turns, axes)
    for array in (at, turns, axes):
        array.setflags(write=False)
    return tuple(map(_unchecked, at, turns, axes, names))


def _check(centres: Array, rotations: Array, semi_axes: Array) -> None:
    sizes = (semi_axes >= LEAST_SIZE) & (semi_axes <= MOST_SIZE)
    if not (sizes.all() and (np.abs(centres) <= MOST_SIZE).all()):
        raise GeometryError(
            f"expected semi-axes from {LEAST_SIZE:g} to {MOST_SIZE:g} and centres within the latter"
        )
    products = np.swapaxes(rotations, 1, 2) @ rotations
    off = np.abs(products - np.eye(semi_axes.shape[1]))
    if not ((off <= ORTHONORMALITY_TOLERANCE).all() and (np.linalg.det(rotations) > 0.0).all()):
        raise GeometryError("expected rotations")


def _unchecked(centre: Array, rotation: Array, semi_axes: Array, name: str) -> Ellipsoid:
    body = object.__new__(Ellipsoid)
    vars(body).update(centre=centre, rotation=rotation, semi_axes=semi_axes, name=name)
    return body
