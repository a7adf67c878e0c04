"""The minimum distance along a path, as in the thesis' Fig. 6.13."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planners.view import colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def draw_clearance(
    axes: Axes,
    travelled: NDArray[np.float64],
    distances: NDArray[np.float64],
    required: float = 0.0,
    proved: float | None = None,
) -> None:
    """Draw distances (m,) over the travelled length (m,) and, if positive, the required one.

    The least of them is marked; `proved`, a lower bound along the whole path, is said beside it.
    """
    axes.set_title("Minimum distance along the path", loc="left", fontsize=11)
    axes.set_xlabel("travelled length in OMPL's metric", fontsize=9)
    axes.tick_params(labelsize=8)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    if not np.all(np.isfinite(distances)):
        message = "there is nothing to keep a distance from"
        axes.text(0.5, 0.5, message, transform=axes.transAxes, ha="center")
        return
    axes.fill_between(travelled, distances, color=colours.tint(colours.ROBOT, 0.8), linewidth=0)
    axes.plot(travelled, distances, color=colours.ROBOT, linewidth=1.5)
    _mark_least(axes, travelled, distances, proved)
    if required > 0.0:
        axes.axhline(required, color=colours.PATH, linestyle="--", linewidth=1)
    axes.margins(x=0.0)
    axes.set_ylim(bottom=min(0.0, 1.05 * float(distances.min())))


def _mark_least(
    axes: Axes,
    travelled: NDArray[np.float64],
    distances: NDArray[np.float64],
    proved: float | None,
) -> None:
    lowest = int(np.argmin(distances))
    text = f"least drawn: {distances[lowest]:.3g}"
    if proved is not None:
        text = f"proved: at least {proved:.3g}"
    place = lowest / len(distances)
    axes.plot(travelled[lowest], distances[lowest], "o", color=colours.GOAL, markersize=5)
    axes.annotate(
        text,
        (travelled[lowest], distances[lowest]),
        xytext=(0, 14),
        textcoords="offset points",
        ha="left" if place < 0.1 else "right" if place > 0.9 else "center",
        fontsize=9,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 2.0},
    )
