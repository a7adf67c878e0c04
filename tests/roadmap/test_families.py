"""The families solved at every width, paths judged anew; blocked ones never."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.families import make_family, make_family_scene
from ellipsoid_planning.roadmap.highway import EXHAUSTED, SOLVED, TIMEOUT
from tests.families.oracle import CASES
from tests.roadmap.family_paths import (
    assert_exactly_free,
    assert_free,
    assert_verified,
    changed,
    is_proved,
    query,
)

# How long planners look for what there is not [s].
SHORT = 0.2


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_families_are_solved_at_every_width(name, dimension):
    for clearance, seed in itertools.product((1e-1, 1e-3, 1e-6), (None, 1)):
        made = make_family_scene(name, clearance, dimension, seed)
        scenario = made.scenario
        planner, outcome = query(scenario)
        assert outcome.status == SOLVED, (clearance, seed)
        assert is_proved(planner.cspace, outcome.path)
        tightest = assert_free(scenario, outcome.path)
        if clearance <= 1e-6:
            assert_exactly_free(scenario, tightest)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_paths_lead_through_the_passage(name, dimension):
    """No way has more play, however closely one looks."""
    made = make_family_scene(name, 1e-2, dimension, 2)
    _, outcome = query(made.scenario)
    sampled = assert_verified(made.scenario, outcome.path)
    play = min(gate.play for gate in made.gates)
    assert 0.0 < sampled.smallest <= 0.5 * play * (1 + 1e-6)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_blocked_families_have_no_path(name, dimension):
    for clearance in (1e-2, 1e-6, 1e-11):
        _, outcome = query(make_family(name, clearance, dimension, 2, blocked=True), limit=SHORT)
        assert outcome.status in (TIMEOUT, EXHAUSTED)
        assert outcome.path is None


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_a_required_clearance_of_more_than_half_the_play_blocks(name, dimension):
    made = make_family_scene(name, 1e-1, dimension, 1)
    play = min(gate.play for gate in made.gates)
    narrow = changed(made.scenario, clearance=0.49 * play)
    _, outcome = query(narrow)
    assert outcome.status == SOLVED
    assert_free(narrow, outcome.path)
    _, outcome = query(changed(made.scenario, clearance=0.51 * play), limit=SHORT)
    assert outcome.path is None


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_where_rounding_decides_paths_are_proved_or_refused(name, dimension):
    """At 1e-9 and below there may be no path, but none that is not proved."""
    for clearance in (1e-9, 1e-11, 1e-13):
        scenario = make_family(name, clearance, dimension, 1)
        planner, outcome = query(scenario, limit=SHORT)
        if outcome.path is not None:
            assert is_proved(planner.cspace, outcome.path)
            assert_exactly_free(scenario, assert_free(scenario, outcome.path))


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_the_same_query_gives_the_same_path(name, dimension):
    scenario = make_family(name, 1e-3, dimension, 3)
    first, second = (query(scenario)[1] for _ in range(2))
    assert first.status == SOLVED
    np.testing.assert_array_equal(first.path, second.path)
