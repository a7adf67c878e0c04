"""The page of a scenario or a result, with a roadmap to switch on."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.scenario import Scenario


def scene_page(scenario: Scenario, result: PlanResult | None) -> str:
    """The HTML text of a page with the scenario, and the result's path if there is one."""
    from planners.view.meshcat_page import scene_html

    return scene_html(scenario, result)
