"""Regenerates the results of the thesis' chapter 5: its figures, and a table of its numbers.

    python -m benchmarks.chapter5 [FOLDER]

Figures 5.3 to 5.8, 5.10 and 5.12 to 5.16 go to the folder, by default docs/images/chapter5.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from benchmarks.chapter5_figures import FIGURES, haar_volumes
from benchmarks.chapter5_trials import errors, grid_errors, median_of_largest, sums
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.motion_volume import contained_motions
from ellipsoid_planning.geometry.sum_bounds import sum_volume_bounds
from ellipsoid_planning.orientation_forms import rotation_from_form

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images" / "chapter5"
MANY = 20_000


def body(*axes: float, zxz_deg=None, yaw_deg: float = 0.0) -> Ellipsoid:
    if len(axes) == 2:
        return Ellipsoid.from_semi_axes(axes, None, math.radians(yaw_deg))
    rotation = rotation_from_form("euler_zxz_deg", zxz_deg or [0.0, 0.0, 0.0])
    return Ellipsoid.from_semi_axes(axes, None, rotation)


def rows() -> list[tuple[str, str, str]]:
    """Figure, what the thesis prints, what we compute."""
    return [*_examples(), *_errors(), *_motions()]


def _examples() -> list[tuple[str, str, str]]:
    def values(first: Ellipsoid, second: Ellipsoid, *names: str) -> str:
        found = sum_volume_bounds(first, second)
        return ", ".join(f"{float(found[name]):.6g}" for name in names)

    five = ("brunn_minkowski", "lower", "lower_exact_surface", "exact", "upper_exact_surface")
    turned = body(7, 3, 3, zxz_deg=[-45, -22.5, 45]), body(2, 3, 4, zxz_deg=[60, 45, -30])
    return [
        ("5.9 (a)", "63.61", values(body(3, 3), body(1.5, 1.5), "exact")),
        (
            "5.9 (b)",
            "131.9, 165.2, 171.1, 179.1",
            values(
                body(1, 5), body(3, 6, yaw_deg=45), "brunn_minkowski", "lower", "exact", "upper"
            ),
        ),
        ("5.11 (a)", "1.15e3", values(body(4, 4, 4), body(2.5, 2.5, 2.5), "exact")),
        (
            "5.11 (b)",
            "448.1, 563.3, 573.7",
            values(
                body(2, 2, 2), body(2, 2, 6), "brunn_minkowski", "exact", "upper_cauchy_schwarz"
            ),
        ),
        (
            "5.11 (c)",
            "1354.4, 1678.8, 1724.3, 1725.9, 1729.2, 1741.2",
            values(*turned, *five, "upper"),
        ),
    ]


def _errors() -> list[tuple[str, str, str]]:
    plane, space = errors(sums(2, MANY)), errors(sums(3, MANY))
    means = ("arithmetic_mean", "geometric_mean")
    first = median_of_largest(("lower", "upper"))
    second = median_of_largest(("lower_exact_surface", "upper_exact_surface"))
    estimate = f"V_est {_worst(space, 'estimate'):.2f} %"
    return [
        ("5.6", "below 5 %", _span(grid_errors("M"), "lower", "upper")),
        ("5.8", "below 10 %", _span(grid_errors("F"), "lower", "upper")),
        ("5.10", "below 8 %", f"{_span(plane, 'lower', 'upper')} ({MANY} trials)"),
        ("5.12", "6 %; 2 %", f"{first:.1f} %; {second:.1f} % (median of the worst of 100)"),
        ("5.13", "0.7 %", f"{_worst(plane, *means):.2f} % ({MANY} trials)"),
        (
            "5.14",
            "V_AM, V_GM below 1 %",
            f"{_worst(space, *means):.1f} %, {estimate} ({MANY} trials)",
        ),
    ]


def _motions() -> list[tuple[str, str, str]]:
    plane = contained_motions(body(18, 15), body(2, 3)).value
    arena, part = body(30, 40, 50), body(1, 2, 3)
    space = contained_motions(arena, part).value
    drawn = 8.0 * math.pi**2 * float(np.mean(haar_volumes(arena, part, MANY)))
    return [
        ("5.15", "3.799e3", f"{plane:.9g}"),
        ("5.16", "1.64e7; 1.57e7", f"{space:.7g}; {drawn:.6g} (Haar Monte Carlo, {MANY})"),
    ]


def _span(found: dict[str, np.ndarray], lower: str, upper: str) -> str:
    return f"{found[lower].min():+.2f} %, {found[upper].max():+.2f} %"


def _worst(found: dict[str, np.ndarray], *names: str) -> float:
    return max(float(np.abs(found[name]).max()) for name in names)


def main() -> None:
    """Draw, and print the table."""
    parser = argparse.ArgumentParser(description="The results of the thesis' chapter 5.")
    parser.add_argument("folder", nargs="?", type=Path, default=FOLDER)
    parser.add_argument("--no-figures", action="store_true", help="print the table only")
    arguments = parser.parse_args()
    if not arguments.no_figures:
        arguments.folder.mkdir(parents=True, exist_ok=True)
        for name, draw in FIGURES.items():
            draw().savefig(arguments.folder / f"figure-{name.replace('.', '-')}.png", dpi=100)
    print("| figure | printed | computed |\n|---|---|---|")
    for row in rows():
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
