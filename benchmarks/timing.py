"""Times of the kernel cases, measured in turns so that a noisy moment hits all of them."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.cases import Case, agreement, all_cases

CALL_TIME = 2e-3
"""A measurement calls a case as often as fits in this [s], at least once."""


@dataclass(frozen=True)
class CaseTime:
    """Seconds for one operation of a case, one for each round, and how many hits it found."""

    topic: str
    method: str
    seconds: tuple[float, ...]
    hits: int | None

    @property
    def median(self) -> float:
        """The median over the rounds [s]."""
        return statistics.median(self.seconds)


def measured(rounds: int, progress: Callable[[str], None]) -> list[CaseTime]:
    """Times of all cases; each round measures every case once."""
    progress("kernels: preparing scenes and compiling")
    cases = all_cases()
    hits = [agreement(case) for case in cases]
    repeats = [max(1, int(CALL_TIME / _seconds(case, 1))) for case in cases]
    times: list[list[float]] = [[] for _ in cases]
    for number in range(rounds):
        progress(f"kernels: round {number + 1} of {rounds}")
        for case, repeat, found in zip(cases, repeats, times, strict=True):
            found.append(_seconds(case, repeat) / (repeat * case.operations))
    return [
        CaseTime(case.topic, case.method, tuple(found), count)
        for case, found, count in zip(cases, times, hits, strict=True)
    ]


def _seconds(case: Case, repeat: int) -> float:
    began = time.perf_counter()
    for _ in range(repeat):
        case.run()
    return time.perf_counter() - began
