"""Families of scenarios solved by HighwayRoadmap: a fresh planner for every seed and clearance."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.families import make_family
from ellipsoid_planning.families.catalogue import FAMILIES
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.result import PlanResult
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.scenario import Scenario
from planners.certify import path_result
from planners.verify import verify_result

OPEN = math.inf
"""Stands for the clearance of a scene without its passage."""
OPEN_AS = 0.1
"""The clearance that the rest of such a scene is made for."""
GIVE_UP = 3
"""A clearance that no path was found at with the first so many seeds is not asked again."""


@dataclass(frozen=True)
class Run:
    """One query: its seed, its processor time [s], and whether it found a path."""

    seed: int
    seconds: float
    solved: bool


@dataclass
class Series:
    """The runs of a family at one clearance, OPEN for the scene without the passage."""

    clearance: float
    time_limit: float
    runs: list[Run] = field(default_factory=list)
    verified: int = 0

    @property
    def solved(self) -> int:
        """How many runs found a path."""
        return sum(run.solved for run in self.runs)

    @property
    def hopeless(self) -> bool:
        """Whether enough runs have failed, and none has not."""
        return len(self.runs) >= GIVE_UP and not self.solved

    @property
    def median(self) -> float:
        """Median time [s]; infinite if half of the runs found no path, NaN without runs."""
        if not self.runs:
            return math.nan
        return statistics.median(run.seconds if run.solved else math.inf for run in self.runs)


@dataclass
class Case:
    """A family in one dimension, its series by clearance."""

    family: str
    dimension: int
    series: dict[float, Series] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """As in a table; some families come in space only and say so themselves."""
        return self.family if self.family.endswith("3d") else f"{self.family} {self.dimension}-D"

    def ratio(self, one: float, other: float) -> float:
        """The median time at clearance ``one`` over that at ``other``."""
        return self.series[one].median / self.series[other].median

    def paired_ratio(self, one: float, other: float) -> float:
        """The median of such ratios of the single scenes, as far as both were solved."""
        known = {run.seed: run.seconds for run in self.series[other].runs if run.solved}
        runs = [run for run in self.series[one].runs if run.solved and run.seed in known]
        ratios = [run.seconds / known[run.seed] for run in runs]
        return statistics.median(ratios) if ratios else math.nan

    def exponent(self, clearances: list[float]) -> float:
        """p of the least-squares fit time ~ clearance^(-p) to the finite medians."""
        points = [(c, self.series[c].median) for c in clearances]
        points = [point for point in points if math.isfinite(point[1])]
        if len(points) < 2:
            return math.nan
        logs = np.log(np.array(points))
        return float(-np.polyfit(logs[:, 0], logs[:, 1], 1)[0])


def all_cases(names: list[str]) -> list[Case]:
    """The families asked for in every dimension that they come in."""
    return [Case(name, n) for name in names for n in FAMILIES[name].dimensions]


def measure(
    case: Case,
    clearances: list[float],
    seeds: int,
    time_limit: float,
    verified: int,
    progress: Callable[[str], None],
) -> None:
    """Fill a case, seed by seed so that a noisy moment hits all clearances."""
    case.series = {c: Series(c, time_limit) for c in (*clearances, OPEN)}
    _warm_up(case)
    for seed in range(1, seeds + 1):
        progress(f"{case.name}, seed {seed} of {seeds}")
        for clearance, series in case.series.items():
            if not series.hopeless:
                scenario = _scenario(case, clearance, seed)
                run, path = _solved(scenario, seed, time_limit)
                series.runs.append(run)
                if path is not None and seed <= verified:
                    _verify(scenario, path)
                    series.verified += 1


def _scenario(case: Case, clearance: float, seed: int) -> Scenario:
    without = clearance == OPEN
    size = OPEN_AS if without else clearance
    return make_family(case.family, size, case.dimension, seed, without_passage=without)


def _warm_up(case: Case) -> None:
    """Compile, and run everything once, on a scene that no other run has."""
    scenario = _scenario(case, 1e-2, 0)
    HighwayRoadmap(scenario.cspace()).compile_kernels()
    _solved(scenario, 0, 5.0)


def _solved(
    scenario: Scenario, seed: int, time_limit: float
) -> tuple[Run, NDArray[np.float64] | None]:
    """One query, its path checked; the first level is laid out before the clock starts."""
    cspace = scenario.cspace()
    planner = HighwayRoadmap(cspace, RoadmapParameters(seed=seed))
    planner.prepare()
    ends = scenario.start[None], scenario.goal[None]
    began = time.process_time()
    outcome = planner.solve(*ends, lambda: time.process_time() > began + time_limit)
    seconds = time.process_time() - began
    if outcome.path is not None:
        _check(cspace, scenario, outcome.path)
    return Run(seed, seconds, outcome.status == SOLVED), outcome.path


def _check(cspace: CSpace, scenario: Scenario, path: NDArray[np.float64]) -> None:
    """Whether a path leads from start to goal in motions that are proved free."""
    apart = cspace.distance(path[0], scenario.start) + cspace.distance(path[-1], scenario.goal)
    if apart > 1e-9 or not np.all(cspace.are_motions_valid(path[:-1], path[1:])):
        raise AssertionError(f"{scenario.name}: the path is not proved free")


def _verify(scenario: Scenario, path: NDArray[np.float64]) -> None:
    """Check a path again, densely and without the kernels."""
    found = path_result(scenario.cspace(), path)
    report = verify_result(PlanResult(scenario, "HighwayRoadmap", SOLVED, path=found))
    if not report.passed:
        raise AssertionError(f"{scenario.name}: {report}")
