"""Arrangements whose copies touch by a hair: none is called free."""

from __future__ import annotations

import pytest

from tests.adversarial.outcome import Outcome
from tests.adversarial.packing_judge import least_gap
from tests.adversarial.packing_search import SEARCHES, _as_world
from tests.crystal.packings import one_body


def test_no_arrangement_is_called_free_that_touches() -> None:
    total = sum((search(seed) for search in SEARCHES.values() for seed in range(2)), Outcome())
    assert total.tried >= 8
    assert not total.false, total.false[0].what
    assert not total.refused, total.refused[0].what


@pytest.mark.parametrize(
    "arrangement",
    [
        [320.2000000000001, -877.5000000000002],
        [-183.8, -756.0000000000001],
        [-125.79999999999998, -751.5000000000001],
    ],
)
def test_far_from_a_flat_cell_more_is_asked_for(arrangement: list[float]) -> None:
    """A hundred cells out the places of copies are rounded by more than these touch by."""
    cell, search = "{lengths: [4, 9], angles_deg: [8]}", "{lower: 0, upper: 0.01, step: 0.01}"
    model = one_body("p2", cell, [0.2, 0.1], f"{{position: {{x: {search}, y: {search}}}}}")
    assert -1e-13 < float(least_gap(model, arrangement)) < -1e-14
    assert not model.is_free(arrangement)
    assert model.is_free([arrangement[0] - 1e-10, arrangement[1]]) != model.is_free(
        [arrangement[0] + 1e-10, arrangement[1]]
    )


def test_the_judge_knows_a_row_of_discs() -> None:
    model = one_body("p1", "{lengths: [2.5, 9], angles_deg: [110]}", [1.0, 1.0], position=[7, -3])
    assert float(least_gap(model, [])) == pytest.approx(0.4, abs=1e-15)  # told up to 0.4 of 1
    close = one_body("p1", "{lengths: [2.25, 9]}", [1.0, 1.0])
    assert float(least_gap(close, [])) == pytest.approx(0.25, abs=1e-15)
    assert len(_as_world(close, []).world.obstacles) == 0
