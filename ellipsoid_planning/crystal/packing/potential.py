"""The Gaussian cost GCF of a packing: how much a crystal's molecules overlap (thesis 3.4.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import erfc

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import gaussian_overlap

Array = NDArray[np.float64]

# The share of a part's overlap with itself that all copies left out may add up to.
TAIL = 1e-10
# More lattice vectors along an axis than are ever looked at.
EVERY = 1_000_000
# More copies than this for each pair of parts are refused: seconds for one value.
MOST = 1e6


@dataclass(frozen=True, eq=False)
class GaussianPotential:
    """GCF (thesis 3.13): the integral over a unit cell of the square of the density of mixtures.

    The density is the sum over all parts of all copies of the molecule, those of the lattice, too,
    which (3.13) leaves out (with m = 1 nothing would push the molecules apart). It is a sum of
    overlaps of pairs, in closed form N(μ₁ − μ₂; 0, Σ₁ + Σ₂) for each two Gaussians.

    Attributes:
        model: the molecule and its crystal.
        mixture: what stands for an ellipsoid.
        own_pairs: whether two parts of the same molecule count, and each part with itself (a
            constant). Without them it is no integral of a square any more.
        tail: what all copies left out may change GCF by, as a share of the smallest overlap of a
            part with itself.
        copies: None for all copies that matter, or N for a block of lattice vectors whose
            components are at most N, however much lies beyond it.

    Raises:
        CrystalError: if the tail is not between 0 and 1, or `copies` is negative.
    """

    model: PackingModel
    mixture: GaussianMixture
    own_pairs: bool = True
    tail: float = TAIL
    copies: int | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.tail < 1.0:
            raise CrystalError(f"expected a tail between 0 and 1, got {self.tail:g}; 1e-10, say")
        if self.copies is not None and self.copies < 0:
            raise CrystalError(f"expected copies >= 0, got {self.copies}; leave it out for all")

    def value(self, configuration: ArrayLike) -> float:
        """GCF of one configuration (K,)."""
        return float(self.values(np.asarray(configuration, dtype=float)[None])[0])

    def values(self, configurations: ArrayLike) -> Array:
        """GCF (m,) of many configurations (m, K)."""
        return self.values_and_gradients(configurations)[0]

    def value_and_gradient(self, configuration: ArrayLike) -> tuple[float, Array]:
        """GCF of a configuration (K,) and its gradient (K,), per radian and unit of length."""
        values, gradients = self.values_and_gradients(np.asarray(configuration, dtype=float)[None])
        return float(values[0]), gradients[0]

    def values_and_gradients(self, configurations: ArrayLike) -> tuple[Array, Array]:
        """GCF (m,) and gradients (m, K) of many configurations (m, K).

        Raises:
            CrystalError: if the configurations have another size, or are not finite.
        """
        given = np.ascontiguousarray(configurations, dtype=float)
        count = len(self.model.molecule.coordinates)
        if given.ndim != 2 or given.shape[1] != count or not np.all(np.isfinite(given)):
            raise CrystalError(
                f"expected configurations of {count} finite numbers, got an array {given.shape}; "
                f"the coordinates are {', '.join(self.model.keys)}"
            )
        values, gradients = np.empty(len(given)), np.empty(given.shape)
        gaussian_overlap.potentials(*self._tables, given, values, gradients)
        return values + self._constant, gradients

    @cached_property
    def reaches(self) -> Array:
        """(P, P): pairs of parts whose centres are farther apart than this are left out."""
        if self.copies is not None:
            return np.full((len(self.model.parts),) * 2, math.inf)
        radii = self._radii
        found = np.zeros((len(radii), len(radii)))
        for (i, j), _ in np.ndenumerate(found):
            squares = float(radii[i] ** 2 + radii[j] ** 2)
            found[i, j] = self._reach(squares, self._peak(i, j))
        self._check_work(float(found.max()))
        return found

    def _check_work(self, reach: float) -> None:
        n = self.model.dimension
        copies = (math.pi if n == 2 else 4.0 * math.pi / 3.0) * reach**n / self.model.cell.volume
        if copies > MOST:
            raise CrystalError(
                f"m_b = {self.mixture.spread:g} makes Gaussians so wide that {copies:.3g} "
                "copies of the cell count; enlarge m_b, or limit the copies"
            )

    @cached_property
    def truncation(self) -> float:
        """A proved bound of what the copies left out would change GCF by; infinite for a block."""
        if self.copies is not None:
            return math.inf
        pairs = len(self.model.parts) ** 2 * len(self.model.crystal[0]) ** 2
        return pairs * self._allowed

    @cached_property
    def _tables(self) -> tuple[object, ...]:
        whole, mixture, n = self.model.molecule, self.mixture, self.model.dimension
        arrays = (whole.kinds, whole.parents, whole.origins, whole.axes)
        span = EVERY if self.copies is None else self.copies
        reaches = np.minimum(self.reaches, EVERY * float(self.model.cell.lengths.min()))
        gaussians = (mixture.masses(n), mixture.exponents, reaches, span, self.own_pairs)
        crystal = self.model.crystal
        return *arrays, whole.part_frames, whole.parts, *gaussians, crystal, n == 2

    @property
    def _radii(self) -> Array:
        return np.array([float(part.semi_axes.max()) for part in self.model.parts])

    @cached_property
    def _themselves(self) -> Array:
        """(P,): the overlap of each part with itself."""
        n, (b, c) = self.model.dimension, self.mixture.exponents
        first, second = self.mixture.masses(n)
        shape = first**2 * (b / 2) ** (n / 2) + second**2 * (c / 2) ** (n / 2)
        shape += 2 * first * second * (b * c / (b + c)) ** (n / 2)
        sizes = np.array([float(np.prod(part.semi_axes)) for part in self.model.parts])
        return np.asarray(shape * (2.0 * math.pi) ** (-n / 2) / sizes)

    @property
    def _constant(self) -> float:
        """What the parts' overlaps with themselves add to GCF, whatever the configuration."""
        return float(self._themselves.sum()) * len(self.model.crystal[0]) * self.own_pairs

    @cached_property
    def _allowed(self) -> float:
        """The tail of one pair of parts and one operation; those of a cell stay in `tail`."""
        pairs = len(self.model.parts) ** 2 * len(self.model.crystal[0]) ** 2
        return self.tail * float(self._themselves.min()) / pairs

    def _peak(self, i: int, j: int) -> float:
        """A bound of the factor before the slowest exponential of two parts' overlap."""
        n = self.model.dimension
        first, second = self.model.parts[i], self.model.parts[j]
        # |Σ₁/b + Σ₂/c| is at least either's determinant alone plus the other's (Minkowski).
        root = sum(float(np.prod(p.semi_axes)) ** (2.0 / n) for p in (first, second))
        masses = np.abs(self.mixture.masses(n)).sum() ** 2
        return float(masses * (float(self.mixture.exponents.max()) / root / 2 / math.pi) ** (n / 2))

    def _reach(self, squares: float, peak: float) -> float:
        """The distance D beyond which all of a lattice's copies together stay below `_allowed`.

        Beyond D each overlap is at most peak · exp(−d² / 2λ), λ = (r₁² + r₂²) / m_b. A sum over
        lattice points is at most the integral over their cells (half a diagonal ρ around each):
        of exp(−s² / 2λ) over s = |x| − ρ > D − 2ρ.
        """
        lam = squares / self.mixture.spread
        rho = 0.5 * float(np.linalg.norm(self.model.cell.basis, axis=0).sum())

        def log_tail(reach: float) -> float:
            # Scaled by exp(s²/2λ), lest it underflow.
            s = reach - 2.0 * rho
            whole = _beyond(s, lam, rho, self.model.dimension) * peak / self.model.cell.volume
            return math.log(whole) - math.log(self._allowed)

        low, high = 2.0 * rho, 2.0 * rho + 35.0 * math.sqrt(lam)
        if log_tail(low) <= 0.0:
            return low
        return float(brentq(log_tail, low, high, xtol=1e-6 * high)) * (1.0 + 1e-5)


def _beyond(s: float, lam: float, rho: float, dimension: int) -> float:
    """The integral of exp(−t²/2λ) over the shells of radius t + ρ, t from s."""
    power = math.exp(-s * s / (2.0 * lam))
    flat = math.sqrt(math.pi * lam / 2.0) * float(erfc(s / math.sqrt(2.0 * lam)))
    if dimension == 2:
        return 2.0 * math.pi * (lam * power + rho * flat)
    squares = lam * (s * power + flat)
    return 4.0 * math.pi * (squares + 2.0 * rho * lam * power + rho * rho * flat)
