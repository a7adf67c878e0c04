"""How long each phase of a run's process may take, and the names of its files."""

from __future__ import annotations

from planners.benchmark.run import RunTask

TASK = "task.json"
PHASE = "phase"
RECORD = "record.json"
OUTPUT = "output.txt"

STARTING = "starting"
PLANNING = "planning"
CHECKING = "checking"

_START_LIMIT = 600.0  # [s]; the first run on a machine compiles the kernels
_CHECK_LIMIT = 600.0  # [s]; a long path near contact takes its verification a while
_GRACE = 2.0  # [s]
_GRACE_SHARE = 0.25
MEMORY_GRACE = 1.25
"""A process is killed at so many times its memory limit; OMPL's planners stop at the limit."""


def phase_limit(task: RunTask, phase: str) -> float:
    """The longest time [s] for a phase: starting, planning or checking."""
    if phase == PLANNING:
        return task.time_limit * (1.0 + _GRACE_SHARE) + _GRACE
    return _START_LIMIT if phase == STARTING else _CHECK_LIMIT
