"""What a command is about: a scenario, by file or bundled name, or a result."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from planners.cli.terminal import say

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.scenario import Scenario

RESULT_SUFFIX = ".json"


def load_source(name: str) -> tuple[Scenario, PlanResult | None]:
    """The scenario that `name` stands for, and the result if it names a result file.

    Raises:
        ScenarioError: no such scenario, or something is wrong with it.
        ResultError: the same of a result.
    """
    from ellipsoid_planning.result import load_result
    from ellipsoid_planning.scenario import load_scenario

    if Path(name).suffix.lower() == RESULT_SUFFIX:
        result = load_result(name)
        return result.scenario, result
    scenario = load_scenario(name)
    say_notices(scenario)
    return scenario, None


def say_notices(scenario: Scenario) -> None:
    """Tell the user what of a scenario was taken for something else than it says."""
    for notice in scenario.notices:
        say(f"Note: {scenario.name}: {notice}")
