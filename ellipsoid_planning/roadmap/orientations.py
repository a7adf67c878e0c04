"""The orientations of a roadmap's layers."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.groups.finite_groups import icosahedral_rotations
from ellipsoid_planning.groups.quaternions import left_matrix
from ellipsoid_planning.groups.standard_grids import super_fibonacci

Array = NDArray[np.float64]

ICOSAHEDRAL_COUNT = 60


def headings(count: int) -> Array:
    """``count`` evenly spread planar orientations as quaternions (count, 4)."""
    half = np.pi * np.arange(count) / count
    zero = np.zeros(count)
    return np.column_stack([zero, zero, np.sin(half), np.cos(half)])


@cache
def spread_orientations(dimension: int, count: int) -> Array:
    """``count`` well spread orientations (count, 4), read-only.

    Headings in the plane; in space the icosahedral group at 60, else super-Fibonacci.
    """
    if dimension == 2:
        out = headings(count)
    elif count == ICOSAHEDRAL_COUNT:
        out = icosahedral_rotations()
    else:
        out = super_fibonacci(count)
    out.setflags(write=False)
    return out


def random_turn(orientations: Array, dimension: int, random: np.random.Generator) -> Array:
    """The orientations turned together by a random rotation, so that no axis is special."""
    turn = random.normal(size=4)
    if dimension == 2:
        turn[:2] = 0.0
    return np.asarray(orientations @ left_matrix(turn / np.linalg.norm(turn)).T)
