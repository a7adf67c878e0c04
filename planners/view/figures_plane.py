"""The workspace of a planar scenario, with the robot swept along its path."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import colours
from planners.view.embedding import outline

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes
    from matplotlib.patches import Ellipse

    from ellipsoid_planning.geometry import Ellipsoid
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
    _draw_bodies(axes, robot.bodies_at(scenario.start), colours.START, 5)
    _draw_bodies(axes, robot.bodies_at(scenario.goal), colours.GOAL, 5)
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
    for configuration in trajectory.evenly(SWEPT_POSES)[1:-1]:
        bodies = scenario.robot.bodies_at(configuration)
        _draw_bodies(axes, bodies, colours.tint(colours.ROBOT, 0.55), 3, colours.ROBOT)
    positions = trajectory.configurations[:, :2]
    axes.plot(*positions.T, color=colours.PATH, linewidth=1.6, zorder=6)


def _draw_bodies(
    axes: Axes, bodies: Iterable[Ellipsoid], colour: str, zorder: float, edge: str = "none"
) -> None:
    for body in bodies:
        axes.add_patch(
            ellipse(body, facecolor=colour, edgecolor=edge, linewidth=0.6, zorder=zorder)
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
