"""Packed cells in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ellipsoid_planning.geometry.directions import unit_directions
from planners.view import crystal_colours as palette
from planners.view.figures_plane import ellipse, finish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.copies import Copy
    from planners.view.crystal_cell import DrawnCell

    Array = NDArray[np.float64]

OUTLINE_POINTS = 96
ROOM = 0.06  # around the cells for the axes' letters, as a part of their longer side


def draw_plane_cell(
    axes: Axes,
    cell: DrawnCell,
    other: DrawnCell | None = None,
    window: tuple[Array, Array] | None = None,
) -> None:
    """Draw the copies, the cells, and what overlaps in yellow.

    Args:
        axes: where to draw.
        cell: what to draw.
        other: an arrangement whose molecule is drawn as dashed outlines.
        window: corners (2,) of what is shown, those of `plane_window` by default.
    """
    for copy in cell.neighbours:
        _draw_copy(axes, cell, copy, faded=True)
    for copy in cell.home[::-1]:
        _draw_copy(axes, cell, copy, faded=False)
    for overlap in cell.overlaps:
        outline = overlap.boundary(unit_directions(2, OUTLINE_POINTS))
        axes.fill(
            *outline.T,
            facecolor=palette.OVERLAP,
            edgecolor=palette.OVERLAP_EDGE,
            linewidth=0.8,
            zorder=5,
        )
    if other is not None:
        look = {"fill": False, "edgecolor": "black", "linestyle": "--", "linewidth": 1.2}
        for body in other.home[0].bodies:
            axes.add_patch(ellipse(body, zorder=7, **look))
    _draw_lines(axes, cell)
    finish(axes)
    low, high = plane_window(cell) if window is None else window
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])


def _draw_copy(axes: Axes, cell: DrawnCell, copy: Copy, faded: bool) -> None:
    """The molecule itself has a dark outline."""
    hue = cell.hues[copy.operation]
    original = copy.operation == 0 and not faded
    edge = "black" if original else (palette.faded(hue) if faded else hue)
    shades = palette.part_shades(cell.model, palette.faded(hue) if faded else hue)
    height = 2.0 if faded else (4.0 if original else 3.0)
    for body, shade in zip(copy.bodies, shades, strict=True):
        axes.add_patch(
            ellipse(
                body,
                facecolor=shade,
                edgecolor=edge,
                linewidth=1.1 if original else 0.8,
                zorder=height,
            )
        )


def _draw_lines(axes: Axes, cell: DrawnCell) -> None:
    for line in cell.neighbour_lines():
        axes.plot(*line.T, color=palette.NEIGHBOUR_CELLS, linewidth=0.8, linestyle="--", zorder=6)
    for edge in cell.home_edges():
        axes.plot(*edge.T, color=palette.CELL, linewidth=2.0, zorder=8, solid_capstyle="round")
    _name_axes(axes, cell)


def _name_axes(axes: Axes, cell: DrawnCell) -> None:
    """The letters a and b outside the home cell, in the middle of its edges."""
    basis = cell.model.cell.basis
    corner = cell.model.cell.cartesian(cell.origin)
    for name, along, across in (("a", 0, 1), ("b", 1, 0)):
        outward = -_rejected(basis[:, across], basis[:, along])
        axes.annotate(
            name,
            tuple(corner + 0.5 * basis[:, along]),
            xytext=tuple(11.0 * outward),
            textcoords="offset points",
            ha="center",
            va="center",
            style="italic",
            fontsize=12,
            zorder=9,
            path_effects=halo(),
        )


def halo() -> list[Any]:
    """Keeps letters readable on whatever is below them."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=3.0, foreground="white")]


def _rejected(vector: Array, along: Array) -> Array:
    rest = vector - along * (vector @ along) / (along @ along)
    return np.asarray(rest / np.linalg.norm(rest))


def plane_window(cell: DrawnCell) -> tuple[Array, Array]:
    """The corners (2,) of a rectangle that holds all cells and copies, and the axes' letters."""
    bodies = [body for copy in cell.copies for body in copy.bodies]
    centres = np.array([body.centre for body in bodies])
    reach = np.array([np.linalg.norm(body.matrix, axis=1) for body in bodies])
    corners = cell.corners(cell.low, cell.high)
    room = ROOM * float(np.max(np.ptp(corners, axis=0)))
    low = np.minimum((centres - reach).min(axis=0), corners.min(axis=0) - room)
    high = np.maximum((centres + reach).max(axis=0), corners.max(axis=0) + room)
    return low - 0.3 * room, high + 0.3 * room
