"""Numbers and scenarios of a campaign, checked before anything is run or written."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.scenario import Scenario
from planners.benchmark.contenders import Contender
from planners.registry import checked_parameters, find_planner

LARGEST_SEED = 2**32


def check_numbers(
    runs: int, time_limit: float, memory_limit: float, seed: int, jobs: int = 1
) -> None:
    """Check the numbers of a campaign; messages name the options of the command.

    Raises:
        PlannerError: one is out of its range.
    """
    for option, count in (("--runs", runs), ("--jobs", jobs)):
        if count < 1:
            raise PlannerError(f"{option}: expected a whole number of at least 1, got {count}")
    for option, value, unit in (
        ("--time-limit", time_limit, "seconds"),
        ("--memory-limit", memory_limit, "MB"),
    ):
        if not 0.0 < value < math.inf:
            raise PlannerError(f"{option}: expected a positive number of {unit}, got {value:g}")
    if not 0 <= seed <= LARGEST_SEED - runs:
        raise PlannerError(
            f"--seed: expected an integer from 0 to {LARGEST_SEED - runs}, one for each run "
            f"follows it, got {seed}"
        )


def check_scenario(scenario: Scenario, contenders: Sequence[Contender]) -> None:
    """Check start and goal, and what the scenario sets for a planner that takes part.

    Raises:
        ScenarioError: naming the place in the file.
        PlannerError: a parameter is unknown or of the wrong type.
    """
    from ellipsoid_planning.scenario_checks import check_endpoints

    own = dict(scenario.planner)
    name = own.pop("name", None)
    for planner in {contender.planner for contender in contenders}:
        entry = find_planner(planner)
        if entry.name != name:
            continue
        try:
            checked_parameters(entry, own)
        except PlannerError as error:
            raise scenario.origin.error(("planner",), str(error)) from None
    check_endpoints(scenario)
