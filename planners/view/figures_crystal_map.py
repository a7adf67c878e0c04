"""Where arrangements are free, beside GCF: maps over two coordinates (thesis fig. 3.8)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import CrystalError
from planners.view.figures_crystal import saved
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel
    from ellipsoid_planning.crystal.packing.potential import GaussianPotential

    Array = NDArray[np.float64]

SIZE = (11.0, 4.6)  # [inches]
FREE, COLLISION = "#1a1a1a", "#ffffff"  # as in the thesis
OUTLINE = "#d55e00"
PIXELS = 181


def picture_of_potential_map(
    potential: GaussianPotential,
    suffix: str,
    across: str | None = None,
    up: str | None = None,
    fixed: Mapping[str, float] | None = None,
    pixels: int = PIXELS,
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
    pixels: int = PIXELS,
) -> Figure:
    """Return the matplotlib figure: the collision map, then GCF."""
    from matplotlib.figure import Figure

    model = potential.model
    keys = _keys(model, across, up, fixed or {})
    configurations, axes_values, others = _plane_of(model, keys, fixed or {}, pixels)
    shape = (len(axes_values[1]), len(axes_values[0]))
    free = model.are_free(configurations).reshape(shape)
    values = np.asarray(potential.values(configurations)).reshape(shape)
    drawn = Figure(figsize=SIZE, layout="constrained")
    held = ", ".join(f"{_label(name)} = {value:g}{_unit(name)}" for name, value in others.items())
    name = as_written(model.name)
    drawn.suptitle(f"{name}: {held}" if held else name, fontsize=12, fontweight="bold")
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
        axes.contour(*places, free.astype(float), levels=[0.5], colors=OUTLINE, linewidths=1.0)
    axes.set_title(
        f"(b) GCF, $m_b$ = {potential.mixture.spread:g}; outlined: free", loc="left", fontsize=10
    )
    bar = axes.figure.colorbar(shown, ax=axes, pad=0.02)
    bar.ax.tick_params(labelsize=8)
