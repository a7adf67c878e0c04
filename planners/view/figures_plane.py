"""The workspace of a planar scenario, with the robot swept along its path."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import colours
from planners.view.embedding import outline
from planners.view.joint_markers import joint_markers
from planners.view.links import followed_points, ghost_count, link_colours, link_shades

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from matplotlib.axes import Axes
    from matplotlib.patches import Ellipse
    from numpy.typing import NDArray

    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.robots import Robot
    from ellipsoid_planning.scenario import Scenario
    from planners.view.trajectory import Trajectory

SWEPT_POSES = 24


def draw_workspace(axes: Axes, scenario: Scenario, trajectory: Trajectory | None) -> None:
    """Draw arena, obstacles, the robot at start and goal, and swept along the path if given."""
    world, robot = scenario.world, scenario.robot
    axes.set_title("Workspace", loc="left", fontsize=11)
    if not world.arenas:
        draw_bounds(axes, scenario)
    for arena in world.arenas:
        fill = colours.tint(colours.ARENA, 0.82)
        axes.add_patch(ellipse(arena, facecolor=fill, edgecolor=colours.ARENA, linewidth=1.5))
    for obstacle in world.obstacles:
        axes.add_patch(ellipse(obstacle, facecolor=colours.OBSTACLE, linewidth=0, zorder=2))
    if trajectory is not None:
        _draw_swept(axes, scenario, trajectory)
    for configuration, colour in ((scenario.start, colours.START), (scenario.goal, colours.GOAL)):
        _draw_robot(axes, robot, configuration, link_shades(robot, colour), 5)
        _draw_joints(axes, robot, configuration)
    _label(axes, robot.bodies_at(scenario.start), "start")
    _label(axes, robot.bodies_at(scenario.goal), "goal")
    finish(axes)


def ellipse(body: Ellipsoid, **look: Any) -> Ellipse:
    """Return the matplotlib patch of an ellipse."""
    from matplotlib import patches

    angle = float(np.degrees(np.arctan2(body.rotation[1, 0], body.rotation[0, 0])))
    width, height = 2.0 * body.semi_axes
    return patches.Ellipse(tuple(body.centre), width, height, angle=angle, **look)


def draw_bounds(axes: Axes, scenario: Scenario) -> None:
    """Draw the box that the robot's base position keeps to."""
    from matplotlib.patches import Rectangle

    low, size = scenario.world.low, scenario.world.high - scenario.world.low
    corner = (float(low[0]), float(low[-1]))
    box = Rectangle(corner, size[0], size[-1], fill=False, edgecolor=colours.FRAME, linestyle="--")
    axes.add_patch(box)


def finish(axes: Axes) -> None:
    """Give both axes one scale and a thin grey frame."""
    axes.set_aspect("equal", anchor="N")
    axes.autoscale_view()
    axes.tick_params(colors="#606060", labelsize=8)
    for spine in axes.spines.values():
        spine.set_color(colours.FRAME)


def _draw_swept(axes: Axes, scenario: Scenario, trajectory: Trajectory) -> None:
    edges = link_colours(scenario.robot)
    fills = {link: colours.tint(colour, 0.55) for link, colour in edges.items()}
    for configuration in trajectory.evenly(ghost_count(scenario.robot, SWEPT_POSES))[1:-1]:
        _draw_robot(axes, scenario.robot, configuration, fills, 3, edges)
    positions = followed_points(scenario.robot, trajectory.configurations)
    axes.plot(*positions.T, color=colours.PATH, linewidth=1.6, zorder=6)


def _draw_robot(
    axes: Axes,
    robot: Robot,
    configuration: NDArray[np.float64],
    fills: Mapping[str, str],
    zorder: float,
    edges: Mapping[str, str] | None = None,
) -> None:
    """Draw each part in its link's colours."""
    for body, link in zip(robot.bodies_at(configuration), robot.part_links, strict=True):
        edge = "none" if edges is None else edges[link]
        look = {"facecolor": fills[link], "edgecolor": edge, "linewidth": 0.6, "zorder": zorder}
        axes.add_patch(ellipse(body, **look))


def _draw_joints(axes: Axes, robot: Robot, configuration: NDArray[np.float64]) -> None:
    from matplotlib.patches import Circle

    poses = robot.link_poses(configuration)
    for marker in joint_markers(robot):
        points = marker.placed(poses)
        axes.plot(*points.T, color=colours.JOINT, linewidth=1.0, zorder=5.5)
        for point in points:
            axes.add_patch(
                Circle(
                    (point[0], point[1]),
                    marker.radius,
                    facecolor="white",
                    edgecolor=colours.JOINT,
                    linewidth=0.5,
                    zorder=5.6,
                )
            )


def _label(axes: Axes, bodies: Iterable[Ellipsoid], text: str) -> None:
    outlines = np.concatenate([outline(body) for body in bodies])
    left, bottom = outlines.min(axis=0)
    below = (0.5 * (left + float(outlines[:, 0].max())), bottom)
    axes.annotate(
        text,
        below,
        xytext=(0, -3),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=9,
        zorder=7,
    )
