"""What every safety function answers, and what it tells of itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class TableReport:
    """What is known of one table.

    Attributes:
        links: names of the links that share it.
        description: its grids, in words.
        orientations, lines: how many cells of orientations, and lines for each of them.
        intervals: number of free intervals.
        memory: bytes.
        seconds: what filling or loading it took.
        loaded: whether it came from a file.
        inflation: by how much links were grown to cover what lies within a cell.
    """

    links: tuple[str, ...]
    description: str
    orientations: int
    lines: int
    intervals: int
    memory: int
    seconds: float
    loaded: bool
    inflation: float


@dataclass(frozen=True)
class SafetyReport:
    """What a safety function costs, and how much of the work its tables do.

    Attributes:
        kind: "exact" or "tabulated".
        tables: the distinct ones.
        states: how many configurations the following are about.
        safe: the share of them that is safe.
        answered: the share of link queries that tables answer; nan without tables or states.
        lookup_time: mean time of the tables' look-ups for all links of a state [s].
        state_time: mean time of a whole answer, batched [s].
        exact_time: the same by the exact kernels [s].
    """

    kind: str
    tables: tuple[TableReport, ...] = ()
    states: int = 0
    safe: float = float("nan")
    answered: float = float("nan")
    lookup_time: float = float("nan")
    state_time: float = float("nan")
    exact_time: float = float("nan")

    @property
    def memory(self) -> int:
        """Bytes of all tables."""
        return sum(table.memory for table in self.tables)

    @property
    def seconds(self) -> float:
        """What filling or loading all tables took."""
        return sum(table.seconds for table in self.tables)


class SafetyFunction(Protocol):
    """S(g₀; q) = ∏ s_i(g₀ ∘ f_i(q)): whether a robot of links is safe (thesis 6.4).

    "Safe" is always proved; it takes in limits of joints, bounds and self-collision. What
    is free by less than the tolerance of the C-space may be called unsafe.
    """

    @property
    def cspace(self) -> Any:
        """The C-space that it is a function on."""

    def is_safe(self, configuration: ArrayLike) -> bool:
        """Whether a configuration (d,) is safe."""

    def are_safe(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether each configuration (m, d) is safe, shape (m,)."""

    def report(self, configurations: ArrayLike | None = None) -> SafetyReport:
        """What it costs; measured on configurations (m, d), if given."""
