"""A layer of the configuration space: C-obstacles, sweep lines, free intervals, roadmap."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ellipsoid_planning.robots.joint import CONTINUOUS, PRISMATIC, REVOLUTE
from planners.view import colours
from planners.view.figures_plane import finish
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from planners.view.layer_slice import LayerSlice

LINES = 40
LONGEST_LINE = 64  # that fits over the picture


def draw_layer(axes: Axes, view: LayerSlice, marked: str, lines: int = LINES) -> None:
    """Draw one plane of a layer, as in the thesis' Figs. 6.1, 6.2 and 6.6.

    The base of the layer's own configuration gets a dot; `marked` says what it is.
    """
    places = view.sweep_lines(lines)
    intervals = view.free_intervals(places)
    _draw_regions(axes, view)
    _draw_intervals(axes, view, places, intervals)
    _draw_roadmap(axes, *view.roadmap(places, intervals))
    colour = colours.START if marked == "start" else colours.ROBOT
    dot = {"markersize": 8, "markeredgecolor": "white", "zorder": 6}
    axes.plot(*view.point, "o", color=colour, label=marked, **dot)  # type: ignore[arg-type]
    axes.set_title(_title(view), loc="left", fontsize=11)
    across, up = "xyz"[view.across], "xyz"[view.cspace.dimension - 1]
    axes.set_xlabel(f"{across} of the robot's base", fontsize=9)
    axes.set_ylabel(f"{up} of the robot's base", fontsize=9)
    finish(axes)
    (left, bottom), (right, top) = view.bounds
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    add_legend(axes)


def add_legend(axes: Axes) -> None:
    """Put a legend below the axis label, at a distance that does not scale with the axes."""
    from matplotlib.transforms import ScaledTranslation

    below = ScaledTranslation(0.0, -0.42, axes.figure.dpi_scale_trans)
    axes.legend(
        loc="upper right",
        bbox_to_anchor=(1.02, 0.0),
        bbox_transform=axes.transAxes + below,
        ncols=4,
        fontsize=8,
        frameon=False,
        columnspacing=1.2,
        handletextpad=0.5,
    )


def _draw_regions(axes: Axes, view: LayerSlice) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Polygon

    axes.set_facecolor(colours.OUTSIDE)
    allowed = view.allowed()
    if len(allowed) > 2:
        edge = colours.ARENA if view.cspace.world.arenas else "none"
        axes.add_patch(Polygon(allowed, facecolor="white", edgecolor=edge, linewidth=1.5))
    obstacles = PolyCollection(
        view.c_obstacles(),
        facecolors=[(*colours.rgb(colours.C_OBSTACLE), 0.45)],
        edgecolors=colours.C_OBSTACLE,
        linewidths=0.8,
        zorder=2,
        label="C-obstacles of the parts",
    )
    axes.add_collection(obstacles)


def _draw_intervals(
    axes: Axes,
    view: LayerSlice,
    places: NDArray[np.float64],
    intervals: list[NDArray[np.float64]],
) -> None:
    from matplotlib.collections import LineCollection

    low, high = view.bounds[:, 1]
    whole = [[(line, low), (line, high)] for line in places]
    axes.add_collection(LineCollection(whole, colors=colours.SWEEP_LINE, linewidths=0.5, zorder=1))
    free = [
        [(line, bottom), (line, top)]
        for line, on_line in zip(places, intervals, strict=True)
        for bottom, top in on_line
    ]
    axes.add_collection(
        LineCollection(
            free, colors=colours.FREE_INTERVAL, linewidths=1.6, zorder=3, label="free intervals"
        )
    )


def _draw_roadmap(axes: Axes, nodes: NDArray[np.float64], edges: NDArray[np.float64]) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(
        LineCollection(
            list(edges), colors=colours.ROADMAP, linewidths=1.4, zorder=4, label="roadmap"
        )
    )
    axes.plot(*nodes.T, "o", color=colours.ROADMAP, markersize=2.5, zorder=5)


def _title(view: LayerSlice) -> str:
    place = ""
    if view.fixed is not None:
        axis, value = view.fixed
        place = f" at {'xyz'[axis]} = {value:.3g}"
    joints = _joint_values(view)
    if not view.cspace.rotates:
        return f"The layer{place}{joints}"
    if view.cspace.dimension == 2:
        return f"The layer of heading {_degrees(float(view.configuration[2]))}{joints}"
    return f"The layer of one orientation{place}{joints}"


def _joint_values(view: LayerSlice) -> str:
    """Say the values of the joints on a second line, or how many there are if it is too long."""
    robot = view.cspace.robot
    said = []
    for joint in robot.joints:
        if joint.type in (REVOLUTE, CONTINUOUS, PRISMATIC):
            (value,) = view.configuration[robot.joint_slices[joint.name]]
            shown = f"{value:.3g}" if joint.type == PRISMATIC else _degrees(float(value))
            said.append(f"{as_written(joint.name)} {shown}")
    line, count = ", ".join(said), len(robot.joint_slices)
    if count == 0:
        return ""
    if len(said) == count and len(line) <= LONGEST_LINE:
        return f"\n{line}"
    return f"\nat one value of {'the joint' if count == 1 else f'each of the {count} joints'}"


def _degrees(angle: float) -> str:
    degrees = round(math.degrees(angle)) + 0  # no minus before a zero
    return f"{degrees:d}°".replace("-", "\N{MINUS SIGN}")
