"""The Gaussian potential GCF and its candidates (thesis figs. 3.6, 3.7 and 3.8)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import CrystalError
from planners.view import colours
from planners.view.crystal_cell import drawn_cell
from planners.view.crystal_plane import plane_window
from planners.view.figures_crystal import saved
from planners.view.figures_plane import ellipse, finish

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.gaussian_mixture import GaussianMixture
    from ellipsoid_planning.crystal.model import PackingModel
    from ellipsoid_planning.crystal.potential import GaussianPotential

    Array = NDArray[np.float64]

COUNTS_SIZE = (6.5, 4.2)  # [inches]
MOST_TICKS = 12
MIXTURE_SIZE = (6.5, 6.0)
MAP_SIZE = (11.0, 4.6)
HUES = (colours.ROBOT, colours.GOAL, colours.START, "#aa4499", "#56b4e9", "#999933")
MARKERS = "osD^vP"
CONTOURS = (0.1, 0.3, 0.5, 0.7, 0.9)  # of the largest value
PIXELS = 240
FREE, COLLISION = "#1a1a1a", "#ffffff"  # as in the thesis


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
    axes.set_xscale("log")
    spreads = np.unique(np.concatenate([np.asarray(x, dtype=float) for x, _ in counts.values()]))
    axes.set_xticks(spreads if len(spreads) <= MOST_TICKS else spreads[:: len(spreads) // 6])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("$m_b$")
    axes.set_ylabel("free candidates")
    axes.set_ylim(0.0, 1.12 * axes.dataLim.ymax)
    axes.set_title(title or "Free minima of GCF, one sought in each cell of a grid", fontsize=11)
    axes.grid(color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return drawn


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
        f"{model.name}: contours of the mixture, $m_b$ = {mixture.spread:g}, "
        "in parts of its maximum;\ndashed: the ellipses",
        fontsize=10,
    )
    finish(axes)
    return drawn


def picture_of_potential_map(
    potential: GaussianPotential,
    suffix: str,
    across: str | None = None,
    up: str | None = None,
    fixed: Mapping[str, float] | None = None,
    pixels: int = 181,
) -> bytes:
    """Draw where arrangements are free, and GCF, over two coordinates (Fig. 3.8).

    Args:
        potential: GCF of the model.
        suffix: the picture's format, such as png.
        across: the key of the coordinate to the right, the first one by default.
        up: that of the one upwards, the next one by default.
        fixed: the others' values by key as files give them; the middle of their ranges by default.
        pixels: along each axis.

    Raises:
        CrystalError: if a key is unknown or two are the same.
    """
    return saved(draw_potential_map(potential, across, up, fixed, pixels), suffix)


def draw_potential_map(
    potential: GaussianPotential,
    across: str | None = None,
    up: str | None = None,
    fixed: Mapping[str, float] | None = None,
    pixels: int = 181,
) -> Figure:
    """Return the matplotlib figure: the collision map, then GCF."""
    from matplotlib.figure import Figure

    model = potential.model
    keys = _keys(model, across, up, fixed or {})
    configurations, axes_values, others = _plane_of(model, keys, fixed or {}, pixels)
    shape = (len(axes_values[1]), len(axes_values[0]))
    free = model.are_free(configurations).reshape(shape)
    values = np.asarray(potential.values(configurations)).reshape(shape)
    drawn = Figure(figsize=MAP_SIZE, layout="constrained")
    held = ", ".join(f"{_label(name)} = {value:g}{_unit(name)}" for name, value in others.items())
    drawn.suptitle(f"{model.name}: {held}" if held else model.name, fontsize=12, fontweight="bold")
    panels = drawn.subplots(1, 2)
    _draw_free(panels[0], free, axes_values)
    _draw_values(panels[1], values, free, axes_values, potential)
    for panel in panels:
        for key, write in zip(keys, (panel.set_xlabel, panel.set_ylabel), strict=True):
            write(f"{_label(key)} [{_unit(key)}]" if _unit(key) else _label(key), fontsize=9)
        panel.tick_params(labelsize=8)
    return drawn


def _label(key: str) -> str:
    return key.removesuffix("_deg").replace("_", " ")


def _unit(key: str) -> str:
    return "°" if key.endswith("_deg") else ""


def _keys(
    model: PackingModel, across: str | None, up: str | None, fixed: Mapping[str, float]
) -> tuple[str, str]:
    rest = [key for key in model.keys if key not in {across, up} and key not in fixed]
    first = across if across is not None else (rest.pop(0) if rest else "")
    second = up if up is not None else (rest.pop(0) if rest else "")
    for key in (first, second, *fixed):
        if key not in model.keys:
            raise CrystalError(
                f"{key!r} is no coordinate; the coordinates of {model.name} are "
                f"{', '.join(model.keys)}"
            )
    if first == second or first in fixed or second in fixed:
        raise CrystalError(
            f"expected two coordinates for the map's axes that are not held fixed, got {first!r} "
            f"and {second!r}"
        )
    return first, second


def _plane_of(
    model: PackingModel, keys: tuple[str, str], fixed: Mapping[str, float], pixels: int
) -> tuple[Array, list[Array], dict[str, float]]:
    """Configurations (pixels², K) row by row, both axes' values and the others', in file units."""
    ranges = dict(zip(model.keys, model.grid.ranges, strict=True))
    middle = np.array([0.5 * (r.lower + r.upper) for r in model.grid.ranges])
    shown = model.values_of(middle)
    others = {key: fixed.get(key, shown[key]) for key in model.keys if key not in keys}
    base = model.configuration({**shown, **others})
    columns = [model.keys.index(key) for key in keys]
    ends = [(ranges[key].lower, ranges[key].upper) for key in keys]
    # The middles of the pixels.
    values = [a + (np.arange(pixels) + 0.5) / pixels * (b - a) for a, b in ends]
    grid = np.tile(base, (pixels * pixels, 1))
    across, up = np.meshgrid(*values)
    grid[:, columns[0]], grid[:, columns[1]] = across.ravel(), up.ravel()
    turns = [model.molecule.coordinates[column].turns for column in columns]
    in_files = [np.degrees(v) if turn else v for v, turn in zip(values, turns, strict=True)]
    return grid, in_files, others


def _extent(values: Sequence[Array]) -> tuple[float, float, float, float]:
    ends: list[float] = []
    for row in values:
        half = 0.5 * float(row[1] - row[0]) if len(row) > 1 else 0.5
        ends += [float(row[0]) - half, float(row[-1]) + half]
    return ends[0], ends[1], ends[2], ends[3]


def _draw_free(axes: Axes, free: NDArray[np.bool_], values: Sequence[Array]) -> None:
    from matplotlib.colors import ListedColormap

    axes.imshow(
        free,
        origin="lower",
        extent=_extent(values),
        aspect="auto",
        cmap=ListedColormap([COLLISION, FREE]),
        vmin=0,
        vmax=1,
        interpolation="nearest",
    )
    share = 100.0 * float(free.mean())
    axes.set_title(f"(a) black: free ({share:.3g} % of the map)", loc="left", fontsize=10)


def _draw_values(
    axes: Axes,
    values: Array,
    free: NDArray[np.bool_],
    places: Sequence[Array],
    potential: GaussianPotential,
) -> None:
    from matplotlib.colors import PowerNorm

    shown = axes.imshow(
        values,
        origin="lower",
        extent=_extent(places),
        aspect="auto",
        norm=PowerNorm(0.5),  # most of the differences are among low values
        cmap="gray",
        interpolation="nearest",
    )
    if free.any() and not free.all():
        axes.contour(*places, free.astype(float), levels=[0.5], colors="#d55e00", linewidths=1.0)
    axes.set_title(
        f"(b) GCF, $m_b$ = {potential.mixture.spread:g}; outlined: free", loc="left", fontsize=10
    )
    bar = axes.figure.colorbar(shown, ax=axes, pad=0.02)
    bar.ax.tick_params(labelsize=8)
