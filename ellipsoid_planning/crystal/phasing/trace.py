"""What a refinement looked at, step by step: for trends of costs and errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.arrangement_errors import (
    ArrangementErrors,
    arrangement_errors,
)

Array = NDArray[np.float64]


@dataclass(eq=False)
class Trace:
    """Configurations and their costs, in the order in which they were met; grows."""

    _configurations: list[Array] = field(default_factory=list)
    _costs: list[float] = field(default_factory=list)

    def add(self, configuration: ArrayLike, cost: float) -> None:
        """One more step."""
        self._configurations.append(np.array(configuration, dtype=float))
        self._costs.append(float(cost))

    def extend(self, other: Trace) -> None:
        """All steps of another refinement that went on from here."""
        self._configurations.extend(other._configurations)
        self._costs.extend(other._costs)

    def __len__(self) -> int:
        return len(self._costs)

    @property
    def configurations(self) -> Array:
        """(S, K)."""
        return np.array(self._configurations)

    @property
    def costs(self) -> Array:
        """(S,), FCF."""
        return np.array(self._costs)

    @property
    def improvements(self) -> NDArray[np.int64]:
        """The steps that were better than all before them."""
        costs = self.costs
        if not len(costs):
            return np.zeros(0, np.int64)
        before = np.minimum.accumulate(np.append(np.inf, costs[:-1]))
        return np.flatnonzero(costs < before)


@dataclass(frozen=True, eq=False)
class Trend:
    """The best so far at the steps where it changed (Figs. 3.14 and 3.19).

    Attributes:
        steps: (I,), counted from 0.
        costs: (I,), FCF.
        errors: I of them; empty where no target is known.
    """

    steps: NDArray[np.int64]
    costs: Array
    errors: tuple[ArrangementErrors, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, errors under the thesis' names."""
        return {
            "steps": self.steps.tolist(),
            "costs": self.costs.tolist(),
            "errors": [one.to_dict() for one in self.errors],
        }


def trend(trace: Trace, model: PackingModel, target: ArrayLike | None = None) -> Trend:
    """The improvements of a trace, with the errors against a target (K,) if one is known."""
    steps = trace.improvements
    errors: tuple[ArrangementErrors, ...] = ()
    if target is not None and len(steps):
        every = trace.configurations[steps]
        errors = tuple(arrangement_errors(model, one, target) for one in every)
    return Trend(steps, trace.costs[steps], errors)
