"""The crystal packing of the thesis' section 4.3.1 and Fig. 4.6, over many turns of each grid.

    python -m benchmarks.chapter4_packing [FILE.png]

A rabbit of three ellipsoids keeps its place in a cell and turns; its copies in the neighbouring
cells turn with it (P1). Counted are the orientations of a grid at which no copies meet. A grid
turned at random has every orientation equally often at each node, so that the expected number is
the same for all grids of a size, the free share of all orientations times the size: one placement
of a grid, as in Fig. 4.6, is luck. What an even grid buys is less scatter about that number.
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.groups import RotationGrid, grid_by_name
from ellipsoid_planning.groups.quaternions import inverse, product, random_rotations
from ellipsoid_planning.scenario import load_scenario
from planners.view import colours

FILE = Path(__file__).resolve().parent.parent / "docs" / "images" / "chapter4" / "figure-4-6.png"
CELL = np.array([12.0, 8.4, 7.4])
GRIDS = {
    "600-cell": ((420, 1_380, 6_300), colours.ROBOT),
    "icosahedral": ((480, 1_920, 5_280), colours.START),
    "euler": ((500, 1_372, 5_324), colours.GOAL),
    "random": ((500, 1_500, 5_000), colours.ROADMAP),
}
TURNS = 40
STEPS = (
    18  # of the golden section; errors of the share s of 0.618^18 matter at grazing contact only
)
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


def are_free(rotations: np.ndarray, parts: tuple[Ellipsoid, ...], cell: np.ndarray) -> np.ndarray:
    """At which of the rotations (n, 4) no copies of the body in a lattice of cells meet, (n,)."""
    free = np.ones(len(rotations), dtype=bool)
    steps = [np.array(step) for step in itertools.product((-1, 0, 1), repeat=3)]
    # A copy's opposite one meets the body just where it does.
    for step in steps[len(steps) // 2 + 1 :]:
        left = np.flatnonzero(free)
        seen = _turned(inverse(rotations[left]), step * cell)
        for one, other in itertools.product(parts, repeat=2):
            free[left] &= ~_meet(one, other, seen + other.centre - one.centre)
    return free


def _turned(rotations: np.ndarray, vector: np.ndarray) -> np.ndarray:
    pure = np.append(vector, 0.0)
    return product(product(rotations, pure), inverse(rotations))[:, :3]


def _meet(one: Ellipsoid, other: Ellipsoid, offsets: np.ndarray) -> np.ndarray:
    """Whether ellipsoids meet when the other's centre is at ``offsets`` (n, 3) from the first's.

    The sum of E1 and E2 is the intersection of the ellipsoids Q1 / s + Q2 / (1 - s), 0 < s < 1.
    """
    whiten = np.linalg.inv(one.matrix)
    squares, axes = np.linalg.eigh(whiten @ other.shape_matrix @ whiten.T)
    weights = ((offsets @ whiten.T) @ axes) ** 2

    def value(s: np.ndarray) -> np.ndarray:
        s = s[:, None]
        return np.sum(weights * s * (1.0 - s) / (1.0 - s + squares * s), axis=1)

    low, high = np.zeros(len(offsets)), np.ones(len(offsets))
    for _ in range(STEPS):
        width = GOLDEN * (high - low)
        first, second = high - width, low + width
        rising = value(first) < value(second)
        low, high = np.where(rising, first, low), np.where(rising, high, second)
    return value(0.5 * (low + high)) <= 1.0


def found(grid: RotationGrid, parts: tuple[Ellipsoid, ...], turns: int, seed: int) -> np.ndarray:
    """How many free orientations each of the randomly turned grids has, (turns,)."""
    turned = random_rotations(turns, seed)
    nodes = grid.quaternions()
    return np.array([are_free(product(turn, nodes), parts, CELL).sum() for turn in turned])


def trial(name: str, size: int, parts: tuple[Ellipsoid, ...], turns: int) -> np.ndarray:
    """How many free orientations each of ``turns`` placements of a grid has, (turns,)."""
    if name == "random":  # other rotations every time, not the same ones turned
        grids = [grid_by_name(name, count=size, seed=seed) for seed in range(turns)]
        return np.array([are_free(g.quaternions(), parts, CELL).sum() for g in grids])
    return found(grid_by_name(name, count=size), parts, turns, seed=size)


def results(turns: int = TURNS) -> list[tuple[str, int, np.ndarray]]:
    """Grid, count and free orientations found, for every grid and size."""
    parts = load_scenario("rabbit-3d-open").robot.parts
    cases = [(name, size) for name, (sizes, _) in GRIDS.items() for size in sizes]
    return [(name, size, trial(name, size, parts, turns)) for name, size in cases]


def draw(rows: list[tuple[str, int, np.ndarray]]) -> Figure:
    """The free orientations found against the number of samples, and their scatter."""
    drawn = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = drawn.subplots(1, 2)
    for name, (_, hue) in GRIDS.items():
        mine = [(count, values) for other, count, values in rows if other == name]
        counts = np.array([count for count, _ in mine])
        mean = np.array([values.mean() for _, values in mine])
        spread = np.array([values.std(ddof=1) for _, values in mine])
        left.errorbar(counts, mean, spread, color=hue, marker="o", capsize=4, label=name)
        right.plot(counts, 100.0 * spread / mean, color=hue, marker="o", label=name)
    left.set_title("Free orientations found: mean ± standard deviation", loc="left", fontsize=10)
    right.set_title("Standard deviation [% of the mean]", loc="left", fontsize=10)
    right.set_ylim(bottom=0.0)
    for axes in (left, right):
        axes.set_xlabel("orientations tried")
        axes.spines[["top", "right"]].set_visible(False)
    left.legend(fontsize=9, frameon=False)
    return drawn


def main() -> None:
    """Draw, and print the table."""
    parser = argparse.ArgumentParser(description="Free orientations found against samples.")
    parser.add_argument("file", nargs="?", type=Path, default=FILE)
    parser.add_argument("--turns", type=int, default=TURNS, metavar="N")
    arguments = parser.parse_args()
    rows = results(arguments.turns)
    draw(rows).savefig(arguments.file, dpi=80)
    print("| grid | tried | free, mean | of those tried | standard deviation | none found |")
    print("|---|---|---|---|---|---|")
    for name, count, values in rows:
        share = f"{100.0 * values.mean() / count:.2f} %"
        none = f"{100.0 * np.mean(values == 0):.0f} %"
        spread = values.std(ddof=1)
        print(f"| {name} | {count:,} | {values.mean():.1f} | {share} | {spread:.1f} | {none} |")


if __name__ == "__main__":
    main()
