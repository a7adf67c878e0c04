"""Planar scenes as thin solids in space; spatial scenes as they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.geometry.orientation import quaternion_from_rotation

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.geometry import Ellipsoid


@dataclass(frozen=True)
class Slab:
    """The heights between which a planar body is drawn, in units of the thickness."""

    bottom: float
    top: float


FLOOR = Slab(-1.0, 0.0)
SOLID = Slab(0.0, 2.0)
ABOVE = Slab(0.0, 2.6)  # the moving robot, seen over its own start and goal
STILL_JOINTS = Slab(1.9, 1.9)
JOINTS = Slab(2.5, 2.5)
LINES = Slab(2.6, 3.4)  # the path and the roadmap, seen over the bodies


@dataclass(frozen=True)
class Embedding:
    """Maps bodies and points of an n-dimensional scenario into the space that is drawn.

    Attributes:
        dimension: n, 2 or 3.
        thickness: of a planar body [the scenario's unit of length]; not used in 3-D.
    """

    dimension: int
    thickness: float

    def matrix(self, body: Ellipsoid, slab: Slab) -> NDArray[np.float64]:
        """Return the (4, 4) map from the unit shape to the body.

        The unit shape is the unit ball in 3-D. In 2-D it is meshcat's cylinder of radius and
        height 1 about the y axis, which becomes a disc from the slab's bottom to its top.
        """
        matrix = np.eye(4)
        if self.dimension == 3:
            matrix[:3, :3], matrix[:3, 3] = body.matrix, body.centre
            return matrix
        upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        stretch = np.eye(3)
        stretch[:2, :2] = body.matrix
        stretch[2, 2] = self.thickness * (slab.top - slab.bottom)
        matrix[:3, :3] = stretch @ upright
        matrix[:2, 3] = body.centre
        matrix[2, 3] = self.thickness * 0.5 * (slab.bottom + slab.top)
        return matrix

    def points(self, positions: ArrayLike, slab: Slab = LINES) -> NDArray[np.float64]:
        """Return positions (m, n) as points (m, 3), in 2-D at the middle of the slab."""
        flat = np.atleast_2d(np.asarray(positions, dtype=float))
        if self.dimension == 3:
            return flat
        height = self.thickness * 0.5 * (slab.bottom + slab.top)
        return np.column_stack([flat, np.full(len(flat), height)])

    def pose(
        self, position: NDArray[np.float64], rotation: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the position (3,) and the (x, y, z, w) of a pose (n,), (n, n), on the floor."""
        n = self.dimension
        point, turned = np.zeros(3), np.eye(3)
        point[:n], turned[:n, :n] = position, rotation
        return point, quaternion_from_rotation(turned)


def outline(body: Ellipsoid, count: int = 96) -> NDArray[np.float64]:
    """Return the closed boundary polygon of an ellipse, (count, 2), evenly spaced in angle."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.asarray(body.centre + np.column_stack([np.cos(angle), np.sin(angle)]) @ body.matrix.T)
