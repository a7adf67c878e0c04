"""The families' worlds made awkward: other units, bodies twice, ends in passages."""

import pytest

from ellipsoid_planning.families import make_family, make_family_scene
from ellipsoid_planning.roadmap.highway import SOLVED
from tests.families.oracle import CASES
from tests.roadmap.family_paths import assert_free, changed, query


@pytest.mark.parametrize(("name", "dimension"), CASES)
@pytest.mark.parametrize("scale", [1e-3, 1e6])
def test_the_unit_of_length_does_not_matter(name, dimension, scale):
    scenario = changed(make_family(name, 1e-3, dimension, 1), scale=scale)
    _, outcome = query(scenario)
    assert outcome.status == SOLVED
    assert_free(scenario, outcome.path)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_bodies_and_arenas_may_stand_twice_in_the_same_place(name, dimension):
    """And a smaller one inside each."""
    scenario = make_family(name, 1e-3, dimension, 1)
    inner = tuple(
        type(b)(b.centre, b.rotation, 0.5 * b.semi_axes, b.name) for b in scenario.world.obstacles
    )
    crowded = changed(
        scenario,
        obstacles=scenario.world.obstacles * 2 + inner,
        arenas=scenario.world.arenas * 2,
    )
    _, outcome = query(crowded)
    assert outcome.status == SOLVED
    assert_free(scenario, outcome.path)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_ends_may_lie_in_the_passage(name, dimension):
    made = make_family_scene(name, 1e-3, dimension, 1)
    inside = made.gates[len(made.gates) // 2].configuration
    scenario = made.scenario
    for ends in ((inside, scenario.goal), (scenario.start, inside), (inside, inside)):
        query_between = changed(scenario, ends=ends)
        _, outcome = query(query_between)
        assert outcome.status == SOLVED
        assert_free(query_between, outcome.path)
