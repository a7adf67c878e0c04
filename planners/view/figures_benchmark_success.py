"""The share of runs that are solved within a time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from planners.benchmark.run import RunRecord
from planners.view.figures_benchmark_style import GRID, INK, Style, plain_axes, spread, time_axis
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (8.4, 4.2)  # [inches]
_LABEL_ROOM = 0.075
_FASTEST = 1e-5  # the axis of times begins here at the earliest [s]


def draw_success(
    name: str, records: Sequence[RunRecord], limit: float, looks: dict[str, Style]
) -> Figure:
    """A step curve for each contender: how many of its runs had a free path by then.

    Args:
        name: of the problem.
        records: its runs.
        limit: the time limit of a run [s].
        looks: the contenders' styles.
    """
    from matplotlib.figure import Figure

    drawn = Figure(figsize=SIZE, layout="constrained")
    axes = drawn.add_subplot()
    axes.set_title(
        f"{as_written(name)}: solved runs against time",
        loc="left",
        fontsize=13,
        fontweight="bold",
        color=INK,
    )
    axes.set_xscale("log")
    axes.set_xlabel("planning time", color=INK)
    plain_axes(axes)
    time_axis(axes.xaxis)
    axes.yaxis.set_major_formatter(lambda value, _: f"{100.0 * value:.0f} %")
    axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    axes.grid(axis="y", color=GRID, linewidth=0.8)
    labels = [label for label in looks if any(record.label == label for record in records)]
    fastest = min([record.seconds for record in records if record.solved] or [0.1 * limit])
    low = max(0.6 * fastest, _FASTEST)
    ends = {}
    for label in reversed(labels):
        own = [record for record in records if record.label == label]
        ends[label] = _draw_steps(axes, own, low, limit, looks[label])
    axes.set_xlim(low, limit)
    axes.set_ylim(-0.03, 1.05)
    _label_ends(axes, {label: ends[label] for label in labels}, looks)
    return drawn


def _draw_steps(
    axes: Axes, records: Sequence[RunRecord], low: float, limit: float, look: Style
) -> float:
    times = sorted(min(record.seconds, limit) for record in records if record.solved)
    shares = [index / len(records) for index in range(len(times) + 1)]
    axes.step(
        [low, *times, limit],
        [*shares, shares[-1]],
        where="post",
        color=look.colour,
        linestyle=look.dashes,
        linewidth=look.width,
    )
    return shares[-1]


def _label_ends(axes: Axes, ends: dict[str, float], looks: dict[str, Style]) -> None:
    low, high = axes.get_ylim()
    heights = [(share - low) / (high - low) for share in ends.values()]
    for (label, share), place in zip(
        ends.items(), spread(heights, _LABEL_ROOM, 0.03, 0.97), strict=True
    ):
        axes.annotate(
            f"{label}  {100.0 * share:.0f} %",
            (1.0, share),
            xycoords=("axes fraction", "data"),
            xytext=(1.03, place),
            textcoords="axes fraction",
            va="center",
            fontsize=9.5,
            color=looks[label].colour,
            fontweight="bold" if looks[label].is_ours else "normal",
            arrowprops={
                "arrowstyle": "-",
                "color": looks[label].colour,
                "linewidth": 0.7,
                "alpha": 0.6,
                "shrinkA": 1,
                "shrinkB": 1,
                "relpos": (0.0, 0.5),
            },
        )
