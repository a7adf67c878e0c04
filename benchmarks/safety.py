"""Safety functions of articulated robots against FCL, side by side; prints Markdown tables.

    python -m benchmarks.safety                             # as in the thesis' section 6.4; minutes
    python -m benchmarks.safety --snake 500 --chain 300     # smaller roadmaps
    python -m benchmarks.safety --parts states growth

Roadmaps are OMPL's PRM grown to a number of milestones, with the same samples for every checker;
motions are certified with ours, and checked at OMPL's default resolution with FCL.

Aims: roadmaps at least 20 times faster, tables included; a state of the snake in less than 2 µs;
cost against the world linear in the number of links, self-collision less than quadratic.
"""

from __future__ import annotations

import argparse
import sys

from benchmarks.markdown import duration
from benchmarks.ratios import times
from benchmarks.safety_cases import LINKS, StateCosts, exponent, growth, state_costs
from benchmarks.safety_roadmaps import CHECKERS, NAMES, Growth, grown
from benchmarks.safety_scenes import CHAIN, SNAKE

PARTS = ("roadmaps", "states", "growth")
RUNS = 3
"""Of our own roadmaps, which take about a second; the median counts. FCL's takes minutes."""
FASTER = 20.0
STATE_TIME = 2e-6
LINEAR, QUADRATIC = 1.15, 2.0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.safety", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--snake", type=int, default=3000, help="its milestones (3000)")
    parser.add_argument("--chain", type=int, default=2000, help="its milestones (2000)")
    parser.add_argument("--seed", type=int, default=1, help="of OMPL (1)")
    given = parser.parse_args()
    if given.snake < 2 or given.chain < 2:
        parser.error("expected at least two milestones")
    return given


def progress(message: str) -> None:
    sys.stderr.write(f"{message}\n")
    sys.stderr.flush()


def row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def roadmaps(name: str, milestones: int, seed: int) -> tuple[list[str], list[str]]:
    """A table of how a scene's roadmap grows, and whether the aim is reached."""
    found: dict[str, Growth] = {}
    for checker in CHECKERS:
        progress(f"{name}: PRM of {milestones} milestones, {NAMES[checker]}")
        runs = 1 if checker == "fcl" else RUNS
        grew = [grown(name, checker, milestones, seed) for _ in range(runs)]
        found[checker] = sorted(grew, key=lambda one: one.seconds + one.tables)[runs // 2]
    lines = ["", row(name, "edges", "tables", "roadmap", "with tables", "FCL : this")]
    lines.append(row("---", *["---:"] * 5))
    checks, slow = [], found["fcl"].seconds_for(milestones)
    for checker, one in found.items():
        own = one.seconds_for(milestones)
        ratio = slow / (own + one.tables)
        tables = duration(one.tables) if one.tables else ""
        costs = (duration(own), duration(own + one.tables), times(ratio))
        lines.append(row(NAMES[checker], f"{one.edges:,}", tables, *costs))
        if checker != "fcl":
            checks.append(
                f"{_word(ratio >= FASTER)}: {name}, {milestones} milestones, {NAMES[checker]}: "
                f"{times(ratio)}, aim {FASTER:g}"
            )
    return lines, checks


def states(name: str) -> tuple[list[str], list[str]]:
    """A table of what states of a scene cost, and the tables' own data."""
    progress(f"{name}: states")
    found = state_costs(name)
    methods = tuple(found.anywhere)
    lines = ["", row(f"one state of {name}", *methods), row("---", *["---:"] * len(methods))]
    for label, costs in (("anywhere", found.anywhere), ("valid", found.valid)):
        lines.append(row(label, *(duration(costs[method]) for method in methods)))
    lines += ["", *_about_tables(found)]
    checks = []
    if name == SNAKE:
        least = found.anywhere["exact"]
        checks.append(
            f"{_word(least < STATE_TIME)}: a state of {name}: {duration(least)}, aim 2 µs"
        )
    return lines, checks


def _about_tables(found: StateCosts) -> list[str]:
    lines = [
        f"- {len(table.links)} links share a table of {table.description}: "
        f"{table.memory / 1e3:,.0f} kB, filled in {duration(table.seconds)}, "
        f"links grown by {table.inflation:.2g}"
        for table in found.tables.tables
    ]
    lines.append(
        f"- {100 * found.safe:.0f} % of the states are valid; tables answer "
        f"{100 * found.tables.answered:.0f} % of the queries for links, "
        f"{100 * found.answered_valid:.0f} % at valid states"
    )
    return lines


def links() -> tuple[list[str], list[str]]:
    """A table of what more links cost."""
    found = {}
    for count in LINKS:
        progress(f"a snake of {count} links")
        found[count] = growth(count)
    lines = ["", row("links", *map(str, LINKS), "exponent")]
    lines.append(row("---", *["---:"] * (len(LINKS) + 1)))
    slopes = {}
    for part in found[LINKS[0]]:
        costs = {count: one[part] for count, one in found.items()}
        slopes[part] = exponent(costs)
        lines.append(row(part, *map(duration, costs.values()), f"{slopes[part]:.2f}"))
    checks = [
        f"{_word(slopes[part] <= most)}: {part} grows as links ** {slopes[part]:.2f}, aim {aim}"
        for part, most, aim in (
            ("environment", LINEAR, "linear"),
            ("self-collision", QUADRATIC, "less than 2"),
        )
    ]
    return lines, checks


def _word(reached: bool) -> str:
    return "reached" if reached else "MISSED"


def main() -> None:
    """Measure and print."""
    given = arguments()
    lines: list[str] = []
    checks: list[str] = []
    parts = []
    if "states" in given.parts:
        parts += [lambda: states(SNAKE), lambda: states(CHAIN)]
    if "growth" in given.parts:
        parts.append(links)
    if "roadmaps" in given.parts:
        parts.append(lambda: roadmaps(SNAKE, given.snake, given.seed))
        parts.append(lambda: roadmaps(CHAIN, given.chain, given.seed))
    for part in parts:
        own, verdicts = part()
        lines += own
        checks += verdicts
    print(*lines, "", "```", *checks, "```", sep="\n")


if __name__ == "__main__":
    main()
