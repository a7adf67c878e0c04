"""Sizes, limits and parameters out of range are refused where they enter, by one clear line."""

import copy
import math

import numpy as np
import pytest

from ellipsoid_planning.errors import GeometryError, PlannerError, ScenarioError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario, load_scenario
from ellipsoid_planning.trees.parameters import TreeParameters
from ellipsoid_planning.world import World

ARM = """\
format: 1
name: arm
dimension: 2
bounds: {low: [-5, -5], high: [5, 5]}
obstacles: [{semi_axes: [0.3, 0.3], position: [-4, 0]}]
robot:
  base: fixed
  links:
    - {name: post, parts: [{semi_axes: [0.2, 0.2]}]}
    - {name: arm, parts: [{semi_axes: [1, 0.1], position: [1.3, 0]}]}
  joints:
    - {name: j, type: revolute, parent: post, child: arm, limit: {lower_deg: -90, upper_deg: 90}}
start: {joints: {j_deg: 0}}
goal: {joints: {j_deg: 90}}
"""
LIMITS = "{lower_deg: -90, upper_deg: 90}"
SLIDE = ("revolute", "prismatic"), ("j_deg: 0", "j: 0"), ("j_deg: 90", "j: 1")


def read(folder, *replacements):
    text = ARM
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    file = folder / "arm.yaml"
    file.write_text(text, encoding="utf-8")
    return load_scenario(file)


@pytest.mark.parametrize("limit", ["1e16", "1.7e308", "360000"])
def test_limits_that_mean_none_make_a_joint_continuous(tmp_path, limit):
    wide = f"{{lower_deg: -{limit}, upper_deg: {limit}}}"
    scenario = read(tmp_path, (LIMITS, wide), ("j_deg: 90", "j_deg: 270"))
    (joint,) = scenario.robot.joints
    assert (joint.type, joint.lower, joint.upper) == ("continuous", -math.pi, math.pi)
    assert scenario.goal == pytest.approx([-math.pi / 2.0])
    assert len(scenario.notices) == 1
    assert "joint 'j': limits" in scenario.notices[0]
    assert "mean none" in scenario.notices[0]
    assert Scenario.from_dict(scenario.to_dict()).robot.joints[0].type == "continuous"


def test_a_range_over_a_turn_stays_bounded(tmp_path):
    scenario = read(tmp_path, (LIMITS, "{lower_deg: -3600, upper_deg: 359999}"))
    (joint,) = scenario.robot.joints
    assert joint.type == "revolute"
    assert joint.lower == math.radians(-3600.0)
    assert scenario.notices == ()


def test_a_range_below_rounding_fixes_the_joint():
    axis, at = [0.0, 0.0, 1.0], [1.0, 2.0, 3.0]
    turned = Joint.of("j", "a", "b", "revolute", at, None, axis, 0.5, 0.5 + 1e-15)
    assert (turned.type, turned.value_count) == ("fixed", 0)
    cosine, sine = math.cos(0.5), math.sin(0.5)
    expected = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]
    np.testing.assert_allclose(turned.rotation, expected, atol=1e-15)
    moved = Joint.of("j", "a", "b", "prismatic", at, turned.rotation, [1, 0, 0], 2.0, 2.0 + 1e-13)
    assert moved.type == "fixed"
    np.testing.assert_allclose(moved.position, np.array(at) + 2.0 * turned.rotation[:, 0])
    planar = Joint.of("j", "a", "b", "revolute", [0, 0], None, None, 0.5, 0.5 + 1e-15)
    np.testing.assert_allclose(planar.rotation, [[cosine, -sine], [sine, cosine]], atol=1e-15)
    assert "fixed at" in moved.notice


def test_a_joint_that_its_limits_fix_may_be_named(tmp_path):
    free = read(
        tmp_path,
        (LIMITS, "{lower_deg: 0, upper_deg: 1e-14}"),
        ("base: fixed", "base: translating"),
        ("start: {", "start: {position: [0, 0], "),
        ("goal: {", "goal: {position: [1, 0], "),
    )
    assert free.robot.configuration_size == 2
    assert "fixed" in free.notices[0]


BAD = {
    "one end": ([(LIMITS, "{lower_deg: 0, upper_deg: 1e16}")], "limit.lower_deg", 12, "thousand"),
    "shift": ([(LIMITS, "{lower: -1e16, upper: 1}"), *SLIDE], "limit.lower", 12, "within 1e+12"),
    "far": ([(LIMITS, "{lower: 0, upper: 1e9}"), *SLIDE], "joints[0].limit", 12, "1000 times"),
    "nothing moves": ([(LIMITS, "{lower_deg: 0, upper_deg: 1e-14}")], "base", 7, "fixed at 0"),
    "tiny": ([("[0.3, 0.3]", "[0.3, 1e-160]")], "semi_axes[1]", 5, "from 1e-12 to 1e+12"),
    "huge": ([("[0.3, 0.3]", "[0.3, 1e200]")], "semi_axes[1]", 5, "from 1e-12 to 1e+12"),
    "far off": ([("[-4, 0]", "[-4, 1e200]")], "position[1]", 5, "-1e+12 to 1e+12"),
    "bounds": ([("[5, 5]", "[5, 1e13]")], "bounds.high[1]", 4, "-1e+12 to 1e+12"),
    "flat": ([("[5, 5]", "[5, -4.9999999999999]")], "bounds.low[1]", 4, "at least 1e-12 apart"),
    "thin": ([("[0.3, 0.3]", "[0.3, 1e-12]")], "obstacles[0].semi_axes", 5, "rounding hides"),
    "clearance": ([("name: arm\nd", "name: arm\nclearance: 1e200\nd")], "clearance", 3, "at most"),
    "digits": ([("[-4, 0]", "[-4, " + "1" * 400 + "]")], "position[1]", 5, "expected"),
}


@pytest.mark.parametrize("case", BAD)
def test_sizes_out_of_range_are_one_clear_error(tmp_path, case):
    replacements, field, line, words = BAD[case]
    with pytest.raises(ScenarioError) as caught:
        read(tmp_path, *replacements)
    error = caught.value
    assert str(error.field).endswith(field)
    assert error.line == line
    assert words in str(error)
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    "text", ["a: " + "[" * 1_500, "{" * 1_000, "a: " + "1" * 5_000, "a: &a [*a]"]
)
def test_deep_and_endless_texts_are_one_clear_error(tmp_path, text):
    file = tmp_path / "deep.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"deep\.yaml") as caught:
        load_scenario(file)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_scenes_within_the_range_are_read_as_they_are(scale):
    document = copy.deepcopy(load_scenario("rabbit-2d-open").to_dict())
    for body in (*document["obstacles"], *document["arena"], *document["robot"]["parts"]):
        body["semi_axes"] = [scale * value for value in body["semi_axes"]]
        body["position"] = [scale * value for value in body["position"]]
    for place in (document["bounds"]["low"], document["bounds"]["high"]):
        place[:] = [scale * value for value in place]
    for pose in (document["start"], document["goal"]):
        pose["position"] = [scale * value for value in pose["position"]]
    assert Scenario.from_dict(document).world.high[0] == document["bounds"]["high"][0]


def disc(radius, at=(0.0, 0.0)):
    return Ellipsoid(np.array(at), np.eye(2), np.full(2, radius))


def test_python_refuses_the_same_sizes():
    for radius in (1e-160, 1e200):
        with pytest.raises(GeometryError, match="double precision"):
            disc(radius)
    with pytest.raises(GeometryError, match="double precision"):
        disc(1.0, (0.0, 1e200))
    for radius in (1e-13, 1e13):
        with pytest.raises(GeometryError, match=r"part 'part 1': expected semi-axes from 1e-12"):
            RigidRobot((disc(radius),))
        with pytest.raises(GeometryError, match=r"obstacle 'obstacle 1': expected semi-axes"):
            World(-np.ones(2), np.ones(2), (disc(radius),))
    with pytest.raises(GeometryError, match="bounds"):
        World(-np.ones(2), np.array([1.0, 1e13]))
    with pytest.raises(GeometryError, match="bounds that are at least"):
        World(np.zeros(2), np.array([1.0, 1e-13]))
    with pytest.raises(GeometryError, match="joint 'j': position"):
        Joint.of("j", "a", "b", "fixed", [1e13, 0.0])


@pytest.mark.parametrize("largest", [1e-200, 1e200])
def test_an_axis_may_have_any_length(largest):
    joint = Joint.of("j", "a", "b", "continuous", [0, 0, 0], None, [largest, largest, 0.0])
    np.testing.assert_allclose(joint.axis, [math.sqrt(0.5), math.sqrt(0.5), 0.0], rtol=1e-15)


@pytest.mark.parametrize(
    "values",
    [{"metric_weight": 1e20}, {"inflation": 1e300}, {"refine": 10**30}, {"seed": 10**5000}],
)
def test_parameters_have_ranges(values):
    (name,) = values
    with pytest.raises(PlannerError, match=rf"{name}: expected .* from .* to .*, got"):
        RoadmapParameters(**values)


@pytest.mark.parametrize("values", [{"metric_weight": 1e20}, {"range": 1e300}, {"range": 1e-300}])
def test_parameters_of_trees_have_ranges(values):
    with pytest.raises(PlannerError, match=r"expected a number from .* to 1e\+12, got 1e"):
        TreeParameters(**values)
