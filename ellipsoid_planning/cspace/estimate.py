"""A mean with a confidence interval, from independent randomised copies of one estimate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError

COPIES = 16


@dataclass(frozen=True)
class Estimate:
    """An estimated fraction in [0, 1].

    Attributes:
        value: the estimate, unbiased.
        standard_error: of ``value``; 0 if it is exact, or if all copies agreed.
        low, high: the confidence interval, by Student's t over the copies. Where all agreed on
            0 or 1 it ends where one would have seen otherwise with that confidence.
        confidence: that of the interval, say 0.95.
        lines: how many lines (or configurations) were looked at.
    """

    value: float
    standard_error: float
    low: float
    high: float
    confidence: float
    lines: int

    @property
    def half_width(self) -> float:
        """Half the interval's length."""
        return 0.5 * (self.high - self.low)


def exactly(value: float, confidence: float) -> Estimate:
    """The estimate of what is known."""
    return Estimate(value, 0.0, value, value, confidence, 0)


def estimate_from_copies(
    means: NDArray[np.float64], draws: int, lines: int, confidence: float
) -> Estimate:
    """The estimate from the means (copies,) of independent copies.

    Args:
        means: one unbiased estimate each, at least two.
        draws: how many random layers they rest on altogether.
        lines: what to report.
        confidence: of the interval, between 0 and 1.
    """
    value = float(np.mean(means))
    error = float(np.std(means, ddof=1)) / math.sqrt(len(means))
    half = student_quantile(confidence, len(means) - 1) * error
    low, high = max(value - half, 0.0), min(value + half, 1.0)
    unseen = 1.0 - (1.0 - confidence) ** (1.0 / draws)
    if error == 0.0 and value in (0.0, 1.0):
        low, high = (0.0, unseen) if value == 0.0 else (1.0 - unseen, 1.0)
    return Estimate(value, error, low, high, confidence, lines)


def check_confidence(confidence: float) -> None:
    """Raise GeometryError unless the confidence lies between 0 and 1."""
    if not 0.0 < confidence < 1.0:
        raise GeometryError(f"expected a confidence between 0 and 1, got {confidence}")


def student_quantile(confidence: float, freedom: int) -> float:
    """The t that a t-distributed number exceeds in size with probability 1 - confidence."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + 0.5 * confidence))
