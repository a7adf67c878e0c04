"""Measure everything and print Markdown tables, with raw numbers in JSON beside them.

    python -m benchmarks.table                    # everything; an hour or two
    python -m benchmarks.table --quick            # a look, in a few minutes
    python -m benchmarks.table --scenarios rabbit-3d-open rabbit-3d-narrow --runs 3

Progress goes to stderr, tables and checks to stdout; both are written to files as well.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import time
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from benchmarks import aims, markdown
from benchmarks.command import CommandTimes, command_times
from benchmarks.plans import Series, run_plans
from benchmarks.ratios import by_scenario
from benchmarks.scenes import reference_scenario
from benchmarks.timing import CaseTime, measured
from ellipsoid_planning.scenario import bundled_scenarios

PARTS = ("kernels", "plans", "command")
COMMAND_SCENARIO = "rabbit-3d-narrow"
_BEGAN = time.perf_counter()


@dataclass
class Measurements:
    """Everything measured in one run; a part that was left out is None."""

    kernels: list[CaseTime] | None = None
    plans: list[Series] | None = None
    command: CommandTimes | None = None


def progress(message: str) -> None:
    sys.stderr.write(f"[{time.perf_counter() - _BEGAN:6.0f} s] {message}\n")
    sys.stderr.flush()


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.table", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    known = list(bundled_scenarios())
    parser.add_argument("--scenarios", nargs="+", choices=known, default=known, metavar="NAME")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--runs", type=int, default=5, help="seeds of each planner (5)")
    parser.add_argument("--time-limit", type=float, default=60.0, help="of one run [s] (60)")
    parser.add_argument("--rounds", type=int, default=15, help="of the kernels (15)")
    parser.add_argument("--quick", action="store_true", help="1 run of 2 s at most, 3 rounds")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("benchmarks/results"),
        help="files without suffix: .md and .json are added (benchmarks/results)",
    )
    given = parser.parse_args()
    if given.quick:
        given.runs, given.time_limit, given.rounds = 1, 2.0, 3
    if given.runs < 1 or given.rounds < 1 or not given.time_limit > 0.0:
        parser.error("runs, rounds and time limit must be positive")
    if not given.output.parent.is_dir():
        parser.error(f"no such folder: {given.output.parent}")
    return given


def measure(given: argparse.Namespace) -> Measurements:
    """Run the parts that are asked for."""
    found = Measurements()
    if "kernels" in given.parts:
        found.kernels = measured(given.rounds, progress)
    if "command" in given.parts:
        known = bundled_scenarios()
        name = COMMAND_SCENARIO if COMMAND_SCENARIO in known else next(iter(known))
        found.command = command_times(name, 1 if given.quick else 5, progress)
    if "plans" in given.parts:
        found.plans = run_plans(given.scenarios, given.runs, given.time_limit, progress)
    return found


def report(found: Measurements) -> str:
    """Tables and checks as Markdown."""
    lines: list[str] = []
    checks: list[aims.Check] = []
    if found.kernels is not None:
        scene = reference_scenario().name
        lines += [*markdown.kernel_table(found.kernels), "", f"States and motions: {scene}.", ""]
        checks += aims.kernel_checks(found.kernels)
    if found.plans is not None:
        table = by_scenario(found.plans)
        lines += [*markdown.plan_table(table), "", *markdown.notes(table), ""]
        checks += aims.plan_checks(table)
    if found.command is not None:
        checks += aims.command_checks(found.command)
    return "\n".join([*lines, "```", *map(str, checks), "```"])


def raw(found: Measurements, given: argparse.Namespace) -> dict[str, Any]:
    """All numbers, and what they were measured with."""
    packages = ("ellipsoid-planning", "ompl", "python-fcl", "numba", "numpy")
    return {
        "options": {key: str(value) for key, value in vars(given).items()},
        "machine": {
            "platform": platform.platform(),
            "processor": platform.processor(),
            "cores": os.cpu_count(),
            "load": os.getloadavg(),
            "python": platform.python_version(),
            "versions": {name: version(name) for name in packages},
        },
        "kernels": None if found.kernels is None else [asdict(one) for one in found.kernels],
        "plans": None if found.plans is None else [one.to_dict() for one in found.plans],
        "command": None if found.command is None else asdict(found.command),
    }


def main() -> None:
    """Measure, print, write."""
    given = arguments()
    found = measure(given)
    text = report(found)
    print(text)
    given.output.with_suffix(".md").write_text(text + "\n", encoding="utf-8")
    numbers = json.dumps(raw(found, given), indent=1)
    given.output.with_suffix(".json").write_text(numbers + "\n", encoding="utf-8")
    progress(f"wrote {given.output.with_suffix('.md')} and .json")


if __name__ == "__main__":
    main()
