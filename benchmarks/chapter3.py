"""Draws the figures of the thesis' chapter 3 with our numbers.

    python -m benchmarks.chapter3 [FOLDER] [--figures 3.6 3.9 ...]

Figures 3.4, 3.6 to 3.19 go to the folder, by default docs/images/chapter3. `benchmarks.phasing`
has the numbers.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from benchmarks.chapter3_figures import FIGURES

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images" / "chapter3"


def main() -> None:
    """Draw them, and say how long each took."""
    parser = argparse.ArgumentParser(description="The figures of the thesis' chapter 3.")
    parser.add_argument("folder", nargs="?", type=Path, default=FOLDER)
    parser.add_argument("--figures", nargs="+", choices=list(FIGURES), default=list(FIGURES))
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for name in arguments.figures:
        began = time.perf_counter()
        file = arguments.folder / f"figure-{name.replace('.', '-')}.png"
        FIGURES[name]().savefig(file, dpi=80)
        print(f"{file}: {time.perf_counter() - began:.1f} s", flush=True)


if __name__ == "__main__":
    main()
