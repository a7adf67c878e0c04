"""The minimum distance along a path, as in the thesis' Fig. 6.13."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planners.view import colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from planners.view.clearance_along import Distances


def draw_clearance(
    axes: Axes, along: Distances, required: float = 0.0, proved: float | None = None
) -> None:
    """Draw distances over the travelled length and, if positive, the required one.

    The least of them is marked. Above the panel, where no curve passes, stand its value or
    `proved`, a lower bound along the whole path, and the distance of what does not move.
    """
    axes.set_title("Minimum distance along the path", loc="left", fontsize=11)
    axes.set_xlabel("travelled length in OMPL's metric", fontsize=9)
    axes.tick_params(labelsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    travelled, distances = along.travelled, along.moving
    if not np.all(np.isfinite(distances)):
        message = "there is nothing to keep a distance from"
        axes.text(0.5, 0.5, message, transform=axes.transAxes, ha="center")
        return
    axes.fill_between(travelled, distances, color=colours.tint(colours.ROBOT, 0.8), linewidth=0)
    axes.plot(travelled, distances, color=colours.ROBOT, linewidth=1.5)
    _mark_least(axes, along, proved)
    if required > 0.0:
        axes.axhline(required, color=colours.PATH, linestyle="--", linewidth=1)
    axes.margins(x=0.0)
    axes.set_ylim(bottom=min(0.0, 1.05 * float(distances.min())))


def _mark_least(axes: Axes, along: Distances, proved: float | None) -> None:
    lowest = int(np.argmin(along.moving))
    least = along.travelled[lowest], along.moving[lowest]
    # Whole, also where it stands at an end of the panel.
    axes.plot(*least, "o", color=colours.GOAL, markersize=5, clip_on=False, zorder=5)
    text = f"least drawn: {least[1]:.3g}" if proved is None else f"proved: at least {proved:.3g}"
    if np.isfinite(along.resting):
        text += f"; not drawn: what does not move, {along.resting:.3g}"
    axes.set_title(text, loc="right", fontsize=9, color=colours.GOAL)
