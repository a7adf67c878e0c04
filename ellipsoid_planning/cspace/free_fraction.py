"""The measured free fraction of a C-space, with a confidence interval.

Free means what `CSpace.is_valid` means: proved free, in bounds and limits, at the clearance asked
for. The fraction is of all configurations within bounds and limits: positions by volume,
rotations by the invariant measure (2 pi in the plane, 8 pi^2 in space), joints by their range.

It comes from the free intervals of sweep lines, so that each line counts infinitely many
configurations. Layers and lines follow a sequence that covers the C-space evenly; a few
independently shifted copies of it tell how well (randomised quasi-Monte Carlo: A. B. Owen,
"Randomly permuted (t, m, s)-nets and (t, s)-sequences", 1995; P. L'Ecuyer and others, "Confidence
intervals for randomized quasi-Monte Carlo estimators", 2023). On a fixed base there are no
lines, and configurations at points of such a sequence are tested.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.estimate import (
    COPIES,
    Estimate,
    check_confidence,
    estimate_from_copies,
    exactly,
)
from ellipsoid_planning.cspace.layer_sequence import LayerSequence, whole_measure
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError

Array = NDArray[np.float64]

DEFAULT_LINES = 100_000
CONFIDENCE = 0.95
# Layers of each copy between two looks at the clock and the target.
_BLOCK = 8
_LEAST_BLOCKS = 4


@dataclass(frozen=True)
class Budget:
    """When to stop; whatever comes first.

    Attributes:
        lines: at least so many lines are looked at, rounded up to whole blocks of layers.
            `DEFAULT_LINES` if nothing else limits the work. With the same seed the same number
            of lines gives the same result, anywhere.
        half_width: stop when the interval of the fraction is that narrow on either side.
        time_limit: [s].
        should_stop: asked some hundred times a second.
    """

    lines: int | None = None
    half_width: float | None = None
    time_limit: float | None = None
    should_stop: Callable[[], bool] | None = None

    def __post_init__(self) -> None:
        for name in ("lines", "half_width", "time_limit"):
            value = getattr(self, name)
            if value is not None and not 0.0 < value < math.inf:
                raise GeometryError(f"expected a positive {name.replace('_', ' ')}, got {value}")

    @property
    def most_lines(self) -> float:
        """How many lines may be looked at."""
        if self.lines is not None:
            return self.lines
        return DEFAULT_LINES if self.time_limit is None and self.half_width is None else math.inf


@dataclass(frozen=True, eq=False)
class FreeFraction:
    """The measured free part of a C-space, or of one layer.

    Attributes:
        fraction: of all configurations (of the layer's positions).
        whole: the measure of all configurations, see `whole_measure` (of the bounds).
        layers: the fractions (m,) of the layers that were drawn, each from a few lines; a sum of
            what is free by layer. Empty if there is but one layer, or the base is fixed.
        freest: a configuration (d,) of the layer with the most free space among these, base in
            the middle of the bounds; None if there is none.
        method: "free intervals", "configurations" (fixed base), or "exact" (nothing to meet).
        seconds: how long it took.
    """

    fraction: Estimate
    whole: float
    layers: Array
    freest: Array | None
    method: str
    seconds: float

    @property
    def volume(self) -> float:
        """The free volume, in the units of ``whole``."""
        return self.fraction.value * self.whole

    @property
    def volume_interval(self) -> tuple[float, float]:
        """The confidence interval of the free volume."""
        return self.fraction.low * self.whole, self.fraction.high * self.whole


def free_fraction(
    cspace: CSpace,
    seed: int = 0,
    budget: Budget | None = None,
    confidence: float = CONFIDENCE,
    on_progress: Callable[[Estimate], None] | None = None,
) -> FreeFraction:
    """Measure the free fraction of a whole C-space.

    Args:
        cspace: of any robot.
        seed: of the random shifts.
        budget: when to stop.
        confidence: of the interval.
        on_progress: told about what is known so far, some tens of times a second.

    Raises:
        GeometryError: if the confidence or the budget makes no sense.
    """
    check_confidence(confidence)
    whole = whole_measure(cspace)
    if _is_empty(cspace):
        return FreeFraction(exactly(1.0, confidence), whole, np.empty(0), None, "exact", 0.0)
    sequence = LayerSequence(cspace, seed)
    return _measured(cspace, sequence, whole, budget or Budget(), confidence, on_progress)


def layer_fraction(
    cspace: CSpace,
    configuration: ArrayLike,
    seed: int = 0,
    budget: Budget | None = None,
    confidence: float = CONFIDENCE,
    on_progress: Callable[[Estimate], None] | None = None,
) -> FreeFraction:
    """Measure the free fraction of the layer of a configuration (d,).

    Everything but the base's position is as there. Arguments as for `free_fraction`.

    Raises:
        GeometryError: as there, if the configuration does not fit, or if the base is fixed.
    """
    check_confidence(confidence)
    sequence = LayerSequence(cspace, seed, configuration)
    whole = float(np.prod(cspace.world.high - cspace.world.low))
    return _measured(cspace, sequence, whole, budget or Budget(), confidence, on_progress)


def _is_empty(cspace: CSpace) -> bool:
    rigid = not isinstance(cspace, ArticulatedCSpace)
    return rigid and not (cspace.world.obstacles or cspace.world.arenas)


def _measured(
    cspace: CSpace,
    sequence: LayerSequence,
    whole: float,
    budget: Budget,
    confidence: float,
    on_progress: Callable[[Estimate], None] | None,
) -> FreeFraction:
    began = time.perf_counter()
    blocks: list[Array] = []
    sums = np.zeros(COPIES)
    told = began
    while True:
        blocks.append(sequence.advance(_BLOCK))
        sums += blocks[-1].sum(axis=1)
        draws = COPIES * sequence.layers
        lines = draws * sequence.lines
        now = time.perf_counter()
        tell = on_progress is not None and now - told > 0.05
        estimate = None
        if tell or budget.half_width is not None:
            estimate = estimate_from_copies(sums / sequence.layers, draws, lines, confidence)
        if tell and on_progress is not None and estimate is not None:
            on_progress(estimate)
            told = now
        if _is_enough(budget, lines, len(blocks), now - began, estimate):
            break
    final = estimate_from_copies(sums / sequence.layers, draws, lines, confidence)
    layers = np.concatenate(blocks, axis=1)
    freest = None
    swept = cspace.robot.base_size > 0
    if swept and sequence.varies and final.value > 0.0:
        copy, layer = np.unravel_index(int(np.argmax(layers)), layers.shape)
        freest = sequence.configuration(int(copy), int(layer))
    return FreeFraction(
        final,
        whole,
        layers.ravel() if swept and sequence.varies else np.empty(0),
        freest,
        "free intervals" if swept else "configurations",
        time.perf_counter() - began,
    )


def _is_enough(
    budget: Budget, lines: int, blocks: int, seconds: float, estimate: Estimate | None
) -> bool:
    if budget.should_stop is not None and budget.should_stop():
        return True
    if lines >= budget.most_lines:
        return True
    if budget.time_limit is not None and seconds >= budget.time_limit:
        return True
    return (
        budget.half_width is not None
        and estimate is not None
        and blocks >= _LEAST_BLOCKS
        and estimate.half_width <= budget.half_width
    )
