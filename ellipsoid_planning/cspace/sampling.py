"""Drawing only free configurations, with no collision check."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.poses import configurations_from_poses, poses
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.kernels import sampling
from ellipsoid_planning.robots.rigid import RigidRobot

Array = NDArray[np.float64]

_ATTEMPTS = 64


class FreeIntervalSampling:
    """Draws an orientation and a line, computes the line's free intervals, and draws in them.

    With ``uniform`` the configurations are exactly uniform on free space (with a clearance: on
    the part of it that the intervals know, see kernels.lines). Without, places that are narrow
    along a line are favoured, which is what a roadmap wants; the line's axis is random then.
    """

    def __init__(self, cspace: CSpace, seed: int, uniform: bool = True) -> None:
        """Prepare to draw from ``cspace``; the same ``seed`` gives the same configurations.

        Raises:
            GeometryError: if the robot is articulated, see `ArticulatedSampling`.
        """
        if not isinstance(cspace.robot, RigidRobot):
            raise GeometryError(
                f"expected the C-space of a rigid robot, got that of an "
                f"{type(cspace.robot).__name__}; draw from it with ArticulatedSampling"
            )
        self._cspace = cspace
        self._uniform = uniform
        self._random = np.random.default_rng(seed)
        self._numbers = np.empty((_ATTEMPTS, sampling.NUMBERS))
        self._pose = np.empty((1, 7))
        robot = cspace.robot
        self._kind = sampling.FIXED
        if robot.rotates:
            self._kind = sampling.PLANAR if robot.dimension == 2 else sampling.SPATIAL
        self._origin = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        if not robot.rotates:
            self._origin = poses(robot, np.zeros(robot.dimension))[0]

    def sample(self, out: Array) -> bool:
        """Write a free configuration to ``out`` (d,); False if 64 lines in a row were refused."""
        return self._draw(self._origin, -1.0, out)

    def sample_near(self, configuration: ArrayLike, distance: float, out: Array) -> bool:
        """Write a free configuration within ``distance`` of ``configuration`` to ``out`` (d,).

        The distance is OMPL's. Returns False if 64 lines in a row were refused.

        Raises:
            GeometryError: if the distance is negative, or it is no single configuration.
        """
        if not distance >= 0.0:
            raise GeometryError(f"expected a distance of at least 0, got {distance}")
        return self._draw(self._cspace.pose(configuration), distance, out)

    def _draw(self, near: Array, distance: float, out: Array) -> bool:
        self._random.random(out=self._numbers)
        found = sampling.draw_free(
            self._cspace.scene,
            self._kind,
            near,
            distance,
            self._uniform,
            self._numbers,
            self._pose[0],
        )
        if found:
            out[:] = configurations_from_poses(self._cspace.robot, self._pose)[0]
        return bool(found)
