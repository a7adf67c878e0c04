"""What a family shows: how time grows as the clearance shrinks, and where a planner first fails."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from planners.benchmark.problems import scientific
from planners.benchmark.summary import Row


@dataclass(frozen=True)
class Growth:
    """One contender on one family.

    Attributes:
        family, label: who, on what.
        exponent: p of the least-squares fit time ~ clearance^(-p) to the median times that are
            no bounds; NaN with fewer than two of them.
        largest, smallest: the clearances between which that holds.
        first_failure: the largest clearance at which a run failed, None if none did.
    """

    family: str
    label: str
    exponent: float
    largest: float
    smallest: float
    first_failure: float | None


def growths(rows: Iterable[Row]) -> tuple[Growth, ...]:
    """The growth of every contender on every family with at least two clearances."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        if row.family is not None and row.clearance is not None:
            found.setdefault((row.family, row.label), []).append(row)
    return tuple(_growth(own) for own in found.values() if len(own) > 1)


def _growth(rows: Sequence[Row]) -> Growth:
    points = [
        (row.clearance, row.time.median.value)
        for row in rows
        if row.clearance is not None and not row.time.median.is_bound
    ]
    clearances = [clearance for clearance, _ in points] or [math.nan]
    failed = [row.clearance for row in rows if row.clearance is not None and row.failures]
    family = rows[0].family
    return Growth(
        family=family if family is not None else "",
        label=rows[0].label,
        exponent=_exponent(points),
        largest=max(clearances),
        smallest=min(clearances),
        first_failure=max(failed, default=None),
    )


def _exponent(points: Sequence[tuple[float, float]]) -> float:
    if len(points) < 2:
        return math.nan
    logs = [(math.log(clearance), math.log(seconds)) for clearance, seconds in points]
    centre = [sum(values) / len(logs) for values in zip(*logs, strict=True)]
    spread = sum((x - centre[0]) ** 2 for x, _ in logs)
    if not spread > 0.0:  # all at one clearance: there is nothing to fit
        return math.nan
    moment = sum((x - centre[0]) * (y - centre[1]) for x, y in logs)
    return -moment / spread


def growth_notes(rows: Iterable[Row]) -> list[str]:
    """A sentence for each contender on each family."""
    return [_sentence(growth) for growth in growths(rows)]


def _sentence(growth: Growth) -> str:
    parts = []
    if not math.isnan(growth.exponent):
        between = f"{scientific(growth.largest)} to {scientific(growth.smallest)}"
        parts.append(f"time ~ clearance^{-growth.exponent:.2f} from {between}")
    if growth.first_failure is None:
        parts.append("no run failed")
    else:
        parts.append(f"first failure at clearance {scientific(growth.first_failure)}")
    return f"{growth.family}, {growth.label}: {', '.join(parts)}"
