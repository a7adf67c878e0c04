"""From ranked candidates to one arrangement: the loop of the thesis' flowchart (Fig. 3.3)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.errors import CrystalError

from .parameters import Refinement
from .refine import Refined, refine

Array = NDArray[np.float64]
Progress = Callable[[int, int, float], None]
Refiner = Callable[[FourierCost, Array, Refinement], Refined]


@dataclass(frozen=True, eq=False)
class Tried:
    """A candidate, and what refinement made of it.

    Attributes:
        number: its place among the candidates, from 0.
        candidate: (K,).
        cost: its FCF.
        refined: the refinement.
    """

    number: int
    candidate: Array
    cost: float
    refined: Refined


@dataclass(frozen=True, eq=False)
class PhasingOutcome:
    """What became of a list of candidates.

    Attributes:
        solved: whether the best is free and its cost at most the threshold.
        best: the refined candidate of the lowest cost, free ones first.
        tried: all that were refined, in the order in which that happened.
        threshold: the FCF that would have been low enough.
        seconds: that the loop took.
    """

    solved: bool
    best: Tried
    tried: tuple[Tried, ...]
    threshold: float
    seconds: float

    @property
    def configuration(self) -> Array:
        """(K,), the arrangement that was found."""
        return self.best.refined.configuration

    def to_dict(self) -> dict[str, Any]:
        """Numbers for JSON, angles in radians."""
        return {
            "solved": self.solved,
            "threshold": self.threshold,
            "best": self.best.number,
            "configuration": self.configuration.tolist(),
            "cost": self.best.refined.cost,
            "free": self.best.refined.free,
            "seconds": self.seconds,
            "tried": [
                {
                    "number": one.number,
                    "candidate": one.candidate.tolist(),
                    "candidate_cost": one.cost,
                    "configuration": one.refined.configuration.tolist(),
                    "cost": one.refined.cost,
                    "free": one.refined.free,
                    "rounds": one.refined.rounds,
                    "looked_at": len(one.refined.trace),
                    "seconds": one.refined.seconds,
                }
                for one in self.tried
            ],
        }


def phase_candidates(
    cost: FourierCost,
    candidates: ArrayLike,
    parameters: Refinement | None = None,
    on_progress: Progress | None = None,
    refiner: Refiner = refine,
) -> PhasingOutcome:
    """Refine one candidate after the other until one has a cost at or below the threshold.

    With method "both" least squares goes through all candidates before the first tree grows: it
    takes milliseconds, a tree takes most of a second. So give it more than the thesis' ten.
    Candidates may collide (``search.slack``): trees start where least squares found a free
    arrangement near them; method "rrt" passes them over.

    Args:
        cost: FCF against the target, which knows the model.
        candidates: (B, K), best first, such as ``Ranking.configurations``.
        parameters: of the refinement; the defaults if None.
        on_progress: called after each refinement with how many were done, how many there may be,
            and the lowest cost so far.
        refiner: what refines a candidate; `kept.KeptRefinements` takes up an earlier run.

    Raises:
        CrystalError: there are no candidates, or of another size.
        PlannerError: a parameter is out of its range.
        KeyboardInterrupt: SIGINT arrived while a tree grew.
    """
    began = time.perf_counter()
    given = np.array(candidates, dtype=float)
    if given.ndim != 2 or not len(given):
        raise CrystalError(
            f"expected candidates as an array (B, {len(cost.model.keys)}) of one or more, got "
            f"shape {given.shape}; a grid with smaller steps may have some"
        )
    chosen = parameters or Refinement()
    threshold = chosen.cost_share * cost.norm
    plan = _plan(chosen, cost.model.are_free(given))
    tried: list[Tried] = []
    for number, one_way in plan:
        refined = refiner(cost, given[number], one_way)
        tried.append(Tried(number, given[number], cost.value(given[number]), refined))
        best = min(tried, key=_merit)
        if on_progress is not None:
            on_progress(len(tried), len(plan), best.refined.cost)
        if best.refined.free and best.refined.cost <= threshold:
            seconds = time.perf_counter() - began
            return PhasingOutcome(True, best, tuple(tried), threshold, seconds)
    return PhasingOutcome(False, best, tuple(tried), threshold, time.perf_counter() - began)


def _plan(parameters: Refinement, free: NDArray[np.bool_]) -> list[tuple[int, Refinement]]:
    """Which candidate is refined how, in order; a tree alone needs a free one, if there is any."""
    count = len(free)
    if parameters.method == "rrt" and np.any(free):
        return [(int(number), parameters) for number in np.flatnonzero(free)]
    if parameters.method != "both":
        return [(number, parameters) for number in range(count)]
    polished = replace(parameters, method="polish")
    trees = range(min(count, parameters.trees))
    return [(number, polished) for number in range(count)] + [(n, parameters) for n in trees]


def _merit(tried: Tried) -> tuple[bool, float]:
    return not tried.refined.free, tried.refined.cost
