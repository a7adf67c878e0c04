"""The runs of one problem, each with its own log or with none, as one log of OMPL's."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from importlib.metadata import version

from planners.benchmark.ompl_log import (
    BenchmarkLog,
    PlannerLog,
    format_log,
    merge_planners,
    parse_log,
)
from planners.benchmark.run import CRASHED, HUNG, LOST, OUT_OF_MEMORY, RunRecord

_PREFIX = "geometric_"  # as OMPL has it
_TIMED_OUT, _CRASHED = "4", "7"
_STATUS = {HUNG: _TIMED_OUT, OUT_OF_MEMORY: _TIMED_OUT, CRASHED: _CRASHED, LOST: _CRASHED}
"""OMPL's numbers for runs that it could not log itself."""
_STATUS_NAMES = (
    "status|Unknown status|Invalid start|Invalid goal|Unrecognized goal type|Timeout"
    "|Approximate solution|Exact solution|Crash"
)


def merged_log(
    records: Sequence[RunRecord],
    *,
    runs: int,
    time_limit: float,
    memory_limit: float,
    parameters: Mapping[str, str] | None = None,
) -> str:
    """The log of all ``records``, which belong to one problem.

    Args:
        records: of one problem, in any order; at least one.
        runs: how many of each planner were asked for.
        time_limit: of a run [s].
        memory_limit: of a run [MB].
        parameters: of the experiment, values by "name TYPE".
    """
    ordered = sorted(records, key=lambda record: record.run)
    parsed = {record.key: parse_log(record.log) for record in ordered if record.log is not None}
    head = next(iter(parsed.values()), _bare_log(ordered[0]))
    labels = dict.fromkeys(record.label for record in records)
    blocks = [
        _planner_log([record for record in ordered if record.label == label], parsed)
        for label in labels
    ]
    whole = replace(
        head,
        planners=tuple(blocks),
        parameters=dict(parameters or {}),
        run_count=runs,
        seconds=f"{time_limit:g}",
        memory=f"{memory_limit:g}",
        start=min([log.start for log in parsed.values()] or [head.start]),
        seed=str(min(record.seed for record in records)),
        duration=sum(record.seconds for record in records),
    )
    return format_log(whole)


def _bare_log(record: RunRecord) -> BenchmarkLog:
    """A header for a problem with not a single run that came to its end."""
    return BenchmarkLog(
        version=f"OMPL version {version('ompl')}",
        experiment=record.problem,
        host=platform.node() or "unknown",
        start=datetime.now(timezone.utc).astimezone().strftime("%Y-%m-%d %H:%M:%S"),
        setup="",
        cpu="",
        seed=str(record.seed),
        seconds="",
        memory="",
        run_count=0,
        duration=0.0,
        enums=(_STATUS_NAMES,),
        planners=(),
    )


def _planner_log(records: Iterable[RunRecord], parsed: Mapping[str, BenchmarkLog]) -> PlannerLog:
    return merge_planners(
        parsed[record.key].planners[0] if record.key in parsed else _without_log(record)
        for record in records
    )


def _without_log(record: RunRecord) -> PlannerLog:
    run = {
        "time REAL": repr(record.seconds),
        "status ENUM": _STATUS.get(record.status, "0"),
        "solved BOOLEAN": "0",
        "checker TEXT": record.checker,
        "seed INTEGER": str(record.seed),
        "outcome TEXT": record.status,
        "certified BOOLEAN": "0",
        "verified BOOLEAN": "0",
    }
    if record.memory is not None:
        run["memory taken REAL"] = repr(record.memory)
    return PlannerLog(f"{_PREFIX}{record.label}", {}, (run,))
