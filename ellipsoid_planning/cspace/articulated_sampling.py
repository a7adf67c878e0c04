"""Drawing free configurations of articulated robots."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.kernels import articulated_sampling as kernels
from ellipsoid_planning.kernels import sampling
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot

Array = NDArray[np.float64]

_ATTEMPTS = 64


class ArticulatedSampling:
    """Draws orientation, joints and a line, and then in the line's free intervals.

    Joints are drawn until the robot keeps its parts apart, which is tested; whether it is clear of
    obstacles and inside arenas is not, but for a robot on a fixed base. With ``uniform`` the
    configurations are exactly uniform on free space; see `FreeIntervalSampling`.
    """

    def __init__(self, cspace: ArticulatedCSpace, seed: int, uniform: bool = True) -> None:
        """Prepare to draw from ``cspace``; the same ``seed`` gives the same configurations.

        Raises:
            GeometryError: if the robot is rigid, see `FreeIntervalSampling`.
        """
        if not isinstance(cspace, ArticulatedCSpace):
            raise GeometryError(
                f"expected the C-space of an articulated robot, got that of a "
                f"{type(cspace.robot).__name__}; draw from it with FreeIntervalSampling"
            )
        self._cspace = cspace
        self._uniform = uniform
        self._random = np.random.default_rng(seed)
        robot = cspace.articulated
        self._kind = base_kind(robot)
        count = kernels.BASE_NUMBERS + kernels.JOINT_NUMBERS * len(robot.moving_joints)
        self._numbers = np.empty((_ATTEMPTS, count))
        self._origin = cspace.poses(np.zeros(robot.configuration_size))[0]
        self._row = np.empty((1, len(self._origin)))

    def sample(self, out: Array) -> bool:
        """Write a free configuration to ``out`` (d,); False if 64 draws in a row were refused."""
        return self._draw(self._origin, -1.0, out)

    def sample_near(self, configuration: ArrayLike, distance: float, out: Array) -> bool:
        """Write a free configuration within ``distance`` of ``configuration`` to ``out`` (d,).

        The distance is OMPL's. Returns False if 64 draws in a row were refused.

        Raises:
            GeometryError: if the distance is negative, or it is no single configuration.
        """
        if not distance >= 0.0:
            raise GeometryError(f"expected a distance of at least 0, got {distance}")
        return self._draw(self._cspace.pose(configuration), distance, out)

    def _draw(self, near: Array, distance: float, out: Array) -> bool:
        self._random.random(out=self._numbers)
        cspace = self._cspace
        found = kernels.draw_articulated(
            cspace.scene,
            cspace.kinematics,
            self._kind,
            near,
            distance,
            self._uniform,
            self._numbers,
            self._row[0],
        )
        if found:
            out[:] = cspace.configurations(self._row)[0]
        return bool(found)


def base_kind(robot: ArticulatedRobot) -> int:
    """Which kind of base a robot has, in the words of kernels.articulated_sampling."""
    if robot.base == FIXED_BASE:
        return kernels.IMMOBILE
    if not robot.rotates:
        return sampling.FIXED
    return sampling.PLANAR if robot.dimension == 2 else sampling.SPATIAL
