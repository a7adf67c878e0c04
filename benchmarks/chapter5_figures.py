"""The pictures of the thesis' chapter 5 that show results, with our numbers."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.chapter5_trials import (
    RATIOS,
    axes_of,
    errors,
    grid_errors,
    rotations_of,
    sums,
)
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.approximations import gaussian_sum, offset_sum
from ellipsoid_planning.geometry.bound import Bound
from ellipsoid_planning.geometry.boundary_mesh import difference_polygon, sum_polygon
from ellipsoid_planning.geometry.difference_volume import difference_volume
from ellipsoid_planning.geometry.intrinsic_estimates import mean_curvature_bounds, surface_bounds
from ellipsoid_planning.geometry.minkowski_summary import minkowski_summary
from ellipsoid_planning.geometry.motion_volume import contained_motions
from ellipsoid_planning.geometry.orientation import rotation_from_yaw
from planners.view import colours, figures_minkowski
from planners.view.figures_plane import ellipse, finish

BLUE, ORANGE, GREEN, PINK = colours.ROBOT, colours.GOAL, colours.START, colours.ROADMAP


def figure_5_3() -> Figure:
    """Sums of two ellipses at six angles, with the ellipse inside and the one around."""
    drawn = Figure(figsize=(11.0, 7.0), layout="constrained")
    first = Ellipsoid.from_semi_axes([6.0, 2.0])
    for panel, degrees in zip(drawn.subplots(2, 3).flat, range(0, 180, 30), strict=True):
        second = Ellipsoid.from_semi_axes([10.0, 2.0], None, math.radians(degrees))
        inner, outer = offset_sum(first, second), gaussian_sum(first, second)
        _curve(panel, sum_polygon(first, second, 400), colours.PATH, "exact")
        _curve(panel, inner.ellipsoid.surface_points(400), BLUE, "by offset (5.3.1)")
        _curve(panel, outer.ellipsoid.surface_points(400), ORANGE, "by Gaussians (5.3.2)")
        panel.set_title(f"E2 turned by {degrees}°", loc="left", fontsize=9)
        finish(panel)
    _legend_below(drawn, drawn.axes[0])
    return drawn


def figure_5_4() -> Figure:
    """The sum of two ellipsoids with the ellipsoid inside and the one around."""
    first = Ellipsoid.from_semi_axes([20.0, 30.0, 40.0])
    return figures_minkowski.draw(
        minkowski_summary(first, Ellipsoid.from_semi_axes([6.0, 2.0, 2.0]))
    )


def figure_5_5() -> Figure:
    """Bounds of the total mean curvature in 100 random trials."""
    names = {
        "integral_upper": ("M_ub1", ORANGE),
        "circumscribed": ("M_ub2", PINK),
        "schwarz": ("M_lb2", GREEN),
        "integral_lower": ("M_lb1", BLUE),
    }
    return _trials(mean_curvature_bounds(axes_of(3)), names, "total mean curvature M")


def figure_5_6() -> Figure:
    """Errors of the best bounds of the total mean curvature over the axis ratios."""
    return _maps("M")


def figure_5_7() -> Figure:
    """Bounds of the surface in 100 random trials."""
    names = {
        "cauchy_schwarz": ("F_ub1", ORANGE),
        "circumscribed": ("F_ub2", PINK),
        "schwarz": ("F_lb", BLUE),
    }
    return _trials(surface_bounds(axes_of(3)), names, "surface F")


def figure_5_8() -> Figure:
    """Errors of the best bounds of the surface over the axis ratios."""
    return _maps("F")


def figure_5_10() -> Figure:
    """Errors of the bounds of the area of sums in 100 random trials."""
    return _error_lines(2, {"upper": ("V_ub", ORANGE), "lower": ("V_lb", BLUE)})


def figure_5_12() -> Figure:
    """Errors of the bounds of the volume of sums in 100 random trials."""
    names = {
        "upper": ("V_ub1", ORANGE),
        "upper_exact_surface": ("V_ub2", PINK),
        "lower_exact_surface": ("V_lb2", GREEN),
        "lower": ("V_lb1", BLUE),
    }
    return _error_lines(3, names)


def figure_5_13() -> Figure:
    """Errors of the estimates of the area of sums in 100 random trials."""
    return _error_lines(2, ESTIMATES)


def figure_5_14() -> Figure:
    """Errors of the estimates of the volume of sums in 100 random trials."""
    return _error_lines(3, ESTIMATES)


ESTIMATES = {
    "arithmetic_mean": ("V_AM", ORANGE),
    "geometric_mean": ("V_GM", BLUE),
    "estimate": ("V_est", GREEN),
}


def figure_5_15() -> Figure:
    """An ellipse moving inside another: its room by heading, and the volume of its motions."""
    arena, part = Ellipsoid.from_semi_axes([18.0, 15.0]), Ellipsoid.from_semi_axes([2.0, 3.0])
    drawn = Figure(figsize=(11.0, 4.6), layout="constrained")
    left, right = drawn.subplots(1, 2)
    left.add_patch(ellipse(arena, facecolor="white", edgecolor=colours.ARENA, linewidth=1.8))
    for degrees, colour in ((0, BLUE), (45, GREEN), (90, ORANGE)):
        turned = part.transform(rotation_from_yaw(math.radians(degrees)), np.zeros(2))
        boundary = difference_polygon(arena, turned, 400)
        _curve(left, boundary, colour, f"E2 turned by {degrees}°")
        body = turned.transform(np.eye(2), boundary[np.argmax(boundary @ _heading(degrees))])
        left.add_patch(ellipse(body, facecolor=colours.tint(colour, 0.6), edgecolor=colour))
    left.legend(fontsize=8, loc="center")
    left.set_title("Where E2's centre can be", loc="left", fontsize=10)
    finish(left)
    headings = np.arange(360) * (math.pi / 360.0)
    turns = np.array([rotation_from_yaw(angle) for angle in headings])
    areas = difference_volume(arena.matrix, turns @ part.matrix)
    exact = contained_motions(arena, part).value
    right.plot(np.degrees(headings), areas, color=BLUE)
    summed = 2.0 * math.pi * float(np.mean(areas))
    title = f"V_num = {summed:.9g}, V_PK (5.97) = {exact:.9g}"
    _label(right, "E2's heading [degrees]", "area of E1 ⊖ E2", title)
    return drawn


def figure_5_16() -> Figure:
    """An ellipsoid moving inside another: Haar Monte Carlo against the closed form."""
    arena = Ellipsoid.from_semi_axes([30.0, 40.0, 50.0])
    part = Ellipsoid.from_semi_axes([1.0, 2.0, 3.0])
    exact = contained_motions(arena, part).value
    volumes = haar_volumes(arena, part, 20_000)
    counts = np.unique(np.geomspace(10, len(volumes), 200).astype(int))
    means = 8.0 * math.pi**2 * np.cumsum(volumes)[counts - 1] / counts
    spread = 8.0 * math.pi**2 * volumes.std() / np.sqrt(counts)
    drawn = Figure(figsize=(11.0, 4.6), layout="constrained")
    left, right = drawn.subplots(1, 2, width_ratios=[1, 1.3])
    summary = minkowski_summary(arena, part, difference=True)
    figures_minkowski.draw_solid(left, summary, figures_minkowski.camera_of(summary))
    low, high = (
        100.0 * ((means - 1.96 * spread) / exact - 1.0),
        100.0 * ((means + 1.96 * spread) / exact - 1.0),
    )
    right.fill_between(counts, low, high, color=colours.tint(BLUE, 0.7), linewidth=0)
    right.plot(counts, 100.0 * (means / exact - 1.0), color=BLUE)
    right.axhline(0.0, color=colours.PATH, linewidth=1.0)
    right.set_xscale("log")
    title = f"V_num = {means[-1]:.6g}, V_PK (5.98) = {exact:.7g}"
    _label(right, "random rotations", "error of V_num [%], 95 % interval", title)
    return drawn


def haar_volumes(arena: Ellipsoid, part: Ellipsoid, count: int) -> np.ndarray:
    """Volumes (count,) of differences at rotations drawn by Haar's measure."""
    normal = np.random.default_rng(3).normal(size=(count, 3, 3))
    q, r = np.linalg.qr(normal)
    q *= np.sign(np.diagonal(r, axis1=1, axis2=2))[:, None, :]
    q *= np.sign(np.linalg.det(q))[:, None, None]
    return difference_volume(arena.matrix, q @ part.matrix)


FIGURES = {
    "5.3": figure_5_3,
    "5.4": figure_5_4,
    "5.5": figure_5_5,
    "5.6": figure_5_6,
    "5.7": figure_5_7,
    "5.8": figure_5_8,
    "5.10": figure_5_10,
    "5.12": figure_5_12,
    "5.13": figure_5_13,
    "5.14": figure_5_14,
    "5.15": figure_5_15,
    "5.16": figure_5_16,
}


def _trials(bounds: dict[str, Bound], names: dict[str, tuple[str, str]], what: str) -> Figure:
    """Values and errors of bounds, trial by trial, in the order of the exact values."""
    order = np.argsort(bounds["exact"].value)
    found, trial = errors(bounds), np.arange(len(order))
    drawn = Figure(figsize=(11.0, 6.0), layout="constrained")
    top, bottom = drawn.subplots(2, 1, sharex=True)
    for name, (label, colour) in names.items():
        top.plot(trial, bounds[name].value[order], ".-", color=colour, linewidth=0.7, label=label)
        bottom.plot(trial, found[name][order], ".-", color=colour, linewidth=0.7, label=label)
    exact = bounds["exact"].value[order]
    top.plot(trial, exact, color=colours.PATH, linewidth=1.2, label="exact")
    bottom.axhline(0.0, color=colours.PATH, linewidth=1.2)
    top.legend(fontsize=8, ncols=5, loc="upper left")
    _label(top, "", what, f"Bounds of the {what}, semi-axes uniform in [10, 50]")
    _label(bottom, "trial, in the order of the exact value", "error [%]", "")
    return drawn


def _maps(which: str) -> Figure:
    """Errors of the best lower and upper bounds over b/a and c/a."""
    found = grid_errors(which)
    drawn = Figure(figsize=(11.0, 4.6), layout="constrained")
    for panel, name, short in zip(
        drawn.subplots(1, 2), ("lower", "upper"), ("lb", "ub"), strict=True
    ):
        worst = found[name].flat[np.argmax(np.abs(found[name]))]
        shown = panel.contourf(RATIOS, RATIOS, found[name].T, levels=20, cmap="viridis")
        drawn.colorbar(shown, ax=panel, label="error [%]")
        panel.set_aspect("equal")
        _label(panel, "b / a", "c / a", f"{which}_{short}: at worst {worst:+.2f} %")
    return drawn


def _error_lines(dimension: int, names: dict[str, tuple[str, str]]) -> Figure:
    found = errors(sums(dimension))
    drawn = Figure(figsize=(11.0, 4.0), layout="constrained")
    axes = drawn.subplots()
    for name, (label, colour) in names.items():
        label_with_worst = f"{label}, at worst {found[name][np.argmax(np.abs(found[name]))]:+.3g} %"
        axes.plot(found[name], ".-", color=colour, linewidth=0.7, label=label_with_worst)
    axes.axhline(0.0, color=colours.PATH, linewidth=1.2)
    axes.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14), frameon=False)
    what = "areas of sums of ellipses" if dimension == 2 else "volumes of sums of ellipsoids"
    _label(axes, "trial", "error [%]", f"Errors of {what}, semi-axes uniform in [10, 50]")
    return drawn


def _curve(axes: Axes, points: np.ndarray, colour: str, label: str) -> None:
    closed = np.concatenate([points, points[:1]])
    axes.plot(*closed.T, color=colour, linewidth=1.3, label=label)


def _heading(degrees: float) -> np.ndarray:
    return rotation_from_yaw(math.radians(degrees))[:, 0]


def _label(axes: Axes, x: str, y: str, title: str) -> None:
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.set_title(title, loc="left", fontsize=10)
    axes.tick_params(labelsize=8)


def _legend_below(drawn: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)


__all__ = ["FIGURES", "haar_volumes", "rotations_of"]
