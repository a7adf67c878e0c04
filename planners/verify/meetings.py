"""What testing many configurations found: clearances, and contacts that are certain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Meeting:
    """A part that certainly meets an obstacle or another part, or leaves an arena.

    Attributes:
        kind: "obstacle", "arena" or "self".
        part, body: names.
        depth: about how deep.
        row: of the configuration.
    """

    kind: str
    part: str
    body: str
    depth: float
    row: int


@dataclass(frozen=True, eq=False)
class Clearances:
    """Of k configurations.

    Attributes:
        lower: (k,), bounds of the distance to obstacles and arena boundaries from below.
        upper: (k,), from above; infinite where only `lower` was needed.
        meetings: every contact that is certain.
    """

    lower: Array
    upper: Array
    meetings: tuple[Meeting, ...]
