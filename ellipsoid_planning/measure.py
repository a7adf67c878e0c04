"""What can be said about a scenario's free space before planning in it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.closed_form import ClosedForm, closed_form
from ellipsoid_planning.cspace.estimate import Estimate
from ellipsoid_planning.cspace.free_fraction import (
    CONFIDENCE,
    Budget,
    FreeFraction,
    free_fraction,
    layer_fraction,
)
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.roadmap.openings import (
    Opening,
    least_width,
    load_kernels,
    narrowest_openings,
    until,
)
from ellipsoid_planning.scenario import Scenario

LAYER_LINES = 20_000
OPENINGS = 5
OPENINGS_TIME = 5.0  # [s]
QUARTILES = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, eq=False)
class Measurement:
    """Free space, bounds and narrow places of a scenario.

    Attributes:
        scenario: what was measured.
        seed: of the measurement.
        free: the whole C-space.
        layers: single layers by name: "start", "goal", and "freest", that of the drawn ones with
            the most free space. None where the base is fixed.
        bound: the closed form of thesis 5.5.2.
        width: the robot's least width; if it has joints, no more than that.
        openings: the narrowest ones, the narrowest first.
        time: seconds by what they were spent on.
    """

    scenario: Scenario
    seed: int
    free: FreeFraction
    layers: dict[str, FreeFraction]
    bound: ClosedForm
    width: float
    openings: tuple[Opening, ...]
    time: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers as data for JSON."""
        free, bound = self.free, self.bound
        return {
            "scenario": self.scenario.name,
            "seed": self.seed,
            "confidence": free.fraction.confidence,
            "free": {
                "fraction": _interval(free.fraction, 1.0),
                "volume": _interval(free.fraction, free.whole),
                "whole": free.whole,
                "measure": measure_of(self.scenario),
                "method": free.method,
                "lines": free.fraction.lines,
            },
            "layers": {
                "sampled": len(free.layers),
                "without_free_space": self.closed_layers,
                "quartiles": self.quartiles,
                **{
                    name: {
                        "fraction": _interval(layer.fraction, 1.0),
                        "volume": _interval(layer.fraction, layer.whole),
                    }
                    for name, layer in self.layers.items()
                },
                "freest_configuration": None if free.freest is None else free.freest.tolist(),
            },
            "closed_form": {
                "exact": bound.kind == "exact",
                "lower": bound.lower,
                "upper": bound.upper,
                "reasons": list(bound.reasons),
            },
            "robot_width": self.width,
            "openings": [
                {
                    "bodies": list(one.bodies),
                    "point": one.point.tolist(),
                    "gap": one.gap,
                    "width": one.width,
                    "play": one.play,
                }
                for one in self.openings
            ],
            "time": self.time,
        }

    @property
    def quartiles(self) -> list[float] | None:
        """Least, quartiles and greatest of the drawn layers' fractions; None without layers."""
        layers = self.free.layers
        return np.quantile(layers, QUARTILES).tolist() if len(layers) else None

    @property
    def closed_layers(self) -> float | None:
        """The share of the drawn layers in which no line was free; None without layers."""
        layers = self.free.layers
        return float(np.mean(layers == 0.0)) if len(layers) else None


def measure(
    scenario: Scenario,
    seed: int = 0,
    budget: Budget | None = None,
    confidence: float = CONFIDENCE,
    on_progress: Callable[[str], None] | None = None,
) -> Measurement:
    """Measure a scenario's free space and find its narrow places.

    Args:
        scenario: of any robot; its start and goal need not be free.
        seed: of the estimates.
        budget: for the whole C-space; single layers and openings take little beside it.
        confidence: of all intervals.
        on_progress: told what is being done, and how far the estimate is.

    Raises:
        GeometryError: if the budget or the confidence makes no sense.
    """
    began = time.perf_counter()
    cspace = scenario.cspace()
    say = on_progress if on_progress is not None else _silent
    say("Measuring free space")
    spent = {}

    def told(estimate: Estimate) -> None:
        say(f"Measuring free space: {percentage(estimate)}")

    free = free_fraction(cspace, seed, budget, confidence, told)
    spent["free_space"] = free.seconds
    layers = _layers(scenario, cspace, free, seed, confidence, say)
    spent["layers"] = sum(layer.seconds for layer in layers.values())
    say("Bounds in closed form")
    then = time.perf_counter()
    bound = closed_form(cspace)
    spent["closed_form"] = time.perf_counter() - then
    say("Looking for narrow openings")
    then = time.perf_counter()
    openings: list[Opening] = []
    if scenario.robot.base_size > 0:
        load_kernels(cspace)
        openings = narrowest_openings(cspace, OPENINGS, until(OPENINGS_TIME))
    width = least_width(cspace)
    spent["openings"] = time.perf_counter() - then
    spent = {"total": time.perf_counter() - began, **spent}
    return Measurement(scenario, seed, free, layers, bound, width, tuple(openings), spent)


def measure_of(scenario: Scenario) -> str:
    """What volumes are products of, in words."""
    robot = scenario.robot
    factors = []
    if robot.base_size:
        factors.append("area" if scenario.dimension == 2 else "volume")
    if robot.rotates:
        factors.append("rotations (2 pi)" if scenario.dimension == 2 else "rotations (8 pi^2)")
    if getattr(robot, "moving_joints", ()):
        factors.append("joint ranges")
    return " x ".join(factors)


def percentage(estimate: Estimate) -> str:
    """An estimate as text: per cent, with digits as far as the interval makes sense."""
    half = 100.0 * max(estimate.high - estimate.value, estimate.value - estimate.low)
    if half == 0.0:
        return f"{100.0 * estimate.value:g} %"
    digits = min(max(1 - math.floor(math.log10(half)), 0), 12)
    return f"{100.0 * estimate.value:.{digits}f} % ± {half:.{digits}f} %"


def _layers(
    scenario: Scenario,
    cspace: CSpace,
    free: FreeFraction,
    seed: int,
    confidence: float,
    say: Callable[[str], None],
) -> dict[str, FreeFraction]:
    if scenario.robot.base_size == 0:
        return {}
    named: dict[str, NDArray[np.float64]] = {"start": scenario.start, "goal": scenario.goal}
    if free.freest is not None:
        named["freest"] = free.freest
    budget = Budget(lines=LAYER_LINES)
    found = {}
    for name, configuration in named.items():
        say(f"Measuring the {name}'s layer" if name != "freest" else "Measuring the freest layer")
        found[name] = layer_fraction(cspace, configuration, seed, budget, confidence)
    return found


def _interval(estimate: Estimate, scale: float) -> dict[str, float]:
    return {
        "value": scale * estimate.value,
        "low": scale * estimate.low,
        "high": scale * estimate.high,
        "standard_error": scale * estimate.standard_error,
    }


def _silent(_: str) -> None:
    pass
