"""One target phased: its candidates, and what each method of refinement makes of them."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes, simulate
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.arrangement_errors import (
    ArrangementErrors,
    arrangement_errors,
)
from ellipsoid_planning.crystal.phasing.trace import trend
from planners.crystal.parameters import Refinement
from planners.crystal.phasing import phase_candidates

Candidates = Callable[[FourierCost], np.ndarray]
"""From FCF against a target to candidates (B, K), best first."""
SHOWN = 10
NOISE_LEFT = 1.5


@dataclass
class MethodResult:
    """What one method came to; ``errors`` under the thesis' names."""

    errors: dict[str, Any]
    cost: float  # as a share of the cost of an empty cell
    solved: bool
    tried: int
    seconds: float
    trend: dict[str, Any] | None = None


@dataclass
class Trial:
    """A target's candidates and results; angles in radians, errors under the thesis' names."""

    target: list[float]
    ranking_seconds: float
    candidates: int
    first_cost: float
    first: dict[str, Any]
    best_of_ten: dict[str, Any]
    methods: dict[str, MethodResult] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


def run_trial(
    model: PackingModel,
    target: np.ndarray,
    candidates: Candidates,
    methods: dict[str, Refinement],
    noise: float = 0.0,
    with_trends: bool = False,
) -> Trial:
    """Phase one target from its magnitudes alone."""
    cost = FourierCost(model, _noisy(simulate(model, target), noise))
    began = time.perf_counter()
    given = candidates(cost)
    seconds = time.perf_counter() - began
    errors = [arrangement_errors(model, one, target) for one in given[:SHOWN]]
    best = min(errors, key=lambda one: one.mean_turn)
    trial = Trial(
        target.tolist(),
        seconds,
        len(given),
        cost.value(given[0]) / cost.norm,
        errors[0].to_dict(),
        best.to_dict(),
    )
    for name, parameters in methods.items():
        chosen = parameters
        if noise > 0.0:  # what remains of the cost at the target is about the noise
            chosen = replace(parameters, threshold=max(parameters.cost_share, NOISE_LEFT * noise))
        trial.methods[name] = _result(cost, given, target, chosen, with_trends)
    return trial


def _result(
    cost: FourierCost,
    candidates: np.ndarray,
    target: np.ndarray,
    parameters: Refinement,
    with_trend: bool,
) -> MethodResult:
    given = candidates[:SHOWN] if parameters.method == "rrt" else candidates
    outcome = phase_candidates(cost, given, parameters)
    found: ArrangementErrors = arrangement_errors(cost.model, outcome.configuration, target)
    course = None
    if with_trend and parameters.method == "rrt":
        course = trend(outcome.best.refined.trace, cost.model, target).to_dict()
    return MethodResult(
        found.to_dict(),
        outcome.best.refined.cost / cost.norm,
        outcome.solved,
        len(outcome.tried),
        outcome.seconds,
        course,
    )


def _noisy(exact: Magnitudes, noise: float) -> Magnitudes:
    """Magnitudes with normal errors of this share of each, the same for each run."""
    if noise == 0.0:
        return exact
    rng = np.random.default_rng(len(exact))
    factors = 1.0 + noise * rng.normal(size=len(exact))
    return Magnitudes(exact.reflections, np.abs(exact.values * factors), source="with noise")
