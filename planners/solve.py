"""Whole plans: a scenario goes in, a result that proves itself comes out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning import __version__
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.result import PlanResult

from . import bindings
from .certify import path_result
from .registry import OwnPlanner
from .request import (
    STATUS_NAMES,
    Request,
    checked_request,
    planner_statistics,
    prepared,
    simplified_path,
)
from .setup import Checker
from .spaces import state_access

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario


@dataclass(frozen=True)
class Outcome:
    """What a planner came back with; ``configurations`` (m, d) only when solved.

    ``seconds`` are the planner's own; ``simplification`` those of shortening the path, if any.
    """

    status: str
    seconds: float
    configurations: NDArray[np.float64] | None
    statistics: dict[str, Any]
    simplification: float | None = None


def plan(
    scenario: Scenario,
    planner: str | None = None,
    checker: Checker = "plugin",
    time_limit: float = 10.0,
    seed: int | None = None,
    simplify: bool = True,
    anytime: bool = False,
    parameters: Mapping[str, Any] | None = None,
    resolution: float | None = None,
    roadmap: str | Path | None = None,
) -> PlanResult:
    """Plan a path for ``scenario`` and certify it.

    Args:
        scenario: what to plan for.
        planner: a name from `planners.registry.planner_names`; the scenario's own planner if
            None, HighwayRoadmap if it names none.
        checker: "plugin" (exact, certified), "tabulated" (the same with states looked up in
            tables) or "fcl" (python-fcl, discrete motions).
        time_limit: for the planner alone [s].
        seed: makes the run repeat exactly with most planners; None for a different run each time.
        simplify: shorten the path, under the same checker, for no longer than the planner took
            (see `planners.request.simplified_path`).
        anytime: let planners that can improve their path do so until the time limit.
        parameters: of the planner; they come before those that the scenario gives for it.
        resolution: of discrete motions, see `planners.setup.install`.
        roadmap: a file that the planner's roadmap is kept in: loaded if it exists, written when
            the planner has ended, whether there is a path or not. HighwayRoadmap has one.

    Returns:
        The result. ``status`` is "solved", "timeout", "exhausted" (the planner gave up within
        its limit), "invalid_start" or "invalid_goal". An approximate solution is not one. The
        path is ``certified`` when every segment is proved free, whatever checker found it.

    Raises:
        PlannerError: unknown planner, parameter or checker, or a combination that cannot work.
        RoadmapError: the file ``roadmap`` is none of this scene, or cannot be written.
        KeyboardInterrupt: SIGINT arrived; the planner has returned and all is restored.
    """
    request = checked_request(
        scenario,
        planner,
        checker,
        time_limit,
        seed,
        simplify,
        anytime,
        parameters,
        resolution,
        roadmap,
    )
    return answer(request)


def answer(request: Request, ends_checked: bool = False) -> PlanResult:
    """The result of a request; see `plan` for what it says and raises.

    Start and goal are checked here unless they were before (``ends_checked``).
    """
    for status, configuration in (
        ("invalid_start", request.scenario.start),
        ("invalid_goal", request.scenario.goal),
    ):
        if not (ends_checked or request.cspace.is_valid(configuration)):
            return plan_result(request, Outcome(status, 0.0, None, {}))
    with bindings.ompl_output("silent"):
        return plan_result(request, _run(request))


def _run(request: Request) -> Outcome:
    setup, planner = prepared(request)
    try:
        outcome = _solved(request, setup, planner)
        if request.roadmap is not None:
            planner.save_roadmap(request.roadmap)
        return outcome
    finally:
        bindings.clear_sampler(setup.getSpaceInformation())


def _solved(request: Request, setup: og.SimpleSetup, planner: ob.Planner) -> Outcome:
    condition = _condition(request, setup)
    with bindings.interruptible(condition) as interruption:
        status = setup.solve(condition).getStatus()
        gave_up = not condition()
    if interruption.requested:
        raise KeyboardInterrupt
    if status not in STATUS_NAMES:
        raise _failure(request.entry.name, status.name, getattr(planner, "error", None))
    name = STATUS_NAMES[status]
    if name == "timeout" and gave_up:
        name = "exhausted"
    seconds = float(setup.getLastPlanComputationTime())
    statistics = planner_statistics(planner)
    if name != "solved":
        return Outcome(name, seconds, None, statistics)
    access = state_access(request.cspace)
    found = bindings.configurations_of_path(setup.getSolutionPath(), access)
    simplification = None
    if request.simplify:
        began = time.perf_counter()
        found = simplified_path(request, setup.getSpaceInformation(), found, seconds)
        simplification = time.perf_counter() - began
    return Outcome(name, seconds, found, statistics, simplification)


def _failure(planner: str, status: str, traceback: str | None) -> PlannerError:
    if traceback is None:
        return PlannerError(f"{planner} ended with status {status}")
    error = PlannerError(f"{planner} failed: {traceback.strip().splitlines()[-1]}")
    error.__cause__ = RuntimeError(traceback)
    return error


def _condition(request: Request, setup: og.SimpleSetup) -> ob.PlannerTerminationCondition:
    if request.anytime or isinstance(request.entry, OwnPlanner):
        return bindings.stop_after(request.time_limit)
    return bindings.stop_when_solved(setup.getProblemDefinition(), request.time_limit)


def plan_result(request: Request, run: Outcome) -> PlanResult:
    """The result that an outcome makes, its path measured and certified."""
    statistics, found = dict(run.statistics), run.configurations
    path = None if found is None else path_result(request.cspace, found)
    return PlanResult(
        scenario=request.scenario,
        planner=request.entry.name,
        seed=request.seed,
        status=run.status,
        time={
            "planning": run.seconds,
            "simplification": run.simplification,
            "total": run.seconds + (run.simplification or 0.0),
            "build": statistics.pop("build_time", None),
            "search": statistics.pop("search_time", None),
        },
        path=path,
        statistics=statistics,
        version=__version__,
    )
