"""The packed cell as a picture and as a page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from planners.cli.terminal import say, working

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel


def draw_cell(
    model: PackingModel,
    configuration: NDArray[np.float64],
    figure: Path | None,
    html: Path | None,
    title: str = "",
) -> None:
    """Write what is wished of one arrangement (K,).

    Raises:
        EllipsoidPlanningError: a file cannot be written.
    """
    if figure is not None:
        from planners.view.figures_crystal import picture_of_cell
        from planners.view.writing import write_whole

        with working("Drawing the figure"):
            picture = picture_of_cell(model, configuration, figure.suffix[1:].lower(), title=title)
        write_whole(figure, picture)
        say(f"Wrote {figure}")
    if html is not None:
        from planners.view.crystal_page import page_of_cell
        from planners.view.meshcat_page import write_page

        with working("Drawing the page"):
            page = page_of_cell(model, configuration, title=title)
        write_page(page, html)
        say(f"Wrote {html}")
