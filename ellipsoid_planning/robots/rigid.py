"""Rigid robots: finite unions of ellipsoids that move together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.naming import numbered
from ellipsoid_planning.geometry.orientation import (
    check_rotation,
    rotation_from_quaternion,
    rotation_from_yaw,
)
from ellipsoid_planning.robots.configurations import checked_configuration
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.sizes import check_bodies

BASE_LINK = "base"


@dataclass(frozen=True, eq=False)
class RigidRobot:
    """A union of ellipsoids fixed to one base frame, free to turn or only to translate.

    A configuration is a flat array: [x, y, yaw] (yaw in rad) in the plane, [x, y, z, qx, qy,
    qz, qw] in space, and the position alone when the robot does not rotate.

    Attributes:
        parts: the ellipsoids in the base frame, at least one; unnamed ones are numbered.
        rotates: False for a robot that only translates.
        orientation: (n, n), base frame to world frame, of a robot that does not rotate;
            the identity by default. A rotating robot has none.

    Raises:
        GeometryError: if there is no part, the dimensions differ, or sizes are out of the range
            that scenes may have, see `ellipsoid_planning.sizes`.
    """

    parts: tuple[Ellipsoid, ...]
    rotates: bool = True
    orientation: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", numbered(self.parts, "part"))
        if not self.parts:
            raise GeometryError("expected a robot of at least one part, got none")
        dimensions = {part.dimension for part in self.parts}
        if len(dimensions) > 1:
            raise GeometryError(f"expected parts of one dimension, got {sorted(dimensions)}")
        check_bodies(self.parts, "part")
        if self.rotates and self.orientation is not None:
            raise GeometryError("a rotating robot has no fixed orientation; set rotates to False")
        if not self.rotates:
            self._fix_orientation()

    def _fix_orientation(self) -> None:
        given = np.eye(self.dimension) if self.orientation is None else self.orientation
        orientation = check_rotation(given, self.dimension)
        orientation.setflags(write=False)
        object.__setattr__(self, "orientation", orientation)

    @property
    def dimension(self) -> int:
        """The dimension n of the robot's world, 2 or 3."""
        return self.parts[0].dimension

    @property
    def configuration_size(self) -> int:
        """The length d of a configuration: n, or 3 (plane) and 7 (space) when rotating."""
        if not self.rotates:
            return self.dimension
        return 3 if self.dimension == 2 else 7

    @property
    def base_size(self) -> int:
        """How many numbers of a configuration place the base: all of them."""
        return self.configuration_size

    @property
    def root(self) -> str:
        """Name of the one link, which all parts are fixed to."""
        return BASE_LINK

    @property
    def part_links(self) -> tuple[str, ...]:
        """The name of each part's link."""
        return (BASE_LINK,) * len(self.parts)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """None."""
        return ()

    @property
    def joint_slices(self) -> Mapping[str, slice]:
        """Where the values of each joint stand in a configuration: nowhere."""
        return MappingProxyType({})

    def link_poses(
        self, configuration: ArrayLike
    ) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """The base pose, by the name of the one link."""
        return {BASE_LINK: self.pose(configuration)}

    def pose(self, configuration: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the base position (n,) and rotation (n, n), base to world, of a configuration.

        A quaternion of any positive length is taken for the rotation it points at.

        Raises:
            GeometryError: if it is no single configuration of finite numbers.
        """
        values = checked_configuration(configuration, self.configuration_size)
        return values[: self.dimension], self._rotation(values)

    def _rotation(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        if self.orientation is not None:
            return self.orientation
        if self.dimension == 2:
            return rotation_from_yaw(float(values[2]))
        return rotation_from_quaternion(values[3:])

    def bodies_at(self, configuration: ArrayLike) -> tuple[Ellipsoid, ...]:
        """Return the parts in the world frame at a configuration (d,)."""
        position, rotation = self.pose(configuration)
        return tuple(part.transform(rotation, position) for part in self.parts)


def check_rigid(robot: Any) -> None:
    """Refuse what is not a rigid robot, an articulated one above all.

    Raises:
        GeometryError: if it is none.
    """
    if not isinstance(robot, RigidRobot):
        raise GeometryError(
            f"expected a RigidRobot, got {type(robot).__name__}; CSpace(world, robot) knows the "
            "poses and motions of every robot"
        )
