"""Pictures, asked for the colours at the places where bodies are drawn."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.image import imread
from matplotlib.patches import Ellipse

from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.view import colours
from planners.view.figures import draw, figure
from planners.view.figures_plane import SWEPT_POSES
from planners.view.figures_space import workspace_camera
from planners.view.trajectory import follow
from tests.view.pixels import resembles
from tests.view.scenes import planar_scenario, solved, spatial_scenario, unsolved


def rendered(drawn):
    canvas = FigureCanvasAgg(drawn)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3] / 255.0


def colour_at(picture, axes, point):
    column, row = axes.transData.transform(point)
    return picture[round(picture.shape[0] - 1 - row), round(column)]


def test_planar_workspace_shows_bodies_where_they_are():
    scenario = planar_scenario()
    drawn = draw(scenario)
    picture = rendered(drawn)
    workspace = drawn.axes[0]
    for body in scenario.world.obstacles:
        for point in [
            body.centre,
            *(body.centre + 0.9 * np.array([1, -1])[:, None] * body.matrix[:, 0]),
        ]:
            assert resembles(colour_at(picture, workspace, point), colours.OBSTACLE)
        outside = body.centre + 1.1 * body.matrix[:, 0]
        assert not resembles(colour_at(picture, workspace, outside), colours.OBSTACLE)
    for configuration, colour in ((scenario.start, colours.START), (scenario.goal, colours.GOAL)):
        for body in scenario.robot.bodies_at(configuration):
            assert resembles(colour_at(picture, workspace, body.centre), colour)


def test_spatial_workspace_shows_bodies_where_they_project():
    scenario = spatial_scenario()
    drawn = draw(scenario)
    picture = rendered(drawn)
    camera = workspace_camera(scenario)
    groups = {
        colours.OBSTACLE: scenario.world.obstacles,
        colours.START: scenario.robot.bodies_at(scenario.start),
        colours.GOAL: scenario.robot.bodies_at(scenario.goal),
    }
    for colour, bodies in groups.items():
        for body in bodies:
            place = camera.axes(body.centre[None])[0, :2]
            assert resembles(colour_at(picture, drawn.axes[0], place), colour)
    empty = colour_at(picture, drawn.axes[0], camera.axes(np.array([[20.0, 0, 0]]))[0, :2])
    assert empty[2] - empty[0] > 0.1  # the arena's far wall
    assert empty.min() > 0.5


def test_nearer_bodies_hide_farther_ones():
    scenario = spatial_scenario()
    camera = workspace_camera(scenario)
    # Along the line of sight, behind the start's face and before it.
    face = scenario.robot.bodies_at(scenario.start)[0]
    for side, colour in ((-1.0, colours.START), (1.0, colours.OBSTACLE)):
        small = Ellipsoid.from_semi_axes([1.0] * 3)
        moved = small.transform(np.eye(3), face.centre + side * 30.0 * camera.back)
        world = World(scenario.world.low, scenario.world.high, (moved,))
        other = Scenario("hidden", world, scenario.robot, scenario.start, scenario.goal)
        drawn = draw(other)
        place = workspace_camera(other).axes(face.centre[None])[0, :2]
        assert resembles(colour_at(rendered(drawn), drawn.axes[0], place), colour)


def test_obstacles_that_hide_the_robot_are_seen_through():
    scenario = spatial_scenario()
    camera = workspace_camera(scenario)
    bodies = scenario.robot.bodies_at(scenario.start)
    middle = np.mean([body.centre for body in bodies], axis=0)
    size = 4.0 * max(float(body.semi_axes.max()) for body in bodies)
    before = Ellipsoid.from_semi_axes([size] * 3, middle + 40.0 * camera.back)
    other = Scenario(
        "hidden",
        World(scenario.world.low, scenario.world.high, (before,)),
        scenario.robot,
        scenario.start,
        scenario.goal,
    )
    drawn = draw(other)
    place = workspace_camera(other).axes(bodies[0].centre[None])[0, :2]
    seen = colour_at(rendered(drawn), drawn.axes[0], place)
    assert not resembles(seen, colours.OBSTACLE)
    assert seen[1] > seen[0]  # the start's green shines through


def test_the_layer_shows_c_obstacles_intervals_and_roadmap():
    scenario = planar_scenario()
    drawn = draw(scenario)
    picture = rendered(drawn)
    layer = drawn.axes[1]
    (regions,) = [c for c in layer.collections if isinstance(c, PolyCollection)]
    pairs = len(scenario.robot.parts) * len(scenario.world.obstacles)
    assert len(regions.get_paths()) == pairs
    _, free, edges = [c for c in layer.collections if isinstance(c, LineCollection)]
    for bottom, top in free.get_segments()[::7]:
        middle = 0.5 * (bottom + top) + [0.0, 0.2 * (top - bottom)[1]]
        assert resembles(colour_at(picture, layer, middle), colours.FREE_INTERVAL, 0.2)
    assert len(edges.get_segments()) > 20
    assert "heading 0°" in layer.get_title(loc="left")
    # Below the pillar's centre, half-way between two lines: the C-obstacles' fill.
    pillar = scenario.world.obstacles[0].centre + np.array([0.3, 0.0])
    red, green, blue = colour_at(picture, layer, pillar)
    assert red > green > blue


@pytest.mark.parametrize("make", [planar_scenario, spatial_scenario])
def test_the_distance_panel_is_the_clearance_of_the_path(make):
    scenario = make(clearance=0.5)
    result = solved(scenario)
    distance = draw(result).axes[2]
    curve, least, required = distance.get_lines()
    cspace = scenario.cspace()
    trajectory = follow(cspace, result.path.configurations)
    np.testing.assert_allclose(curve.get_xdata()[-1], result.path.length)
    np.testing.assert_allclose(
        curve.get_ydata(), [cspace.clearance(q) for q in trajectory.configurations]
    )
    assert least.get_ydata() == [min(curve.get_ydata())]
    assert list(required.get_ydata()) == [0.5, 0.5]


def test_the_robot_is_swept_along_the_path():
    scenario = planar_scenario()
    result = solved(scenario)
    drawn = draw(result)
    picture = rendered(drawn)
    bodies = [p for p in drawn.axes[0].patches if isinstance(p, Ellipse)]
    still = len(scenario.world.arenas) + len(scenario.world.obstacles)
    assert len(bodies) == still + SWEPT_POSES * len(scenario.robot.parts)
    (path,) = drawn.axes[0].get_lines()
    np.testing.assert_array_equal(
        path.get_xydata()[[0, -1]], result.path.configurations[[0, -1], :2]
    )
    middle = path.get_xydata()[len(path.get_xydata()) // 2]
    beside = colour_at(picture, drawn.axes[0], middle + np.array([0.0, 1.8]))
    assert resembles(beside, colours.tint(colours.ROBOT, 0.55), 0.2)


def test_without_a_path_there_are_two_panels():
    assert len(draw(planar_scenario()).axes) == 2
    assert len(draw(unsolved(spatial_scenario())).axes) == 2


def test_nothing_to_keep_a_distance_from():
    base = planar_scenario()
    world = World(base.world.low, base.world.high)
    scenario = Scenario("empty", world, base.robot, base.start, base.goal)
    distance = draw(solved(scenario)).axes[2]
    assert [text.get_text() for text in distance.texts] == [
        "there is nothing to keep a distance from"
    ]


def test_figure_writes_the_picture_whole(tmp_path):
    target = tmp_path / "picture.png"
    assert figure(planar_scenario(), target) == target
    assert imread(target).shape[1] == 1430
    assert list(tmp_path.iterdir()) == [target]


def test_a_suffix_chooses_the_format(tmp_path):
    target = figure(planar_scenario(), tmp_path / "picture.svg")
    assert target.read_text(encoding="utf-8").startswith("<?xml")


@pytest.mark.parametrize("name", ["picture.xyz", "picture"])
def test_an_unknown_format_is_a_clean_error(name, tmp_path):
    with pytest.raises(EllipsoidPlanningError, match=r"unknown picture format.*\.png"):
        figure(planar_scenario(), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_folder_is_a_clean_error(tmp_path):
    with pytest.raises(EllipsoidPlanningError, match="does not exist"):
        figure(planar_scenario(), tmp_path / "missing" / "picture.png")


def test_the_distance_of_a_fixed_arm_is_that_of_what_moves():
    def limb(name, at):
        return Link(name, (Ellipsoid.from_semi_axes([0.5, 0.2], [at, 0.0]),))

    joint = Joint.of("j", "base", "arm", "revolute", [0.0, 0.0], None, None, -2.0, 2.0)
    robot = ArticulatedRobot((limb("base", 0.0), limb("arm", 1.0)), (joint,), "fixed")
    floor, post = (
        Ellipsoid.from_semi_axes([5.0, 1.0], [0.0, -1.3]),
        Ellipsoid.from_semi_axes([0.3, 0.3], [2.0, 0.5]),
    )
    world = World(np.full(2, -6.0), np.full(2, 6.0), (floor, post))
    scenario = Scenario("arm", world, robot, np.array([0.7]), np.array([1.9]))
    path = PathResult.from_configurations(
        robot, [scenario.start, scenario.goal], min_clearance=0.0, certified=False
    )
    distance = draw(PlanResult(scenario, "by hand", "solved", path=path)).axes[2]
    curve, least = distance.get_lines()
    assert scenario.cspace().clearance(scenario.goal) == pytest.approx(0.1)
    assert np.min(curve.get_ydata()) > 0.5
    assert least.get_xdata() == [0.0]
    assert distance.get_title(loc="right").endswith("not drawn: what does not move, 0.1")
    assert not distance.texts
