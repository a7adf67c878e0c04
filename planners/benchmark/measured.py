"""One run inside its own process: OMPL's benchmark, then the path's simplification and checks."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ompl import base as ob
from ompl import geometric as og
from ompl import tools as ot

from ellipsoid_planning.scenario import Scenario
from planners import bindings
from planners.benchmark.limits import CHECKING, PLANNING
from planners.benchmark.memory import resident_memory
from planners.benchmark.run import (
    CRASHED,
    EXHAUSTED,
    NOT_FREE,
    OUT_OF_MEMORY,
    SOLVED,
    TIMEOUT,
    RunRecord,
    RunTask,
)
from planners.request import (
    STATUS_NAMES,
    Request,
    checked_request,
    planner_statistics,
    prepared,
    simplified_path,
)
from planners.solve import Outcome, plan_result
from planners.spaces import state_access
from planners.verify import verify_result
from planners.verify.report import NOT_RESOLVED

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult

LOG = "ompl.log"
PROGRESS_SAMPLES = 100
"""How often planners that report their progress are asked for it within the time limit."""

_NEARLY = 0.9  # OMPL looks at the memory now and then only

Announce = Callable[[str], None]


@dataclass(frozen=True)
class _Measured:
    """A record in the making, and the properties that OMPL's log gets beside its own."""

    record: RunRecord
    properties: Mapping[str, str]


class _Meter:
    """What is read right before and right after the planner works; OMPL clears it soon after."""

    def __init__(self, announce: Announce) -> None:
        self._announce = announce
        self._before = 0.0
        self.memory = 0.0  # that the planner took [MB]
        self.statistics: dict[str, Any] = {}
        self.error: str | None = None  # the traceback of a planner of ours

    def before(self, _: ob.Planner) -> None:
        self._before = resident_memory(os.getpid()) or 0.0
        self._announce(PLANNING)

    def after(self, planner: ob.Planner, _: ot.RunProperties) -> None:
        self._announce(CHECKING)
        self.memory = max((resident_memory(os.getpid()) or 0.0) - self._before, 0.0)
        self.error = getattr(planner, "error", None)
        if not bindings.is_bound(planner):  # OMPL counts the states and motions of its own
            self.statistics = planner_statistics(planner)


def measured_run(task: RunTask, announce: Announce) -> RunRecord:
    """Run ``task`` in this process, in the current folder, where OMPL's log is written.

    ``announce`` is called with PLANNING right before the planner begins and with CHECKING
    once it has returned. Exceptions of the planner come through.
    """
    scenario = Scenario.from_dict(task.scenario)
    request = checked_request(scenario, task.planner, task.checker, task.time_limit, task.seed)
    with bindings.ompl_output("silent"):
        setup, planner = prepared(request)
        try:
            return _benchmarked(task, request, setup, planner, announce)
        finally:
            bindings.clear_sampler(setup.getSpaceInformation())


def _benchmarked(
    task: RunTask,
    request: Request,
    setup: og.SimpleSetup,
    planner: ob.Planner,
    announce: Announce,
) -> RunRecord:
    planner.setName(task.label)
    benchmark = ot.Benchmark(setup, task.problem)
    benchmark.addPlanner(planner)
    meter = _Meter(announce)
    benchmark.setPreRunEvent(meter.before)
    benchmark.setPostRunEvent(meter.after)
    benchmark.benchmark(_limits(task))
    run = benchmark.getRecordedExperimentData().planners[0].runs[0]
    measured = _evaluated(task, request, setup, meter, run)
    for name, value in measured.properties.items():
        run[name] = value
    benchmark.saveResultsToFile(LOG)
    return replace(measured.record, log=Path(LOG).read_text(encoding="utf-8"))


def _limits(task: RunTask) -> ot.Request:
    request = ot.Request()
    request.maxTime = task.time_limit
    request.maxMem = task.memory_limit
    request.runCount = 1
    request.timeBetweenUpdates = task.time_limit / PROGRESS_SAMPLES  # 0 would ask without pause
    request.displayProgress = False
    request.saveConsoleOutput = False
    request.simplify = False  # it has no limit of its own there
    return request


def _evaluated(
    task: RunTask,
    request: Request,
    setup: og.SimpleSetup,
    meter: _Meter,
    run: ot.RunProperties,
) -> _Measured:
    seconds, statistics = float(run["time REAL"]), meter.statistics
    status, reason = _status(task, run, meter)
    record = RunRecord.of(
        task, status, reason=reason, seconds=seconds, memory=meter.memory, statistics=statistics
    )
    if status != SOLVED:
        return _Measured(record, _properties(record))
    found = bindings.configurations_of_path(setup.getSolutionPath(), state_access(request.cspace))
    began = time.perf_counter()
    shorter = simplified_path(request, setup.getSpaceInformation(), found, seconds)
    simplification = time.perf_counter() - began
    record = replace(record, simplification=simplification)
    outcome = Outcome(SOLVED, seconds, shorter, statistics, simplification)
    result = plan_result(request, outcome)
    record = _verified(record, result)
    return _Measured(record, _properties(record))


def _status(task: RunTask, run: ot.RunProperties, meter: _Meter) -> tuple[str, str]:
    """Our name for how the planner ended, and in words why it failed."""
    status = ob.PlannerStatus.PlannerStatusType(int(run["status ENUM"]))
    name = STATUS_NAMES.get(status, CRASHED)
    if name == CRASHED:
        lines = (meter.error or "").strip().splitlines()
        return CRASHED, lines[-1] if lines else f"its status was {status.name}"
    if name != TIMEOUT:
        return name, "" if name == SOLVED else name.replace("_", " ")
    if float(run["time REAL"]) >= task.time_limit:
        return TIMEOUT, f"no path within {task.time_limit:g} s"
    if meter.memory >= _NEARLY * task.memory_limit:
        return OUT_OF_MEMORY, f"it stopped at the limit of {task.memory_limit:g} MB"
    return EXHAUSTED, "the planner gave up before its time limit"


def _verified(record: RunRecord, result: PlanResult) -> RunRecord:
    path = result.path
    assert path is not None  # noqa: S101  the status is "solved"
    report = verify_result(result)
    record = replace(
        record,
        length=path.length,
        clearance=_finite(report.sampled_clearance),
        proved_clearance=_finite(path.min_clearance),
        certified=path.certified,
        verified=report.passed,
        result=result.to_dict(),
    )
    if report.passed:
        return record
    reason = "; ".join(f"{check.name}: {check.detail}" for check in report.failures)
    if report.verdict == NOT_RESOLVED:
        return replace(record, reason=reason)
    return replace(record, status=NOT_FREE, reason=reason)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _properties(record: RunRecord) -> dict[str, str]:
    """What is added to OMPL's own properties of a run, by their names in its log."""
    properties = {
        "checker TEXT": record.checker,
        "seed INTEGER": str(record.seed),
        "outcome TEXT": record.status,
        "certified BOOLEAN": _text(bool(record.certified)),
        "verified BOOLEAN": _text(bool(record.verified)),
        "clearance REAL": _text(record.clearance),
        "proved clearance REAL": _text(record.proved_clearance),
        "memory taken REAL": _text(record.memory),
        "simplification time REAL": _text(record.simplification),
        "simplified solution length REAL": _text(record.length),
    }
    if record.status == NOT_FREE:
        properties["solved BOOLEAN"] = "0"  # OMPL believes the planner
    for name, value in record.statistics.items():
        if isinstance(value, bool | int | float):
            kind = "REAL" if isinstance(value, float) else "INTEGER"
            properties[f"planner {name.replace('_', ' ')} {kind}"] = _text(value)
    return properties


def _text(value: float | bool | None) -> str:
    if value is None:
        return "nan"  # which OMPL's reader takes for nothing
    return repr(value) if isinstance(value, float) else str(int(value))
