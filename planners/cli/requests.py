"""A request from the words of the command line: one mistake, one message that says where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario
    from planners.registry import PlannerEntry
    from planners.request import Request


def checked_plan_request(
    source: str, planner: str | None, parameters: Mapping[str, Any], **others: Any
) -> Request:
    """The request of ``plan``, checked before anything is computed.

    Args:
        source: a scenario's file, or the name of a bundled one.
        planner: its name, or None for the scenario's own.
        parameters: those of ``--set``.
        others: of `planners.request.checked_request`.

    Raises:
        ScenarioError: the scenario is wrong; of its planner, the place in the file is named.
        PlannerError: an option is wrong.
        RoadmapError: no roadmap can be kept where ``roadmap`` says.
    """
    from ellipsoid_planning.errors import PlannerError
    from ellipsoid_planning.scenario import load_scenario
    from planners.registry import checked_parameters
    from planners.request import check_limits, checked_request, chosen_planner

    check_limits(others["time_limit"], others["seed"], option="--")
    scenario = load_scenario(source)
    if planner is None:
        _check_own_planner(scenario)
    entry, own = chosen_planner(scenario, planner)
    for name, value in own.items():
        _check_own_parameter(scenario, entry, name, value)
    try:
        checked_parameters(entry, parameters)
    except PlannerError as error:
        raise PlannerError(f"--set: {error}") from None
    return checked_request(scenario, planner, parameters=parameters, **others)


def _check_own_parameter(scenario: Scenario, entry: PlannerEntry, name: str, value: object) -> None:
    from ellipsoid_planning.errors import PlannerError
    from planners.registry import checked_parameters

    try:
        checked_parameters(entry, {name: value})
    except PlannerError as error:
        raise scenario.origin.error(("planner", name), str(error)) from None


def _check_own_planner(scenario: Scenario) -> None:
    from ellipsoid_planning.errors import PlannerError
    from planners.request import chosen_planner

    try:
        chosen_planner(scenario, None)
    except PlannerError as error:
        raise scenario.origin.error(("planner", "name"), str(error)) from None
