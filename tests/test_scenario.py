"""Scenarios as values: built in Python, written, read back, orientation forms."""

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
from ellipsoid_planning.geometry.orientation import normalised_heading, rotation_from_yaw
from ellipsoid_planning.orientation_forms import (
    form_of_heading,
    form_of_rotation,
    heading_from_degrees,
    rotation_from_form,
)
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario
from ellipsoid_planning.world import World

angles = st.floats(-720.0, 720.0)


def planar(**changes):
    world = World([-5, -5], [5, 5], obstacles=(Ellipsoid.from_semi_axes([1, 2], [0, 4], 0.123),))
    robot = RigidRobot((Ellipsoid.from_semi_axes([1.0, 0.5]),))
    fields = {"start": [-3, 0, 0.1], "goal": [3, 0, 7.0], **changes}
    return Scenario("planar", world, robot, **fields)


def spatial():
    turn = Rotation.from_euler("xyz", [0.1, 0.2, 0.3])
    world = World([-5] * 3, [5] * 3)
    robot = RigidRobot((Ellipsoid.from_semi_axes([1, 2, 3], rotation=turn.as_matrix()),))
    return Scenario("spatial", world, robot, [0] * 6 + [1], [1, 1, 1, *turn.as_quat()])


def again(scenario):
    return Scenario.from_dict(json.loads(json.dumps(scenario.to_dict())))


def bodies(scenario):
    return (*scenario.robot.parts, *scenario.world.obstacles, *scenario.world.arenas)


def assert_identical(first, second):
    np.testing.assert_array_equal(first.start, second.start)
    np.testing.assert_array_equal(first.goal, second.goal)
    for one, other in zip(bodies(first), bodies(second), strict=True):
        assert one.name == other.name
        np.testing.assert_array_equal(one.centre, other.centre)
        np.testing.assert_array_equal(one.semi_axes, other.semi_axes)
        np.testing.assert_array_equal(one.rotation, other.rotation)


@pytest.mark.parametrize("name", sorted(bundled_scenarios()))
def test_bundled_scenarios_come_back_to_the_last_bit(name):
    scenario = load_scenario(name)
    assert_identical(scenario, again(scenario))
    assert again(scenario).to_dict() == scenario.to_dict()


def test_python_scenarios_come_back_to_rounding_and_then_exactly():
    for scenario in (planar(), spatial()):
        back = again(scenario)
        for one, other in zip(bodies(scenario), bodies(back), strict=True):
            np.testing.assert_allclose(one.rotation, other.rotation, atol=1e-15)
        np.testing.assert_allclose(scenario.goal, back.goal, atol=1e-15)
        assert_identical(back, again(back))


def test_quaternions_of_configurations_come_back_to_the_last_bit():
    scenario = spatial()
    np.testing.assert_array_equal(scenario.goal, again(scenario).goal)


def test_a_changed_copy_is_written_as_changed():
    scenario = load_scenario("rabbit-3d-open")
    world = World(scenario.world.low, scenario.world.high, scenario.world.obstacles[:1])
    changed = dataclasses.replace(scenario, world=world, clearance=0.5, start=scenario.goal)
    back = again(changed)
    assert_identical(changed, back)
    assert back.clearance == 0.5
    assert len(back.world.obstacles) == 1


def test_translating_robots_keep_their_orientation():
    document = planar().to_dict()
    document["robot"]["rotates"] = False
    document["start"]["orientation"] = {"yaw_deg": 30}
    document["goal"]["orientation"] = {"yaw_deg": 390}
    scenario = Scenario.from_dict(document)
    assert scenario.start.tolist() == [-3.0, 0.0]
    np.testing.assert_allclose(scenario.robot.orientation, rotation_from_yaw(math.pi / 6))
    back = again(scenario)
    np.testing.assert_array_equal(scenario.robot.orientation, back.robot.orientation)


def test_configurations_are_normalised_and_read_only():
    scenario = planar()
    assert scenario.goal[2] == pytest.approx(7.0 - 2.0 * math.pi)
    with pytest.raises(ValueError, match="read-only"):
        scenario.goal[0] = 1.0
    tilted = dataclasses.replace(spatial(), start=[0, 0, 0, 0, 0, 0, 1.0005])
    assert tilted.start[6] == 1.0


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"start": [0.0, 0.0]}, "start"),
        ({"goal": [0.0, 0.0, math.nan]}, "goal"),
        ({"clearance": -1.0}, "clearance"),
        ({"clearance": math.nan}, "clearance"),
    ],
)
def test_pieces_that_do_not_fit_are_refused(changes, field):
    with pytest.raises(ScenarioError) as caught:
        planar(**changes)
    assert caught.value.field == field


def test_mixed_dimensions_are_refused():
    with pytest.raises(ScenarioError, match="dimension 3"):
        Scenario("mixed", spatial().world, planar().robot, [0, 0, 0], [0, 0, 0])


def test_scenarios_and_errors_pickle():
    scenario = load_scenario("rabbit-3d-open")
    assert_identical(scenario, pickle.loads(pickle.dumps(scenario)))
    error = ScenarioError("wrong", file="a.yaml", field="start", line=3, column=4)
    assert str(pickle.loads(pickle.dumps(error))) == "a.yaml:3:4: start: wrong"


@given(angles, angles, angles)
def test_euler_forms_mean_what_they_say(first, second, third):
    triple = [first, second, third]
    expected = Rotation.from_euler("xyz", triple, degrees=True).as_matrix()
    np.testing.assert_allclose(rotation_from_form("rpy_deg", triple), expected, atol=1e-12)
    expected = Rotation.from_euler("ZXZ", triple, degrees=True).as_matrix()
    np.testing.assert_allclose(rotation_from_form("euler_zxz_deg", triple), expected, atol=1e-12)


@given(angles)
def test_axis_angle_means_what_it_says(angle):
    axis = np.array([1.0, -2.0, 2.0])
    expected = Rotation.from_rotvec(math.radians(angle) * axis / 3.0).as_matrix()
    value = {"axis": axis.tolist(), "angle_deg": angle}
    np.testing.assert_allclose(rotation_from_form("axis_angle", value), expected, atol=1e-12)


@given(angles)
def test_angles_in_degrees_survive_writing(degrees):
    heading = heading_from_degrees(degrees)
    assert heading_from_degrees(form_of_heading(heading)["yaw_deg"]) == heading
    rotation = rotation_from_yaw(heading)
    form = form_of_rotation(rotation)
    np.testing.assert_array_equal(rotation_from_form("yaw_deg", form["yaw_deg"]), rotation)


@given(st.floats(-10.0, 10.0))
def test_any_heading_survives_writing_to_rounding(yaw):
    heading = normalised_heading(yaw)
    back = heading_from_degrees(form_of_heading(heading)["yaw_deg"])
    assert back == pytest.approx(heading, rel=5e-16, abs=1e-300)


def test_short_angles_are_written_short():
    assert form_of_heading(math.radians(30.0)) == {"yaw_deg": 30.0}
    assert form_of_rotation(rotation_from_yaw(math.radians(-60.0))) == {"yaw_deg": -60.0}
