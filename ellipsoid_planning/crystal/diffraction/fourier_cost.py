"""The Fourier cost FCF of the thesis' equation (3.8): how far a model is from given magnitudes.

(3.8) integrates over a ball of reciprocal space. A crystal's transform lives on the reciprocal
lattice, so that the integral is a sum; a reflection counts as often as the ball has pairs
(h, -h) of its kind. All is left in the magnitudes' unit:

    FCF(q) = √( Σ_h multiplicity_h (|F_target(h)| − k |F_q(h)|)² ).

The factor k is 1, or, for magnitudes with a scale of their own, the one that makes FCF smallest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes
from ellipsoid_planning.crystal.diffraction.structure_factors import StructureFactors
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.kernels import structure_factors as kernels

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FourierCost:
    """FCF of a model's configurations against magnitudes.

    Attributes:
        model: the packing model.
        magnitudes: the target's, at R reflections.
        scaled: whether the model's magnitudes are brought to the target's scale by the best k.
    """

    model: PackingModel
    magnitudes: Magnitudes
    scaled: bool = False

    @cached_property
    def structure(self) -> StructureFactors:
        """The model's structure factors at the target's reflections."""
        return StructureFactors(self.model, self.magnitudes.reflections)

    @cached_property
    def weights(self) -> Array:
        """(R,), the reflections' multiplicities."""
        weights = self.magnitudes.reflections.multiplicities.astype(float)
        weights.setflags(write=False)
        return weights

    @cached_property
    def norm(self) -> float:
        """√(Σ multiplicity |F_target|²), the cost of an empty cell: a unit to judge costs by."""
        return float(np.sqrt(np.sum(self.weights * self.magnitudes.values**2)))

    def value(self, configuration: ArrayLike) -> float:
        """FCF of a configuration (K,)."""
        return float(self.values(np.asarray(configuration, dtype=float)[None])[0])

    def values(self, configurations: ArrayLike) -> Array:
        """FCF (m,) of configurations (m, K). Lets go of Python's lock.

        Raises:
            CrystalError: if their size is another, or a value is not finite.
        """
        checked = self.structure.checked(configurations)
        costs = np.empty(len(checked))
        kernels.misfits(
            self.structure.molecule,
            self.structure.planar,
            checked,
            self.structure.table,
            self.magnitudes.values,
            self.weights,
            self.scaled,
            costs,
        )
        return costs

    def value_and_gradient(self, configuration: ArrayLike) -> tuple[float, Array]:
        """FCF of a configuration (K,), and its gradient (K,); 0 where FCF is 0, its minimum."""
        residuals, jacobian = self.residuals_and_jacobian(configuration)
        cost = float(np.linalg.norm(residuals))
        if cost == 0.0:
            return 0.0, np.zeros(jacobian.shape[1])
        return cost, jacobian.T @ residuals / cost

    def residuals(self, configuration: ArrayLike) -> Array:
        """(R,), √multiplicity (|F_target| − k |F|): FCF is their norm."""
        sizes = self.structure.magnitudes(np.asarray(configuration, dtype=float)[None])[0]
        return np.sqrt(self.weights) * (self.magnitudes.values - self._scale(sizes) * sizes)

    def jacobian(self, configuration: ArrayLike) -> Array:
        """(R, K), the derivatives of `residuals`, that of k included."""
        return self.residuals_and_jacobian(configuration)[1]

    def residuals_and_jacobian(self, configuration: ArrayLike) -> tuple[Array, Array]:
        """`residuals` (R,) and `jacobian` (R, K) at the price of one of them."""
        sizes, rates = self.structure.magnitudes_and_rates(configuration)
        scale, target, weights = self._scale(sizes), self.magnitudes.values, self.weights
        change = scale * rates
        own = float(weights @ sizes**2)
        if self.scaled and own > 0.0:
            slope = (weights * (target - 2.0 * scale * sizes)) @ rates / own
            change += np.outer(sizes, slope)
        root = np.sqrt(weights)
        return root * (target - scale * sizes), -root[:, None] * change

    def scale(self, configuration: ArrayLike) -> float:
        """The factor k at a configuration (K,)."""
        return self._scale(self.structure.magnitudes(np.asarray(configuration)[None])[0])

    def correlations(self, configurations: ArrayLike) -> Array:
        """(m,), correlation coefficients of the magnitudes of configurations (m, K), weighted.

        1 for the target itself, whatever the scale; 0 where the magnitudes are all alike.
        """
        weights = self.weights / self.weights.sum()
        sizes = self.structure.magnitudes(configurations)
        sizes -= (sizes @ weights)[:, None]
        target = self.magnitudes.values - weights @ self.magnitudes.values
        mixed = sizes @ (weights * target)
        length = np.sqrt((sizes**2 @ weights) * (weights @ target**2))
        return np.divide(mixed, length, out=np.zeros_like(mixed), where=length > 0.0)

    def _scale(self, sizes: Array) -> float:
        if not self.scaled:
            return 1.0
        return float(kernels.best_scale(sizes, self.magnitudes.values, self.weights))
