"""What a planner is asked for, checked, and everything made ready for it to begin."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning.errors import PlannerError, RoadmapError
from ellipsoid_planning.roadmap.shorten import without_detours
from ellipsoid_planning.roadmap.store_format import check_target
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.sizes import MOST_SECONDS

from . import bindings
from .certify import is_certified
from .registry import OwnPlanner, PlannerEntry, checked_parameters, find_planner, registered_planner
from .setup import CHECKERS, PLUGIN_CHECKERS, Checker, simple_setup
from .spaces import state_access, write_configuration

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.scenario import Scenario

DEFAULT_PLANNER = "HighwayRoadmap"
SIMPLIFICATION_FLOOR = 0.1
"""OMPL may simplify a path for so long [s], however quickly it was found."""

_Statuses = ob.PlannerStatus.PlannerStatusType
SOLVED = _Statuses.EXACT_SOLUTION
STATUS_NAMES = {
    SOLVED: "solved",
    _Statuses.INVALID_START: "invalid_start",
    _Statuses.INVALID_GOAL: "invalid_goal",
    _Statuses.INFEASIBLE: "exhausted",
    _Statuses.TIMEOUT: "timeout",
    _Statuses.APPROXIMATE_SOLUTION: "timeout",
    _Statuses.UNKNOWN: "timeout",
}
"""The name that a result gives to each of OMPL's statuses; others are failures of the planner."""


@dataclass(frozen=True)
class Request:
    """What a planner is asked for; its fields are those of `planners.solve.plan`, checked."""

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
    roadmap: Path | None = None


def checked_request(
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
) -> Request:
    """The request that these arguments of `planners.solve.plan` make.

    Raises:
        PlannerError: unknown planner, parameter or checker, or a combination that cannot work.
        RoadmapError: no roadmap can be kept where ``roadmap`` says.
    """
    entry, own = chosen_planner(scenario, planner)
    if checker not in CHECKERS:
        raise PlannerError(f"checker: expected one of {', '.join(CHECKERS)}, got {checker!r}")
    if entry.needs_plugin and checker not in PLUGIN_CHECKERS:
        raise PlannerError(f"{entry.name} works with the plug-in checker only, not {checker!r}")
    check_limits(time_limit, seed)
    if roadmap is not None:
        check_roadmap_file(entry, Path(roadmap))
    values = checked_parameters(entry, {**own, **(parameters or {})})
    if isinstance(scenario.robot, ArticulatedRobot):
        entry.check_articulated(values)
    return Request(
        scenario=scenario,
        cspace=scenario.cspace(),
        entry=entry,
        parameters=values,
        checker=checker,
        resolution=resolution,
        time_limit=float(time_limit),
        seed=seed,
        simplify=simplify,
        anytime=anytime,
        roadmap=None if roadmap is None else Path(roadmap),
    )


def chosen_planner(scenario: Scenario, planner: str | None) -> tuple[PlannerEntry, dict[str, Any]]:
    """The planner called ``planner``, or else the scenario's own, and the scenario's parameters.

    Raises:
        PlannerError: no planner has this name.
    """
    own = dict(scenario.planner)
    own_name = own.pop("name", DEFAULT_PLANNER)
    entry = registered_planner(own_name) if planner is None else find_planner(planner)
    return entry, own if entry.name == own_name else {}


def check_limits(time_limit: float, seed: int | None, option: str = "") -> None:
    """Check a time limit [s] and a seed; ``option`` stands before their names in messages.

    Raises:
        PlannerError: no positive, finite number of seconds, or no seed of OMPL's.
    """
    if not 0.0 < time_limit <= MOST_SECONDS:
        name = f"{option}time-limit" if option else "time limit"
        raise PlannerError(
            f"{name}: expected a positive number of seconds, at most {MOST_SECONDS:g}, "
            f"got {time_limit!r}"
        )
    if seed is not None and (type(seed) is not int or not 0 <= seed < 2**32):
        raise PlannerError(f"{option}seed: expected an integer in [0, 2**32), got {seed!r}")


def check_roadmap_file(entry: PlannerEntry, file: Path) -> None:
    """Check that a planner can keep its roadmap in a file.

    Raises:
        PlannerError: it keeps none.
        RoadmapError: the folder is missing or cannot be written to, or there is something that
            is no file.
    """
    if not isinstance(entry, OwnPlanner) or not hasattr(entry.load(), "load_roadmap"):
        raise PlannerError(
            f"roadmap: {entry.name} keeps no roadmap in a file; {DEFAULT_PLANNER} does"
        )
    check_target(file)
    if not os.access(file.resolve().parent, os.W_OK):
        raise RoadmapError(f"{file}: the folder cannot be written to; name a file in another one")


def prepared(request: Request) -> tuple[og.SimpleSetup, ob.Planner]:
    """The set-up of a request with its planner, every kernel that a solve can call compiled.

    Call `planners.bindings.clear_sampler` on its space information when it has served.
    """
    setup = simple_setup(
        request.scenario,
        request.checker,
        request.seed,
        request.resolution,
        cspace=request.cspace,
    )
    si = setup.getSpaceInformation()
    try:
        setup.setOptimizationObjective(bindings.path_length_objective(si, not request.anytime))
        planner = _allocated(request, si)
        if request.roadmap is not None and request.roadmap.exists():
            planner.load_roadmap(request.roadmap)
        setup.setPlanner(planner)
        _warm_up(setup, planner, request)
    except BaseException:
        bindings.clear_sampler(si)
        raise
    return setup, planner


def _allocated(request: Request, si: ob.SpaceInformation) -> ob.Planner:
    values = dict(request.parameters)
    if isinstance(request.entry, OwnPlanner):
        kinds = request.entry.parameter_kinds()
        if request.seed is not None and "seed" in kinds:
            values.setdefault("seed", request.seed)
        if request.anytime and "anytime" in kinds:
            values.setdefault("anytime", True)
    return request.entry.allocate(si, values)


def _warm_up(setup: og.SimpleSetup, planner: ob.Planner, request: Request) -> None:
    # Compile every kernel that a solve can call, so that its time is the planner's alone.
    si = setup.getSpaceInformation()
    state = si.allocState()
    write_configuration(state, request.scenario.start, request.cspace)
    own = isinstance(request.entry, OwnPlanner)
    if own and hasattr(planner, "warm_up"):
        planner.warm_up()
    si.isValid(state)
    si.checkMotion(state, state)
    start = request.scenario.start[None]
    is_certified(request.cspace, np.repeat(start, 2, axis=0))
    if request.simplify:
        without_detours(request.cspace, np.repeat(start, 2, axis=0))
    if own:
        return
    sampler = si.allocValidStateSampler()
    sampler.sampleNear(state, state, 1e-3)
    sampler.sample(state)


def simplified_path(
    request: Request, si: ob.SpaceInformation, found: NDArray[np.float64], planning: float
) -> NDArray[np.float64]:
    """The path ``found`` (m, d) shortened, certified if it was before.

    A certified path loses its detours by proved shortcuts between its states. Then OMPL's
    simplification is given as long as the ``planning`` took [s], or `SIMPLIFICATION_FLOOR`; it
    mostly ends far earlier.

    Raises:
        KeyboardInterrupt: SIGINT arrived; the simplification has returned.
    """
    certified = is_certified(request.cspace, found)
    if certified:
        found = without_detours(request.cspace, found)
    condition = bindings.stop_after(max(SIMPLIFICATION_FLOOR, planning))
    with bindings.interruptible(condition) as interruption:
        shorter = bindings.simplified(si, found, state_access(request.cspace), condition)
    if interruption.requested:
        raise KeyboardInterrupt
    # Simplification ends with a repair that moves states, and halves segments: certify again.
    return shorter if not certified or is_certified(request.cspace, shorter) else found


def planner_statistics(planner: ob.Planner) -> dict[str, Any]:
    """A planner's own counts: what ours keep themselves, a bound one's vertices and edges."""
    if not bindings.is_bound(planner):
        return dict(getattr(planner, "statistics", {}))
    size = bindings.graph_size_of_planner(planner)
    return {} if size is None else {"vertices": size[0], "edges": size[1]}
