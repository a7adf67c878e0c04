"""Cubic and body-centred lattices in the exponential coordinates of a Voronoi cell."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.quaternions import exponential
from ellipsoid_planning.groups.voronoi import VoronoiCell

Array = NDArray[np.float64]

# Lattice points in a cube of edge 1. The cubic lattice straddles the identity, which puts more
# nodes into small cells; the body-centred one has it for a node.
_OFFSETS = {
    "cubic": np.array([[0.5, 0.5, 0.5]]),
    "bcc": np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 0.5]]),
}
LATTICES = tuple(_OFFSETS)


@dataclass(frozen=True, eq=False)
class LatticeLevels:
    """How many lattice points a cell has at every edge of the lattice's cube.

    Attributes:
        counts: the counts there are (k,), rising.
        steps: (k + 1,) falling: the cell has counts[i] points for steps[i + 1] < step <= steps[i].
    """

    counts: NDArray[np.int64]
    steps: Array

    def step(self, count: int, equal_volume: float) -> float:
        """An edge [rad] at which the cell has ``count`` points, near ``equal_volume``."""
        where = int(np.searchsorted(self.counts, count))
        largest, least = self.steps[where], self.steps[where + 1]
        inside = 0.05 * (min(largest, 2.0 * least) - least)
        return float(np.clip(equal_volume, least + inside, min(largest, 2.0 * least) - inside))


def _points(lattice: str, steps: int) -> Array:
    if lattice not in _OFFSETS:
        raise GridError(f"unknown lattice {lattice!r}; known are {', '.join(LATTICES)}")
    axis = np.arange(-steps, steps + 1)
    cubes = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    return (cubes + _OFFSETS[lattice]).reshape(-1, 3)


def points_per_cube(lattice: str) -> int:
    """How many points of the lattice a cube of its edge has."""
    return len(_OFFSETS[lattice]) if lattice in _OFFSETS else len(_points(lattice, 0))


def lattice_nodes(cell: VoronoiCell, lattice: str, step: float) -> Array:
    """The rotations (m, 4) of the closed cell on a lattice whose cube has the edge ``step`` [rad].

    Raises:
        GridError: the lattice is unknown.
    """
    points = step * _points(lattice, math.ceil(cell.circumradius / step) + 1)
    points = points[np.linalg.norm(points, axis=1) <= cell.circumradius * (1.0 + 1e-12)]
    rotations = exponential(points)
    return rotations[cell.contains(rotations, 1e-12)]


def lattice_levels(cell: VoronoiCell, lattice: str, count: int) -> LatticeLevels:
    """The levels of a lattice in a cell up to a few beyond ``count`` points."""
    least = 0.6 * (cell.volume * points_per_cube(lattice) / max(count, 1)) ** (1.0 / 3.0)
    points = _points(lattice, math.ceil(cell.circumradius / least) + 1)
    length = np.linalg.norm(points, axis=1)
    safe = np.where(length > 0.0, length, 1.0)
    largest = np.where(length > 0.0, cell.reach(points / safe[:, None]) / safe, np.inf)
    largest = -np.sort(-largest[largest > least])
    falls = np.flatnonzero(np.diff(largest) < -1e-9 * largest[1:]) + 1
    ends = np.append(falls, len(largest))
    steps = np.append(largest[ends - 1], least)
    return LatticeLevels(ends.astype(np.int64), steps)
