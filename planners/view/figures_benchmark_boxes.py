"""Box plots of time, path length and clearance, a row for each planner."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from planners.benchmark.run import RunRecord
from planners.view.figures_benchmark_style import (
    GRID,
    INK,
    QUIET,
    Style,
    plain_axes,
    time_axis,
)
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 11.0  # [inches]
_ROW_HEIGHT = 0.42
_AROUND = 1.35
_LARGE_RATIO = 20.0
"""Values that differ by more than this are drawn on a logarithmic axis."""


def draw_boxes(
    name: str, records: Sequence[RunRecord], limit: float, looks: dict[str, Style]
) -> Figure:
    """Boxes between the quartiles, whiskers to 1.5 times their distance, a dot for each run.

    Args:
        name: of the problem.
        records: its runs.
        limit: the time limit of a run [s]; runs without a path are open arrows at it.
        looks: the contenders' styles.
    """
    from matplotlib.figure import Figure

    labels = [label for label in looks if any(record.label == label for record in records)]
    drawn = Figure(figsize=(WIDTH, _AROUND + _ROW_HEIGHT * len(labels)), layout="constrained")
    drawn.suptitle(as_written(name), fontsize=13, fontweight="bold", color=INK, x=0.01, ha="left")
    panels = drawn.subplots(1, 3, sharey=True, width_ratios=(1.4, 1.0, 1.0))
    rows = [[record for record in records if record.label == label] for label in labels]
    styles = [looks[label] for label in labels]
    _draw_times(panels[0], rows, limit, styles)
    _draw_values(panels[1], "path length", [_values(row, "length") for row in rows], styles)
    clearances = [_values(row, "clearance") for row in rows]
    _draw_values(panels[2], "smallest clearance along the path", clearances, styles)
    _name_rows(panels[0], labels, rows, looks)
    return drawn


def _values(records: Sequence[RunRecord], what: str) -> list[float]:
    values = [getattr(record, what) for record in records if record.solved]
    return [value for value in values if value is not None]


def _name_rows(
    axes: Axes,
    labels: Sequence[str],
    rows: Sequence[Sequence[RunRecord]],
    looks: dict[str, Style],
) -> None:
    names = [
        f"{label}   {sum(record.solved for record in row)}/{len(row)}"
        for label, row in zip(labels, rows, strict=True)
    ]
    axes.set_yticks(range(len(labels)), names, fontsize=10)
    for tick, label in zip(axes.get_yticklabels(), labels, strict=True):
        tick.set_color(looks[label].colour)
        tick.set_fontweight("bold" if looks[label].is_ours else "normal")
    axes.set_ylim(len(labels) - 0.4, -0.6)


def _draw_times(
    axes: Axes, rows: Sequence[Sequence[RunRecord]], limit: float, styles: Sequence[Style]
) -> None:
    _prepare(axes, "planning time", logarithmic=True)
    time_axis(axes.xaxis)
    axes.axvline(limit, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)))
    for height, (records, look) in enumerate(zip(rows, styles, strict=True)):
        _box(axes, height, [record.seconds for record in records if record.solved], look)
        failures = sum(not record.solved for record in records)
        if failures:
            axes.plot(
                limit,
                height,
                ">",
                color="white",
                markeredgecolor=look.colour,
                markersize=8,
                markeredgewidth=1.5,
                clip_on=False,
                zorder=4,
            )
            axes.annotate(
                f"{failures} failed",
                (limit, height),
                xytext=(9, 0),
                textcoords="offset points",
                fontsize=8.5,
                color=look.colour,
                va="center",
                annotation_clip=False,
            )


def _draw_values(
    axes: Axes, title: str, rows: Sequence[Sequence[float]], styles: Sequence[Style]
) -> None:
    positive = [value for row in rows for value in row if value > 0.0]
    wide = bool(positive) and max(positive) > _LARGE_RATIO * min(positive)
    _prepare(axes, title, logarithmic=wide)
    for height, (values, look) in enumerate(zip(rows, styles, strict=True)):
        _box(axes, height, values, look)


def _prepare(axes: Axes, title: str, *, logarithmic: bool) -> None:
    axes.set_title(title, loc="left", fontsize=10.5, color=INK)
    if logarithmic:
        axes.set_xscale("log")
    plain_axes(axes)
    axes.grid(axis="x", color=GRID, linewidth=0.8)


def _box(axes: Axes, height: int, values: Sequence[float], look: Style) -> None:
    if not values:
        return
    line = {"color": look.colour, "linewidth": 1.2}
    axes.boxplot(
        [list(values)],
        positions=[height],
        orientation="horizontal",
        widths=0.5,
        showfliers=False,
        patch_artist=True,
        manage_ticks=False,
        boxprops={"facecolor": (*_channels(look.colour), 0.16), "edgecolor": look.colour},
        medianprops={"color": look.colour, "linewidth": 2.6},
        whiskerprops=line,
        capprops=line,
    )
    axes.plot(values, [height] * len(values), "o", color=look.colour, markersize=3, alpha=0.6)


def _channels(colour: str) -> tuple[float, float, float]:
    from planners.view.colours import rgb

    return rgb(colour)
