"""The part of a C-space around some place: the same decisions with fewer bodies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.packing import scene_within
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.rigid import check_rigid
from ellipsoid_planning.world import World

Array = NDArray[np.float64]


class LocalCSpace(CSpace):
    """A C-space whose base positions are confined to a box, made from a larger one.

    Bodies that the robot cannot come near to from within the box are left out, so that its size
    and what it costs to look at, whole sweep lines included, depend on the box and not on the
    world. Whatever is proved in it holds in the whole.
    """

    def __init__(self, whole: CSpace, low: ArrayLike, high: ArrayLike) -> None:
        """Confine base positions to the bounds within the box from ``low`` to ``high`` (n,).

        Raises:
            GeometryError: if nothing of the bounds is in the box, or the robot is articulated.
        """
        check_rigid(whole.robot)
        self.robot, self.clearance_required = whole.robot, whole.clearance_required
        self._low, self._high = np.zeros(3), np.zeros(3)
        n = whole.dimension
        self._low[:n] = np.maximum(whole.world.low, low)
        self._high[:n] = np.minimum(whole.world.high, high)
        reach = float(layout.part_rows(whole.scene)[:, layout.PART_REACH].max())
        # Bodies that were left out are farther away than this.
        self._horizon = self.clearance_required + reach
        self.scene, members = scene_within(whole.scene, self._low, self._high, self._horizon)
        kept = tuple(whole.world.obstacles[k] for k in members)
        self.world = World(self._low[:n], self._high[:n], kept, whole.world.arenas)

    def clearance(self, configuration: ArrayLike) -> float:
        """As of the whole C-space, but no more than what is known of bodies that were left out."""
        position = self.pose(configuration)[:3]
        beyond = np.maximum(0.0, np.maximum(self._low - position, position - self._high))
        known = self._horizon - float(np.linalg.norm(beyond))
        found = super().clearance(configuration)
        return min(found, known) if math.isfinite(known) else found

    def motion_clearance(self, first: ArrayLike, second: ArrayLike) -> float:
        """As of the whole C-space, but no more than what is known of bodies that were left out."""
        return min(super().motion_clearance(first, second), self._horizon)
