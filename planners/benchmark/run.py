"""One run of one planner: what is asked for, and what came of it. Both are plain data."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from planners.setup import Checker

SOLVED = "solved"
NOT_FREE = "not free"
CRASHED = "crashed"
HUNG = "hung"
OUT_OF_MEMORY = "out of memory"
TIMEOUT = "timeout"
EXHAUSTED = "exhausted"
LOST = "lost"
STATUSES = (
    SOLVED,
    TIMEOUT,
    EXHAUSTED,
    "invalid_start",
    "invalid_goal",
    NOT_FREE,
    CRASHED,
    HUNG,
    OUT_OF_MEMORY,
    LOST,
)
"""How a run can end; everything but "solved" is a failure.

"not free": a path was reported that the independent verification refutes. "hung": killed because
it ignored its time limit. "lost": the worker that ran it was lost, again and again.
"""


def slug(text: str) -> str:
    """A text as part of file names and of OMPL's logs, which want names without spaces."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip("-.") or "unnamed"


@dataclass(frozen=True)
class RunTask:
    """What one run does; it can be pickled and sent anywhere.

    Attributes:
        problem: name of the problem.
        scenario: the scenario of this run in its file format.
        planner: a name for `planners.registry.find_planner`.
        checker: "plugin", "tabulated" or "fcl".
        label: planner, and checker where it is needed to tell contenders apart.
        run: number of the run, from 0.
        seed: of everything random.
        time_limit: for the planner alone [s].
        memory_limit: what the planner may take beyond what is there before it begins [MB].
    """

    problem: str
    scenario: Mapping[str, Any]
    planner: str
    checker: Checker
    label: str
    run: int
    seed: int
    time_limit: float
    memory_limit: float

    @property
    def key(self) -> str:
        """The run's name: problem, contender and number."""
        return f"{self.problem}/{slug(self.label)}/{self.run:03d}"

    def to_dict(self) -> dict[str, Any]:
        """Everything, as data for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class RunRecord:
    """What came of a run.

    Attributes:
        problem, planner, checker, label, run, seed: as in its task.
        status: one of `STATUSES`.
        reason: why it failed, or why its path could not be verified, in words; else empty.
        seconds: time of the planner alone [s].
        simplification: time of the path's simplification [s].
        length: OMPL's length of the simplified path.
        clearance: the smallest distance that the independent verification sampled along it.
        proved_clearance: the certificate's lower bound of it; not positive without one.
        certified: whether every motion is proved free.
        verified: whether the independent verification found nothing wrong.
        memory: what the planner took [MB].
        statistics: the planner's own counts.
        log: OMPL's log of this run, None if there is none.
        result: the result with its path in its file format, None without.
    """

    problem: str
    planner: str
    checker: str
    label: str
    run: int
    seed: int
    status: str
    reason: str = ""
    seconds: float = 0.0
    simplification: float | None = None
    length: float | None = None
    clearance: float | None = None
    proved_clearance: float | None = None
    certified: bool | None = None
    verified: bool | None = None
    memory: float | None = None
    statistics: Mapping[str, Any] = field(default_factory=dict)
    log: str | None = field(default=None, repr=False)
    result: Mapping[str, Any] | None = field(default=None, repr=False)

    @classmethod
    def of(cls, task: RunTask, status: str, **entries: Any) -> RunRecord:
        """The record of ``task`` with this status and these further fields."""
        return cls(
            problem=task.problem,
            planner=task.planner,
            checker=task.checker,
            label=task.label,
            run=task.run,
            seed=task.seed,
            status=status,
            **entries,
        )

    @property
    def key(self) -> str:
        """The run's name, as its task's."""
        return f"{self.problem}/{slug(self.label)}/{self.run:03d}"

    @property
    def solved(self) -> bool:
        """Whether a path was found that withstood the verification."""
        return self.status == SOLVED

    def to_dict(self) -> dict[str, Any]:
        """Everything, as data for JSON."""
        return asdict(self)
