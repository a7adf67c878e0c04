"""Regenerates the results of the thesis' chapter 4: grids side by side, and its figures.

    python -m benchmarks.chapter4 [FOLDER] [--no-figures] [--counts N N ...]

Figures 4.3, 4.4, 4.7, 4.9, 4.10 and 4.12, and one of the grids' evenness, go to the folder, by
default docs/images/chapter4.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from benchmarks.chapter4_figures import FIGURES, evenness
from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups import GridMetrics, RotationGrid, grid_by_name, grid_names, measure
from ellipsoid_planning.groups.voronoi import ALL_ROTATIONS

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images" / "chapter4"
COUNTS = (500, 4_500, 36_000)
FAR = 1.6  # a grid that has no count within this factor of the wanted one is left out
HEAD = (
    "| grid | N | separation [°] | covering radius [°] | thickness | neighbour ratio | distortion |"
)


def nearest_size(name: str, count: int) -> GridMetrics | None:
    """The measures of the named grid whose count is nearest to ``count``, None when none is."""
    # The first is at least as fine as wanted; the second, a little coarser, may be nearer.
    both = [_at_least(name, count), _at_least(name, round(count / 1.5))]
    grids = [grid for grid in both if grid is not None]
    best = min(grids, key=lambda grid: abs(math.log(grid.count / count)), default=None)
    if best is None or abs(math.log(best.count / count)) > math.log(FAR):
        return None
    return measure(best)


def _at_least(name: str, count: int) -> RotationGrid | None:
    resolution = math.degrees((ALL_ROTATIONS / count) ** (1.0 / 3.0))
    try:
        return grid_by_name(name, resolution_deg=resolution)
    except GridError:
        return None


def table(counts: tuple[int, ...]) -> list[tuple[str, GridMetrics]]:
    """Every grid at every count, by wanted count and then by thickness."""
    rows: list[tuple[str, GridMetrics]] = []
    for count in counts:
        found = [(name, nearest_size(name, count)) for name in grid_names()]
        kept = [(name, one) for name, one in found if one is not None]
        rows += sorted(kept, key=lambda row: row[1].thickness)
    return rows


def line(name: str, one: GridMetrics) -> str:
    covering = f"{math.degrees(one.covering):.2f}"
    cells = (
        name,
        f"{one.count:,}",
        f"{math.degrees(one.separation):.2f}",
        covering if one.covering_is_exact else f"at least {covering}",
        f"{one.thickness:.2f}",
        f"{one.neighbour_ratio:.3f}",
        "" if one.max_distortion is None else f"{100.0 * one.max_distortion:.2f} %",
    )
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Draw, and print the table."""
    parser = argparse.ArgumentParser(description="The results of the thesis' chapter 4.")
    parser.add_argument("folder", nargs="?", type=Path, default=FOLDER)
    parser.add_argument("--no-figures", action="store_true", help="print the table only")
    parser.add_argument("--counts", nargs="+", type=int, default=COUNTS, metavar="N")
    arguments = parser.parse_args()
    rows = table(tuple(arguments.counts))
    if not arguments.no_figures:
        arguments.folder.mkdir(parents=True, exist_ok=True)
        for name, draw in FIGURES.items():
            draw().savefig(arguments.folder / f"figure-{name.replace('.', '-')}.png", dpi=80)
        evenness(rows).savefig(arguments.folder / "evenness.png", dpi=80)
    print(HEAD + "\n|---|---|---|---|---|---|---|")
    for name, one in rows:
        print(line(name, one))


if __name__ == "__main__":
    main()
