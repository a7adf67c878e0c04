"""The static world: obstacles, arenas and the bounds of the robot's base position."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.naming import numbered
from ellipsoid_planning.sizes import LEAST_LENGTH, REMEDY, check_bodies, check_coordinates


@dataclass(frozen=True, eq=False)
class World:
    """Ellipsoids to stay out of, ellipsoids to stay within, and a box for the base position.

    Attributes:
        low, high: corners (n,) of the box that the robot's base position keeps to.
        obstacles: bodies that no part of the robot may meet.
        arenas: bodies each of which must contain the whole robot; none means no arena.

    Unnamed bodies are numbered. Everything is in the world frame.

    Raises:
        GeometryError: if the box is empty, the dimensions differ, or sizes are out of the range
            that scenes may have, see `ellipsoid_planning.sizes`.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    obstacles: tuple[Ellipsoid, ...] = ()
    arenas: tuple[Ellipsoid, ...] = ()

    def __post_init__(self) -> None:
        low, high = np.array(self.low, dtype=float), np.array(self.high, dtype=float)
        if low.shape not in ((2,), (3,)) or low.shape != high.shape:
            raise GeometryError(
                f"expected bounds of 2 or 3 numbers each, got shapes {low.shape} and {high.shape}"
            )
        if not (np.all(np.isfinite(low)) and np.all(np.isfinite(high)) and np.all(low < high)):
            raise GeometryError(
                f"expected finite bounds with low < high, got {low.tolist()} and {high.tolist()}"
            )
        check_coordinates((low, high), "bounds")
        if not np.all(high - low >= LEAST_LENGTH):
            raise GeometryError(
                f"expected bounds that are at least {LEAST_LENGTH:g} apart, got {low.tolist()} and "
                f"{high.tolist()}; {REMEDY}"
            )
        for field, value in (("low", low), ("high", high)):
            value.setflags(write=False)
            object.__setattr__(self, field, value)
        object.__setattr__(self, "obstacles", numbered(self.obstacles, "obstacle"))
        object.__setattr__(self, "arenas", numbered(self.arenas, "arena"))
        for body in (*self.obstacles, *self.arenas):
            if body.dimension != self.dimension:
                raise GeometryError(
                    f"expected bodies of dimension {self.dimension} as the bounds, "
                    f"but {body.name!r} has dimension {body.dimension}"
                )
        check_bodies(self.obstacles, "obstacle")
        check_bodies(self.arenas, "arena")

    @property
    def dimension(self) -> int:
        """The dimension n, 2 or 3."""
        return len(self.low)
