"""Whole plans of the bundled scenarios, by every planner with every checker, in turns."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from typing import Any

from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.scenario import Scenario, load_scenario
from planners.setup import Checker
from planners.solve import plan

HIGHWAY = ("HighwayRoadmap", "plugin")
PEERS: tuple[tuple[str, Checker], ...] = (
    ("RRTConnect", "plugin"),
    ("RRTConnect", "fcl"),
    ("RRT", "plugin"),
    ("RRT", "fcl"),
    ("PRM", "plugin"),
    ("PRM", "fcl"),
)
CONTENDERS: tuple[tuple[str, Checker], ...] = (("HighwayRoadmap", "plugin"), *PEERS)

QUICK = 1.0
"""A contender whose runs so far all took less than this [s] runs more often: noise matters."""
MORE_RUNS = 5
"""So many times more often."""
GIVE_UP = 2
"""A contender that has found no path in its first so many runs is not asked again."""


@dataclass(frozen=True)
class Run:
    """One solve: its time [s], without simplification, and how it ended."""

    seed: int
    status: str
    seconds: float
    certified: bool | None
    statistics: dict[str, Any]


@dataclass
class Series:
    """All runs of one contender on one scenario."""

    scenario: str
    planner: str
    checker: Checker
    time_limit: float
    runs: list[Run] = field(default_factory=list)

    @property
    def name(self) -> str:
        """Planner and checker in words."""
        return f"{self.planner} + {self.checker}"

    @property
    def failures(self) -> int:
        """Runs without a path."""
        return sum(run.status != "solved" for run in self.runs)

    @property
    def median(self) -> float:
        """Median time [s]; a run without a path counts as the limit, or as longer if it was."""
        if not self.runs:
            return math.nan
        return statistics.median(self._counted(run) for run in self.runs)

    @property
    def is_bound(self) -> bool:
        """Whether the median is a lower bound: at least half of the runs found no path."""
        return 2 * self.failures >= len(self.runs) > 0

    @property
    def uncertified(self) -> int:
        """Paths that were found but cannot be proved free, and mostly are not."""
        return sum(run.certified is False for run in self.runs)

    def wants_more(self, number: int, runs: int) -> bool:
        """Whether run ``number`` of ``runs`` asked for shall take place."""
        if self.failures == len(self.runs) >= GIVE_UP:
            return False
        if number < runs:
            return True
        # The later runs have no say in it, or those that turn out slow would be the last ones.
        quick = max(map(self._counted, self.runs[:runs]), default=math.inf) < QUICK
        return quick and number < runs * MORE_RUNS

    def _counted(self, run: Run) -> float:
        return run.seconds if run.status == "solved" else max(run.seconds, self.time_limit)

    def to_dict(self) -> dict[str, Any]:
        """Everything, for JSON."""
        return {**asdict(self), "median": self.median, "failures": self.failures}


def run_plans(
    names: Iterable[str], runs: int, time_limit: float, progress: Callable[[str], None]
) -> list[Series]:
    """Every contender on every scenario, seed by seed, the contenders of a scenario in turns.

    Ctrl-C ends the measuring; what was measured until then is returned.
    """
    scenarios = [load_scenario(name) for name in names]
    found = [
        (scenario, Series(scenario.name, planner, checker, time_limit))
        for scenario in scenarios
        for planner, checker in CONTENDERS
    ]
    try:
        for scenario in scenarios:
            progress(f"plans: warming up {scenario.name}")
            warm_up(scenario)
        for number in range(runs * MORE_RUNS):
            for scenario, series in found:
                if series.wants_more(number, runs):
                    progress(f"plans: run {number + 1}, {scenario.name}, {series.name}")
                    series.runs.append(one_run(scenario, series, seed=number + 1))
    except KeyboardInterrupt:
        progress("plans: interrupted, going on with what there is")
    return [series for _, series in found]


def warm_up(scenario: Scenario) -> None:
    """Run every contender for a moment, so that nothing is loaded for the first time later."""
    for planner, checker in CONTENDERS:
        one_run(scenario, Series(scenario.name, planner, checker, 0.05), seed=1)


def one_run(scenario: Scenario, series: Series, seed: int) -> Run:
    """One solve; an error of the planner is a status like any other."""
    try:
        result = plan(
            scenario,
            series.planner,
            series.checker,
            time_limit=series.time_limit,
            seed=seed,
            simplify=False,
        )
    except EllipsoidPlanningError as error:
        return Run(seed, f"error: {error}", series.time_limit, None, {})
    certified = None if result.path is None else result.path.certified
    seconds = float(result.time["total"] or 0.0)
    return Run(seed, result.status, seconds, certified, dict(result.statistics))
