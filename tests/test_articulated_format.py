"""Scenarios of articulated robots: read, kept in order, written and read back to the last bit."""

import dataclasses
import json
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.orientation_forms import degrees_from_radians
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario, scenario_schema
from ellipsoid_planning.scenario_files import parse_document
from ellipsoid_planning.scenario_yaml import scenario_text
from ellipsoid_planning.world import World
from tests.articulated_texts import PLANAR, SPATIAL
from tests.random_trees import random_configuration, random_tree

CASES = [(n, base) for n in (2, 3) for base in ("free", "translating", "fixed")]
BODY = Ellipsoid.from_semi_axes([1.0, 0.5])


def read(text):
    data, origin = parse_document(text)
    return Scenario._from_document(data, origin)


def again(scenario):
    return Scenario.from_dict(json.loads(json.dumps(scenario.to_dict())))


def random_scenario(rng, n, base):
    robot = random_tree(rng, n, base)
    ends = [random_configuration(rng, robot) for _ in range(2)]
    return Scenario("random", World([-5.0] * n, [5.0] * n), robot, *ends)


def assert_same_numbers(first, second, tolerance=0.0):
    def same(one, other):
        np.testing.assert_allclose(one, other, rtol=tolerance, atol=tolerance)

    one, other = first.robot, second.robot
    same(first.start, second.start)
    same(first.goal, second.goal)
    assert (one.base, one.joint_names, one.ignored) == (
        other.base,
        other.joint_names,
        other.ignored,
    )
    assert one.part_links == other.part_links
    for name in ("position", "orientation"):
        own, twin = getattr(one, name), getattr(other, name)
        assert (own is None) == (twin is None)
        if own is not None:
            same(own, twin)
    for part, twin in zip(one.parts, other.parts, strict=True):
        assert part.name == twin.name
        same(part.rotation, twin.rotation)
        same(part.centre, twin.centre)
    for joint, twin in zip(one.joints, other.joints, strict=True):
        assert (joint.type, joint.parent, joint.child) == (twin.type, twin.parent, twin.child)
        same(joint.position, twin.position)
        same(joint.rotation, twin.rotation)
        same([joint.lower, joint.upper], [twin.lower, twin.upper])
        if joint.axis is not None:
            same(joint.axis, twin.axis)


@pytest.mark.parametrize("text", [PLANAR, SPATIAL])
def test_files_come_back_to_the_last_bit(text):
    scenario = read(text)
    assert_same_numbers(scenario, again(scenario))
    assert again(scenario).to_dict() == scenario.to_dict()
    written = read(scenario_text(scenario))
    assert written.to_dict() == scenario.to_dict()
    assert_same_numbers(scenario, written)
    assert_same_numbers(scenario, pickle.loads(pickle.dumps(scenario)))


@pytest.mark.parametrize(("n", "base"), CASES)
def test_python_scenarios_come_back_to_rounding_and_then_exactly(n, base):
    rng = np.random.default_rng(21)
    for _ in range(5):
        scenario = random_scenario(rng, n, base)
        back = again(scenario)
        assert_same_numbers(scenario, back, tolerance=4e-15)
        assert_same_numbers(back, again(back))
        assert again(back).to_dict() == back.to_dict()


def test_the_planar_file_is_read_as_it_says():
    scenario = read(PLANAR)
    robot = scenario.robot
    assert robot.joint_names == ("ear",)
    assert [part.name for part in robot.parts] == ["face", "ear 1"]
    (ear,) = robot.joints
    assert (ear.lower, ear.upper) == (0.0, math.radians(90))
    np.testing.assert_allclose(ear.rotation, [[0.0, -1.0], [1.0, 0.0]], atol=1e-15)
    assert scenario.start.tolist() == [-40.0, 0.0, 0.0, math.radians(30)]
    assert scenario.goal.tolist() == [40.0, 10.0, math.radians(30), 0.0]


def test_the_spatial_file_is_read_as_it_says():
    scenario = read(SPATIAL)
    robot = scenario.robot
    assert robot.joint_names == ("shoulder", "wrist", "slide")
    assert robot.position.tolist() == [0.0, 0.0, 1.0]
    turn = Rotation.from_rotvec(math.radians(20) * np.array([1, 2, 3]) / math.sqrt(14))
    np.testing.assert_allclose(robot.orientation, turn.as_matrix(), atol=1e-15)
    shoulder = Rotation.from_euler("xyz", [10, 20, 30], degrees=True).as_quat()
    np.testing.assert_allclose(scenario.start, [*shoulder, -math.pi / 2, 0.33], atol=1e-15)
    assert scenario.goal.tolist() == [0.0, 0.0, 0.0, 1.0, math.radians(17), 0.0]
    pairs = frozenset({frozenset({"hand", "foot"}), frozenset({"finger", "arm"})})
    assert robot.ignored == pairs


def test_a_fixed_base_stands_at_the_origin_by_default():
    text = SPATIAL.replace("  position: [0, 0, 1]\n", "")
    text = text.replace("  orientation: {axis_angle: {axis: [1, 2, 3], angle_deg: 20}}\n", "")
    robot = read(text).robot
    assert robot.position.tolist() == [0.0, 0.0, 0.0]
    np.testing.assert_array_equal(robot.orientation, np.eye(3))


def test_goals_may_repeat_a_fixed_base():
    base = "  position: [0, 0, 1]\n  orientation: {axis_angle: {axis: [1, 2, 3], angle_deg: 20}}\n"
    assert read(SPATIAL.replace("goal:\n", "goal:\n" + base)).to_dict() == read(SPATIAL).to_dict()


def test_a_translating_base_keeps_its_orientation():
    text = PLANAR.replace("base: free", "base: translating").replace("yaw_deg: 0}", "yaw_deg: 390}")
    scenario = read(text)
    assert scenario.start.tolist() == [-40.0, 0.0, math.radians(30)]
    assert scenario.to_dict()["goal"]["orientation"] == {"yaw_deg": 390.0}


def one_joint(**changes):
    fields = {"type": "revolute", "lower": -1.0, "upper": 1.0, **changes}
    joint = Joint.of("turn", "base", "arm", position=[1.0, 0.0], **fields)
    return ArticulatedRobot((Link("base", (BODY,)), Link("arm", (BODY,))), (joint,))


def scenario_at(robot, value):
    world = World([-5, -5], [5, 5])
    return Scenario("one", world, robot, [0, 0, 0, value], [0, 0, 0, 0.5])


@pytest.mark.parametrize(("degrees", "value"), [(180, -math.pi), (-180, -math.pi), (450, None)])
def test_continuous_joints_are_normalised(degrees, value):
    scenario = scenario_at(one_joint(type="continuous"), math.radians(degrees))
    assert scenario.start[3] == pytest.approx(math.pi / 2 if value is None else value)
    text = PLANAR.replace("type: revolute", "type: continuous").replace(
        "ear_deg: 30", "ear_deg: 450"
    )
    text = text.replace("      limit: {lower_deg: 0, upper_deg: 90}\n", "")
    assert read(text).start[3] == math.radians(90)


def test_revolute_joints_may_turn_beyond_half_a_turn():
    text = PLANAR.replace("upper_deg: 90", "upper_deg: 720").replace("ear_deg: 30", "ear_deg: 450")
    scenario = read(text)
    assert scenario.start[3] == math.radians(450)
    assert again(scenario).start[3] == scenario.start[3]


def test_values_on_their_limits_are_within_them():
    robot = one_joint()
    assert scenario_at(robot, 1.0).start[3] == 1.0
    assert scenario_at(robot, 1.0 + 1e-10).start[3] == 1.0
    with pytest.raises(ScenarioError, match=r"within its limits \[-57\.29577951, 57\.29577951\]"):
        scenario_at(robot, 1.0 + 1e-8)
    with pytest.raises(ScenarioError, match="4 finite numbers"):
        scenario_at(robot, math.nan)


def test_keys_of_joint_values_must_differ():
    joints = (
        Joint.of("a", "base", "arm", "revolute", [1.0, 0.0], lower=-1.0, upper=1.0),
        Joint.of("a_deg", "arm", "tip", "prismatic", [1.0, 0.0], lower=-1.0, upper=1.0),
    )
    robot = ArticulatedRobot((Link("base", (BODY,)), Link("arm"), Link("tip")), joints)
    with pytest.raises(ScenarioError, match="both be called a_deg") as caught:
        Scenario("twice", World([-5, -5], [5, 5]), robot, np.zeros(5), np.zeros(5))
    assert caught.value.field == "robot.joints[1].name"


@given(st.floats(-720.0, 720.0))
def test_degrees_survive_writing(degrees):
    angle = math.radians(degrees)
    assert math.radians(degrees_from_radians(angle)) == angle


@given(st.floats(-12.0, 12.0))
def test_any_angle_survives_writing_to_rounding(angle):
    back = math.radians(degrees_from_radians(angle))
    assert back == pytest.approx(angle, rel=5e-16, abs=1e-300)


@pytest.mark.parametrize("name", ["a: b", "#1", "yes", "1", "left ear", "x, y", 'it\'s "so"', "[x"])
def test_any_name_reads_back(name):
    joint = Joint.of(name, name, "arm", "prismatic", [1.0, 0.0], lower=-1.0, upper=1.0)
    ignored = frozenset({frozenset({name, "arm"})})
    robot = ArticulatedRobot((Link(name, (BODY,)), Link("arm")), (joint,), ignored=ignored)
    scenario = scenario_at(robot, 0.25)
    assert read(scenario_text(scenario)).to_dict() == scenario.to_dict()
    assert read(scenario_text(scenario)).start[3] == 0.25


def test_changed_copies_are_written_as_changed():
    scenario = read(PLANAR)
    goal = np.array([1.0, 2.0, 0.5, 0.25])
    back = again(dataclasses.replace(scenario, goal=goal))
    np.testing.assert_allclose(back.goal, goal, rtol=1e-15)


def test_the_schema_knows_both_kinds_of_robots():
    schema = scenario_schema()
    kinds = [entry["$ref"].rsplit("/", 1)[1] for entry in schema["properties"]["robot"]["oneOf"]]
    rigid, articulated = (schema["$defs"][kind]["properties"] for kind in kinds)
    assert set(rigid) == {"rotates", "parts"}
    assert set(articulated) == {"base", "links", "joints", "ignore_self_collision"}
    joint = schema["$defs"]["JointBlock"]
    assert joint["required"] == ["name", "type", "parent", "child"]
    assert {"origin", "axis", "limit"} <= set(joint["properties"])
    assert "joints" in schema["$defs"]["Pose"]["properties"]
