"""Mixtures of Gaussians that stand for ellipsoids: flat inside, quick to drop (thesis 3.4.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

RATIOS_A = (3.0, -1.0)
RATIOS_B = (1.0, 3.0)


LARGEST_SPREAD = 1e6


@dataclass(frozen=True)
class GaussianMixture:
    """The mixture ψ(x; a, b) of thesis (3.11) with a = m_a [3, −1] and b = m_b [1, 3].

    For an ellipsoid of matrix A, with Σ = A Aᵀ, ψ(x) is the sum of
    a_k exp(−b_k (x − μ)ᵀ Σ⁻¹ (x − μ) / 2) / ((2π)^(n/2) |Σ|^(1/2)). Its integral is 1 for every
    ellipsoid, because m_a = m_b^(n/2) / (3 − 3^(−n/2)).

    Attributes:
        spread: m_b, above 0 and at most 1e6. The larger, the narrower the Gaussians.

    Raises:
        CrystalError: if m_b is not in its range.
    """

    spread: float

    def __post_init__(self) -> None:
        if not 0.0 < self.spread <= LARGEST_SPREAD:
            raise CrystalError(
                f"expected 0 < m_b <= {LARGEST_SPREAD:g}, got {self.spread:g}; 0.2 is the thesis' "
                "value in the plane"
            )

    @property
    def exponents(self) -> Array:
        """b, (2,)."""
        return self.spread * np.array(RATIOS_B)

    def amplitudes(self, dimension: int) -> Array:
        """a, (2,), for ellipsoids of a dimension (1 for the thesis' Fig. 3.4)."""
        scale = self.spread ** (dimension / 2.0) / (3.0 - 3.0 ** (-dimension / 2.0))
        return scale * np.array(RATIOS_A)

    def masses(self, dimension: int) -> Array:
        """The integrals (2,) of the two Gaussians; their sum is 1."""
        return self.amplitudes(dimension) * self.exponents ** (-dimension / 2.0)

    def density(self, ellipsoid: Ellipsoid, points: ArrayLike) -> Array:
        """ψ of an ellipsoid at points (..., n)."""
        n = ellipsoid.dimension
        offsets = np.asarray(points, dtype=float) - ellipsoid.centre
        squares = ((offsets @ ellipsoid.rotation / ellipsoid.semi_axes) ** 2).sum(axis=-1)
        scale = (2.0 * math.pi) ** (n / 2.0) * float(np.prod(ellipsoid.semi_axes))
        terms = zip(self.amplitudes(n), self.exponents, strict=True)
        return sum((a * np.exp(-0.5 * b * squares) for a, b in terms), np.zeros(())) / scale
