"""Whole plans: a scenario goes in, a result that proves itself comes out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning import __version__
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.result import PlanResult

from . import bindings
from .certify import is_certified, path_result
from .registry import OwnPlanner, PlannerEntry, checked_parameters, find_planner
from .setup import CHECKERS, Checker, simple_setup
from .spaces import state_access, write_configuration

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.scenario import Scenario

DEFAULT_PLANNER = "HighwayRoadmap"
SIMPLIFICATION_LIMIT = 2.0
"""Longest time for simplifying one path [s]; it usually converges far earlier."""

_Statuses = ob.PlannerStatus.PlannerStatusType
_SOLVED = _Statuses.EXACT_SOLUTION
_STATUS_NAMES = {
    _SOLVED: "solved",
    _Statuses.INVALID_START: "invalid_start",
    _Statuses.INVALID_GOAL: "invalid_goal",
    _Statuses.INFEASIBLE: "exhausted",
    _Statuses.TIMEOUT: "timeout",
    _Statuses.APPROXIMATE_SOLUTION: "timeout",
    _Statuses.UNKNOWN: "timeout",
}


@dataclass(frozen=True)
class _Request:
    """What `plan` was asked for, checked."""

    scenario: Scenario
    cspace: CSpace
    entry: PlannerEntry
    parameters: Mapping[str, Any]
    checker: Checker
    resolution: float | None
    time_limit: float
    seed: int | None
    simplify: bool
    anytime: bool


@dataclass(frozen=True)
class _Run:
    """What a planner came back with; ``configurations`` (m, d) only when solved."""

    status: str
    seconds: float
    configurations: NDArray[np.float64] | None
    statistics: dict[str, Any]


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
) -> PlanResult:
    """Plan a path for ``scenario`` and certify it.

    Args:
        scenario: what to plan for.
        planner: a name from `planners.registry.planner_names`; the scenario's own planner if
            None, HighwayRoadmap if it names none.
        checker: "plugin" (exact, certified) or "fcl" (python-fcl, discrete motions).
        time_limit: for the planner alone [s].
        seed: makes the run repeat exactly with most planners; None for a different run each time.
        simplify: shorten the path with OMPL's simplification, under the same checker.
        anytime: let planners that can improve their path do so until the time limit.
        parameters: of the planner; they come before those that the scenario gives for it.
        resolution: of discrete motions, see `planners.setup.install`.

    Returns:
        The result. ``status`` is "solved", "timeout", "exhausted" (the planner gave up within
        its limit), "invalid_start" or "invalid_goal". An approximate solution is not one. The
        path is ``certified`` when every segment is proved free, whatever checker found it.

    Raises:
        PlannerError: unknown planner, parameter or checker, or a combination that cannot work.
        KeyboardInterrupt: SIGINT arrived; the planner has returned and all is restored.
    """
    request = _checked_request(
        scenario, planner, checker, time_limit, seed, simplify, anytime, parameters, resolution
    )
    for status, configuration in (
        ("invalid_start", scenario.start),
        ("invalid_goal", scenario.goal),
    ):
        if not request.cspace.is_valid(configuration):
            return _result(request, _Run(status, 0.0, None, {}))
    with bindings.ompl_output("silent"):
        return _result(request, _run(request))


def _checked_request(
    scenario: Scenario,
    planner: str | None,
    checker: Checker,
    time_limit: float,
    seed: int | None,
    simplify: bool,
    anytime: bool,
    parameters: Mapping[str, Any] | None,
    resolution: float | None,
) -> _Request:
    own = dict(scenario.planner)
    own_name = own.pop("name", DEFAULT_PLANNER)
    entry = find_planner(own_name if planner is None else planner)
    if checker not in CHECKERS:
        raise PlannerError(f"checker: expected one of {', '.join(CHECKERS)}, got {checker!r}")
    if entry.needs_plugin and checker != "plugin":
        raise PlannerError(f"{entry.name} works with the plug-in checker only, not {checker!r}")
    if not time_limit > 0.0:
        raise PlannerError(f"time limit: expected a positive number of seconds, got {time_limit!r}")
    values = {**(own if entry.name == own_name else {}), **(parameters or {})}
    return _Request(
        scenario=scenario,
        cspace=scenario.cspace(),
        entry=entry,
        parameters=checked_parameters(entry, values),
        checker=checker,
        resolution=resolution,
        time_limit=float(time_limit),
        seed=seed,
        simplify=simplify,
        anytime=anytime,
    )


def _run(request: _Request) -> _Run:
    setup = simple_setup(
        request.scenario,
        request.checker,
        request.seed,
        request.resolution,
        cspace=request.cspace,
    )
    si = setup.getSpaceInformation()
    setup.setOptimizationObjective(bindings.path_length_objective(si, not request.anytime))
    planner = _allocated(request, si)
    setup.setPlanner(planner)
    try:
        _warm_up(setup, planner, request)
        return _solved(request, setup, planner)
    finally:
        bindings.clear_sampler(si)


def _allocated(request: _Request, si: ob.SpaceInformation) -> ob.Planner:
    values = dict(request.parameters)
    if isinstance(request.entry, OwnPlanner):
        kinds = request.entry.parameter_kinds()
        if request.seed is not None and "seed" in kinds:
            values.setdefault("seed", request.seed)
        if request.anytime and "anytime" in kinds:
            values.setdefault("anytime", True)
    return request.entry.allocate(si, values)


def _solved(request: _Request, setup: og.SimpleSetup, planner: ob.Planner) -> _Run:
    condition = _condition(request, setup)
    with bindings.interruptible(condition) as interruption:
        status = setup.solve(condition).getStatus()
        gave_up = not condition()
    if interruption.requested:
        raise KeyboardInterrupt
    if status not in _STATUS_NAMES:
        raise _failure(request.entry.name, status.name, getattr(planner, "error", None))
    name = _STATUS_NAMES[status]
    if name == "timeout" and gave_up:
        name = "exhausted"
    seconds = float(setup.getLastPlanComputationTime())
    statistics = _statistics(planner)
    if name != "solved":
        return _Run(name, seconds, None, statistics)
    access = state_access(request.cspace)
    found = bindings.configurations_of_path(setup.getSolutionPath(), access)
    if request.simplify:
        began = time.perf_counter()
        found = _simplified(request, setup.getSpaceInformation(), found)
        statistics["simplification_time"] = time.perf_counter() - began
    return _Run(name, seconds, found, statistics)


def _failure(planner: str, status: str, traceback: str | None) -> PlannerError:
    if traceback is None:
        return PlannerError(f"{planner} ended with status {status}")
    error = PlannerError(f"{planner} failed: {traceback.strip().splitlines()[-1]}")
    error.__cause__ = RuntimeError(traceback)
    return error


def _condition(request: _Request, setup: og.SimpleSetup) -> ob.PlannerTerminationCondition:
    if request.anytime or isinstance(request.entry, OwnPlanner):
        return bindings.stop_after(request.time_limit)
    return bindings.stop_when_solved(setup.getProblemDefinition(), request.time_limit)


def _simplified(
    request: _Request, si: ob.SpaceInformation, found: NDArray[np.float64]
) -> NDArray[np.float64]:
    condition = bindings.stop_after(SIMPLIFICATION_LIMIT)
    with bindings.interruptible(condition) as interruption:
        shorter = bindings.simplified(si, found, state_access(request.cspace), condition)
    if interruption.requested:
        raise KeyboardInterrupt
    # Simplification ends with a repair that moves states, and halves segments: certify again.
    if is_certified(request.cspace, shorter) or not is_certified(request.cspace, found):
        return shorter
    return found


def _statistics(planner: ob.Planner) -> dict[str, Any]:
    if not bindings.is_bound(planner):
        return dict(getattr(planner, "statistics", {}))
    size = bindings.graph_size_of_planner(planner)
    return {} if size is None else {"vertices": size[0], "edges": size[1]}


def _warm_up(setup: og.SimpleSetup, planner: ob.Planner, request: _Request) -> None:
    # Compile every kernel that a solve can call, so that its time is the planner's alone.
    si = setup.getSpaceInformation()
    state = si.allocState()
    write_configuration(state, request.scenario.start, request.cspace)
    si.isValid(state)
    si.checkMotion(state, state)
    if isinstance(request.entry, OwnPlanner):
        if hasattr(planner, "warm_up"):
            planner.warm_up()
        return
    sampler = si.allocValidStateSampler()
    sampler.sampleNear(state, state, 1e-3)
    sampler.sample(state)


def _result(request: _Request, run: _Run) -> PlanResult:
    statistics, found = dict(run.statistics), run.configurations
    path = None if found is None else path_result(request.cspace, found)
    return PlanResult(
        scenario=request.scenario,
        planner=request.entry.name,
        seed=request.seed,
        status=run.status,
        time={
            "total": run.seconds,
            "build": statistics.pop("build_time", None),
            "search": statistics.pop("search_time", None),
        },
        path=path,
        statistics=statistics,
        version=__version__,
    )
