"""What every robot has, rigid or articulated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.joint import Joint


class Robot(Protocol):
    """A union of ellipsoids that a configuration (d,) places in the world."""

    @property
    def parts(self) -> tuple[Ellipsoid, ...]:
        """The ellipsoids, each in the frame of the link that it is fixed to."""

    @property
    def orientation(self) -> NDArray[np.float64] | None:
        """(n, n), base to world, of a base that does not rotate."""

    @property
    def dimension(self) -> int:
        """The dimension n of the world, 2 or 3."""

    @property
    def rotates(self) -> bool:
        """Whether the base rotates."""

    @property
    def configuration_size(self) -> int:
        """The length d of a configuration."""

    @property
    def base_size(self) -> int:
        """How many numbers of a configuration place the base; 0 if it is fixed."""

    @property
    def root(self) -> str:
        """Name of the link that is the base."""

    @property
    def part_links(self) -> tuple[str, ...]:
        """The name of each part's link, in the order of ``parts``."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints between the links, none of a rigid robot."""

    @property
    def joint_slices(self) -> Mapping[str, slice]:
        """Where the values of each moving joint stand in a configuration, by name."""

    def link_poses(
        self, configuration: ArrayLike
    ) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Position (n,) and rotation (n, n) of every link's frame in the world, by name."""

    def pose(self, configuration: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Base position (n,) and rotation (n, n) of a configuration (d,)."""

    def bodies_at(self, configuration: ArrayLike) -> tuple[Ellipsoid, ...]:
        """The parts in the world frame at a configuration (d,)."""
