"""How many proofs a turning motion takes as its gap shrinks; prints a Markdown table.

    python -m benchmarks.steps

Steps of the length gap / speed would grow as 1 / gap, and in the best case as its root; a curved
tube cannot be followed in fewer than gap^(−1/2) straight proofs.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from benchmarks.steps_cases import CASES, GAPS, Motion, exponent, proofs

AIM = 0.55
"""Largest exponent over gaps of 1e-2 and less."""


def row(case: Callable[[float], Motion]) -> tuple[str, bool]:
    """The line of a case, and whether it reaches the aim."""
    counts = [proofs(case, gap) for gap in GAPS]
    cspace, first, last = case(GAPS[-1])
    began = time.perf_counter()
    cspace.motion_proofs(first, last)
    seconds = time.perf_counter() - began
    name = (case.__doc__ or case.__name__).splitlines()[0].rstrip(".")
    if min(counts) < 0:
        return f"| {name} | " + " | ".join(map(str, counts)) + " | refused | |", False
    power = exponent(GAPS[1:], counts[1:])
    cells = " | ".join(map(str, counts))
    return f"| {name} | {cells} | {power:.2f} | {seconds * 1e3:.2g} ms |", power <= AIM


def main() -> None:
    """Count and print."""
    head = " | ".join(f"{gap:.0e}" for gap in GAPS)
    print(f"| gap | {head} | exponent | time at {GAPS[-1]:.0e} |")
    print("|---|" + "---:|" * (len(GAPS) + 2))
    reached = True
    for case in CASES:
        line, fine = row(case)
        reached &= fine
        print(line)
    print(f"\n{'reached' if reached else 'MISSED'}: exponents of at most {AIM}")


if __name__ == "__main__":
    main()
