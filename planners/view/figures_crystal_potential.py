"""Gaussian mixtures and the candidates of their potential GCF (thesis figs. 3.6 and 3.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import CrystalError
from planners.view import colours
from planners.view.crystal_cell import drawn_cell
from planners.view.crystal_plane import plane_window
from planners.view.figures_crystal import saved
from planners.view.figures_plane import ellipse, finish
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
    from ellipsoid_planning.crystal.packing.model import PackingModel

    Array = NDArray[np.float64]

COUNTS_SIZE = (6.5, 4.2)  # [inches]
MOST_TICKS = 12
MIXTURE_SIZE = (6.5, 6.0)
HUES = (colours.ROBOT, colours.GOAL, colours.START, "#aa4499", "#56b4e9", "#999933")
MARKERS = "osD^vP"
CONTOURS = (0.1, 0.3, 0.5, 0.7, 0.9)  # of the largest value
PIXELS = 240


def picture_of_candidate_counts(
    counts: Mapping[str, tuple[ArrayLike, ArrayLike]], suffix: str, title: str = ""
) -> bytes:
    """Draw how many candidates there are for each m_b, a line for each grid (Fig. 3.6).

    Args:
        counts: by the grid's name: the values of m_b and the numbers of free candidates.
        suffix: the picture's format, such as png.
        title: of the figure.
    """
    return saved(draw_candidate_counts(counts, title), suffix)


def draw_candidate_counts(
    counts: Mapping[str, tuple[ArrayLike, ArrayLike]], title: str = ""
) -> Figure:
    """Return the matplotlib figure."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, NullLocator

    drawn = Figure(figsize=COUNTS_SIZE, layout="constrained")
    axes = drawn.add_subplot()
    _draw_counts(axes, counts)
    axes.set_xscale("log")
    spreads = np.unique(np.concatenate([np.asarray(x, dtype=float) for x, _ in counts.values()]))
    axes.set_xticks(spreads if len(spreads) <= MOST_TICKS else spreads[:: len(spreads) // 6])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("$m_b$")
    axes.set_ylabel("free candidates")
    axes.set_ylim(0.0, 1.12 * axes.dataLim.ymax)
    axes.set_title(
        as_written(title) or "Free minima of GCF, one sought in each cell of a grid", fontsize=11
    )
    axes.grid(color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return drawn


def _draw_counts(axes: Axes, counts: Mapping[str, tuple[ArrayLike, ArrayLike]]) -> None:
    """A line for each grid, the highest of its numbers written above it."""
    for index, (name, (spreads, numbers)) in enumerate(counts.items()):
        x, y = np.asarray(spreads, dtype=float), np.asarray(numbers, dtype=float)
        hue, marker = HUES[index % len(HUES)], MARKERS[index % len(MARKERS)]
        axes.plot(x, y, color=hue, marker=marker, markersize=5, linewidth=1.6, label=name)
        best = int(np.argmax(y))
        axes.annotate(
            f"{y[best]:.0f} at {x[best]:g}",
            (x[best], y[best]),
            xytext=(0, 7),
            textcoords="offset points",
            ha="center",
            fontsize=8,
            color=hue,
        )


def picture_of_mixture(
    model: PackingModel, configuration: ArrayLike, mixture: GaussianMixture, suffix: str
) -> bytes:
    """Draw the contours of a planar molecule's Gaussian mixture and its parts (Fig. 3.7).

    Raises:
        CrystalError: if the model is not planar, or the configuration does not fit it.
    """
    return saved(draw_mixture(model, configuration, mixture), suffix)


def draw_mixture(model: PackingModel, configuration: ArrayLike, mixture: GaussianMixture) -> Figure:
    """Return the matplotlib figure."""
    from matplotlib.figure import Figure

    if model.dimension != 2:
        raise CrystalError(
            f"{model.name}: contours of the mixture are drawn for planar models, this one is "
            f"{model.dimension}-dimensional"
        )
    bodies = model.molecule.bodies(configuration)
    low, high = plane_window(drawn_cell(model, configuration, (1, 1)))
    x, y = (np.linspace(a, b, PIXELS) for a, b in zip(low, high, strict=True))
    places = np.stack(np.meshgrid(x, y), axis=-1)
    density = np.sum([mixture.density(body, places) for body in bodies], axis=0)
    drawn = Figure(figsize=MIXTURE_SIZE, layout="constrained")
    axes = drawn.add_subplot()
    top = float(density.max())
    axes.contourf(x, y, density, levels=np.linspace(0.0, top, 24), cmap="Blues", vmin=0.0)
    lines = axes.contour(
        x, y, density, levels=[share * top for share in CONTOURS], colors="#08306b", linewidths=0.9
    )
    labels = {share * top: f"{share:g}" for share in CONTOURS}
    axes.clabel(lines, fmt=labels, fontsize=8)
    for body in bodies:
        axes.add_patch(
            ellipse(body, fill=False, edgecolor=colours.GOAL, linewidth=1.8, linestyle="--")
        )
    axes.set_title(
        f"{as_written(model.name)}: contours of the mixture, $m_b$ = {mixture.spread:g}, "
        "in parts of its maximum;\ndashed: the ellipses",
        fontsize=10,
    )
    finish(axes)
    return drawn
