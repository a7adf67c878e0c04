"""What a narrow passage costs HighwayRoadmap, family by family; prints a table and Markdown.

    python -m benchmarks.families                 # every family, 20 seeds; about half an hour
    python -m benchmarks.families --quick         # 3 seeds at three clearances
    python -m benchmarks.families --families gap bend --clearances 1e-1 1e-4 --seeds 5

One process, kernels compiled beforehand, a fresh planner for every query; times are processor times
of `solve`, which keeps one core busy, its first level laid out before. Every path is proved motion
by motion; some are sampled densely as well.

Aims: see AIMS; the scene without its passage takes at least a third of the time at 1e-1.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Iterator

from benchmarks.families_cases import OPEN, Case, Series, all_cases, measure
from benchmarks.markdown import duration
from benchmarks.ratios import times
from ellipsoid_planning.families import family_names

AIMS = {"gap": 1e-6, "turned-gap": 1e-6, "window-3d": 1e-6}
"""Down to which clearance every run must be solved, at most GROWTH times as slow as at 1e-1."""
OTHER_AIMS = {"bend": 1e-4, "slot-3d": 1e-4, "tight-arena": 1e-4}
"""The same without a limit of time."""
GROWTH, AGAINST_OPEN = 3.0, 3.0
WIDE = 1e-1
CLEARANCES = tuple(float(f"1e-{digits}") for digits in range(1, 12))
ROUNDING = 1e-7
"""From this clearance on, rounding has its say; such clearances have a table of their own."""
_BEGAN = time.perf_counter()


def progress(message: str) -> None:
    sys.stderr.write(f"[{time.perf_counter() - _BEGAN:6.0f} s] {message}\n")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.families", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    known = family_names()
    parser.add_argument("--families", nargs="+", choices=known, default=known, metavar="NAME")
    parser.add_argument("--clearances", nargs="+", type=float, default=CLEARANCES)
    parser.add_argument("--seeds", type=int, default=20, help="scenes of each family (20)")
    parser.add_argument("--time-limit", type=float, default=10.0, help="of a query [s] (10)")
    parser.add_argument("--verify", type=int, default=1, help="seeds sampled densely too (1)")
    parser.add_argument("--quick", action="store_true", help="3 seeds; 1e-1, 1e-3, 1e-6")
    given = parser.parse_args()
    if given.quick:
        given.seeds, given.clearances = 3, (1e-1, 1e-3, 1e-6)
    if given.seeds < 1 or not given.time_limit > 0.0:
        parser.error("seeds and time limit must be positive")
    if not all(0.0 < clearance <= 1.0 for clearance in given.clearances):
        parser.error("clearances must be above 0 and at most 1")
    given.clearances = sorted({*given.clearances, WIDE}, reverse=True)
    return given


def scientific(clearance: float) -> str:
    if clearance == OPEN:
        return "open"
    return f"{clearance:.0e}".replace("e-0", "e-").replace("e+00", "")


def text(case: Case) -> Iterator[str]:
    """One line a clearance."""
    for clearance, series in case.series.items():
        solved = f"{series.solved}/{len(series.runs)}"
        line = f"{case.name:18s} {scientific(clearance):>6s} {solved:>7s} {shown(series):>9s}"
        yield line + f"   slowest {slowest(series):>9s}   sampled densely: {series.verified}"


def shown(series: Series) -> str:
    if math.isinf(series.median):
        return f">{series.time_limit:g} s"
    return "" if math.isnan(series.median) else duration(series.median)


def slowest(series: Series) -> str:
    solved = [run.seconds for run in series.runs if run.solved]
    return duration(max(solved)) if solved else "none"


def cell(series: Series) -> str:
    """The median time, and how many were solved if that is not all."""
    if series.solved == len(series.runs):
        return shown(series)
    share = f"{series.solved}/{len(series.runs)}"
    return f"{shown(series)} ({share})" if series.solved else share


def row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def table(cases: list[Case], clearances: list[float]) -> list[str]:
    """Median times by clearance, and what they amount to."""
    least = clearances[-1]
    heads = ["without passage", *map(scientific, clearances)]
    heads += [f"{scientific(WIDE)} : without", f"{scientific(least)} : {scientific(WIDE)}", "p"]
    lines = [row(["Family", *heads]), row(["---", *["---:"] * len(heads)])]
    for case in cases:
        cells = [cell(case.series[c]) for c in (OPEN, *clearances)]
        cells += [factor(case.ratio(WIDE, OPEN)), factor(case.ratio(least, WIDE))]
        lines.append(row([case.name, *cells, f"{case.exponent(clearances):.2f}"]))
    return lines


def rounding_table(cases: list[Case], clearances: list[float]) -> list[str]:
    """Median times and solved runs where rounding decides."""
    lines = [row(["Family", *map(scientific, clearances)])]
    lines.append(row(["---", *["---:"] * len(clearances)]))
    return lines + [row([one.name, *(cell(one.series[c]) for c in clearances)]) for one in cases]


def factor(value: float) -> str:
    return times(value) if math.isfinite(value) else "?"


def checks(case: Case) -> Iterator[str]:
    """Whether a case reaches its aims."""
    aim = AIMS.get(case.family, OTHER_AIMS.get(case.family))
    if aim is None:
        return
    asked = [series for c, series in case.series.items() if aim <= c <= WIDE]
    solved, runs = sum(one.solved for one in asked), sum(len(one.runs) for one in asked)
    yield f"{verdict(solved == runs)}: {case.name}: {solved} of {runs} solved to {scientific(aim)}"
    if case.family in AIMS and aim in case.series:
        for what, most, pair in (
            (f"{scientific(aim)} : {scientific(WIDE)}", GROWTH, (aim, WIDE)),
            (f"{scientific(WIDE)} : without passage", AGAINST_OPEN, (WIDE, OPEN)),
        ):
            found, paired = case.ratio(*pair), case.paired_ratio(*pair)
            line = f"{verdict(found <= most)}: {case.name}: time {what}: {factor(found)}"
            yield line + f" (scene by scene {factor(paired)}), aim {most:g}"


def verdict(reached: bool) -> str:
    return "reached" if reached else "MISSED "


def main() -> None:
    """Measure and print."""
    given = arguments()
    cases = all_cases(given.families)
    for case in cases:
        measure(case, given.clearances, given.seeds, given.time_limit, given.verify, progress)
        print("\n".join(text(case)), flush=True)
    large = [c for c in given.clearances if c > 3.0 * ROUNDING]
    small = [c for c in given.clearances if c <= 3.0 * ROUNDING]
    print("\n", *table(cases, large), sep="\n")
    if small:
        print("", *rounding_table(cases, small), sep="\n")
    print("\n```", *(line for case in cases for line in checks(case)), "```", sep="\n")


if __name__ == "__main__":
    main()
