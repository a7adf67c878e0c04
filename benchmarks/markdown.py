"""The measurements as Markdown for the README."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from benchmarks.cases import OURS
from benchmarks.plans import HIGHWAY, PEERS, Series
from benchmarks.ratios import Table, ratio, rounded, times
from benchmarks.timing import CaseTime

_CHECKER_NAMES = {"plugin": "plug-in", "fcl": "FCL"}
_UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))


def duration(seconds: float) -> str:
    """A time with its unit and two or three digits."""
    if not math.isfinite(seconds) or seconds <= 0.0:
        return f"{seconds} s"
    for size, unit in _UNITS:
        if seconds >= size:
            return f"{rounded(seconds / size)} {unit}"
    return f"{seconds:.1e} s"


def _row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def kernel_table(measured: list[CaseTime]) -> Iterator[str]:
    """One row a method; ratios to ours of the same topic."""
    yield _row(["One operation", "by", "time", "ratio"])
    yield _row(["---", "---", "---:", "---:"])
    ours = {one.topic: one.median for one in measured if one.method == OURS}
    for one in measured:
        first = one.topic if one.method == OURS else ""
        quotient = times(one.median / ours[one.topic])
        yield _row([first, one.method, duration(one.median), quotient])


def plan_table(table: Table) -> Iterator[str]:
    """One row a scenario; for each peer the ratio to HighwayRoadmap and its own median."""
    heads = [f"{planner} + {_CHECKER_NAMES[checker]}" for planner, checker in PEERS]
    yield _row(["Scenario", "HighwayRoadmap", *heads])
    yield _row(["---", *["---:"] * (1 + len(heads))])
    for name, row in table.items():
        own = row.get(HIGHWAY)
        if own is not None:
            yield _row([name, _median(own), *(_peer(row.get(key), own) for key in PEERS)])


def _peer(series: Series | None, own: Series) -> str:
    return "" if series is None else f"{ratio(series, own)} ({_median(series)})"


def _median(series: Series) -> str:
    failed = f" {series.failures}/{len(series.runs)}" if series.failures else ""
    if series.is_bound:
        return f">{series.time_limit:g} s{failed}"
    return duration(series.median) + (f", >{series.time_limit:g} s{failed}" if failed else "")


def notes(table: Table) -> Iterator[str]:
    """What a reader of the plan table must know."""
    series = [one for row in table.values() for one in row.values()]
    limit = max((one.time_limit for one in series), default=0.0)
    yield (
        "Median times of the planner alone until its first path, without simplification; in front"
        " of them the ratio to HighwayRoadmap's."
        f" >{limit:g} s k/N: k of N runs found no path in that time; they count as that long."
    )
    yield (
        f"Paths that could not be proved free: {_unproved(series, 'fcl')} found with the FCL"
        f" checker, which looks at motions at a resolution, {_unproved(series, 'plugin')} with the"
        " plug-in."
    )


def _unproved(series: list[Series], checker: str) -> str:
    chosen = [one for one in series if one.checker == checker]
    found = sum(len(one.runs) - one.failures for one in chosen)
    return f"{sum(one.uncertified for one in chosen)} of {found}"
