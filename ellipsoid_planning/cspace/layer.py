"""A layer of the C-space: everything but translation is fixed (thesis 6.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import lines, whitening
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

# Pairs of bodies that a layer remembers; a line meets few of a large world's.
_MOST_WHITENED = 1 << 14


class Layer:
    """The free space of one orientation, looked at along sweep lines.

    What a line needs to know of a pair of bodies is computed once and remembered.

    Attributes:
        rotation: base frame to world frame, shape (n, n).
    """

    def __init__(
        self,
        world: World,
        scene: Array,
        rotation: Array,
        placed: Array,
        bodies: tuple[Ellipsoid, ...],
    ) -> None:
        """Prepare the layer of ``rotation`` (n, n).

        ``placed`` (k, PLACED) and ``bodies`` (k,) are the robot's parts with its base at 0.
        """
        self.rotation = rotation
        self._world, self._scene = world, scene
        self._placed, self._bodies = placed, bodies
        others = len(world.obstacles) + len(world.arenas)
        rows = min(max(len(bodies) * others, 1), _MOST_WHITENED)
        self._table = np.empty((rows, whitening.WHITEN))
        self._keys = np.full(rows, -1, dtype=np.int64)
        self._scratch = np.empty((1, 9))

    def free_intervals(self, position: ArrayLike, axis: int = -1) -> Array:
        """Free intervals (k, 2) of the line through ``position`` (n,) along ``axis``.

        They are values of the base's swept coordinate, sorted; every base position in them is
        provably free at the clearance asked for. The swept coordinate of ``position`` is ignored.

        Raises:
            GeometryError: if the position or the axis does not fit the dimension.
        """
        n = self._world.dimension
        point = np.zeros(3)
        values = np.asarray(position, dtype=float)
        if values.shape != (n,) or not -n <= axis < n:
            raise GeometryError(
                f"expected a position of {n} numbers and an axis in [{-n}, {n}), "
                f"got shape {values.shape} and axis {axis}"
            )
        point[:n] = values
        cache = (self._table, self._keys, self._scratch)
        room = lines.CAPACITY
        while True:
            out = np.empty((room, 2))
            count = lines.free_intervals(
                self._scene, self._placed, 0, *cache, axis % n, *point, out
            )
            # A full table may have cost free space.
            if count < room:
                return out[:count]
            room *= 2

    def obstacle_pairs(self) -> tuple[tuple[Ellipsoid, Ellipsoid], ...]:
        """Pairs (obstacle, part) whose Minkowski sum, part centred at 0, is a C-obstacle.

        The obstacle is moved by minus the part's offset, so that the C-obstacle stands where the
        base position must not be; the part is rotated and centred at the origin.
        """
        return self._pairs(self._world.obstacles)

    def arena_pairs(self) -> tuple[tuple[Ellipsoid, Ellipsoid], ...]:
        """Pairs (arena, part) whose Minkowski difference must hold the base position."""
        return self._pairs(self._world.arenas)

    def _pairs(self, bodies: tuple[Ellipsoid, ...]) -> tuple[tuple[Ellipsoid, Ellipsoid], ...]:
        n = self._world.dimension
        pairs = []
        for part in self._bodies:
            turned = Ellipsoid(np.zeros(n), part.rotation, part.semi_axes, part.name)
            for body in bodies:
                moved = Ellipsoid(
                    body.centre - part.centre, body.rotation, body.semi_axes, body.name
                )
                pairs.append((moved, turned))
        return tuple(pairs)
