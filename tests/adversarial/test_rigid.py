"""Some seconds of the search: nothing that collides is certified, nothing that is free refused."""

from __future__ import annotations

import numpy as np
import pytest

from tests.adversarial import rigid_cases
from tests.adversarial.outcome import Outcome
from tests.adversarial.rigid_motion import closest, is_proved_closer
from tests.adversarial.rigid_search import SEARCHES, search

CASES = 4


@pytest.mark.parametrize("kind", SEARCHES)
def test_nothing_is_decided_wrongly(kind: str) -> None:
    total = Outcome()
    for seed in range(CASES):
        total += SEARCHES[kind](seed)
    assert total.false == ()
    assert total.refused == ()


@pytest.mark.parametrize("seed", [27, 38, 64])
def test_what_was_certified_once_is_refused(seed: int) -> None:
    """With the reach 2·value/(root − slope) these were false certificates."""
    assert search(rigid_cases.post_with_a_hairy_proof, seed).false == ()


@pytest.mark.parametrize("kind", rigid_cases.FREE, ids=lambda kind: kind.__name__)
def test_motions_of_a_least_gap_above_the_tolerance_are_certified(kind) -> None:
    outcomes = [search(kind, seed) for seed in range(100, 100 + CASES)]
    assert sum(outcome.tried for outcome in outcomes) > CASES / 2
    assert all(outcome.certified == outcome.tried for outcome in outcomes)


def test_the_judge_sees_what_collides() -> None:
    hit = 0
    for seed in range(8):
        for scenario in search_cases(seed):
            place = closest(scenario, scenario.start, scenario.goal)
            hit += place.gap < 0.0 and is_proved_closer(scenario, place)
    assert hit > 4


def search_cases(seed: int) -> tuple:
    return rigid_cases.hit_while_held(np.random.default_rng(seed)).scenarios[-1:]
