"""A number or an array that says how it relates to the true value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Kind = Literal["exact", "lower", "upper", "estimate"]


@dataclass(frozen=True, eq=False)
class Bound:
    """A value beside what it bounds.

    Attributes:
        value: (...), float64; one number has the shape ().
        kind: "exact" (to rounding), "lower" (never above the true value), "upper" (never
            below it) or "estimate" (either).
        source: the thesis equation, or the inequality's name.
    """

    value: NDArray[np.float64]
    kind: Kind
    source: str

    def __float__(self) -> float:
        return float(self.value)
