"""Motions of rigid robots that are aimed at cancellation, decided by kernels and by the judge."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ellipsoid_planning.scenario import Scenario
from tests.adversarial.outcome import Counterexample, Outcome
from tests.adversarial.rigid_cases import Case, kinds
from tests.adversarial.rigid_lines import line_beside_an_obstacle, line_in_an_arena
from tests.adversarial.rigid_motion import closest, is_proved_closer
from tests.random_scenes import Rng


def outcome_of(case: Case) -> Outcome:
    """Decide the motions of a case, and judge what was decided."""
    total = Outcome()
    for scenario in case.scenarios:
        certified = scenario.cspace().is_motion_valid(scenario.start, scenario.goal)
        false = _false(scenario, case.hints) if certified else ()
        refused = ()
        if case.free and not certified:
            refused = (Counterexample("free by the tolerance, but refused", scenario),)
        total += Outcome(1, int(certified), false, refused)
    return total


def _false(scenario: Scenario, hints: tuple[float, ...]) -> tuple[Counterexample, ...]:
    """The certified motion, if it comes closer than it may."""
    place = closest(scenario, scenario.start, scenario.goal, hints)
    missing = scenario.clearance - place.gap
    if missing <= 0.0 or not is_proved_closer(scenario, place):
        return ()
    what = f"certified, but {missing:.3g} too close at s = {place.s:.12g}"
    return (Counterexample(what, scenario),)


def search(kind: Callable[[Rng], Case], seed: int) -> Outcome:
    """One case of a kind: same seed, same case."""
    return outcome_of(kind(np.random.default_rng(seed)))


SEARCHES: dict[str, Callable[[int], Outcome]] = {
    f"rigid: {kind.__name__.replace('_', ' ')}": partial(search, kind) for kind in kinds()
} | {
    f"rigid: {line.__name__.replace('_', ' ')}": line
    for line in (line_beside_an_obstacle, line_in_an_arena)
}
"""Searches by name: each decides one case of a seed."""
