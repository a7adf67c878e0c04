"""The search for false certificates, for as long as one likes.

    python -m benchmarks.adversarial --minutes 60 --seed 1

Every case is aimed at a place where numbers cancel (tests/adversarial), and judged without the
kernels. Seeds go up from the first one; a case of a kind and a seed is always the same. Scenarios
that were decided wrongly are written to a folder, and the script then exits with 1.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import sys
import time
from collections.abc import Callable
from pathlib import Path

from ellipsoid_planning.scenario_yaml import scenario_text
from tests import adversarial
from tests.adversarial.outcome import Counterexample, Outcome


def searches(word: str = "") -> dict[str, Callable[[int], Outcome]]:
    """All kinds of cases whose name contains the word.

    They stand in the tables SEARCHES (kind: what decides its case of a seed) of tests/adversarial.
    """
    names = [m.name for m in pkgutil.iter_modules(adversarial.__path__, adversarial.__name__ + ".")]
    found = [importlib.import_module(name) for name in names if name.endswith("_search")]
    tables = [module.SEARCHES for module in found]
    return {name: search for table in tables for name, search in table.items() if word in name}


def save(found: Counterexample, kind: str, seed: int, folder: Path) -> Path:
    """Write a scenario that was decided wrongly, and say where it is."""
    folder.mkdir(parents=True, exist_ok=True)
    name = "".join(c if c.isalnum() else "-" for c in f"{kind}-{seed}")
    count = len(list(folder.glob(f"{name}-*.yaml")))
    path = folder / f"{name}-{count}.yaml"
    path.write_text(f"# {kind}, seed {seed}: {found.what}\n{scenario_text(found.scenario)}")
    return path


def report(totals: dict[str, Outcome]) -> None:
    """Print what was tried so far."""
    print(f"\n{'kind':42} {'tried':>8} {'certified':>9} {'false':>6} {'refused':>7}")
    for kind, total in totals.items():
        counts = total.tried, total.certified, len(total.false), len(total.refused)
        print(f"{kind:42} {counts[0]:8d} {counts[1]:9d} {counts[2]:6d} {counts[3]:7d}")


def run(minutes: float, seed: int, word: str, folder: Path) -> int:
    """Search in turn by every kind until the time is over: 1 if anything was wrong, else 0."""
    kinds = searches(word)
    totals = {kind: Outcome() for kind in kinds}
    began = reported = time.monotonic()
    while time.monotonic() - began < 60.0 * minutes:
        for kind, search in kinds.items():
            outcome = search(seed)
            totals[kind] += outcome
            for found in outcome.false + outcome.refused:
                print(f"{kind}, seed {seed}: {found.what}: {save(found, kind, seed, folder)}")
        seed += 1
        if time.monotonic() - reported > 60.0:
            reported = time.monotonic()
            report(totals)
    report(totals)
    return int(any(total.false or total.refused for total in totals.values()))


def main() -> int:
    """Read the command line and search."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0, help="first seed")
    parser.add_argument("--kind", default="", help="only kinds whose name contains this")
    parser.add_argument("--folder", type=Path, default=Path("counterexamples"))
    given = parser.parse_args()
    return run(given.minutes, given.seed, given.kind, given.folder)


if __name__ == "__main__":
    sys.exit(main())
