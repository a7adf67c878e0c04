"""``measure``: the free space of a scenario, its bounds and its narrow openings."""

import json
import math

import pytest

from tests.cli.command import refused, run

ROUND = """\
format: 1
name: two balls
dimension: 2
bounds: {low: [-10, -10], high: [10, 10]}
arena:
  - {name: yard, semi_axes: [10, 10]}
obstacles:
  - {name: left, semi_axes: [1, 1], position: [-4, 0]}
  - {name: right, semi_axes: [2, 2], position: [4, 0]}
robot:
  parts:
    - {name: hull, semi_axes: [0.5, 0.5]}
start: {position: [0, 4], orientation: {yaw_deg: 0}}
goal: {position: [0, -4], orientation: {yaw_deg: 0}}
"""
ARM = """\
format: 1
name: arm
dimension: 2
bounds: {low: [-10, -10], high: [10, 10]}
obstacles:
  - {name: post, semi_axes: [0.5, 0.5], position: [2, 1]}
robot:
  base: fixed
  links:
    - {name: upper, parts: [{name: u, semi_axes: [1, 0.2], position: [1, 0]}]}
    - {name: lower, parts: [{name: l, semi_axes: [1, 0.2], position: [1, 0]}]}
  joints:
    - name: elbow
      type: revolute
      parent: upper
      child: lower
      origin: {position: [2, 0]}
      limit: {lower_deg: -120, upper_deg: 120}
start: {joints: {elbow_deg: -60}}
goal: {joints: {elbow_deg: -90}}
"""


def measured(*arguments):
    done = run("measure", *arguments, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture
def balls(tmp_path):
    file = tmp_path / "balls.yaml"
    file.write_text(ROUND, encoding="utf-8")
    return file


def test_the_closed_form_and_the_measurement_agree(balls):
    found = measured(balls, "--lines", 5000)
    exact = 2.0 * math.pi * math.pi * (9.5**2 - 1.5**2 - 2.5**2)
    bound = found["closed_form"]
    assert bound["exact"] and bound["reasons"] == []
    assert bound["upper"] == bound["lower"] == pytest.approx(exact, rel=1e-12)
    volume = found["free"]["volume"]
    assert abs(volume["value"] - exact) < 5.0 * volume["standard_error"]
    assert volume["low"] < volume["value"] < volume["high"]
    assert found["free"]["whole"] == pytest.approx(400.0 * 2.0 * math.pi)
    layer = found["layers"]["start"]["fraction"]["value"]
    assert layer == pytest.approx(exact / (800.0 * math.pi), rel=1e-3)
    assert found["time"]["total"] >= found["time"]["free_space"] > 0.0


def test_narrow_openings_are_named(balls):
    found = measured(balls, "--lines", 500)
    gaps = {tuple(sorted(one["bodies"])): one for one in found["openings"]}
    assert gaps["left", "right"]["gap"] == pytest.approx(5.0)
    assert gaps["left", "right"]["point"] == pytest.approx([-0.5, 0.0], abs=1e-6)
    assert gaps["left", "the boundary of yard"]["gap"] == pytest.approx(5.0)
    assert gaps["right", "the boundary of yard"]["gap"] == pytest.approx(4.0)
    assert all(one["play"] == pytest.approx(one["gap"] - 1.0) for one in found["openings"])
    assert found["robot_width"] == pytest.approx(1.0)


def test_a_bundled_scenario_with_its_passages():
    found = measured("rabbit-2d-narrow", "--lines", 2000)
    assert found["closed_form"]["exact"] is False
    assert "3 parts" in found["closed_form"]["reasons"][0]
    assert found["free"]["volume"]["high"] < found["closed_form"]["upper"]
    assert found["openings"][0]["play"] == pytest.approx(0.25, abs=1e-6)
    assert found["openings"][0]["width"] == pytest.approx(4.0)


def test_why_the_closed_form_is_but_a_bound(balls):
    text = ROUND.replace("[4, 0]", "[-1.5, 0]")
    balls.write_text(text, encoding="utf-8")
    bound = measured(balls, "--lines", 500)["closed_form"]
    assert not bound["exact"]
    assert bound["lower"] < bound["upper"]
    assert "left" in bound["reasons"][0] and "right" in bound["reasons"][0]


def test_the_same_seed_prints_the_same_numbers(balls):
    first, second, other = (measured(balls, "--lines", 500, "--seed", seed) for seed in (4, 4, 5))
    assert first["free"] == second["free"] != other["free"]


def test_limits(balls):
    found = measured(balls, "--half-width", "0.002")
    interval = found["free"]["fraction"]
    assert interval["high"] - interval["low"] <= 0.004
    assert measured(balls, "--time-limit", "1e-9")["free"]["lines"] < found["free"]["lines"]


def test_tables_for_people(balls):
    done = run("measure", balls, "--lines", 500)
    assert done.returncode == 0, done.stderr
    for words in ("two balls", "free fraction", "±", "rotations (2 pi)", "exact", "least width"):
        assert words in done.stdout
    assert "Traceback" not in done.stderr


def test_a_fixed_base(tmp_path):
    file = tmp_path / "arm.yaml"
    file.write_text(ARM, encoding="utf-8")
    found = measured(file, "--lines", 2000)
    assert found["free"]["method"] == "configurations"
    assert found["free"]["measure"] == "joint ranges"
    assert 0.0 < found["free"]["fraction"]["value"] < 1.0
    assert found["openings"] == []
    assert found["layers"]["quartiles"] is None


BAD = {
    "lines": (("--lines", "0"), ("--lines", "positive")),
    "seed": (("--seed", "-1"), ("--seed",)),
    "time": (("--time-limit", "nan"), ("--time-limit", "positive")),
    "width": (("--half-width", "-1"), ("--half-width", "positive")),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(case):
    arguments, words = BAD[case]
    assert refused(run("measure", "rabbit-2d-open", *arguments), *words)


def test_an_unknown_scenario():
    assert refused(run("measure", "nowhere"), "nowhere", "no such file")
