"""Which rotations are near which: k-d trees of unit quaternions, where distance is a chord."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.groups.quaternions import chord_of_angle

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


def both_signs(quaternions: Array) -> Array:
    """The quaternions (n, 4) and then their negatives, which are the same rotations, (2 n, 4)."""
    return np.vstack([quaternions, -quaternions])


def tree_of(quaternions: Array) -> cKDTree:
    """A k-d tree of quaternions (n, 4)."""
    from scipy.spatial import cKDTree

    return cKDTree(quaternions)


def pairs_within(first: cKDTree, second: cKDTree, radius: float) -> tuple[Indices, Indices]:
    """The pairs of nodes of two trees that are at most ``radius`` [rad] apart as rotations."""
    chord = chord_of_angle(min(radius, math.pi)) * (1.0 + 1e-12) + 1e-12
    found = first.sparse_distance_matrix(second, chord, output_type="ndarray")
    return found["i"].astype(np.intp), found["j"].astype(np.intp)
