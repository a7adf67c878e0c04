"""Pictures of grids of rotations that show how even they are.

Exponential coordinates, the axis times the angle, put all rotations into a ball of radius 180°.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from ellipsoid_planning.groups.covering import nearest_distances
from ellipsoid_planning.groups.quaternions import angle, exponential, logarithm, random_rotations
from planners.view import colours
from planners.view.figures import DOTS_PER_INCH

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ellipsoid_planning.groups.rotation_grid import RotationGrid

    Array = NDArray[np.float64]

SIZE = (15.0, 5.0)  # [inches]
MOST_POINTS = 3000
PIXELS = 360
PROBES = 40_000
WORST = 1.0  # spacings; the colours' end, the same for all grids so that they compare
BINS = 60


def picture(grid: RotationGrid, suffix: str) -> bytes:
    """Draw a grid; ``suffix`` is the picture's format, such as png."""
    content = io.BytesIO()
    draw(grid).savefig(content, format=suffix, dpi=DOTS_PER_INCH)
    return content.getvalue()


def draw(grid: RotationGrid) -> Figure:
    """Return the matplotlib figure: the ball, a slice of it, and how far rotations are apart."""
    from matplotlib.figure import Figure

    drawn = Figure(figsize=SIZE, layout="constrained")
    draw_ball(drawn.add_subplot(1, 3, 1, projection="3d"), grid)
    draw_slice(drawn.add_subplot(1, 3, 2), grid)
    draw_distances(drawn.add_subplot(1, 3, 3), grid)
    return drawn


def draw_ball(axes: Any, grid: RotationGrid) -> None:
    """Draw rotations as points in the ball, axis times angle; some of them where there are many."""
    step = -(-grid.count // MOST_POINTS)
    # Every k-th would pick a pattern of its own out of a regular grid.
    order = np.random.default_rng(0).permutation(grid.count)[: grid.count // step]
    points = np.degrees(logarithm(grid.at(np.sort(order))))
    turn = np.linalg.norm(points, axis=1)
    shown = axes.scatter(
        *points.T, c=turn, s=9.0, cmap="viridis_r", vmin=0.0, vmax=180.0, linewidths=0
    )
    axes.set_title(_title(grid, len(points)), loc="left", fontsize=10)
    axes.set_box_aspect((1, 1, 1))
    for name in "xyz":
        getattr(axes, f"set_{name}lim")(-180, 180)
        getattr(axes, f"set_{name}ticks")([-180, 0, 180])
    axes.tick_params(labelsize=7)
    _add_scale(axes, shown, "angle [°]")


def _title(grid: RotationGrid, shown: int) -> str:
    some = "" if shown == grid.count else f" ({shown} of them)"
    return f"{grid.name}: {grid.count} rotations as axis times angle{some}"


def draw_slice(axes: Axes, grid: RotationGrid) -> None:
    """Draw a plane through the ball: how far each rotation is from the grid.

    A plane tilted against the axes, since those of a symmetric grid are not typical.
    """
    plane = np.linalg.qr(np.array([[1.0, 0.2, 0.5], [0.0, 1.0, 0.3]]).T)[0].T
    axis = np.linspace(-np.pi, np.pi, PIXELS)
    places = np.stack(np.meshgrid(axis, axis), axis=-1)
    inside = np.linalg.norm(places, axis=-1) <= np.pi
    distances = np.full(inside.shape, np.nan)
    distances[inside] = _distances(grid, exponential(places[inside] @ plane))
    shown = axes.imshow(
        np.degrees(distances),
        origin="lower",
        extent=(-180, 180, -180, 180),
        cmap="cividis",
        vmin=0.0,
        vmax=WORST * np.degrees(grid.spacing),
    )
    axes.set_title("A slice of the ball: distance to the grid", loc="left", fontsize=10)
    axes.set_xticks([-180, 0, 180])
    axes.set_yticks([-180, 0, 180])
    axes.tick_params(labelsize=7)
    for side in axes.spines.values():
        side.set_visible(False)
    _add_scale(axes, shown, "distance to the nearest node [°]")


def _distances(grid: RotationGrid, rotations: Array) -> Array:
    return angle(rotations, grid.at(grid.nearest(rotations)))


def draw_distances(axes: Axes, grid: RotationGrid) -> None:
    """Draw how far nodes are from their nearest neighbours, and any rotations from the grid."""
    between = np.degrees(nearest_distances(grid))
    probed = np.degrees(_distances(grid, random_rotations(PROBES)))
    top = 1.05 * max(between.max(), probed.max())
    kinds = (
        (between, colours.GOAL, "of a node from its nearest neighbour"),
        (probed, colours.ROBOT, "of any rotation from the grid"),
    )
    for values, colour, label in kinds:
        axes.hist(
            values,
            bins=BINS,
            range=(0.0, top),
            weights=np.full(len(values), 100.0 / len(values)),
            color=colour,
            alpha=0.6,
            label=label,
        )
    axes.set_xlim(0.0, top)
    axes.set_title("Distances", loc="left", fontsize=10)
    axes.set_xlabel("[°]", fontsize=9)
    axes.set_ylabel("share [%]", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="upper left", fontsize=8, frameon=False)
    axes.margins(y=0.2)


def _add_scale(axes: Any, shown: Any, label: str) -> None:
    bar = axes.figure.colorbar(shown, ax=axes, shrink=0.7, pad=0.08)
    bar.set_label(label, fontsize=8)
    bar.ax.tick_params(labelsize=7)
