"""One figure of a scenario or of a planned path, drawn by matplotlib without a screen."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.scenario import Scenario
from planners.view import figures_plane, figures_space
from planners.view.clearance_along import distances_along
from planners.view.figures_clearance import draw_clearance
from planners.view.figures_joints import draw_joint_slice
from planners.view.figures_layer import draw_layer
from planners.view.joint_slice import JointSlice
from planners.view.layer_slice import LayerSlice
from planners.view.plain_text import as_written
from planners.view.trajectory import Trajectory, follow
from planners.view.writing import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.result import PlanResult

DOTS_PER_INCH = 130
WIDTH = 11.0  # of a figure [inches]
DISTANCE_HEIGHT = 2.1
JOINTS_HEIGHT = 5.5
TITLE_LINE = 0.25  # one more over a layer, for the joints


def figure(source: Scenario | PlanResult, output: str | Path) -> Path:
    """Draw a scenario or a result and write the picture; the suffix chooses the format.

    A scenario, or a result without a path, shows the workspace and the start's layer; a path
    adds the swept robot, the distance along the path, and the layer of its narrowest place.
    Where the robot's base is fixed there are no layers, and two of its joints are shown instead.

    Raises:
        EllipsoidPlanningError: if the format is unknown or the file cannot be written.
    """
    check_format(Path(output))
    drawn = draw(source)
    content = io.BytesIO()
    drawn.savefig(content, format=Path(output).suffix[1:].lower(), dpi=DOTS_PER_INCH)
    return write_whole(output, content.getvalue())


def draw(source: Scenario | PlanResult) -> Figure:
    """Return the matplotlib figure of a scenario or a result.

    Its axes are, in this order: workspace, layer or joints, and, with a path, the distance.
    """
    scenario = source if isinstance(source, Scenario) else source.scenario
    path = None if isinstance(source, Scenario) else source.path
    cspace = scenario.cspace()
    if path is None:
        corners = np.array([scenario.start, scenario.goal])
        view = _view(scenario, cspace, scenario.start, corners)
        drawn, panels = _blank(scenario, [_panel_height(view)])
        _draw_panels(panels, scenario, None, view, "start")
        return drawn
    trajectory = follow(cspace, path.configurations)
    along = distances_along(scenario, trajectory)
    narrowest = trajectory.configurations[int(np.argmin(along.moving))]
    view = _view(scenario, cspace, narrowest, trajectory.configurations)
    drawn, panels = _blank(scenario, [_panel_height(view), DISTANCE_HEIGHT])
    _draw_panels(panels, scenario, trajectory, view, "narrowest place")
    required, proved = cspace.clearance_required, path.min_clearance if path.certified else None
    draw_clearance(panels[2], along, required, proved)
    return drawn


def _view(
    scenario: Scenario,
    cspace: CSpace,
    configuration: NDArray[np.float64],
    path: NDArray[np.float64],
) -> LayerSlice | JointSlice:
    """What the second panel shows of the configuration space."""
    from ellipsoid_planning.cspace.articulated import ArticulatedCSpace

    if isinstance(cspace, ArticulatedCSpace) and cspace.articulated.base_size == 0:
        return JointSlice(cspace, configuration, path)
    return LayerSlice(cspace, configuration, _across(scenario))


def _blank(scenario: Scenario, heights: list[float]) -> tuple[Figure, list[Axes]]:
    """Return a figure with two panels and, for a second height [inches], a wide one below."""
    from matplotlib.figure import Figure

    drawn = Figure(figsize=(WIDTH, sum(heights)), layout="constrained")
    drawn.suptitle(as_written(scenario.name), fontsize=13, fontweight="bold")
    grid = drawn.add_gridspec(len(heights), 2, height_ratios=heights)
    panels = [drawn.add_subplot(grid[0, 0]), drawn.add_subplot(grid[0, 1])]
    if len(heights) > 1:
        panels.append(drawn.add_subplot(grid[1, :]))
    return drawn, panels


def _draw_panels(
    panels: list[Axes],
    scenario: Scenario,
    trajectory: Trajectory | None,
    view: LayerSlice | JointSlice,
    marked: str,
) -> None:
    workspace = figures_plane if scenario.dimension == 2 else figures_space
    workspace.draw_workspace(panels[0], scenario, trajectory)
    if isinstance(view, JointSlice):
        draw_joint_slice(panels[1], view, marked)
    else:
        draw_layer(panels[1], view, marked)


def _across(scenario: Scenario) -> int:
    """Return the horizontal axis, 0 or 1, along which the robot has farther to go."""
    way = np.abs(scenario.goal[:2] - scenario.start[:2])
    return 1 if scenario.dimension == 3 and way[1] > way[0] else 0


def _panel_height(view: LayerSlice | JointSlice) -> float:
    """Return the height [inches] at which the layer fills its half of the figure's width."""
    if isinstance(view, JointSlice):
        return JOINTS_HEIGHT
    across, up = np.ptp(view.bounds, axis=0)
    title = TITLE_LINE if view.cspace.robot.joints else 0.0
    return float(np.clip(0.44 * WIDTH * up / across + 1.6, 3.8, 6.6)) + title


def check_format(output: Path) -> None:
    """Raise EllipsoidPlanningError unless matplotlib can write the format of a file's suffix."""
    from matplotlib.backend_bases import FigureCanvasBase

    known = FigureCanvasBase.get_supported_filetypes()
    if output.suffix.removeprefix(".").lower() not in known:
        raise EllipsoidPlanningError(
            f"{output}: unknown picture format {output.suffix!r}; "
            f"expected one of {', '.join('.' + name for name in sorted(known))}"
        )
