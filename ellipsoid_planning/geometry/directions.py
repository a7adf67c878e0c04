"""Evenly spread unit vectors on the circle and on the sphere."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError

GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))


def unit_directions(dimension: int, count: int) -> NDArray[np.float64]:
    """Return `count` unit vectors, shape (count, dimension), dimension 2 or 3.

    On the circle they are equally spaced from the first axis on, anticlockwise; on the
    sphere they form the Fibonacci lattice.
    """
    if count < 1:
        raise GeometryError(f"expected at least one direction, got {count}")
    if dimension == 2:
        angles = np.arange(count) * (2.0 * math.pi / count)
        return np.column_stack([np.cos(angles), np.sin(angles)])
    if dimension != 3:
        raise GeometryError(f"expected dimension 2 or 3, got {dimension}")
    index = np.arange(count)
    height = 1.0 - (2.0 * index + 1.0) / count
    radius = np.sqrt((1.0 - height) * (1.0 + height))
    angles = index * GOLDEN_ANGLE
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), height])
