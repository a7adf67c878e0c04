"""Scenarios as YAML text: whatever they hold reads back."""

import dataclasses

import pytest

from ellipsoid_planning.scenario import bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_yaml import scenario_text
from ellipsoid_planning.world import World

TEXTS = [
    "a: b",
    "[x",
    "#1",
    "yes",
    "No",
    "1e-3",
    "",
    " ",
    'it\'s "so"',
    "µ ∈ Σ",
    "- a",
    "x, y",
    "~",
]


def read_back(scenario, folder):
    file = folder / "scene.yaml"
    file.write_text(scenario_text(scenario), encoding="utf-8")
    return load_scenario(file)


@pytest.mark.parametrize("name", bundled_scenarios())
def test_bundled_scenarios_read_back(name, tmp_path):
    scenario = load_scenario(name)
    assert read_back(scenario, tmp_path).to_dict() == scenario.to_dict()
    assert max(map(len, scenario_text(scenario).splitlines())) <= 120


@pytest.mark.parametrize("text", [*TEXTS, "two\nlines", "two  spaces", "word " * 60])
def test_any_text_reads_back(text, tmp_path):
    plain = load_scenario("rabbit-2d-open")
    first, *others = plain.world.obstacles
    world = World(plain.world.low, plain.world.high, (first.with_name(text or "x"), *others))
    scenario = dataclasses.replace(plain, name=text, description=text, world=world)
    assert read_back(scenario, tmp_path).to_dict() == scenario.to_dict()


def test_planner_parameters_and_empty_lists_read_back(tmp_path):
    plain = load_scenario("rabbit-2d-open")
    world = World(plain.world.low, plain.world.high)
    planner = {"name": "RRTConnect", "range": 1e-3, "flag": True, "text": "null", "nothing": None}
    scenario = dataclasses.replace(plain, world=world, planner=planner)
    assert read_back(scenario, tmp_path).to_dict() == scenario.to_dict()
