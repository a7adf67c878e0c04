"""How a query to one of our planners ended."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SOLVED = "solved"
EXHAUSTED = "exhausted"
TIMEOUT = "timeout"


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a query ended: ``status``, and the path (m, d) if solved."""

    status: str
    path: NDArray[np.float64] | None = None
