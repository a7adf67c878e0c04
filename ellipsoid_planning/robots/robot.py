"""What every robot has, rigid or articulated."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid


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

    def pose(self, configuration: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Base position (n,) and rotation (n, n) of a configuration (d,)."""

    def bodies_at(self, configuration: ArrayLike) -> tuple[Ellipsoid, ...]:
        """The parts in the world frame at a configuration (d,)."""
