"""What a campaign has shown, one row for each problem and contender."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from planners.benchmark.campaign import Campaign
from planners.benchmark.run import NOT_FREE, STATUSES, RunRecord


@dataclass(frozen=True)
class Quantile:
    """A number that half, or another part, of the runs stay below.

    Attributes:
        value: the number; NaN without runs.
        is_bound: it is a lower bound, because it falls among runs that found no path.
    """

    value: float
    is_bound: bool = False


@dataclass(frozen=True)
class Quartiles:
    """First quartile, median and third quartile."""

    first: Quantile
    median: Quantile
    third: Quantile


@dataclass(frozen=True)
class Row:
    """The runs of one contender on one problem.

    Attributes:
        problem, label, planner, checker: what was run.
        family, clearance: of the problem, if it is one of a family.
        runs: how many have ended.
        solved: how many found a path that withstood the verification.
        certified: how many of these have a proof.
        time: of the planner [s]; a run without a path counts as the time limit, a lower bound.
        length: of the simplified paths, in OMPL's metric.
        path_clearance: the smallest sampled distances along them.
        failures: counts by status, in the order of `run.STATUSES`.
        not_free: the keys of the runs whose paths were refuted.
    """

    problem: str
    label: str
    planner: str
    checker: str
    family: str | None
    clearance: float | None
    runs: int
    solved: int
    certified: int
    time: Quartiles
    length: Quartiles
    path_clearance: Quartiles
    failures: tuple[tuple[str, int], ...]
    not_free: tuple[str, ...]

    @property
    def success(self) -> float:
        """The share of runs that found a path that is free."""
        return self.solved / self.runs if self.runs else math.nan


def summarised(campaign: Campaign, records: Iterable[RunRecord]) -> tuple[Row, ...]:
    """A row for each problem and contender that has any runs, in the campaign's order."""
    found: dict[tuple[str, str], list[RunRecord]] = {}
    for record in records:
        found.setdefault((record.problem, record.label), []).append(record)
    rows = []
    for problem in campaign.problems:
        for contender in campaign.contenders:
            runs = found.get((problem.name, contender.label))
            if runs:
                rows.append(_row(runs, campaign.time_limit, problem.family, problem.clearance))
    return tuple(rows)


def _row(
    runs: Sequence[RunRecord], limit: float, family: str | None, clearance: float | None
) -> Row:
    first, solved = runs[0], [run for run in runs if run.solved]
    counts = [(status, sum(run.status == status for run in runs)) for status in STATUSES[1:]]
    return Row(
        problem=first.problem,
        label=first.label,
        planner=first.planner,
        checker=first.checker,
        family=family,
        clearance=clearance,
        runs=len(runs),
        solved=len(solved),
        certified=sum(run.certified is True for run in solved),
        time=quartiles([run.seconds for run in solved], len(runs) - len(solved), limit),
        length=quartiles([run.length for run in solved if run.length is not None]),
        path_clearance=quartiles([run.clearance for run in solved if run.clearance is not None]),
        failures=tuple((status, count) for status, count in counts if count),
        not_free=tuple(run.key for run in runs if run.status == NOT_FREE),
    )


def quartiles(values: Sequence[float], failures: int = 0, limit: float = 0.0) -> Quartiles:
    """The quartiles of ``values`` and of so many more that are known to exceed ``limit`` only."""
    ordered = sorted(values)
    ordered.extend([max([limit, *ordered[-1:]])] * failures)
    first, median, third = (_quantile(ordered, failures, share) for share in (0.25, 0.5, 0.75))
    return Quartiles(first, median, third)


def _quantile(ordered: Sequence[float], bounds: int, share: float) -> Quantile:
    if not ordered:
        return Quantile(math.nan)
    place = share * (len(ordered) - 1)
    below, part = math.floor(place), place - math.floor(place)
    above = min(below + 1, len(ordered) - 1) if part > 0.0 else below
    value = ordered[below] + part * (ordered[above] - ordered[below])
    return Quantile(value, above >= len(ordered) - bounds)
