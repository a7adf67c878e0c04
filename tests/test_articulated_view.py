"""Pages and figures of robots with joints, against the robots' own kinematics."""

import math
from itertools import pairwise

import numpy as np
import pytest
import umsgpack
from matplotlib.patches import Ellipse

from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.cli.outputs import columns
from planners.cli.pages import scene_page
from planners.view import colours
from planners.view.figures import draw
from planners.view.joint_markers import joint_markers
from planners.view.joint_slice import JointSlice
from planners.view.links import followed_points, link_colours, link_shades
from planners.view.meshcat_page import scene_html
from planners.view.meshcat_scene import build_scene
from planners.view.show import show
from planners.view.trajectory import follow

body = Ellipsoid.from_semi_axes


def solved(name, world, robot, corners):
    scenario = Scenario(name, world, robot, corners[0], corners[-1])
    path = PathResult.from_configurations(
        robot, [scenario.start, *corners[1:-1], scenario.goal], min_clearance=0.0, certified=False
    )
    return PlanResult(scenario, "HighwayRoadmap", "solved", path=path)


def rabbit():
    """Two ears that turn, and a tail that slides, in the plane."""
    links = (
        Link("body", (body([5, 3], name="body"),)),
        Link("left/ear", (body([4, 1.2], [3.5, 0], name="ear"),)),
        Link("right/ear", (body([4, 1.2], [3.5, 0], name="ear"),)),
        Link("tail", (body([1, 1]),)),
    )
    joints = (
        Joint.of("left", "body", "left/ear", "revolute", [4, 1.5], lower=0, upper=1.6),
        Joint.of("right", "body", "right/ear", "revolute", [4, -1.5], lower=-1.6, upper=0),
        Joint.of("tail", "body", "tail", "prismatic", [-5, 0], axis=[-1, 0], lower=0, upper=2),
    )
    world = World([-30, -30], [30, 30], (body([9, 8], [0, 24]),), (body([45, 35]),))
    corners = ([-25, 0, 0, 0.2, -0.2, 0], [0, 3, 1.5, 0, -1.5, 2], [25, 0, 3, 1.2, -1.4, 1])
    return solved("rabbit", world, ArticulatedRobot(links, joints), corners)


def chain():
    """Three links on ball joints, whose base turns in space."""
    links = [Link(f"link {i}", (body([1, 1, 3], [0, 0, 3]),)) for i in range(3)]
    joints = [
        Joint.of(f"ball {i}", f"link {i}", f"link {i + 1}", "ball", [0, 0, 6]) for i in (0, 1)
    ]
    world = World([-30] * 3, [30] * 3, (body([4, 4, 4], [0, 15, 0]),))
    turned, other = [0.6, 0, 0, 0.8], [0, 0.28, 0, 0.96]
    first = [-20, 0, 0, 0, 0, 0, 1, *other, *turned]
    last = [20, 0, 0, *turned, *turned, *(-np.array(other))]
    return solved("chain", world, ArticulatedRobot(links, joints), (first, last))


def arm():
    """A fixed base; the first joint has limits and goes the long way round."""
    links = (
        Link("pedestal", (body([1.2, 1.2, 1.5]),)),
        Link("upper", (body([0.5, 0.5, 2], [0, 0, 2]),)),
        Link("lower", (body([0.4, 0.4, 2], [0, 0, 2]),)),
        Link("hand", (body([0.3, 0.3, 0.6], [0, 0, 0.7]),)),
    )
    y, z = [0, 1, 0], [0, 0, 1]
    joints = (
        Joint.of("turn", "pedestal", "upper", "revolute", [0, 0, 1.7], None, z, -3.1, 3.1),
        Joint.of("elbow", "upper", "lower", "revolute", [0, 0, 4.1], None, y, -1.7, 1.7),
        Joint.of("wrist", "lower", "hand", "continuous", [0, 0, 4.1], None, [1, 0, 1]),
    )
    world = World([-9, -9, 0], [9, 9, 14], (body([1, 1, 6], [4, -1, 3]),))
    corners = ([-3.0, 1.2, 3.0], [3.0, -1.2, -3.0])
    robot = ArticulatedRobot(links, joints, base="fixed", position=[0, 0, 1])
    return solved("arm", world, robot, corners)


RESULTS = [rabbit, chain, arm]


def commands(scene, kind):
    unpacked = [umsgpack.unpackb(command) for command in scene.commands]
    return [command for command in unpacked if command["type"] == kind]


def transforms(scene):
    return {
        command["path"]: np.array(command["matrix"]).reshape(4, 4).T
        for command in commands(scene, "set_transform")
    }


def rotation(quaternion):
    x, y, z, w = np.asarray(quaternion) / np.linalg.norm(quaternion)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def slerp(first, second, s):
    cosine = first @ second
    second, angle = np.copysign(1.0, cosine) * second, math.acos(min(1.0, abs(cosine)))
    if angle < 1e-9:
        return first
    return (math.sin((1 - s) * angle) * first + math.sin(s * angle) * second) / math.sin(angle)


def moved(scene, moment):
    """The transforms of a scene at a time [s], as three.js interpolates key frames."""
    placed = transforms(scene)
    (animation,) = commands(scene, "set_animation")
    for moving in animation["animations"]:
        matrix = placed[moving["path"]]
        for track in moving["clip"]["tracks"]:
            times = np.array([key["time"] for key in track["keys"]]) / moving["clip"]["fps"]
            values = np.array([key["value"] for key in track["keys"]])
            after = int(np.searchsorted(times, moment))
            part = (moment - times[after - 1]) / (times[after] - times[after - 1])
            if track["name"] == ".position":
                matrix[:3, 3] = values[after - 1] + part * (values[after] - values[after - 1])
            else:
                matrix[:3, :3] = rotation(slerp(values[after - 1], values[after], part))
    return placed


def in_world(placed, path):
    """A node's transform against the scene's root: the product along its path."""
    matrix, at = np.eye(4), "/scenario"
    for name in path.removeprefix("/scenario/").split("/"):
        at = f"{at}/{name}"
        matrix = matrix @ placed.get(at, np.eye(4))
    return matrix


PARTS = {
    "rabbit": ["body", "left-ear/ear", "right-ear/ear", "tail/tail"],
    "chain": ["link 0", "link 1/link 1", "link 1/link 2/link 2"],
    "arm": ["pedestal", "upper/upper", "upper/lower/lower", "upper/lower/hand/hand"],
}


@pytest.mark.parametrize("make", RESULTS)
def test_every_part_moves_as_ompl_interpolates(make):
    result = make()
    scenario, corners = result.scenario, result.path.configurations
    robot, cspace = scenario.robot, scenario.cspace()
    scene = build_scene(scenario, result)
    lengths = [cspace.distance(a, b) for a, b in pairwise(corners)]
    for s in (0.0707, 0.4141, 0.93):
        expected = cspace.interpolate(corners[0], corners[1], s)
        placed = moved(scene, 8.0 * s * lengths[0] / sum(lengths))
        for part, name in zip(robot.bodies_at(expected), PARTS[scenario.name], strict=True):
            (path,) = [p for p in placed if _is_part(p, name)]
            matrix = in_world(placed, path)
            n = robot.dimension
            np.testing.assert_allclose(matrix[:n, 3], part.centre, atol=1e-6)
            linear = matrix[:n, :n] if n == 3 else matrix[:2, [0, 2]]
            np.testing.assert_allclose(linear @ linear.T, part.shape_matrix, atol=1e-5)


def _is_part(path, name):
    """Unnamed parts have a number behind their link's name."""
    plain = path.removeprefix("/scenario/robot/")
    return plain in (name, f"{name} 1")


@pytest.mark.parametrize("make", RESULTS)
def test_links_have_colours_and_names_of_their_own(make):
    result = make()
    scene = build_scene(result.scenario, result)
    names, hues = zip(*scene.links, strict=True)
    assert names == tuple(link.name for link in result.scenario.robot.links)
    assert len({*hues, colours.START, colours.GOAL, colours.OBSTACLE}) == len(names) + 3
    page = scene_html(result.scenario, result)
    assert all(f"</i>{name}" in page for name in names)
    shades = link_shades(result.scenario.robot, colours.START)
    assert shades[names[0]] == colours.START
    assert len(set(shades.values())) == len(names)


@pytest.mark.parametrize("make", RESULTS)
def test_markers_stand_where_joints_turn(make):
    scenario = make().scenario
    poses = scenario.robot.link_poses(scenario.start)
    markers = {marker.joint: marker for marker in joint_markers(scenario.robot)}
    assert list(markers) == list(scenario.robot.joint_names)
    for joint in scenario.robot.joints:
        first, last = markers[joint.name].placed(poses)[[0, -1]]
        at = poses[joint.child][0]
        between = np.linalg.norm(at - first) + np.linalg.norm(at - last)
        assert between == pytest.approx(np.linalg.norm(last - first), abs=1e-9)


def test_a_marker_reaches_out_of_the_links_it_joins():
    links = (Link("fat", (body([2, 1, 1]),)), Link("long", (body([1, 1.5, 1]),)))
    axis, radius = np.array([0, 1, 0]), 0.4
    pin = Joint.of("pin", "fat", "long", "revolute", [0.5, 0, 0], None, axis, -1, 1)
    (marker,) = joint_markers(ArticulatedRobot(links, (pin,)))
    ends = np.array([0.5, 0, 0]) + np.outer([-1.5 - radius, 1.5 + radius], axis)
    np.testing.assert_allclose(marker.points, ends)
    ball = Joint.of("ball", "fat", "long", "ball", [0.5, 0, 0])
    (marker,) = joint_markers(ArticulatedRobot(links, (ball,)))
    np.testing.assert_array_equal(marker.points, [[0.5, 0, 0]])
    assert 1.0 < marker.radius < 1.2


def test_a_joint_with_limits_goes_the_long_way_round():
    result = arm()
    trajectory = follow(result.scenario.cspace(), result.path.configurations, samples=4)
    turns = np.diff(trajectory.configurations[:, 0])
    assert turns.sum() == pytest.approx(6.0)
    assert turns.max() < 0.5
    # The wrist has none, and goes the short way over a half turn.
    assert abs(trajectory.configurations[len(turns) // 2, 2]) > 3.0


def test_what_is_followed():
    scenario = rabbit().scenario
    np.testing.assert_array_equal(followed_points(scenario.robot, scenario.start[None]), [[-25, 0]])
    scenario = arm().scenario
    tip = scenario.robot.bodies_at(scenario.start)[-1].centre
    np.testing.assert_array_equal(followed_points(scenario.robot, scenario.start[None]), [tip])


def test_a_planar_figure_shows_each_link_in_its_colour():
    result = rabbit()
    robot = result.scenario.robot
    workspace, layer, _ = draw(result).axes
    assert layer.get_title(loc="left").splitlines()[0].startswith("The layer of heading ")
    assert "left " in layer.get_title(loc="left").splitlines()[1]
    drawn = {(p.get_center(), p.get_facecolor()) for p in workspace.patches if type(p) is Ellipse}
    for configuration, colour in (
        (result.scenario.start, colours.START),
        (result.scenario.goal, colours.GOAL),
    ):
        shades = link_shades(robot, colour)
        for part, link in zip(robot.bodies_at(configuration), robot.part_links, strict=True):
            assert (tuple(part.centre), (*colours.rgb(shades[link]), 1.0)) in drawn
    ghosts = {(*colours.rgb(colours.tint(hue, 0.55)), 1.0) for hue in link_colours(robot).values()}
    assert ghosts <= {colour for _, colour in drawn}


def test_a_spatial_layer_says_that_joints_are_held():
    layer = draw(chain().scenario).axes[1]
    assert layer.get_title(loc="left").splitlines()[1] == "at one value of each of the 2 joints"


def test_a_fixed_base_has_joints_instead_of_a_layer():
    result = arm()
    _, joints, _ = draw(result).axes
    assert joints.get_title(loc="left") == "Joints turn and elbow"
    assert len(joints.images) == 1
    view = JointSlice(result.scenario.cspace(), result.scenario.start, result.path.configurations)
    free = view.free(12)
    assert 0 < np.count_nonzero(free) < free.size
    for row, column in [(0, 0), (3, 7), (11, 2)]:
        configuration = result.scenario.start.copy()
        configuration[0] = -3.1 + (column + 0.5) / 12 * 6.2
        configuration[1] = -1.7 + (row + 0.5) / 12 * 3.4
        assert free[row, column] == view.cspace.is_valid(configuration)


def test_columns_are_named_after_joints():
    assert columns(rabbit().scenario.robot) == ("x", "y", "yaw", "left", "right", "tail")
    assert columns(arm().scenario.robot) == ("turn", "elbow", "wrist")
    names = columns(chain().scenario.robot)
    assert names[3:8] == ("qx", "qy", "qz", "qw", "ball 0_qx")
    assert len(names) == 15


def test_pages_have_the_roadmap_of_a_base_that_moves():
    assert 'data-folder="roadmap"' in scene_page(rabbit().scenario, None)
    assert 'data-folder="roadmap"' not in scene_page(arm().scenario, arm())


def test_show_writes_a_page(tmp_path):
    result = arm()
    page = show(result.scenario, result.path.configurations, tmp_path / "page.html")
    assert "given: path of length" in page.read_text(encoding="utf-8")
    assert show(result, output=page) == page
    with pytest.raises(EllipsoidPlanningError, match=r"expected a path \(m, 3\)"):
        show(result.scenario, [1.0, 2.0, 3.0], page)
