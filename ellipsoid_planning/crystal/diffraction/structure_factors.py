"""Structure factors of packing models in closed form: unions of ellipsoids under a space group."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.reflections import (
    Reflections,
    friedel_signs,
    unique_reflections,
)
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import structure_factors as kernels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

# Coefficients of terms that cancel: they are sums of few roots of unity, far larger or zero.
CANCELLED = 1e-9


def reflections_of(model: PackingModel) -> Reflections:
    """The reflections that the model's resolution reaches, each set of equivalent ones once."""
    return unique_reflections(model.cell, model.group, model.resolution)


def structure_factors(
    model: PackingModel, configurations: ArrayLike, reflections: Reflections
) -> Complex:
    """The structure factors F(h) = ∫ density(x) exp(2πi h·x) dx over the cell.

    Parts that overlap count twice there. Use `StructureFactors` where they are wanted often.

    Args:
        model: the packing model.
        configurations: (K,) or (m, K), angles [rad].
        reflections: R of them.

    Returns:
        (R,) or (m, R), complex [density · volume, area in the plane].

    Raises:
        CrystalError: if a configuration has another size or is not finite.
    """
    whole = StructureFactors(model, reflections)
    values = np.asarray(configurations, dtype=float)
    return whole.factors(values) if values.ndim > 1 else whole.factors(values[None])[0]


@dataclass(frozen=True, eq=False)
class StructureFactors:
    """The structure factors of one model at given reflections, prepared for many configurations.

    Attributes:
        model: the packing model.
        reflections: R of them.
    """

    model: PackingModel
    reflections: Reflections

    @property
    def planar(self) -> bool:
        """Whether the parts are ellipses."""
        return self.model.dimension == 2

    @cached_property
    def weights(self) -> Array:
        """(P,), density · det A of each part."""
        volumes = [float(np.prod(part.semi_axes)) for part in self.model.parts]
        return self.model.molecule.densities * np.array(volumes)

    @cached_property
    def molecule(self) -> tuple[NDArray[np.generic], ...]:
        """The molecule's arrays for kernels.structure_factors."""
        whole = self.model.molecule
        chain = (whole.kinds, whole.parents, whole.origins, whole.axes)
        return *chain, whole.part_frames, whole.parts, self.weights

    @cached_property
    def table(self) -> tuple[NDArray[np.generic], ...]:
        """Spots and terms for kernels.structure_factors."""
        indices, firsts, spots, terms = _terms(self.model.group, self.reflections.indices)
        vectors = np.zeros((3, len(indices)))
        vectors[: self.model.dimension] = self.model.cell.reciprocal @ indices.T
        return vectors, firsts, spots, terms

    @cached_property
    def carried(self) -> NDArray[np.bool_]:
        """(K, P), which parts each coordinate moves."""
        whole = self.model.molecule
        moved = np.zeros((len(whole.coordinates), len(whole.part_frames)), bool)
        for part, frame in enumerate(whole.part_frames):
            while frame >= 0:
                moved[frame, part] = True
                frame = whole.parents[frame]  # noqa: PLW2901 -- walks up the chain
        return moved

    def factors(self, configurations: ArrayLike) -> Complex:
        """Structure factors (m, R) of configurations (m, K)."""
        values = self.checked(configurations)
        parts = np.empty((len(values), 2, len(self.reflections)))
        kernels.structure_factors(self.molecule, self.planar, values, self.table, parts)
        return parts[:, 0] + 1j * parts[:, 1]

    def magnitudes(self, configurations: ArrayLike) -> Array:
        """Their magnitudes |F|, (m, R)."""
        return _sizes(self.factors(configurations))

    def factors_and_rates(self, configuration: ArrayLike) -> tuple[Complex, Complex]:
        """Structure factors (R,) of a configuration (K,), and their derivatives (R, K)."""
        values = self.checked(np.asarray(configuration, dtype=float)[None])[0]
        factors = np.empty((2, len(self.reflections)))
        rates = np.empty((len(values), 2, len(self.reflections)))
        kernels.factors_and_rates(
            self.molecule, self.carried, self.planar, values, self.table, factors, rates
        )
        return factors[0] + 1j * factors[1], (rates[:, 0] + 1j * rates[:, 1]).T

    def magnitudes_and_rates(self, configuration: ArrayLike) -> tuple[Array, Array]:
        """Magnitudes (R,) of a configuration (K,), and their derivatives (R, K).

        A magnitude has no derivative where it is 0; it is given as 0.
        """
        factors, rates = self.factors_and_rates(configuration)
        sizes = _sizes(factors)
        unit = np.divide(factors, sizes, out=np.zeros_like(factors), where=sizes > 0.0)
        return sizes, np.real(np.conj(unit)[:, None] * rates)

    def checked(self, configurations: ArrayLike) -> Array:
        """Configurations (m, K) as the kernels read them.

        Raises:
            CrystalError: if their size is another, or a value is not finite.
        """
        values = np.ascontiguousarray(configurations, dtype=float)
        count = len(self.model.molecule.coordinates)
        if values.ndim != 2 or values.shape[1] != count or not np.all(np.isfinite(values)):
            raise CrystalError(
                f"expected configurations of {count} finite numbers "
                f"({', '.join(self.model.keys)}), got an array of shape {values.shape}"
                + ("" if np.all(np.isfinite(values)) else " with values that are not finite")
            )
        return values


def _sizes(factors: Complex) -> Array:
    """|F| as the kernels compute it, to the last digit: a target's own cost is 0."""
    return np.sqrt(factors.real**2 + factors.imag**2)


def _terms(group: SpaceGroup, indices: Integers) -> tuple[Integers, Integers, Integers, Array]:
    """Spots (S, n), and firsts, term_spots and terms for kernels.structure_factors."""
    turned = np.einsum("rn,gnm->rgm", indices, group.integer_rotations)
    signs = friedel_signs(turned.reshape(-1, indices.shape[1])).reshape(turned.shape[:2])
    whole = (turned * signs[:, :, None]).reshape(-1, indices.shape[1])
    spots, places = np.unique(whole, axis=0, return_inverse=True)
    steps = (indices @ group.integer_translations.T) % group.denominator
    phases = roots_of_unity(group.denominator)[steps]
    # Operations that send a reflection to the same spot are one term.
    owner = np.repeat(np.arange(len(indices)), group.order)
    keys = np.column_stack([owner, places.ravel(), -signs.ravel()])
    terms, merged = np.unique(keys, axis=0, return_inverse=True)
    coefficients = np.zeros(len(terms), np.complex128)
    np.add.at(coefficients, merged.ravel(), phases.ravel())
    terms = terms[kept := np.abs(coefficients) > CANCELLED]
    firsts = np.searchsorted(terms[:, 0], np.arange(len(indices) + 1))
    real, imaginary = coefficients[kept].real, coefficients[kept].imag
    signs = -terms[:, 2]  # -1 for the conjugate of M
    matrices = np.array([real, -signs * imaginary, imaginary, signs * real])
    return spots, firsts.astype(np.int64), np.ascontiguousarray(terms[:, 1]), matrices


def roots_of_unity(order: int) -> Complex:
    """exp(2πi k/order) for k = 0 … order - 1; 1, i, -1 and -i are exact."""
    angles = 2.0 * np.pi * np.arange(order) / order
    roots: Complex = np.cos(angles) + 1j * np.sin(angles)
    for quarter, value in enumerate((1, 1j, -1, -1j)):
        if quarter * order % 4 == 0:
            roots[quarter * order // 4] = value
    return roots
