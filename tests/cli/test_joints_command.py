"""`joints`: what it prints, as tables and as JSON, and what it refuses."""

import json
import math

import pytest

from tests.articulated_texts import PLANAR
from tests.cli.command import refused, run

LINKS = """\
    - name: tail
      parts:
        - {semi_axes: [3, 1], position: [3, 0]}
    - name: tip
      parts:
        - {semi_axes: [3, 1], position: [3, 0]}
    - name: fin
      parts:
        - {semi_axes: [0.5, 0.5]}
"""
JOINTS = """\
    - {name: tail, type: revolute, parent: head, child: tail, origin: {position: [5.5, 0]},
       limit: {lower_deg: -60, upper_deg: 60}}
    - {name: tip, type: revolute, parent: tail, child: tip, origin: {position: [5, 0]},
       limit: {lower_deg: -175, upper_deg: 175}}
    - {name: fin, type: fixed, parent: tail, child: fin, origin: {position: [3, 2]}}
  ignore_self_collision: [[fin, tip]]
"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    text = PLANAR.replace("  joints:\n", LINKS + "  joints:\n", 1)
    text = text.replace("start:", JOINTS + "start:").replace(
        "ear_deg: 30", "ear_deg: 30, tip_deg: 5"
    )
    file = tmp_path_factory.mktemp("joints") / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_json(file):
    done = run("joints", file, "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert [joint["name"] for joint in report["joints"]] == ["ear", "tail", "tip"]
    assert report["joints"][1]["limits"] == pytest.approx([-math.pi / 3, math.pi / 3])
    assert report["joints"][2]["reach"] == 6.0
    pairs = {frozenset(pair["links"]): pair for pair in report["pairs"]}
    assert len(pairs) == 10
    verdicts = {
        ("head", "ear"): "neighbours",
        ("tail", "fin"): "neighbours",
        ("fin", "tip"): "ignored",
        ("head", "tip"): "meet",
        ("head", "fin"): "never",
        ("ear", "fin"): "never",
    }
    for pair, verdict in verdicts.items():
        assert pairs[frozenset(pair)]["verdict"] == verdict, pair
    found = pairs[frozenset(("head", "tip"))]
    assert set(found["example"]) == set(found["joints"]) == {"tail", "tip"}
    (limits,) = (each for each in found["excluded_by"] if each["joint"] == "tip")
    assert limits["around"] == pytest.approx(math.radians(5))
    assert limits["lower"] < limits["around"] < limits["upper"] < math.radians(175)
    never = pairs[frozenset(("head", "fin"))]
    assert "example" not in never


def test_tables(file):
    done = run("joints", file)
    assert done.returncode == 0, done.stderr
    words = " ".join(done.stdout.split())
    for word in ("-60° … 60°", "never meet", "can meet", "neighbours", "ignored"):
        assert word in words


def test_a_rigid_robot_is_refused():
    assert refused(run("joints", "rabbit-2d-open"), "rigid", "no joints")


def test_help():
    assert "ellipsoid-planning joints" in run("joints", "--help").stdout
