"""Scenes of the families: what their seeds draw, where they start and end, what they say."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.errors import EllipsoidPlanningError, FamilyError
from ellipsoid_planning.families import family_names, make_family, make_family_scene
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.scenario_checks import check_endpoints
from ellipsoid_planning.scenario_yaml import scenario_text
from tests.families.oracle import CASES, scene

SEEDS = [None, *range(6)]
TURNED = [("turned-gap", 2), ("turned-gap", 3), ("window-3d", 3), ("slot-3d", 3)]


def test_the_cases_are_all_there_are():
    assert sorted({name for name, _ in CASES}) == sorted(family_names())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_start_and_goal_are_free_but_not_the_way_between(name, dimension, seed):
    variants = [{}, {"without_passage": True}, {"blocked": True}]
    for clearance, variant in itertools.product((1e-1, 1e-6), variants):
        scenario = make_family(name, clearance, dimension, seed, **variant)
        space = scenario.cspace()
        check_endpoints(scenario, space)
        assert min(space.clearance(scenario.start), space.clearance(scenario.goal)) >= 0.1
        assert not space.is_motion_valid(scenario.start, scenario.goal)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_the_number_of_bodies_is_moderate(name, dimension, seed):
    world = make_family(name, 1e-2, dimension, seed).world
    assert len(world.arenas) == 1
    assert 2 <= len(world.obstacles) <= 12


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), TURNED)
def test_start_and_goal_are_far_from_fitting(name, dimension, seed):
    """The angles between the main part's axes are at most those between its orientations."""
    scenario, gates = scene(name, 1e-3, dimension, seed)
    hull = gates[0].hull
    for end in (scenario.start, scenario.goal):
        rotation = scenario.robot.bodies_at(end)[0].rotation
        cosines = np.abs(np.sum(rotation * hull.rotation, axis=0))
        assert np.all(cosines[:2] <= np.cos(np.radians(25)))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_gap_is_fitted_at_both_ends(dimension, seed):
    made = make_family_scene("gap", 1e-3, dimension, seed)
    fitting = made.gates[0].configuration[dimension:]
    for end in (made.scenario.start, made.scenario.goal):
        assert end[dimension:] == pytest.approx(fitting, abs=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_gaps_of_a_chain_need_different_orientations(dimension, seed):
    _, gates = scene("chain-of-gaps", 1e-3, dimension, seed)
    assert len(gates) == 3
    for first, second in itertools.pairwise(gates):
        cosine = abs(first.hull.rotation[:, 0] @ second.hull.rotation[:, 0])
        assert cosine <= np.cos(np.radians(20))


@pytest.mark.parametrize("seed", SEEDS)
def test_the_slot_is_three_robots_long(seed):
    scenario, gates = scene("slot-3d", 1e-3, 3, seed)
    parts = scenario.robot.bodies_at(scenario.start)
    axis = parts[0].rotation[:, 0]
    robot = max(p.support(axis) for p in parts) + max(p.support(-axis) for p in parts)
    first, last = gates[0].gate.position, gates[-1].gate.position
    assert np.linalg.norm(last - first) >= 3 * robot


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_a_seed_draws_the_same_at_every_clearance(name, dimension):
    wide, narrow = (make_family(name, c, dimension, 3) for c in (1e-1, 1e-6))
    assert wide.start.tolist() == narrow.start.tolist()
    assert wide.goal.tolist() == narrow.goal.tolist()
    for first, second in zip(wide.robot.parts, narrow.robot.parts, strict=True):
        assert first.matrix.tolist() == second.matrix.tolist()
    other = make_family(name, 1e-1, dimension, 4)
    assert other.start.tolist() != wide.start.tolist()


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_variants_differ_in_the_passage_only(name, dimension):
    plain, blocked, without = (
        make_family(name, 1e-2, dimension, 3, **variant)
        for variant in ({}, {"blocked": True}, {"without_passage": True})
    )
    for other in (blocked, without):
        assert other.start.tolist() == plain.start.tolist()
        assert other.goal.tolist() == plain.goal.tolist()
    bodies = {body.name: body for body in plain.world.obstacles}
    assert len(without.world.obstacles) < len(bodies) or name == "tight-arena"
    for body in without.world.obstacles:
        assert body.matrix.tolist() == bodies[body.name].matrix.tolist()
        assert body.centre.tolist() == bodies[body.name].centre.tolist()


@pytest.mark.parametrize("seed", [None, 2])
@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_files_read_back_as_they_were(name, dimension, seed, tmp_path):
    scenario = make_family(name, 1e-3, dimension, seed)
    text = scenario_text(scenario)
    assert text == scenario_text(make_family(name, 1e-3, dimension, seed))
    file = tmp_path / "scene.yaml"
    file.write_text(text, encoding="utf-8")
    assert load_scenario(file).to_dict() == scenario.to_dict()
    assert f"Family {name}" in scenario.description
    assert "Clearance 0.001" in scenario.description
    assert ("yaw_deg" if dimension == 2 else "quaternion") in scenario.description


def test_the_description_says_what_is_missing():
    assert "left out" in make_family("gap", 0.1, 3, without_passage=True).description
    assert "closed" in make_family("gap", 0.1, 3, blocked=True).description


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (("gpa", 0.1), {}, ["'gpa'", "did you mean gap?"]),
        (("nothing", 0.1), {}, ["there are gap,"]),
        (("gap", 0.0), {}, ["above 0"]),
        (("gap", -1e-3), {}, ["above 0", "-0.001"]),
        (("gap", float("nan")), {}, ["above 0", "nan"]),
        (("gap", 1e-15), {}, ["at least 1e-13", "1e-15"]),
        (("gap", float("inf")), {}, ["at most 1"]),
        (("gap", 1.5), {}, ["at most 1", "1.5"]),
        (("gap", 1.0), {"blocked": True}, ["below 1"]),
        (("window-3d", 0.1, 2), {}, ["window-3d", "dimension 3", "got 2"]),
        (("slot-3d", 0.1, 2), {}, ["slot-3d", "dimension 3", "got 2"]),
        (("gap", 0.1, 4), {}, ["dimension 2 or 3", "got 4"]),
        (("gap", 0.1, 2, -1), {}, ["seed", "-1"]),
        (("gap", 0.1), {"blocked": True, "without_passage": True}, ["not both"]),
    ],
)
def test_bad_requests(arguments, options, words):
    with pytest.raises(FamilyError) as caught:
        make_family(*arguments, **options)
    assert isinstance(caught.value, EllipsoidPlanningError)
    for word in words:
        assert word in str(caught.value)
