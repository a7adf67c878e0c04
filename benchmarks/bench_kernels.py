"""Kernels and callbacks with pytest-benchmark: `pytest benchmarks/bench_kernels.py`.

The normal test run does not collect this file. Times are per call of a case, which does
``operations`` of its topic (in the extra information); one group is one topic.
"""

from __future__ import annotations

import pytest

from benchmarks.cases import Case, all_cases


def _name(case: Case) -> str:
    return f"{case.topic}: {case.method}"


@pytest.mark.parametrize("case", all_cases(), ids=_name)
def test_speed(benchmark, case):
    benchmark.group = f"{case.topic} (x{case.operations})"
    benchmark.extra_info["operations"] = case.operations
    case.run()  # compiles what is not compiled yet
    benchmark.pedantic(case.run, rounds=9, iterations=1)
