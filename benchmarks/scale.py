"""What 10 to 10,000 ellipsoids at one density cost; prints Markdown tables.

    python -m benchmarks.scale                        # both dimensions, 5 worlds of each size
    python -m benchmarks.scale --dimensions 3 --worlds 11

Aims: a state check and a whole plan among 10,000 take at most 3 times what they take among 100.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Callable

from benchmarks.scale_cases import BYTES, COUNTS, TIMES, measure
from benchmarks.scale_scenes import SIZES

AIMS = {"state check, in the middle": 3.0, "state check, anywhere": 3.0, "whole plan": 3.0}
"""Largest ratio of the costs among 10,000 and among 100 obstacles."""

Costs = dict[int, list[dict[str, float]]]
"""For every size, what each of its worlds costs."""


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scale", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--dimensions", nargs="+", type=int, choices=(2, 3), default=(2, 3))
    parser.add_argument("--worlds", type=int, default=5, help="of each size (5)")
    given = parser.parse_args()
    if given.worlds < 1:
        parser.error("expected at least one world of each size")
    return given


def measured(dimension: int, worlds: int) -> Costs:
    """The costs of worlds of every size; seed by seed, so that a noisy moment hits all sizes."""
    found: Costs = {size: [] for size in SIZES}
    for seed in range(1, worlds + 1):
        for size in SIZES:
            sys.stderr.write(f"{dimension}-D, world {seed} of {worlds}, {size} obstacles\n")
            found[size].append(measure(size, dimension, seed))
    return found


def median(costs: Costs, size: int, name: str) -> float:
    return statistics.median(world[name] for world in costs[size])


def ratios(costs: Costs, name: str) -> list[float]:
    """Costs among 10,000 over costs among 100, world by world, in ascending order."""
    pairs = zip(costs[SIZES[-1]], costs[SIZES[1]], strict=True)
    return sorted(large[name] / small[name] for large, small in pairs)


def table(costs: Costs) -> list[str]:
    """Medians over the worlds, and the median and the largest ratio, as Markdown."""
    head = " | ".join(f"{size:,}" for size in SIZES)
    lines = [f"| obstacles | {head} | 10,000 : 100 | worst world |"]
    lines.append("|---|" + "---:|" * (len(SIZES) + 2))
    for name in (*TIMES, *COUNTS, *BYTES):
        shown = shown_as(name)
        values = " | ".join(shown(median(costs, size, name)) for size in SIZES)
        of_worlds = ratios(costs, name)
        middle = statistics.median(of_worlds)
        lines.append(f"| {name} | {values} | {middle:.2f} | {of_worlds[-1]:.2f} |")
    return lines


def shown_as(name: str) -> Callable[[float], str]:
    if name in COUNTS:
        return "{:.1f}".format
    return bytes_text if name in BYTES else seconds_text


def seconds_text(value: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value * 1e6:.3g} µs"


def bytes_text(value: float) -> str:
    return f"{value / 1e6:.2g} MB" if value >= 1e6 else f"{value / 1e3:.3g} kB"


def checks(costs: Costs, dimension: int) -> list[str]:
    """Whether the medians of the ratios reach the aims."""
    lines = []
    for name, most in AIMS.items():
        found = statistics.median(ratios(costs, name))
        word = "reached" if found <= most else "MISSED"
        lines.append(f"{word}: {dimension}-D, {name}: {found:.2f} times, aim {most:g}")
    return lines


def main() -> None:
    """Measure and print."""
    given = arguments()
    verdicts = []
    for dimension in given.dimensions:
        costs = measured(dimension, given.worlds)
        print(f"\n### {dimension}-D\n", *table(costs), sep="\n")
        verdicts += checks(costs, dimension)
    print("\n```", *verdicts, "```", sep="\n")


if __name__ == "__main__":
    main()
