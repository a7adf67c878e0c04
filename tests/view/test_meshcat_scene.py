"""The recorded drawing commands: where bodies stand, what is switchable, how the robot moves."""

import numpy as np
import pytest
import umsgpack

from ellipsoid_planning.metric import path_length
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from planners.view import meshcat_animation
from planners.view.meshcat_scene import build_scene
from tests.view.scenes import (
    planar_scenario,
    small_roadmap,
    solved,
    spatial_scenario,
    unsolved,
)


def commands(scene, kind):
    unpacked = [umsgpack.unpackb(command) for command in scene.commands]
    return [command for command in unpacked if command["type"] == kind]


def transforms(scene):
    return {
        command["path"]: np.array(command["matrix"]).reshape(4, 4).T
        for command in commands(scene, "set_transform")
    }


def test_spatial_bodies_stand_where_the_scenario_says():
    scenario = spatial_scenario()
    placed = transforms(build_scene(scenario))
    for path, body in (
        ("/scenario/obstacles/cloud", scenario.world.obstacles[0]),
        ("/scenario/obstacles/cloud (2)", scenario.world.obstacles[1]),
        ("/scenario/arena/arena 1", scenario.world.arenas[0]),
        ("/scenario/goal/face", scenario.robot.bodies_at(scenario.goal)[0]),
    ):
        np.testing.assert_allclose(placed[path][:3, :3], body.matrix, atol=1e-12)
        np.testing.assert_allclose(placed[path][:3, 3], body.centre, atol=1e-12)


def test_planar_bodies_are_flat_discs():
    scenario = planar_scenario()
    scene = build_scene(scenario)
    pillar = scenario.world.obstacles[0]
    placed = transforms(scene)["/scenario/obstacles/pillar"]
    # The rim of meshcat's cylinder is the unit circle in x and z, at y = -1/2 and 1/2.
    angle = np.linspace(0.0, 2.0 * np.pi, 20)
    rim = np.stack([np.cos(angle), 0.5 + 0.0 * angle, np.sin(angle), 1.0 + 0.0 * angle])
    image = (placed @ rim)[:3].T
    radius = np.linalg.norm(
        (image[:, :2] - pillar.centre) @ pillar.rotation / pillar.semi_axes, axis=1
    )
    np.testing.assert_allclose(radius, 1.0)
    assert np.ptp(image[:, 2]) < 1e-12
    assert 0.0 < image[0, 2] < 0.1 * pillar.semi_axes.min() * 10


def test_the_whole_scene_is_scaled_about_its_centre():
    scene = build_scene(spatial_scenario())
    root = transforms(scene)["/scenario"]
    np.testing.assert_allclose(root @ [*scene.camera.centre, 1.0], [0, 0, 0, 1], atol=1e-12)


def test_folders_are_what_there_is_to_see():
    scenario = planar_scenario()
    names = [name for name, _ in build_scene(scenario).folders]
    assert names == ["arena", "obstacles", "start", "goal"]
    full = build_scene(scenario, solved(scenario), small_roadmap(scenario))
    names = [name for name, _ in full.folders]
    assert names == ["arena", "obstacles", "start", "goal", "roadmap", "path", "robot"]
    open_air = [name for name, _ in build_scene(spatial_scenario(arena=False)).folders]
    assert open_air == ["bounds", "obstacles", "start", "goal"]


@pytest.mark.parametrize("shown", [False, True])
def test_the_roadmap_starts_as_asked(shown):
    scenario = spatial_scenario()
    scene = build_scene(scenario, roadmap=small_roadmap(scenario), show_roadmap=shown)
    visible = [
        command["value"]
        for command in commands(scene, "set_property")
        if command["path"] == "/scenario/roadmap" and command["property"] == "visible"
    ]
    assert visible == [shown]
    assert scene.hidden == (() if shown else ("roadmap",))


def tracks(scene):
    (animation,) = commands(scene, "set_animation")
    (clip,) = animation["animations"]
    assert clip["path"] == "/scenario/robot"
    rate = clip["clip"]["fps"]
    return {
        track["name"]: (
            np.array([key["time"] for key in track["keys"]]) / rate,
            np.array([key["value"] for key in track["keys"]]),
        )
        for track in clip["clip"]["tracks"]
    }


def slerp(first, second, s):
    """Interpolate as three.js does between two key frames: the shorter way."""
    cosine = first @ second
    second, angle = np.sign(cosine) * second, np.arccos(min(1.0, abs(cosine)))
    if angle < 1e-9:
        return first
    return (np.sin((1 - s) * angle) * first + np.sin(s * angle) * second) / np.sin(angle)


@pytest.mark.parametrize("make", [planar_scenario, spatial_scenario])
def test_the_robot_moves_as_ompl_interpolates(make):
    scenario = make()
    result = solved(scenario)
    corners = result.path.configurations
    n, space = scenario.dimension, scenario.cspace()
    lengths = [path_length(scenario.robot, corners[i : i + 2]) for i in range(2)]
    moves = tracks(build_scene(scenario, result))
    times, positions = moves[".position"]
    turn_times, quaternions = moves[".quaternion"]
    assert times[-1] == pytest.approx(meshcat_animation.SECONDS + meshcat_animation.PAUSE_SECONDS)
    for s in (0.07, 0.345, 0.81):
        share = lengths[0] / sum(lengths)
        expected = space.interpolate(corners[0], corners[1], s)
        moment = meshcat_animation.SECONDS * share * s
        at = [np.interp(moment, times, column) for column in positions.T]
        np.testing.assert_allclose(at[:n], expected[:n], atol=1e-9)
        i = np.searchsorted(turn_times, moment)
        between = (moment - turn_times[i - 1]) / (turn_times[i] - turn_times[i - 1])
        turned = slerp(quaternions[i - 1], quaternions[i], between)
        half = expected[2] / 2
        wanted = expected[3:] if n == 3 else [0.0, 0.0, np.sin(half), np.cos(half)]
        assert abs(turned @ wanted) == pytest.approx(1.0, abs=1e-9)


def test_a_robot_that_only_translates_keeps_its_orientation():
    turning = planar_scenario()
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    robot = RigidRobot(turning.robot.parts, rotates=False, orientation=turn)
    scenario = Scenario("fixed", turning.world, robot, turning.start[:2], turning.goal[:2])
    scene = build_scene(scenario, solved(scenario))
    assert set(tracks(scene)) == {".position"}
    ear = robot.parts[1]
    placed = transforms(scene)
    np.testing.assert_allclose(placed["/scenario/robot"][:2, :2], turn, atol=1e-12)
    of_base = placed[f"/scenario/robot/{ear.name}"]
    np.testing.assert_allclose(of_base[:2, 3], ear.centre, atol=1e-12)


def test_without_a_path_nothing_moves():
    scenario = planar_scenario()
    assert commands(build_scene(scenario, unsolved(scenario)), "set_animation") == []
