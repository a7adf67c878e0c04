"""What a seed draws: the same numbers for the same family and seed, at every clearance."""

from __future__ import annotations

import math
import zlib

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.orientation import rotation_from_quaternion, rotation_from_yaw

Array = NDArray[np.float64]


class Draws:
    """Random numbers of a seed; without one, the usual values of the canonical scene.

    Every method takes the usual value first and returns it when there is no seed.
    """

    def __init__(self, family: str, seed: int | None) -> None:
        # Families with the same seed shall not share their scenes.
        salt = zlib.crc32(family.encode())
        self._generator = None if seed is None else np.random.default_rng([salt, seed])

    @property
    def canonical(self) -> bool:
        """Whether there is no seed."""
        return self._generator is None

    def number(self, usual: float, low: float, high: float) -> float:
        """A number, uniform between two others."""
        return usual if self._generator is None else float(self._generator.uniform(low, high))

    def integer(self, usual: int, low: int, high: int) -> int:
        """A whole number, uniform from low to high, both included."""
        return usual if self._generator is None else int(self._generator.integers(low, high + 1))

    def sign(self, usual: float = 1.0) -> float:
        """One or minus one."""
        return usual if self._generator is None else float(self._generator.choice([-1.0, 1.0]))

    def vector(self, usual: Array, reach: float) -> Array:
        """A vector (n,), uniform in the cube of half-width `reach` about zero."""
        if self._generator is None:
            return usual
        return self._generator.uniform(-reach, reach, len(usual))

    def rotation(self, usual: Array) -> Array:
        """A rotation (n, n), uniform over all of them."""
        if self._generator is None:
            return usual
        if len(usual) == 2:
            return rotation_from_yaw(float(self._generator.uniform(-math.pi, math.pi)))
        return rotation_from_quaternion(self._generator.standard_normal(4))
