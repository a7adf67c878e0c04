"""Pictures of a packed cell (thesis figs. 2.3, 3.10, 3.11 and 3.16)."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import crystal_colours as palette
from planners.view.crystal_cell import DrawnCell, drawn_cell
from planners.view.crystal_plane import draw_plane_cell, plane_window
from planners.view.crystal_space import FINE, along, draw_space_cell, oblique, window
from planners.view.figures import DOTS_PER_INCH
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from ellipsoid_planning.crystal.packing.model import PackingModel

PLANE_WIDTH = 7.0  # [inches]
PLANE_HEIGHTS = (3.5, 10.0)  # the least and the most
SPACE_SIZE = (10.5, 8.0)
MOST_IN_LEGEND = 16  # operations
LETTER_WIDTH = 0.07  # in the legend [inches]


def picture_of_cell(
    model: PackingModel,
    configuration: ArrayLike,
    suffix: str,
    cells: Sequence[int] | None = None,
    title: str = "",
) -> bytes:
    """Draw the copies of a molecule in one cell or several, as a picture's bytes.

    Args:
        model: the molecule and its crystal.
        configuration: (K,), angles [rad].
        suffix: the picture's format, such as png.
        cells: (n,), how many cells along each axis; by default 3 x 3 in the plane, one in space.
        title: the model's name by default.

    Raises:
        CrystalError: if the configuration or the cells do not fit the model.
    """
    return saved(draw_cell(drawn_cell(model, configuration, cells), title), suffix)


def saved(drawn: Figure, suffix: str) -> bytes:
    """A figure as the bytes of a picture file."""
    content = io.BytesIO()
    drawn.savefig(content, format=suffix, dpi=DOTS_PER_INCH)
    return content.getvalue()


def draw_cell(cell: DrawnCell, title: str = "") -> Figure:
    """Return the matplotlib figure; in space one view from a corner and one along each axis."""
    from matplotlib.figure import Figure

    plane = cell.model.dimension == 2
    drawn = Figure(figsize=_plane_size(cell) if plane else SPACE_SIZE, layout="constrained")
    drawn.suptitle(as_written(title or cell.model.name), fontsize=13, fontweight="bold")
    if plane:
        axes = drawn.add_subplot()
        draw_plane_cell(axes, cell)
        axes.set_title(cell.headline(), fontsize=10)
    else:
        _draw_views(drawn, cell)
    add_legend(drawn, [cell])
    return drawn


def _plane_size(cell: DrawnCell) -> tuple[float, float]:
    """As high as the cells need at the whole width, with the words above and below."""
    low, high = plane_window(cell)
    up = PLANE_WIDTH * float((high - low)[1] / (high - low)[0])
    return PLANE_WIDTH, float(np.clip(up + 1.2, *PLANE_HEIGHTS))


def _draw_views(drawn: Figure, cell: DrawnCell) -> None:
    grid = drawn.add_gridspec(3, 2, width_ratios=(2.6, 1.0))
    main = drawn.add_subplot(grid[:, 0])
    draw_space_cell(main, cell, oblique(cell))
    main.set_title(cell.headline(), fontsize=10)
    cameras = [along(cell, axis) for axis in range(3)]
    # One scale for all three.
    size = np.max([high - low for low, high in (window(cell, c) for c in cameras)], axis=0)
    for axis, camera in enumerate(cameras):
        panel = drawn.add_subplot(grid[axis, 1])
        draw_space_cell(panel, cell, camera, size, FINE // 3)
        panel.set_title(f"along {'abc'[axis]}", fontsize=10)


def add_legend(drawn: Any, cells: Sequence[DrawnCell], other: str = "") -> None:
    """Name the operations, the shades and the yellow below the panels.

    Args:
        drawn: the figure, or the part of one.
        cells: what is in it, of one model.
        other: what the dashed outlines are, if there are any.
    """
    handles = _operation_handles(cells[0])
    if max(cells[0].counts) > 1:
        handles.append(_swatch("#d9d9d9", "neighbouring cells: paler"))
    if any(cell.overlaps for cell in cells):
        handles.append(_swatch(palette.OVERLAP, "overlap", palette.OVERLAP_EDGE))
    if other:
        from matplotlib.lines import Line2D

        handles.append(Line2D([], [], color="black", linestyle="--", linewidth=1.2, label=other))
    widest = max(len(handle.get_label()) for handle in handles)
    columns = int(drawn.bbox.width / drawn.dpi / (0.9 + LETTER_WIDTH * widest))
    drawn.legend(
        handles=handles,
        loc="outside lower center",
        ncols=min(len(handles), max(columns, 1)),
        fontsize=9,
        frameon=False,
    )


def _operation_handles(cell: DrawnCell) -> list[Any]:
    named = list(zip(cell.hues, cell.operations, strict=True))
    if len(named) == 1:
        return [_swatch(named[0][0], "the molecule", "black")]
    handles = [_swatch(hue, triplet) for hue, triplet in named[:MOST_IN_LEGEND]]
    rest = len(named) - MOST_IN_LEGEND
    return [*handles, _swatch("none", f"and {rest} more operations")] if rest > 0 else handles


def _swatch(colour: str, label: str, edge: str = "none") -> Any:
    from matplotlib.patches import Patch

    return Patch(facecolor=colour, edgecolor=edge, label=label)
