"""Dense checks in plain numpy, the simplest alternative: many directions, many surface points.

They are no proofs: with m directions a gap is missed, and with m points a protrusion.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

DIRECTIONS = 2000


def sphere(count: int = DIRECTIONS) -> Array:
    """Unit vectors (count, 3) on a golden spiral."""
    k = np.arange(count) + 0.5
    height, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    radius = np.sqrt(1.0 - height**2)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])


def support(body: Ellipsoid, directions: Array) -> Array:
    """|Aᵀu| for every direction, shape (m,): the support function without the centre."""
    return np.linalg.norm(directions @ body.matrix, axis=1)


def gap(first: Ellipsoid, second: Ellipsoid, directions: Array) -> float:
    """The largest u·c − |A₁ᵀu| − |A₂ᵀu| over the directions."""
    values = directions @ (second.centre - first.centre)
    values -= support(first, directions) + support(second, directions)
    return float(values.max())


def is_inside(part: Ellipsoid, arena: Ellipsoid, directions: Array) -> bool:
    """Whether all sampled surface points of the part lie in the arena."""
    points = directions @ part.matrix.T + (part.centre - arena.centre)
    local = points @ (arena.rotation / arena.semi_axes)
    return bool((local * local).sum(axis=1).max() <= 1.0)


class DenseScene:
    """Obstacles and arenas with all that does not depend on the robot computed beforehand."""

    def __init__(self, world: World, directions: Array) -> None:
        """Tabulate u·c + |Aᵀu| of every obstacle."""
        self._directions, self._arenas = directions, world.arenas
        columns = [directions @ b.centre + support(b, directions) for b in world.obstacles]
        self._reach = np.array(columns).reshape(-1, len(directions))

    def is_free(self, bodies: tuple[Ellipsoid, ...]) -> bool:
        """Whether no body meets an obstacle or leaves an arena, as far as can be seen."""
        for body in bodies:
            if not all(is_inside(body, arena, self._directions) for arena in self._arenas):
                return False
            low = self._directions @ body.centre - support(body, self._directions)
            if not ((low - self._reach).max(axis=1) > 0.0).all():
                return False
        return True
