"""OMPL's benchmark logs as values: read, put together, written.

The format is the one that `ompl.tools.Benchmark` writes (version 2.0) and that OMPL's statistics
script reads: a header, then for each planner its settings, its properties of each run, and, where
it reports any, its progress during each run.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ellipsoid_planning.errors import EllipsoidPlanningError


@dataclass(frozen=True)
class PlannerLog:
    """What a log says of one planner.

    Attributes:
        name: as it is written, "geometric_" and the planner's name.
        common: settings, values by name.
        runs: for each run its values by property, "name TYPE".
        progress_names: properties, "name TYPE", that it reports while it works.
        progress: for each run what it reported, as it is written.
    """

    name: str
    common: Mapping[str, str]
    runs: tuple[Mapping[str, str], ...]
    progress_names: tuple[str, ...] = ()
    progress: tuple[str, ...] = ()


@dataclass(frozen=True)
class BenchmarkLog:
    """One experiment.

    Attributes:
        version: the first line.
        experiment: its name, without spaces.
        host, start: where and when it began.
        setup: what OMPL says of space, query and planners.
        cpu: what OMPL says of the processor.
        seed: the random seed.
        seconds: the time limit of a run [s].
        memory: the memory limit of a run [MB].
        run_count: runs of each planner.
        duration: of the whole experiment [s].
        enums: lines "name|value|value…".
        planners: what was measured.
        parameters: of the experiment, values by "name TYPE".
    """

    version: str
    experiment: str
    host: str
    start: str
    setup: str
    cpu: str
    seed: str
    seconds: str
    memory: str
    run_count: int
    duration: float
    enums: tuple[str, ...]
    planners: tuple[PlannerLog, ...]
    parameters: Mapping[str, str] = field(default_factory=dict)


class _Lines:
    """The lines of a log, taken one by one."""

    def __init__(self, text: str) -> None:
        self._lines = text.split("\n")
        self._next = 0

    def take(self) -> str:
        if self._next >= len(self._lines):
            raise EllipsoidPlanningError("OMPL's benchmark log ends too early")
        self._next += 1
        return self._lines[self._next - 1]

    def match(self, pattern: str) -> str:
        line = self.take()
        found = re.fullmatch(pattern, line)
        if found is None:
            raise EllipsoidPlanningError(
                f"OMPL's benchmark log: line {self._next} does not match {pattern!r}: {line!r}"
            )
        return found[1]

    def count(self, what: str) -> int:
        return int(self.match(rf"(\d+) {what}"))

    def follows(self, pattern: str) -> bool:
        return re.fullmatch(pattern, self._lines[self._next]) is not None

    def block(self) -> str:
        self.match("(<<<\\|)")
        lines = []
        while (line := self.take()) != "|>>>":
            lines.append(line)
        return "\n".join(lines)


def parse_log(text: str) -> BenchmarkLog:
    """The log that ``text`` is.

    Raises:
        EllipsoidPlanningError: it is none that OMPL wrote.
    """
    lines = _Lines(text)
    parameters: dict[str, str] = {}
    version = lines.take()
    experiment = lines.match("Experiment (.*)")
    if lines.follows(r"\d+ experiment properties"):
        count = lines.count("experiment properties")
        parameters = dict(_setting(lines.take()) for _ in range(count))
    return BenchmarkLog(
        version=version,
        experiment=experiment,
        parameters=parameters,
        host=lines.match("Running on (.*)"),
        start=lines.match("Starting at (.*)"),
        setup=lines.block(),
        cpu=lines.block(),
        seed=lines.match("(.*) is the random seed"),
        seconds=lines.match("(.*) seconds per run"),
        memory=lines.match("(.*) MB per run"),
        run_count=lines.count("runs per planner"),
        duration=float(lines.match("(.*) seconds spent to collect the data")),
        enums=tuple(lines.take() for _ in range(lines.count("enum types?"))),
        planners=tuple(_planner(lines) for _ in range(lines.count("planners"))),
    )


def _setting(line: str) -> tuple[str, str]:
    name, _, value = line.partition(" = ")
    return name, value


def _planner(lines: _Lines) -> PlannerLog:
    name = lines.take()
    common = dict(_setting(lines.take()) for _ in range(lines.count("common properties")))
    names = [lines.take() for _ in range(lines.count("properties for each run"))]
    runs = tuple(_values(names, lines.take()) for _ in range(lines.count("runs")))
    progress_names: tuple[str, ...] = ()
    progress: tuple[str, ...] = ()
    if not lines.follows(r"\."):
        count = lines.count("progress properties for each run")
        progress_names = tuple(lines.take() for _ in range(count))
        progress = tuple(lines.take() for _ in range(lines.count("runs")))
    lines.match(r"(\.)")
    return PlannerLog(name, common, runs, progress_names, progress)


def _values(names: Sequence[str], line: str) -> dict[str, str]:
    values = line.split("; ")[:-1]
    return {name: value for name, value in zip(names, values, strict=True) if value}


def format_log(log: BenchmarkLog) -> str:
    """The text of a log, as OMPL would write it."""
    return "\n".join([*_header(log), *(line for p in log.planners for line in _body(p)), ""])


def _header(log: BenchmarkLog) -> Iterator[str]:
    yield log.version
    yield f"Experiment {log.experiment}"
    yield f"{len(log.parameters)} experiment properties"
    yield from (f"{name} = {value}" for name, value in log.parameters.items())
    yield f"Running on {log.host}"
    yield f"Starting at {log.start}"
    for text in (log.setup, log.cpu):
        yield from ("<<<|", text, "|>>>")
    yield f"{log.seed} is the random seed"
    yield f"{log.seconds} seconds per run"
    yield f"{log.memory} MB per run"
    yield f"{log.run_count} runs per planner"
    yield f"{log.duration:.6g} seconds spent to collect the data"
    yield f"{len(log.enums)} enum type{'s' if len(log.enums) > 1 else ''}"
    yield from log.enums
    yield f"{len(log.planners)} planners"


def _body(planner: PlannerLog) -> Iterator[str]:
    yield planner.name
    yield f"{len(planner.common)} common properties"
    yield from (f"{name} = {value}" for name, value in planner.common.items())
    names = sorted({name for run in planner.runs for name in run})
    yield f"{len(names)} properties for each run"
    yield from names
    yield f"{len(planner.runs)} runs"
    for run in planner.runs:
        yield "".join(f"{_plain(run.get(name, ''))}; " for name in names)
    if planner.progress_names:
        yield f"{len(planner.progress_names)} progress properties for each run"
        yield from planner.progress_names
        yield f"{len(planner.progress)} runs"
        yield from planner.progress
    yield "."


def _plain(value: str) -> str:
    # What ends a value, or a line, must not be part of one.
    return " ".join(value.replace(";", ",").split())


def merge_planners(planners: Iterable[PlannerLog]) -> PlannerLog:
    """One planner's runs from several logs, in their order; settings that differ are left out."""
    logs = list(planners)
    first = logs[0]
    common = {
        name: value
        for name, value in first.common.items()
        if all(log.common.get(name) == value for log in logs if log.common)
    }
    names = next((log.progress_names for log in logs if log.progress_names), ())
    progress = [text for log in logs for text in (log.progress or [""] * len(log.runs))]
    return replace(
        first,
        common=common,
        runs=tuple(run for log in logs for run in log.runs),
        progress_names=names,
        progress=tuple(progress) if names else (),
    )
