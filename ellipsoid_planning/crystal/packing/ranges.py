"""The values that a search gives each coordinate of a molecule."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import CrystalError

Array = NDArray[np.float64]

MOST = 10**7  # values of one range; a search never needs as many

# A step that fits the range but for this share of it, fits: 30° into 180° in radians, say.
FITS = 1e-6


@dataclass(frozen=True, eq=False)
class Range:
    """An interval of one coordinate, cut into equal steps.

    Attributes:
        lower, upper: the interval's ends, angles in [rad].
        step: the width of a step, at most the interval's.
        values: (m,), the grid's values: the steps' centres or their ends, read-only.
    """

    lower: float
    upper: float
    step: float
    values: Array

    @classmethod
    def of(cls, lower: float, upper: float, step: float, nodes: str = "centres") -> Range:
        """The range from ``lower`` to ``upper``; ``nodes`` is ``centres`` or ``ends``.

        Raises:
            CrystalError: if the interval is empty, or no whole number of steps long.
        """
        if lower == upper:
            half = 0.5 * step
            raise CrystalError(
                f"expected lower < upper, got {lower:g} twice; for this value alone write lower: "
                f"{lower - half:g}, upper: {lower + half:g}, step: {step:g}"
            )
        if not lower < upper:
            raise CrystalError(
                f"expected lower < upper, got {lower:g} and {upper:g}; exchange or correct them"
            )
        if not (upper - lower) / step <= MOST:
            raise CrystalError(
                f"expected at most {MOST} steps, got {(upper - lower) / step:.3g}; choose a larger "
                f"step than {step:g}"
            )
        count = round((upper - lower) / step)
        if count < 1 or abs(count * step - (upper - lower)) > FITS * (upper - lower):
            raise CrystalError(
                f"expected a step that divides the range of {upper - lower:g}, got {step:g}; "
                f"write {(upper - lower) / max(count, 1):g}, say"
            )
        inside = np.arange(count) + 0.5 if nodes == "centres" else np.arange(count + 1.0)
        values: Array = np.asarray(lower + inside * ((upper - lower) / count), dtype=float)
        values.setflags(write=False)
        return cls(float(lower), float(upper), (upper - lower) / count, values)

    @classmethod
    def fixed(cls, value: float) -> Range:
        """One value only."""
        values = np.array([float(value)])
        values.setflags(write=False)
        return cls(float(value), float(value), 0.0, values)

    def scaled(self, unit: float) -> Range:
        """The range in another unit, π/180 to come from degrees to radians."""
        values = self.values * unit
        values.setflags(write=False)
        return Range(self.lower * unit, self.upper * unit, self.step * unit, values)

    @property
    def cells(self) -> Array:
        """(m, 2), the steps' ends: where a search cell by cell stays; one point if fixed."""
        if self.step == 0.0:
            return np.array([[self.lower, self.upper]])
        count = round((self.upper - self.lower) / self.step)
        edges = np.linspace(self.lower, self.upper, count + 1)
        return np.stack([edges[:-1], edges[1:]], axis=1)
