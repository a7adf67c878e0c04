"""Scenario files: every kind of bad input gives one message with file, field, line and remedy."""

import copy
import math

import pytest

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.scenario import (
    Scenario,
    bundled_scenarios,
    load_scenario,
    scenario_schema,
)

PLANAR = """\
format: 1
name: planar
dimension: 2
bounds: {low: [-50, -40], high: [50, 40]}
arena:
  - {semi_axes: [60, 45]}
obstacles:
  - {name: pillar, semi_axes: [15, 10], position: [-15, -23], orientation: {yaw_deg: -60}}
robot:
  parts:
    - {name: face, semi_axes: [5, 3]}
    - {name: left ear, semi_axes: [3, 1.5], position: [-5, 3], orientation: {yaw_deg: 135}}
start: {position: [-40, 0], orientation: {yaw_deg: 0}}
goal: {position: [40, 10], orientation: {yaw_deg: 30}}
planner: {name: HighwayRoadmap, layers: 60}
"""
SPATIAL = """\
format: 1
name: spatial
dimension: 3
bounds: {low: [-5, -5, -5], high: [5, 5, 5]}
robot:
  parts:
    - {semi_axes: [1, 0.5, 0.4]}
start: {position: [0, 0, 0], orientation: {quaternion: [0, 0, 0, 1]}}
goal: {position: [1, 0, 0], orientation: {rpy_deg: [10, 20, 30]}}
"""


def fault(tmp_path, text):
    """The error of a scenario text, which must name its file."""
    file = tmp_path / "bad.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    error = caught.value
    assert error.file == str(file)
    assert str(error).startswith(str(file))
    assert "\n" not in str(error)
    return error


@pytest.mark.parametrize("text", [PLANAR, SPATIAL])
def test_the_unchanged_texts_are_fine(tmp_path, text):
    (tmp_path / "good.yaml").write_text(text, encoding="utf-8")
    assert load_scenario(tmp_path / "good.yaml").name in text


# text to replace, replacement, field, line, words of the message
PLANAR_FAULTS = [
    ("semi_axes: [5, 3]", "semi_axis: [5, 3]", "robot.parts[0].semi_axis", 11, "'semi_axes'"),
    ("semi_axes: [5, 3]", "colour: red, semi_axes: [5, 3]", "robot.parts[0].colour", 11, "remove"),
    (", semi_axes: [5, 3]", "", "robot.parts[0].semi_axes", 11, "missing"),
    ("name: planar\n", "", "name", None, "missing"),
    ("[3, 1.5]", "[3, 1.5, 2]", "robot.parts[1].semi_axes", 12, "2 numbers because"),
    ("[3, 1.5]", "[3, 1.5, 2, 9]", "robot.parts[1].semi_axes", 12, "got 4"),
    ("dimension: 2", "dimension: 3", "bounds.low", 4, "3 numbers because"),
    ("dimension: 2", "dimension: 4", "dimension", 3, "expected 2 or 3, got 4"),
    ("dimension: 2", "dimension: 2.0", "dimension", 3, "expected 2 or 3, got 2.0"),
    ("format: 1", "format: 2", "format", 1, "expected 1, got 2"),
    ("format: 1", "format: true", "format", 1, "expected 1, got true"),
    ("[3, 1.5]", "[3, 0]", "robot.parts[1].semi_axes[1]", 12, "positive"),
    ("[3, 1.5]", "[3, -1.5]", "robot.parts[1].semi_axes[1]", 12, "-1.5"),
    ("[3, 1.5]", "[3, .nan]", "robot.parts[1].semi_axes[1]", 12, "finite"),
    ("[3, 1.5]", "[3, .inf]", "robot.parts[1].semi_axes[1]", 12, "finite"),
    ("[3, 1.5]", "[3, '1.5']", "robot.parts[1].semi_axes[1]", 12, "a number, got '1.5'"),
    ("[3, 1.5]", "[3, true]", "robot.parts[1].semi_axes[1]", 12, "got true"),
    ("[3, 1.5]", "3", "robot.parts[1].semi_axes", 12, "a list"),
    ("low: [-50, -40]", "low: [-50, 40]", "bounds.low[1]", 4, "low < high"),
    ("{yaw_deg: 30}", "{quaternion: [0, 0, 0, 1]}", "goal.orientation.quaternion", 14, "yaw_deg"),
    ("{yaw_deg: 30}", "{}", "goal.orientation", 14, "exactly one"),
    (", orientation: {yaw_deg: 30}", ", orientation: ", "goal.orientation", 14, "expected a value"),
    ("{yaw_deg: 30}", "30", "goal.orientation", 14, "a mapping, got 30"),
    ("  parts:", "  rotates: yes\n  parts:", "robot.rotates", 10, "true or false"),
    ("  parts:", "  rotates: false\n  parts:", "goal.orientation", 15, "start's orientation"),
    ("name: planar", "name: 5", "name", 2, "text, got 5"),
    ("{name: HighwayRoadmap, layers: 60}", "HighwayRoadmap", "planner", 15, "a mapping"),
    ("{name: HighwayRoadmap, layers: 60}", "{layers: 60}", "planner.name", 15, "missing"),
    ("{name: HighwayRoadmap, layers: 60}", "{name: 3}", "planner.name", 15, "text"),
    ("layers: 60", "7: 60", "planner.7", 15, "text"),
    ("format: 1", "format: 1\nclearance: -1", "clearance", 2, "not negative"),
    ("format: 1", "format: 1\nclerance: 1", "clerance", 2, "'clearance'"),
    ("format: 1", "format: 1\nname: twice", "name", 3, "written twice"),
]


@pytest.mark.parametrize(("old", "new", "field", "line", "words"), PLANAR_FAULTS)
def test_planar_faults(tmp_path, old, new, field, line, words):
    assert old in PLANAR
    error = fault(tmp_path, PLANAR.replace(old, new, 1))
    assert (error.field or "").replace("[7]", ".7") == field
    assert error.line == line
    assert words in error.problem


SPATIAL_FAULTS = [
    ("[0, 0, 0, 1]", "[0, 0, 0, 1.01]", "start.orientation.quaternion", "length 1.01"),
    ("[0, 0, 0, 1]", "[0, 0, 0, 0]", "start.orientation.quaternion", "length 0"),
    ("[0, 0, 0, 1]", "[0, 0, 1]", "start.orientation.quaternion", "expected 4 numbers"),
    ("quaternion: [0, 0, 0, 1]", "yaw_deg: 3", "start.orientation.yaw_deg", "quaternion or rpy"),
    (
        "quaternion: [0, 0, 0, 1]",
        "axis_angle: {axis: [0, 0, 0], angle_deg: 3}",
        "start.orientation.axis_angle",
        "other than zero",
    ),
    (
        "quaternion: [0, 0, 0, 1]",
        "axis_angle: {axis: [0, 0, 1]}",
        "start.orientation.axis_angle.angle_deg",
        "missing",
    ),
    (
        "quaternion: [0, 0, 0, 1]",
        "quaternion: [0, 0, 0, 1], rpy_deg: [0, 0, 0]",
        "start.orientation",
        "quaternion and rpy_deg",
    ),
    ("position: [0, 0, 0]", "position: [0, 0]", "start.position", "3 numbers because"),
]


@pytest.mark.parametrize(("old", "new", "field", "words"), SPATIAL_FAULTS)
def test_spatial_faults(tmp_path, old, new, field, words):
    error = fault(tmp_path, SPATIAL.replace(old, new, 1))
    assert (error.field, error.line) == (field, 8)
    assert words in error.problem


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("format: [1\nname: x\n", 2),
        ("format: 1\n\tname: x\n", 2),
        ("a: 1\n b: 2\n", 2),
        ("format: 1\nname: \x07x\n", 2),
        ("format: 1\nname: *nobody\n", 2),
        ("format: 1\n---\nformat: 1\n", 2),
    ],
)
def test_broken_yaml_names_the_line(tmp_path, text, line):
    error = fault(tmp_path, text)
    assert error.line == line
    assert "broken YAML" in error.problem


@pytest.mark.parametrize("text", ["", "- 1\n", "hello\n", "3\n"])
def test_a_file_that_is_no_mapping(tmp_path, text):
    assert "expected a mapping" in fault(tmp_path, text).problem


def test_deep_and_recursive_yaml(tmp_path):
    assert "nested" in fault(tmp_path, "a: " + "[" * 500 + "\n").problem
    fault(tmp_path, "format: &a [*a]\n")


def test_an_integer_beyond_doubles_is_refused(tmp_path):
    fault(tmp_path, PLANAR.replace("[3, 1.5]", f"[3, 1{'0' * 400}]"))


def test_a_file_that_is_not_utf8(tmp_path):
    file = tmp_path / "latin.yaml"
    file.write_bytes(b"name: caf\xe9\n")
    with pytest.raises(ScenarioError, match="UTF-8"):
        load_scenario(file)


def test_missing_files_suggest_bundled_names(tmp_path):
    with pytest.raises(ScenarioError, match=r"no such file.*did you mean.*rabbit-2d-open"):
        load_scenario("rabit-2d-open")
    with pytest.raises(ScenarioError, match=r"bundled are .*rabbit-2d-open"):
        load_scenario(tmp_path / "zzzzqqq.yaml")
    with pytest.raises(ScenarioError, match="folder"):
        load_scenario(tmp_path)


def test_bundled_names_load():
    for name in bundled_scenarios():
        assert load_scenario(name).name == name


def test_anchors_and_exponents_are_read(tmp_path):
    text = PLANAR.replace("[60, 45]", "&size [6e1, 45.0]").replace("clearance", "")
    (tmp_path / "good.yaml").write_text(text + "clearance: 1e-3\n", encoding="utf-8")
    scenario = load_scenario(tmp_path / "good.yaml")
    assert scenario.clearance == 1e-3
    assert scenario.world.arenas[0].semi_axes.tolist() == [60.0, 45.0]


def test_errors_of_mappings_name_the_field_alone():
    data = {"format": 1}
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_dict(data)
    assert (caught.value.file, caught.value.line) == (None, None)
    assert str(caught.value).startswith("name: ")


def test_from_dict_leaves_its_argument_alone():
    document = load_scenario("rabbit-2d-open").to_dict()
    before = copy.deepcopy(document)
    Scenario.from_dict(document)
    assert document == before


def test_schema_describes_the_format():
    schema = scenario_schema()
    assert schema["additionalProperties"] is False
    assert {"format", "name", "dimension", "robot", "start", "goal"} <= set(schema["required"])
    assert "clearance" in schema["properties"]


@pytest.mark.parametrize(
    ("degrees", "heading"),
    [(180, -math.pi), (-180, -math.pi), (540, -math.pi), (-90, -math.pi / 2)],
)
def test_headings_are_normalised(tmp_path, degrees, heading):
    text = PLANAR.replace("yaw_deg: 30", f"yaw_deg: {degrees}")
    (tmp_path / "turned.yaml").write_text(text, encoding="utf-8")
    assert load_scenario(tmp_path / "turned.yaml").goal[2] == heading
