"""How errors fall while candidates are refined (thesis figs. 3.14 and 3.19)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import CrystalError
from planners.view import colours
from planners.view.figures_crystal import saved
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.phasing.trace import Trend

    Array = NDArray[np.float64]

PANEL = (4.0, 3.4)  # [inches]
HUES = (colours.ROBOT, colours.GOAL, colours.START, "#aa4499")
ERRORS = (
    ("E_h", "", "motion"),
    ("MAE", "°", "mae_deg"),
    ("E_max", "°", "e_max_deg"),
    ("MAE₂", "", "mean_shift"),
)
VANISHES = 1e-9  # as a part of the largest
FEW = 12  # trials that have a thin line each


@dataclass(frozen=True, eq=False)
class ErrorTrend:
    """One error over the steps of many trials.

    Attributes:
        name, unit: of the error, such as MAE and °.
        steps: (s,), increasing.
        values: (trials, s), each trial's error at each step; not a number from where it has
            stopped, so that its last one holds, which must not come first.
    """

    name: str
    unit: str
    steps: Array
    values: Array

    @classmethod
    def of(
        cls, name: str, unit: str, histories: Iterable[tuple[ArrayLike, ArrayLike]]
    ) -> ErrorTrend:
        """The trend of trials with steps of their own: each is its steps and its errors there.

        An error holds until the next step that is given.
        """
        trials = [(np.asarray(s, dtype=float), np.asarray(v, dtype=float)) for s, v in histories]
        steps = np.unique(np.concatenate([np.zeros(0), *(s for s, _ in trials)]))
        rows = []
        for own, values in trials:
            place = np.searchsorted(own, steps, side="right") - 1
            rows.append(np.where(place >= 0, values[np.maximum(place, 0)], values[0]))
        return cls(name, unit, steps, np.array(rows).reshape(len(trials), len(steps)))

    def filled(self) -> Array:
        """The values with each trial's last one kept.

        Raises:
            CrystalError: if there is nothing to draw, or a trial has no first value.
        """
        values = np.array(self.values, dtype=float)
        if values.ndim != 2 or values.shape[1] != len(self.steps) or values.size == 0:
            raise CrystalError(
                f"{self.name}: expected errors (trials, {len(self.steps)}), at least one trial and "
                f"one step, got shape {values.shape}"
            )
        if np.any(np.isnan(values[:, 0])):
            raise CrystalError(f"{self.name}: a trial has no error at its first step")
        known = np.where(np.isnan(values), 0, np.arange(values.shape[1]))
        return np.take_along_axis(values, np.maximum.accumulate(known, axis=1), axis=1)


def trends_of(refinements: Sequence[Trend]) -> list[ErrorTrend]:
    """FCF and, where the target is known, E_h, MAE, E_max and MAE₂ of many refinements.

    Raises:
        CrystalError: if there is no refinement, or one of no step.
    """
    if not refinements or not all(len(one.steps) for one in refinements):
        raise CrystalError("expected one refinement or more, each of one step or more, to draw")
    found = [ErrorTrend.of("FCF", "", [(one.steps, one.costs) for one in refinements])]
    if not all(one.errors for one in refinements):
        return found
    for name, unit, key in ERRORS:
        rows = [[getattr(error, key) for error in one.errors] for one in refinements]
        if all(value is not None for row in rows for value in row):
            histories = [(one.steps, row) for one, row in zip(refinements, rows, strict=True)]
            found.append(ErrorTrend.of(name, unit, histories))
    return found


def picture_of_trends(trends: Sequence[ErrorTrend], suffix: str, title: str = "") -> bytes:
    """Draw the median and the spread of errors over steps, a panel each, as a picture's bytes.

    Raises:
        CrystalError: if a trend has nothing to draw.
    """
    return saved(draw_trends(trends, title), suffix)


def draw_trends(trends: Sequence[ErrorTrend], title: str = "") -> Figure:
    """Return the matplotlib figure."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    if not trends:
        raise CrystalError("expected at least one error to draw over the steps, got none")
    columns = 2 if len(trends) == 4 else min(len(trends), 3)
    rows = -(-len(trends) // columns)
    size = max(PANEL[0] * columns, 5.0), PANEL[1] * rows + 0.7
    drawn = Figure(figsize=size, layout="constrained")
    count = len(trends[0].values)
    trials = f"{count} trial{'s' if count != 1 else ''}"
    drawn.suptitle(
        f"{as_written(title)}: {trials}" if title else trials, fontsize=12, fontweight="bold"
    )
    for index, trend in enumerate(trends):
        axes = drawn.add_subplot(rows, columns, index + 1)
        _draw_trend(axes, trend, HUES[index % len(HUES)])
        axes.set_xlabel("steps", fontsize=9)
        axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
    handles, labels = drawn.axes[0].get_legend_handles_labels()
    drawn.legend(
        handles, labels, loc="outside lower center", ncols=len(labels), fontsize=9, frameon=False
    )
    return drawn


def _draw_trend(axes: Axes, trend: ErrorTrend, hue: str) -> None:
    values, steps = trend.filled(), trend.steps
    low, first, middle, third, high = np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0], axis=0)
    # The best so far holds until there is a better one.
    if len(values) > 1:
        bands = ((low, high, 0.85, "all trials"), (first, third, 0.6, "half of them"))
        for bottom, top, pale, label in bands:
            fill = colours.tint(hue, pale)
            axes.fill_between(steps, bottom, top, step="post", color=fill, linewidth=0, label=label)
    if 1 < len(values) <= FEW:
        for row in values:
            axes.step(steps, row, where="post", color=colours.tint(hue, 0.35), linewidth=0.6)
    axes.step(steps, middle, where="post", color=hue, linewidth=2.2, label="median")
    _mark_ends(axes, steps, middle)
    unit = f" [{trend.unit}]" if trend.unit else ""
    axes.set_title(f"{trend.name}{unit}", loc="left", fontsize=10)
    axes.set_ylim(0.0, 1.08 * max(float(high.max()), 1e-12))
    axes.set_xlim(steps[0], steps[-1] if len(steps) > 1 else steps[0] + 1.0)
    axes.tick_params(labelsize=8)
    axes.grid(color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _mark_ends(axes: Axes, steps: Array, middle: Array) -> None:
    """Write the median before, above its line, and after, beyond it."""
    for index, offset, up in ((0, (4, 6), "bottom"), (-1, (4, 0), "center")):
        vanishes = abs(middle[index]) < VANISHES * float(np.max(np.abs(middle)))
        axes.annotate(
            "0" if vanishes else f"{middle[index]:.3g}",
            (steps[index], middle[index]),
            xytext=offset,
            textcoords="offset points",
            ha="left",
            va=up,
            fontsize=9,
            fontweight="bold",
            annotation_clip=False,
        )
