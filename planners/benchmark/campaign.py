"""A campaign: every problem, by every contender, so and so often."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ellipsoid_planning import __version__
from planners.benchmark.contenders import Contender
from planners.benchmark.problems import Problem
from planners.benchmark.run import RunTask

FORMAT = 1


@dataclass(frozen=True)
class Campaign:
    """What is to be measured.

    Attributes:
        problems: what is planned.
        contenders: who plans.
        runs: how often each contender plans each problem.
        time_limit: of a run, for the planner alone [s].
        memory_limit: of a run, for the planner alone [MB].
        seed: of the first run; each further one has the next.
    """

    problems: tuple[Problem, ...]
    contenders: tuple[Contender, ...]
    runs: int
    time_limit: float
    memory_limit: float
    seed: int

    def tasks(self) -> Iterator[RunTask]:
        """All runs, in turns, so that whatever else the machine does hits all contenders alike."""
        for run in range(self.runs):
            for problem in self.problems:
                for contender in self.contenders:
                    yield self._task(problem, contender, run)

    def _task(self, problem: Problem, contender: Contender, run: int) -> RunTask:
        return RunTask(
            problem=problem.name,
            scenario=problem.scenario(run),
            planner=contender.planner,
            checker=contender.checker,
            label=contender.label,
            run=run,
            seed=self.seed + run,
            time_limit=self.time_limit,
            memory_limit=self.memory_limit,
        )

    def settings(self) -> dict[str, Any]:
        """Everything that results depend on, as data for JSON."""
        return {
            "format": FORMAT,
            "version": __version__,
            "problems": {problem.name: problem.digest() for problem in self.problems},
            "contenders": [f"{c.planner} with {c.checker}" for c in self.contenders],
            "runs": self.runs,
            "time limit": self.time_limit,
            "memory limit": self.memory_limit,
            "seed": self.seed,
        }


def differences(asked: Mapping[str, Any], found: Mapping[str, Any]) -> list[str]:
    """The names of the settings in which two campaigns differ."""
    names = dict.fromkeys([*asked, *found])
    return [name for name in names if asked.get(name) != found.get(name)]
