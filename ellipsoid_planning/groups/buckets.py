"""Nearest nodes in constant time: boxes of a cell, each with the few nodes that can be nearest."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.groups.nearby import both_signs, tree_of
from ellipsoid_planning.groups.quaternions import angle_of_chord, exponential, logarithm
from ellipsoid_planning.groups.voronoi import VoronoiCell

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_BLOCK = 20_000
_MOST_BOXES = 200_000
_FIRST_GUESS = 32


class Buckets:
    """Boxes of exponential coordinates over a Voronoi cell, with candidates.

    A node that is nearest to some rotation of a box is at most the box's diameter farther from
    the box's centre than the node nearest to that centre. Exponential coordinates never measure
    less than twice the chord of quaternions, so that this is exact.

    Attributes:
        reach: the largest distance [rad] of a candidate from a box's centre.
    """

    def __init__(self, cell: VoronoiCell, nodes: Array, spacing: float) -> None:
        """Sort nodes (n, 4), which must reach far enough around the cell, into boxes."""
        self._nodes = nodes
        self._low = -cell.circumradius * (1.0 + 1e-9)
        fewest = math.ceil(-2.0 * self._low / spacing)
        self._side = min(max(fewest, 1), round(_MOST_BOXES ** (1.0 / 3.0)))
        self._width = -2.0 * self._low / self._side
        axis = self._low + self._width * (np.arange(self._side) + 0.5)
        centres = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
        half_diagonal = 0.25 * math.sqrt(3.0) * self._width  # as a chord of quaternions
        used = cell.contains(exponential(centres), 2.0 * half_diagonal)
        used |= np.linalg.norm(centres, axis=1) > math.pi - math.sqrt(3.0) * self._width
        self._row = np.where(used, np.cumsum(used) - 1, 0)
        self._candidates, reach = _candidates(
            exponential(centres[used]), nodes, 2.0 * half_diagonal
        )
        self.reach = float(angle_of_chord(reach))

    def nearest(self, rotations: Array) -> Indices:
        """Which node is nearest to each of the rotations (m, 4) in the cell."""
        out = np.empty(len(rotations), dtype=np.intp)
        for first in range(0, len(rotations), _BLOCK):
            part = rotations[first : first + _BLOCK]
            among = self._candidates[self._row[self._box(part)]]
            overlap = np.abs(np.einsum("mkd,md->mk", self._nodes[among], part))
            out[first : first + _BLOCK] = among[np.arange(len(part)), overlap.argmax(axis=1)]
        return out

    def _box(self, rotations: Array) -> Indices:
        steps = np.floor((logarithm(rotations) - self._low) / self._width).astype(np.intp)
        steps = np.clip(steps, 0, self._side - 1)
        return (steps[:, 0] * self._side + steps[:, 1]) * self._side + steps[:, 2]


def _candidates(centres: Array, nodes: Array, slack: float) -> tuple[Indices, float]:
    """The nodes (boxes, k) that can be nearest, and the largest distance (a chord) of one."""
    tree = tree_of(both_signs(nodes))
    wanted = min(_FIRST_GUESS, 2 * len(nodes))
    while True:
        chord, found = tree.query(centres, k=np.arange(1, wanted + 1))
        limit = chord[:, :1] + slack * (1.0 + 1e-9)
        inside = chord <= limit
        if wanted == 2 * len(nodes) or not np.any(inside[:, -1]):
            break
        wanted = min(2 * wanted, 2 * len(nodes))
    most = int(inside.sum(axis=1).max())
    inside, found = inside[:, :most], found[:, :most]
    kept = np.where(inside, found, found[:, :1]) % len(nodes)
    return kept, float(limit.max())
