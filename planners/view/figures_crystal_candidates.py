"""Candidates side by side with their target (thesis figs. 3.9, 3.12, 3.13, 3.17 and 3.18)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view.crystal_cell import DrawnCell, drawn_cell
from planners.view.crystal_plane import draw_plane_cell, plane_window
from planners.view.crystal_space import FINE, draw_space_cell, oblique, window
from planners.view.crystal_tables import TARGET, Rows, candidates_rows, checked_candidates
from planners.view.figures_crystal import add_legend, saved
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ellipsoid_planning.crystal.packing.model import PackingModel

PANEL = (3.1, {2: 3.9, 3: 2.9})  # width, and height by dimension [inches]
LEAST_WIDTH = 9.0
ROW = 0.24  # height of a table's row
MARGINS = 1.3
FIRST_COLUMN = 1.4  # its width against the others'


def picture_of_candidates(
    model: PackingModel,
    configurations: ArrayLike,
    costs: ArrayLike,
    suffix: str,
    target: ArrayLike | None = None,
    errors: Mapping[str, Sequence[float]] | None = None,
    shown: int = 3,
    cells: Sequence[int] | None = None,
    title: str = "",
    cost_name: str = "FCF",
    found: tuple[ArrayLike, float] | None = None,
) -> bytes:
    """Draw the target, what was found and the first candidates, above a table of all of them.

    Args:
        model: the molecule and its crystal.
        configurations: (m, K), best first, angles [rad].
        costs: (m,).
        suffix: the picture's format, such as png.
        target: (K,), if it is known.
        errors: further columns of the table by their titles, (m,) each.
        shown: how many candidates are drawn.
        cells: (n,), how many cells along each axis, one by default.
        title: the model's name by default.
        cost_name: what the costs are.
        found: what became of a candidate, (K,), and its cost.

    Raises:
        CrystalError: if a size does not fit.
    """
    table = candidates_rows(model, configurations, costs, target, errors, cost_name)
    candidates, values = checked_candidates(model, configurations, costs)
    panels = [
        (f"candidate {i + 1}, {cost_name} {values[i]:.4g}", candidates[i])
        for i in range(min(shown, len(candidates)))
    ]
    if found is not None:
        panels.insert(0, (f"refined, {cost_name} {found[1]:.4g}", np.asarray(found[0], float)))
    if target is not None:
        panels.insert(0, (TARGET, np.asarray(target, dtype=float)))
    drawn_cells = cells if cells is not None else (1,) * model.dimension
    drawn = draw_candidates(model, panels, table, drawn_cells, title or model.name)
    return saved(drawn, suffix)


def draw_candidates(
    model: PackingModel,
    panels: Sequence[tuple[str, np.ndarray]],
    table: Rows,
    cells: Sequence[int],
    title: str,
) -> Figure:
    """Return the matplotlib figure; its axes are the panels, then the table's.

    All panels have the same window, and the same cell where its origin is free to choose.
    """
    from matplotlib.figure import Figure

    first = drawn_cell(model, panels[0][1], cells) if panels else None
    origin = first.origin if first is not None else None
    views = [drawn_cell(model, values, cells, origin) for _, values in panels]
    width, height = PANEL[0] * len(panels), PANEL[1][model.dimension] if panels else 0.0
    below = ROW * (len(table.rows) + 2)
    drawn = Figure(
        figsize=(max(width, LEAST_WIDTH), height + below + MARGINS), layout="constrained"
    )
    drawn.suptitle(as_written(title), fontsize=13, fontweight="bold")
    parts: Any = drawn.subfigures(2, 1, height_ratios=(height + 0.5, below))
    upper, lower = parts
    has_target = bool(panels) and panels[0][0] == TARGET
    _draw_panels(upper, [name for name, _ in panels], views, has_target)
    _draw_table(lower.add_subplot(), table)
    if views:
        dashed = has_target and model.dimension == 2
        add_legend(upper, views, "target" if dashed else "")
    return drawn


def _draw_panels(
    drawn: Figure, titles: Sequence[str], views: Sequence[DrawnCell], has_target: bool
) -> None:
    if not views:
        return
    grid = drawn.add_gridspec(1, len(views))
    plane = views[0].model.dimension == 2
    if plane:
        corners = [plane_window(view) for view in views]
        low, high = (np.array(side) for side in zip(*corners, strict=True))
        shared = low.min(axis=0), high.max(axis=0)
    else:
        sizes = [high - low for low, high in (window(view, oblique(view)) for view in views)]
    for index, (title, view) in enumerate(zip(titles, views, strict=True)):
        axes = drawn.add_subplot(grid[0, index])
        if plane:
            draw_plane_cell(axes, view, views[0] if has_target and index else None, shared)
        else:
            draw_space_cell(axes, view, oblique(view), np.max(sizes, axis=0), FINE // 2)
        axes.set_title(title, fontsize=10)


def _draw_table(axes: Axes, table: Rows) -> None:
    """Text at even distances, the target's row in bold."""
    axes.set_axis_off()
    count = len(table.titles)
    ends = np.cumsum([FIRST_COLUMN, *([1.0] * (count - 1))]) / (count - 1 + FIRST_COLUMN)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(len(table.rows) + 0.5, -1.0)
    size = 9.0 if count <= 10 else 7.5
    for number, row in enumerate([table.titles, *table.rows]):
        bold = number == 0 or row[0] == TARGET
        for index, text in enumerate(row):
            axes.text(
                0.0 if index == 0 else ends[index] - 0.01,
                number - 0.5 if number else -0.6,
                text.replace(" ", "\n", 1) if text.count(" ") > 1 else text,
                ha="left" if index == 0 else "right",
                va="center",
                fontsize=size,
                fontweight="bold" if bold else "normal",
            )
    axes.axhline(0.0, color="#606060", linewidth=0.8)
