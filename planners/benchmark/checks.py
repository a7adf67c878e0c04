"""Numbers and scenarios of a campaign, checked before anything is run or written."""

from __future__ import annotations

from collections.abc import Sequence

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.sizes import MOST_SECONDS
from planners.benchmark.contenders import Contender
from planners.registry import checked_parameters, find_planner

LARGEST_SEED = 2**32
MOST_RUNS = 1_000_000
MOST_JOBS = 10_000
MOST_MEGABYTES = 1e9


def check_numbers(
    runs: int, time_limit: float, memory_limit: float, seed: int, jobs: int = 1
) -> None:
    """Check the numbers of a campaign; messages name the options of the command.

    Raises:
        PlannerError: one is out of its range.
    """
    for option, count, highest in (("--runs", runs, MOST_RUNS), ("--jobs", jobs, MOST_JOBS)):
        if not 1 <= count <= highest:
            raise PlannerError(
                f"{option}: expected a whole number of at least 1, at most {highest}, got {count}"
            )
    for option, value, unit, most in (
        ("--time-limit", time_limit, "seconds", MOST_SECONDS),
        ("--memory-limit", memory_limit, "MB", MOST_MEGABYTES),
    ):
        if not 0.0 < value <= most:
            raise PlannerError(
                f"{option}: expected a positive number of {unit}, at most {most:g}, got {value:g}"
            )
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
