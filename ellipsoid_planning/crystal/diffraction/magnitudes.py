"""Magnitudes of structure factors to compare a model with: simulated ones, or measured ones."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.reflections import Reflections
from ellipsoid_planning.crystal.diffraction.structure_factors import (
    StructureFactors,
    reflections_of,
)
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

SMALLEST, LARGEST = 1e-100, 1e100


@dataclass(frozen=True, eq=False)
class Magnitudes:
    """Magnitudes |F| of reflections of a crystal; all arrays read-only.

    Attributes:
        reflections: R of them, unique under the group.
        values: (R,), |F| in the model's units, or up to one common factor where ``relative``.
        sigmas: (R,), their standard uncertainties; None where nothing is said about them.
        source: where they come from, for messages.
        relative: whether they have a scale of their own, as measured ones do.
        missing: (M, n), indices that the model's resolution reaches and the source lacks.
        notes: what a user should know of how they were read.

    Raises:
        CrystalError: if there are none, their number is not that of the reflections, or one is
            negative or not finite; names the reflection; or the largest is enormous or tiny.
    """

    reflections: Reflections
    values: Array
    sigmas: Array | None = None
    source: str = "magnitudes"
    relative: bool = False
    missing: Integers = field(default_factory=lambda: np.zeros((0, 3), np.int64))
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not len(self.reflections):
            raise CrystalError(f"{self.source}: expected magnitudes of reflections, there are none")
        object.__setattr__(self, "values", self._checked(self.values, "magnitude"))
        if self.sigmas is not None:
            object.__setattr__(self, "sigmas", self._checked(self.sigmas, "uncertainty"))
        if not np.any(self.values > 0.0):
            raise CrystalError(f"{self.source}: all magnitudes are 0; nothing can be compared")
        largest = float(self.values.max())
        if not SMALLEST <= largest <= LARGEST:  # their squares are no numbers any more
            raise CrystalError(
                f"{self.source}: expected magnitudes up to {SMALLEST:g} at least and {LARGEST:g} "
                f"at most, the largest is {largest:g}; multiply all by a factor"
            )

    def __len__(self) -> int:
        return len(self.values)

    @property
    def indices(self) -> Integers:
        """(R, n), the Miller indices."""
        return self.reflections.indices

    @property
    def completeness(self) -> float:
        """The share of the reflections that the resolution reaches, 1 when none is missing."""
        return len(self) / (len(self) + len(self.missing))

    def _checked(self, given: ArrayLike, what: str) -> Array:
        values = np.array(given, dtype=float)
        if values.shape != (len(self.reflections),):
            raise CrystalError(
                f"{self.source}: expected {len(self.reflections)} numbers, one for each "
                f"reflection, got an array of shape {values.shape}"
            )
        wrong = np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))
        if len(wrong):
            raise CrystalError(
                f"{self.source}: reflection {tuple(self.indices[wrong[0]].tolist())}: expected a "
                f"{what} of 0 or more, got {values[wrong[0]]:g}"
            )
        values.setflags(write=False)
        return values


def simulate(
    model: PackingModel, configuration: ArrayLike, reflections: Reflections | None = None
) -> Magnitudes:
    """The magnitudes that a model has in a configuration (K,).

    Args:
        model: the packing model.
        configuration: (K,), angles [rad].
        reflections: all that the model's resolution reaches by default.

    Raises:
        CrystalError: if the configuration has another size or is not finite.
    """
    chosen = reflections_of(model) if reflections is None else reflections
    values = np.asarray(configuration, dtype=float)
    magnitudes = StructureFactors(model, chosen).magnitudes(values[None])[0]
    return Magnitudes(chosen, magnitudes, source=f"simulated from {model.name}")
