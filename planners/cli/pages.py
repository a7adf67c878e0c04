"""The page of a scenario or a result, with a roadmap to switch on."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.roadmap.graph import RoadmapGraph
    from ellipsoid_planning.scenario import Scenario

LONGEST_EXPLORATION = 2.0
"""Time for exploring the roadmap that a page shows [s]; milliseconds mostly suffice."""


def scene_page(scenario: Scenario, result: PlanResult | None) -> str:
    """The HTML text of a page with the scenario, and the result's path if there is one.

    With a result, the roadmap is what HighwayRoadmap explores between start and goal, whoever
    planned; without one, the start's layer of the whole roadmap, less its redundant nodes.
    A robot on a fixed base, which does not translate, has no roadmap.
    """
    from planners.view.meshcat_page import scene_html

    roadmap = None
    if scenario.robot.base_size:
        roadmap = _start_layer(scenario) if result is None else _explored_roadmap(scenario)
    return scene_html(scenario, result, roadmap)


def _start_layer(scenario: Scenario) -> RoadmapGraph | None:
    from ellipsoid_planning.roadmap.eager import eager_roadmap
    from ellipsoid_planning.roadmap.prune import without_redundant_nodes

    cspace = scenario.cspace()
    graph = without_redundant_nodes(eager_roadmap(cspace, scenario.start), cspace)
    return graph if len(graph.edges) else None


def _explored_roadmap(scenario: Scenario) -> RoadmapGraph | None:
    from ellipsoid_planning.roadmap.graph import explored_graph
    from ellipsoid_planning.roadmap.highway import HighwayRoadmap
    from ellipsoid_planning.roadmap.parameters import RoadmapParameters
    from planners.registry import checked_parameters, find_planner

    cspace = scenario.cspace()
    if not (cspace.is_valid(scenario.start) and cspace.is_valid(scenario.goal)):
        return None
    own = dict(scenario.planner)
    parameters = {}
    if own.pop("name", HighwayRoadmap.__name__) == HighwayRoadmap.__name__:
        parameters = checked_parameters(find_planner(HighwayRoadmap.__name__), own)
    roadmap = HighwayRoadmap(cspace, RoadmapParameters(**{**parameters, "anytime": False}))
    end = time.monotonic() + LONGEST_EXPLORATION
    roadmap.solve(scenario.start[None], scenario.goal[None], lambda: time.monotonic() > end)
    graph = explored_graph(roadmap)
    return graph if len(graph.edges) else None
