"""Motions of articulated robots, aimed at cancellation, decided by kernels and the judge."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from ellipsoid_planning.scenario import Scenario
from tests.adversarial.articulated_cases import KINDS, TWISTS, Case, draw
from tests.adversarial.outcome import Counterexample, Outcome

# What is free by this share of the scale is certified, unless the motion is one of those that are
# refused on purpose: half turns are proved both ways round, tiny ones in all ways.
TOLERANCE = 1e-9
PROVED_AT_ONCE = ("plain", "bolted", "offset", "small")
_ROUNDED = 1e-18  # what the judge itself is off by, as a share of the scale


def outcome_of(case: Case) -> Outcome:
    """Decide the motion of a case, and judge what was decided."""
    certified, share = case.is_certified(), float(case.truth.value) / case.scale
    false: tuple[Counterexample, ...] = ()
    refused: tuple[Counterexample, ...] = ()
    if certified and share < -_ROUNDED:
        false = (_counterexample(case, f"certified, but {-float(case.truth.value):.3g} too close"),)
    free = share > 0.5 * TOLERANCE and case.label.split("-")[1] in PROVED_AT_ONCE
    if free and not certified and case.space.are_valid([case.first, case.second]).all():
        refused = (_counterexample(case, "free by the tolerance, but refused"),)
    return Outcome(1, int(certified), false, refused)


def _counterexample(case: Case, what: str) -> Counterexample:
    space, s = case.space, float(case.truth.s)
    ends = case.first.tolist(), case.second.tolist()
    found = f"{case.label}: {what} at s = {s:.12g} from {ends[0]} to {ends[1]}"
    return Counterexample(
        found,
        Scenario(
            case.label,
            space.world,
            space.articulated,
            case.first,
            case.second,
            space.clearance_required,
        ),
    )


def search(kind: str, twist: str, seed: int) -> Outcome:
    """One case, in the plane or in space, grazing or touching near an end."""
    rng = np.random.default_rng([seed, KINDS.index(kind), TWISTS.index(twist)])
    hair = float(rng.choice([-1, 1])) * 10.0 ** rng.uniform(-15, -8)
    if rng.uniform() < 0.25:
        hair = TOLERANCE
    case = draw(rng, kind, twist, int(rng.integers(2, 4)), bool(rng.integers(2)), hair)
    return Outcome() if case is None else outcome_of(case)


SEARCHES: dict[str, Callable[[int], Outcome]] = {
    f"articulated: {kind}, {twist}": lambda seed, kind=kind, twist=twist: search(kind, twist, seed)
    for kind, twist in product(KINDS, TWISTS)
}
"""Searches by name: each decides one case of a seed."""
