"""A page in the browser, from Python: for notebooks and scripts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import ResultError
from ellipsoid_planning.result import PathResult, PlanResult
from planners.view.meshcat_page import open_in_browser, scene_html, write_page

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import ArrayLike

    from ellipsoid_planning.scenario import Scenario


def show(
    source: Scenario | PlanResult,
    path: ArrayLike | None = None,
    output: str | Path | None = None,
) -> Path:
    """Show a scenario, and the robot moving along a path, in 3-D.

    >>> from ellipsoid_planning.scenario import load_scenario
    >>> from planners.view.show import show
    >>> scenario = load_scenario("rabbit-2d-open")
    >>> show(scenario)                                                # doctest: +SKIP
    >>> show(scenario, [scenario.start, scenario.goal], "page.html")  # doctest: +SKIP
    PosixPath('page.html')

    Args:
        source: a scenario, or a planner's result with its path.
        path: configurations (m, d) to show instead; collisions do not matter, the page says
            whether every motion is proved free.
        output: where to write the page; without it, it opens in a browser.

    Returns:
        The page's file.

    Raises:
        EllipsoidPlanningError: if the path does not fit the robot or the page cannot be written.
    """
    scenario = source.scenario if isinstance(source, PlanResult) else source
    result = source if isinstance(source, PlanResult) else None
    if path is not None:
        result = _result(scenario, path)
    page = scene_html(scenario, result)
    return open_in_browser(page) if output is None else write_page(page, output)


def _result(scenario: Scenario, path: ArrayLike) -> PlanResult:
    """A path as if planned, with what can be proved about it."""
    corners = np.array(path, dtype=float)
    size = scenario.robot.configuration_size
    if corners.ndim != 2 or corners.shape[1] != size or len(corners) == 0:
        raise ResultError(f"expected a path (m, {size}), got an array of shape {corners.shape}")
    cspace = scenario.cspace()
    # A path of one configuration is a motion to itself.
    firsts, lasts = corners[: max(len(corners) - 1, 1)], corners[-max(len(corners) - 1, 1) :]
    certified = bool(np.all(cspace.are_motions_valid(firsts, lasts)))
    least = min(cspace.motion_clearance(*motion) for motion in zip(firsts, lasts, strict=True))
    proved = PathResult.from_configurations(
        scenario.robot, corners, min_clearance=max(least, 0.0), certified=certified
    )
    return PlanResult(scenario, "given", "solved", path=proved)
