"""Slow and plain twins of what the grids compute."""

import numpy as np

from ellipsoid_planning.groups.quaternions import random_rotations


def angles(first, second):
    """All angles [rad] between (m, 4) and (n, 4), by traces."""
    return 2.0 * np.arccos(np.minimum(np.abs(first @ second.T), 1.0))


def probes(count=4000, seed=5):
    return random_rotations(count, seed)


def brute_neighbours(rotations, index, radius):
    away = angles(rotations[index][None], rotations)[0]
    found = np.flatnonzero(away <= radius)
    return found[found != index]


def rotation_matrix(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
