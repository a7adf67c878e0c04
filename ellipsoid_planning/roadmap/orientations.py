"""The orientations of a roadmap's layers."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ICOSAHEDRAL_COUNT = 60
# The constants of Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3)"
# (CVPR 2022): psi is the real root of psi^4 = psi + 4 near 1.53.
_PHI = math.sqrt(2.0)
_PSI = 1.533751168755204288118041


def headings(count: int) -> Array:
    """``count`` evenly spread planar orientations as quaternions (count, 4)."""
    half = np.pi * np.arange(count) / count
    zero = np.zeros(count)
    return np.column_stack([zero, zero, np.sin(half), np.cos(half)])


def icosahedral_rotations() -> Array:
    """The 60 rotations of the icosahedral group as quaternions (60, 4), one of each pair ±q."""
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    rows = list(np.vstack([np.eye(4), -np.eye(4)]))
    rows += [0.5 * np.array(s) for s in np.array(np.meshgrid(*[[1, -1]] * 4)).T.reshape(-1, 4)]
    even = [p for p in np.array(np.meshgrid(*[range(4)] * 4)).T.reshape(-1, 4) if _is_even(p)]
    for signs in np.array(np.meshgrid([1, -1], [1, -1], [1, -1])).T.reshape(-1, 3):
        values = 0.5 * np.array([golden * signs[0], signs[1], signs[2] / golden, 0.0])
        rows += [values[p] for p in even]
    unique = [row for row in rows if row[np.flatnonzero(np.abs(row) > 1e-9)[-1]] > 0.0]
    return np.unique(np.round(unique, 15), axis=0)


def _is_even(permutation: NDArray[np.int64]) -> bool:
    if len(set(permutation.tolist())) < len(permutation):
        return False
    return bool(np.linalg.det(np.eye(len(permutation))[permutation]) > 0.0)


def super_fibonacci(count: int) -> Array:
    """``count`` well spread rotations as quaternions (count, 4), deterministic (Alexa 2022)."""
    s = np.arange(count) + 0.5
    radius, other = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    alpha, beta = 2.0 * np.pi * s / _PHI, 2.0 * np.pi * s / _PSI
    return np.column_stack(
        [
            radius * np.sin(alpha),
            radius * np.cos(alpha),
            other * np.sin(beta),
            other * np.cos(beta),
        ]
    )


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
    x, y, z, w = turn / np.linalg.norm(turn)
    left = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    return np.asarray(orientations @ left.T)
