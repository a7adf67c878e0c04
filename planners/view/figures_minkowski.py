"""Pictures of Minkowski sums and differences, as the thesis' Figs. 5.1 to 5.4, 5.9 and 5.11."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.geometry.affine import ellipsoid_from_factor
from ellipsoid_planning.geometry.boundary_mesh import (
    difference_mesh,
    difference_polygon,
    sum_mesh,
    sum_polygon,
)
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from planners.view import colours
from planners.view.camera import Camera, frame
from planners.view.figures import DOTS_PER_INCH, check_format
from planners.view.figures_plane import ellipse, finish
from planners.view.figures_space import Painting
from planners.view.surfaces import ellipsoid_patches
from planners.view.writing import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ellipsoid_planning.geometry.minkowski_summary import MinkowskiSummary

    Array = NDArray[np.float64]

WIDTH = 12.0  # [inches]
CORNERS = 480
COPIES = 14
AZIMUTH = np.radians(-60.0)
EXACT = colours.PATH
STYLES = {
    "offset": (colours.ROBOT, "-"),
    "gaussian": (colours.GOAL, "-"),
    "kurzhanski trace": (colours.ROADMAP, "--"),
    "kurzhanski volume": (colours.START, "--"),
}
KINDS = {
    "exact": colours.PATH,
    "lower": colours.ROBOT,
    "upper": colours.GOAL,
    "estimate": colours.START,
}


def figure(summary: MinkowskiSummary, output: str | Path) -> Path:
    """Draw a Minkowski sum or difference and write the picture; the suffix chooses the format.

    How the boundary comes about, the ellipsoids inside and around, and how good the bounds are.

    Raises:
        EllipsoidPlanningError: if the format is unknown or the file cannot be written.
    """
    check_format(Path(output))
    content = io.BytesIO()
    draw(summary).savefig(content, format=Path(output).suffix[1:].lower(), dpi=DOTS_PER_INCH)
    return write_whole(output, content.getvalue())


def draw(summary: MinkowskiSummary) -> Figure:
    """Return the matplotlib figure: two or three panels, and the bounds below."""
    from matplotlib.figure import Figure

    planar = summary.first.dimension == 2
    columns = 3 if planar else 2
    heights = [_panel_height(summary, columns), 0.8 + 0.22 * len(summary.volumes)]
    drawn = Figure(figsize=(WIDTH, sum(heights)), layout="constrained")
    grid = drawn.add_gridspec(2, columns, height_ratios=heights)
    panels = [drawn.add_subplot(grid[0, k]) for k in range(columns)]
    if planar:
        draw_construction(panels[0], summary)
        draw_shrunk(panels[1], summary)
        draw_approximations(panels[2], summary)
    else:
        camera = camera_of(summary)
        draw_solid(panels[0], summary, camera)
        draw_silhouettes(panels[1], summary, camera)
    draw_bounds(drawn.add_subplot(grid[1, :]), summary)
    return drawn


def _panel_height(summary: MinkowskiSummary, columns: int) -> float:
    """The height [inches] at which what is drawn fills a panel's width, legend included."""
    if summary.first.dimension == 2:
        body = _boundary(summary)
        reach = 0.0 if summary.difference else summary.second.support(np.eye(2))
        points = np.concatenate([body - reach, body + reach, summary.first.surface_points(64)])
        size = np.ptp(points, axis=0)
    else:
        camera = camera_of(summary)
        solid = [_surface(summary).reshape(-1, 3), summary.first.surface_points(500)]
        size = np.ptp(camera.axes(np.concatenate(solid))[:, :2], axis=0)
    return float(np.clip(0.8 * WIDTH / columns * size[1] / size[0], 1.2, 5.0)) + 1.5


def draw_construction(axes: Axes, summary: MinkowskiSummary) -> None:
    """Draw ellipses: the second body touching the first all round, and where its centre goes."""
    first, second = summary.first, summary.second
    boundary = _boundary(summary)
    _set_title(axes, f"{_name(summary)}: where E2's centre goes")
    fill = colours.tint(colours.OBSTACLE, 0.6)
    if not summary.difference:
        axes.fill(*boundary.T, color=colours.tint(colours.C_OBSTACLE, 0.7))
        axes.add_patch(ellipse(first, facecolor=fill, edgecolor=colours.OBSTACLE))
    else:
        axes.add_patch(ellipse(first, facecolor="white", edgecolor=colours.ARENA, linewidth=1.8))
        axes.fill(*boundary.T, color=colours.tint(colours.ARENA, 0.6))
    step = len(boundary) // COPIES
    for centre in boundary[::step]:
        copy = second.transform(np.eye(2), centre - second.centre)
        axes.add_patch(ellipse(copy, fill=False, edgecolor=colours.ROBOT, linewidth=0.7, zorder=3))
    axes.plot(*_closed(boundary).T, color=EXACT, linewidth=1.8, zorder=4)
    finish(axes)


def draw_shrunk(axes: Axes, summary: MinkowskiSummary) -> None:
    """Draw the same where E2 is shrunk to a circle: the boundary is an offset curve there."""
    second = summary.second
    radius = float(np.min(second.semi_axes))
    shrink = (second.rotation * (radius / second.semi_axes)) @ second.rotation.T
    one = ellipsoid_from_factor(shrink @ summary.first.centre, shrink @ summary.first.matrix)
    ball = Ellipsoid.from_semi_axes([radius] * 2, shrink @ second.centre)
    polygon = difference_polygon if summary.difference else sum_polygon
    boundary = polygon(one, ball, CORNERS)
    _set_title(axes, "Shrunk until E2 is a circle: an offset curve")
    fill = colours.tint(colours.OBSTACLE, 0.6)
    if not summary.difference:
        axes.fill(*boundary.T, color=colours.tint(colours.C_OBSTACLE, 0.7))
        axes.add_patch(ellipse(one, facecolor=fill, edgecolor=colours.OBSTACLE))
    else:
        axes.add_patch(ellipse(one, facecolor="white", edgecolor=colours.ARENA, linewidth=1.8))
        axes.fill(*boundary.T, color=colours.tint(colours.ARENA, 0.6))
    for centre in boundary[:: len(boundary) // COPIES]:
        copy = Ellipsoid.from_semi_axes([radius] * 2, centre)
        axes.add_patch(ellipse(copy, fill=False, edgecolor=colours.ROBOT, linewidth=0.7, zorder=3))
    axes.plot(*_closed(boundary).T, color=EXACT, linewidth=1.8, zorder=4)
    finish(axes)


def draw_approximations(axes: Axes, summary: MinkowskiSummary) -> None:
    """Draw the exact boundary of ellipses and the ellipses inside and around it."""
    _set_title(axes, "Exact, and ellipses inside and around")
    axes.plot(*_closed(_boundary(summary)).T, color=EXACT, linewidth=2.0, label="exact", zorder=5)
    for one in summary.approximations:
        colour, line = STYLES[one.name]
        outline = one.ellipsoid.surface_points(CORNERS)
        label = f"{one.name} ({one.kind})"
        axes.plot(*_closed(outline).T, color=colour, linestyle=line, linewidth=1.2, label=label)
    _add_legend(axes)
    finish(axes)


def draw_solid(axes: Axes, summary: MinkowskiSummary, camera: Camera) -> None:
    """Draw ellipsoids: the exact surface, seen through, with the bodies that make it."""
    first, second = summary.first, summary.second
    surface = _surface(summary)
    painting = Painting(camera)
    hue = colours.ARENA if summary.difference else colours.C_OBSTACLE
    if summary.difference:
        _set_title(axes, "E1 (outline), E1 ⊖ E2 (blue) and E2 touching E1 from inside")
        axes.plot(*_closed(_hull(camera, first.surface_points(2000))).T, color=colours.OBSTACLE)
        painting.add(surface, hue)
        painting.paint(axes, 2)
        for copy in _copies(camera, second, surface):
            outline = _hull(camera, copy.surface_points(2000))
            axes.fill(*outline.T, color=colours.ROBOT, alpha=0.25, linewidth=0, zorder=3)
            axes.plot(*_closed(outline).T, color=colours.ROBOT, linewidth=1.0, zorder=4)
    else:
        _set_title(axes, "E1 (grey), E1 ⊕ E2 (seen through) and E2 touching E1")
        painting.add(surface, colours.tint(hue, 0.5), inside=True)
        painting.paint(axes, 1)
        painting.add(ellipsoid_patches(first, 96, 48), colours.OBSTACLE)
        painting.paint(axes, 2)
        for copy in _copies(camera, second, surface):
            painting.add(ellipsoid_patches(copy, 96, 48), colours.ROBOT)
        painting.paint(axes, 3)
        outline = _hull(camera, surface.reshape(-1, 3))
        axes.fill(*outline.T, color=hue, alpha=0.35, linewidth=0, zorder=4)
        axes.plot(*_closed(outline).T, color=EXACT, linewidth=1.5, zorder=5)
    axes.set_aspect("equal", anchor="N")
    axes.autoscale_view()
    axes.set_axis_off()


def draw_silhouettes(axes: Axes, summary: MinkowskiSummary, camera: Camera) -> None:
    """Draw outlines of ellipsoids inside and around, and of the exact set, from one side."""
    _set_title(axes, "Outlines from this side: exact, and ellipsoids inside and around")
    exact = _hull(camera, _surface(summary).reshape(-1, 3))
    axes.plot(*_closed(exact).T, color=EXACT, linewidth=2.0, label="exact", zorder=5)
    for one in summary.approximations:
        colour, line = STYLES[one.name]
        outline = _hull(camera, one.ellipsoid.surface_points(4000))
        label = f"{one.name} ({one.kind})"
        axes.plot(*_closed(outline).T, color=colour, linestyle=line, linewidth=1.2, label=label)
    _add_legend(axes)
    finish(axes)


def draw_bounds(axes: Axes, summary: MinkowskiSummary) -> None:
    """Draw every bound and estimate by its error."""
    exact = summary.exact
    what = "area" if summary.first.dimension == 2 else "volume"
    title = f"Exact {what} {exact:.7g}; errors [%] of lower bounds (blue), upper bounds (orange) "
    _set_title(axes, title + "and estimates (green)")
    axes.tick_params(labelsize=8)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    if not exact > 0.0:
        axes.text(0.5, 0.5, "the set has no volume", transform=axes.transAxes, ha="center")
        return
    named = sorted(summary.volumes.items(), key=lambda one: float(one[1]))
    axes.axvline(0.0, color=EXACT, linewidth=1.0)
    for row, (_, bound) in enumerate(named):
        error = 100.0 * (float(bound) / exact - 1.0)
        colour = KINDS[bound.kind]
        axes.plot([0.0, error], [row, row], color=colours.tint(colour, 0.5), linewidth=2.0)
        axes.plot(error, row, "o", color=colour, markersize=5)
        axes.annotate(
            f"{float(bound):.6g}",
            (error, row),
            xytext=(6 if error >= 0.0 else -6, 0),
            textcoords="offset points",
            ha="left" if error >= 0.0 else "right",
            va="center",
            fontsize=7,
        )
    axes.set_yticks(range(len(named)), [name.replace("_", " ") for name, _ in named])
    axes.margins(x=0.12)


def _boundary(summary: MinkowskiSummary) -> Array:
    polygon = difference_polygon if summary.difference else sum_polygon
    return polygon(summary.first, summary.second, CORNERS)


def _surface(summary: MinkowskiSummary) -> Array:
    """The exact surface as patches (m, 4, 3)."""
    mesh = (difference_mesh if summary.difference else sum_mesh)(
        summary.first, summary.second, 32, 96
    )
    return mesh.vertices[mesh.triangles[:, [0, 1, 2, 2]]]


def camera_of(summary: MinkowskiSummary) -> Camera:
    """Return the camera for `draw_solid` and `draw_silhouettes`."""
    bodies = [summary.first] if summary.difference else []
    points = [_surface(summary).reshape(-1, 3), *(body.surface_points(500) for body in bodies)]
    return frame(np.concatenate(points), float(AZIMUTH))


def _copies(camera: Camera, second: Ellipsoid, surface: Array) -> list[Ellipsoid]:
    """E2 with its centre on the surface: to the right, to the left, and below."""
    points = surface[:, 0]
    seen = camera.axes(points)
    directions = np.array([[1.0, 0.3, 0.3], [-1.0, 0.3, 0.3], [-0.2, -1.0, 0.6]])
    centres = points[np.argmax(seen @ directions.T, axis=0)]
    return [second.transform(np.eye(3), centre - second.centre) for centre in centres]


def _hull(camera: Camera, points: Array) -> Array:
    """The corners (k, 2) of the convex outline of points (m, 3), as the camera sees them."""
    from scipy.spatial import ConvexHull

    seen = camera.axes(points)[:, :2]
    return np.asarray(seen[ConvexHull(seen).vertices])


def _name(summary: MinkowskiSummary) -> str:
    return "E1 ⊖ E2" if summary.difference else "E1 ⊕ E2"


def _closed(points: Array) -> Array:
    return np.concatenate([points, points[:1]])


def _add_legend(axes: Axes) -> None:
    """Below the axes and their numbers, in two columns."""
    axes.legend(
        fontsize=7,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        borderaxespad=3.0,
        ncols=2,
        frameon=False,
    )


def _set_title(axes: Axes, text: str) -> None:
    axes.set_title(text, loc="left", fontsize=9)
