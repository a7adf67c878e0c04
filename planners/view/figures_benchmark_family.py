"""Time against clearance on logarithmic axes: what a narrow passage costs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from planners.benchmark.summary import Row
from planners.view.figures_benchmark_style import (
    GRID,
    INK,
    QUIET,
    Style,
    plain_axes,
    spread,
    time_axis,
)
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 9.6  # [inches]
_PANEL_HEIGHT = 4.9
_LANE_HEIGHT = 0.27
_TOP, _BOTTOM = 0.85, 0.6  # [inches]
_LEFT, _RIGHT = 0.09, 0.795  # shares of the width
_MARKER_SIZE = 6.5
_LABEL_ROOM = 0.055  # least distance of two labels, as a share of the axis


@dataclass(frozen=True)
class _Curve:
    """One contender: medians and quartiles (k,) by clearance (k,), timeouts at the limit."""

    label: str
    look: Style
    clearance: NDArray[np.float64]
    first: NDArray[np.float64]
    median: NDArray[np.float64]
    third: NDArray[np.float64]
    bound: NDArray[np.bool_]


def draw_family(name: str, rows: Sequence[Row], limit: float, looks: Mapping[str, Style]) -> Figure:
    """Medians with bands between the quartiles, by contender, over the free play in the passage.

    Where half of the runs or more found no path the curve ends at the time limit, in an open
    marker with an arrow up; from there on the contender has a lane above the limit.

    Args:
        name: of the family.
        rows: of its problems.
        limit: the time limit of a run [s].
        looks: the contenders' styles, by label.
    """
    from matplotlib.figure import Figure

    curves = [_curve(label, rows, limit, look) for label, look in looks.items()]
    curves = [curve for curve in curves if len(curve.clearance)]
    stuck = [curve for curve in curves if curve.bound.any()]
    lanes = _LANE_HEIGHT * (len(stuck) + 0.4) if stuck else 0.0
    heights = [lanes, _PANEL_HEIGHT] if stuck else [_PANEL_HEIGHT]
    height = sum(heights) + _TOP + _BOTTOM
    drawn = Figure(figsize=(WIDTH, height))
    drawn.subplots_adjust(_LEFT, _BOTTOM / height, _RIGHT, 1.0 - _TOP / height, hspace=0.0)
    panels = drawn.subplots(len(heights), sharex=True, height_ratios=heights, squeeze=False)
    axes: Axes = panels[-1][0]
    _frame(axes, limit, stuck=bool(stuck))
    for curve in reversed(curves):  # ours last, on top
        _draw_curve(axes, curve, limit)
    _fit(axes, curves, limit)
    _label_ends(axes, [curve for curve in curves if not curve.bound[-1]])
    if stuck:
        _draw_lanes(panels[0][0], stuck)
    _title(panels[0][0], name, max(row.runs for row in rows), limit)
    return drawn


def _curve(label: str, rows: Sequence[Row], limit: float, look: Style) -> _Curve:
    own = [row for row in rows if row.label == label and row.clearance is not None]
    own.sort(key=lambda row: -(row.clearance or 0.0))

    def seconds(part: str) -> NDArray[np.float64]:
        quantiles = [getattr(row.time, part) for row in own]
        values = [limit if q.is_bound else min(q.value, limit) for q in quantiles]
        return np.array(values, dtype=float)

    return _Curve(
        label,
        look,
        np.array([row.clearance for row in own], dtype=float),
        seconds("first"),
        seconds("median"),
        seconds("third"),
        np.array([row.time.median.is_bound for row in own], dtype=bool),
    )


def _title(axes: Axes, name: str, runs: int, limit: float) -> None:
    explained = (
        f"median of {runs} runs with a band between the quartiles; "
        f"open markers: at least half of the runs found no path within {limit:g} s"
    )
    texts = {
        36: (f"{as_written(name)}: planning time against clearance", 13, INK, "bold"),
        18: (explained, 9, QUIET, "normal"),
    }
    for up, (text, size, colour, weight) in texts.items():
        axes.annotate(
            text,
            (0.0, 1.0),
            xycoords="axes fraction",
            xytext=(0, up),
            textcoords="offset points",
            fontsize=size,
            color=colour,
            fontweight=weight,
        )


def _frame(axes: Axes, limit: float, *, stuck: bool) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.invert_xaxis()
    axes.set_xlabel("clearance: free play in the passage / width of the robot", color=INK)
    plain_axes(axes)
    time_axis(axes.yaxis)
    axes.grid(axis="y", color=GRID, linewidth=0.8)
    if stuck:
        axes.axhline(limit, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)))
        axes.annotate(
            f"time limit {limit:g} s",
            (1.0, limit),  # curves arrive at the limit farther left
            xycoords=("axes fraction", "data"),
            xytext=(0, -11),
            textcoords="offset points",
            ha="right",
            fontsize=8.5,
            color=QUIET,
        )


def _draw_curve(axes: Axes, curve: _Curve, limit: float) -> None:
    look, x, y, bound = curve.look, curve.clearance, curve.median, curve.bound
    told = curve.first < limit
    told[:-1] |= told[1:]
    told[1:] |= curve.first[:-1] < limit
    alpha = 0.16 if look.is_ours else 0.09
    axes.fill_between(
        x, curve.first, curve.third, where=told, color=look.colour, alpha=alpha, linewidth=0
    )
    for k in range(len(x) - 1):
        if not bound[k : k + 2].all():
            ends = slice(k, k + 2)
            axes.plot(x[ends], y[ends], color=look.colour, linestyle=look.dashes, lw=look.width)
    _mark(axes, x[~bound], y[~bound], look, filled=True)
    arrives = bound & ~np.concatenate([[False], bound[:-1]])
    _mark(axes, x[arrives], y[arrives], look, filled=False)


def _fit(axes: Axes, curves: Sequence[_Curve], limit: float) -> None:
    """Show all that was measured and, where it matters, the time limit."""
    told = [value for curve in curves for value in curve.first if value < limit]
    low = min(told) if told else 0.1 * limit
    stuck = any(curve.bound.any() for curve in curves)
    high = limit if stuck else max(value for curve in curves for value in curve.third)
    axes.set_ylim(0.6 * low, (1.25 if stuck else 1.6) * high)


def _mark(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], look: Style, *, filled: bool
) -> None:
    axes.plot(
        x,
        y,
        look.marker,
        color=look.colour if filled else "white",
        markeredgecolor="white" if filled else look.colour,
        markeredgewidth=0.8 if filled else 1.5,
        markersize=_MARKER_SIZE,
        clip_on=False,
        zorder=4,
    )


def _draw_lanes(axes: Axes, curves: Sequence[_Curve]) -> None:
    """A lane for each contender, from where half of its runs or more found no path."""
    axes.set_ylim(len(curves) - 0.1, -0.5)
    axes.set_yticks([])
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(axis="x", which="both", length=0, labelbottom=False)
    for lane, curve in enumerate(curves):
        look, x = curve.look, curve.clearance[curve.bound]
        axes.plot(x, [lane] * len(x), color=look.colour, linestyle=look.dashes, lw=0.8 * look.width)
        _mark(axes, x, np.full(len(x), float(lane)), look, filled=False)
        for place in x:
            _arrow_up(axes, place, lane, look)
        if curve.bound[-1]:
            _write(axes, curve, (1.0, lane), ("axes fraction", "data"))


def _arrow_up(axes: Axes, x: float, y: float, look: Style) -> None:
    axes.annotate(
        "",
        (x, y),
        xytext=(0, 12.5),
        textcoords="offset points",
        arrowprops={"arrowstyle": "<-", "color": look.colour, "linewidth": 1.1, "shrinkB": 2},
        annotation_clip=False,
    )


def _write(
    axes: Axes, curve: _Curve, place: tuple[float, float], coordinates: str | tuple[str, str]
) -> None:
    axes.annotate(
        curve.label,
        place,
        xycoords=coordinates,
        xytext=(6, 0),
        textcoords="offset points",
        va="center",
        fontsize=10,
        color=curve.look.colour,
        fontweight="bold" if curve.look.is_ours else "normal",
        annotation_clip=False,
    )


def _label_ends(axes: Axes, curves: Sequence[_Curve]) -> None:
    """Write the contenders' names beside the ends of their curves, apart from each other."""
    low, high = axes.get_ylim()
    heights = [math.log(curve.median[-1] / low) / math.log(high / low) for curve in curves]
    places = spread(heights, _LABEL_ROOM, 0.02, 0.98)
    for curve, place in zip(curves, places, strict=True):
        _write(axes, curve, (1.0, place), "axes fraction")
