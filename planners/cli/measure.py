"""``measure``: how much of a scenario's C-space is free, and where it is narrow."""

from __future__ import annotations

from typing import Annotated

import typer

from planners.cli.outputs import print_json
from planners.cli.sources import say_notices
from planners.cli.terminal import result_console, stages, working

MOST_LINES = 1_000_000_000


def measure(
    scenario: Annotated[
        str,
        typer.Argument(metavar="SCENARIO", help="A YAML file, or the name of a bundled scenario."),
    ],
    seed: Annotated[int, typer.Option(metavar="N", help="Of the random lines.")] = 0,
    lines: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Sweep lines to look at. [dim]100000 without another limit.[/dim]"
        ),
    ] = None,
    time_limit: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="For the free space.")
    ] = None,
    half_width: Annotated[
        float | None,
        typer.Option(
            metavar="FRACTION", help="Stop when the fraction is known this well, to either side."
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the numbers as JSON, and nothing else.")
    ] = False,
) -> None:
    """Measure the free space of a scenario.

    Free volume and fraction of the configuration space come from the free intervals of sweep
    lines, with a 95 % confidence interval; beside them stand the bound in closed form and the
    narrowest openings.

    [dim]Examples:[/dim]

    ellipsoid-planning measure rabbit-3d-narrow

    ellipsoid-planning measure my.yaml --half-width 1e-4 --json
    """
    _check(seed, lines, time_limit, half_width)
    from ellipsoid_planning.cspace.free_fraction import Budget
    from ellipsoid_planning.measure import measure as measured
    from ellipsoid_planning.scenario import load_scenario

    problem = load_scenario(scenario)
    say_notices(problem)
    budget = Budget(lines, half_width, time_limit)
    with working(f"Loading {problem.name}"):
        problem.cspace()
    with stages(f"Measuring {problem.name}") as say:
        found = measured(problem, seed, budget, on_progress=say)
    if json:
        print_json(found.to_dict())
        return
    from planners.cli.measure_tables import measurement_tables

    for table in measurement_tables(found):
        result_console().print(table)


def _check(
    seed: int, lines: int | None, time_limit: float | None, half_width: float | None
) -> None:
    from ellipsoid_planning.errors import PlannerError
    from ellipsoid_planning.sizes import MOST_SECONDS

    if not 0 <= seed < 2**32:
        raise PlannerError(f"--seed: expected an integer in [0, 2**32), got {seed}")
    if lines is not None and not 1 <= lines <= MOST_LINES:
        raise PlannerError(
            f"--lines: expected a positive number of lines, at most {MOST_LINES}, got {lines}"
        )
    for option, value in (("--time-limit", time_limit), ("--half-width", half_width)):
        if value is not None and not 0.0 < value <= MOST_SECONDS:
            raise PlannerError(
                f"{option}: expected a positive number, at most {MOST_SECONDS:g}, got {value}"
            )
