"""``verify``: checks a result again, without the kernels that planned it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from planners.cli.command_group import NO_PATH, SOLVED
from planners.cli.terminal import result_console, say, working


def verify(
    result: Annotated[
        Path, typer.Argument(metavar="RESULT.json", help="What [bold]plan --output[/bold] wrote.")
    ],
    scenario: Annotated[
        str | None,
        typer.Option(
            metavar="SCENARIO",
            help="Judge the path against this scenario, a YAML file or a bundled one's name, "
            "instead of the one that the result carries.",
        ),
    ] = None,
) -> None:
    """Check a planned path again, independently of what planned it.

    Every motion is sampled and, between the samples, proved free by separating directions, all in
    plain numpy; FCL looks beside it. Ends, bounds, arenas, clearance and all that the result
    states are checked. A result carries its scenario, and whoever wrote the result wrote that,
    too: name your own with [bold]--scenario[/bold].

    Exit 0 if everything holds, 1 if anything does not or cannot be resolved.

    [dim]Examples:[/dim]

    ellipsoid-planning verify path.json

    ellipsoid-planning verify path.json --scenario rabbit-3d-open
    """
    from ellipsoid_planning.errors import ContradictionError
    from ellipsoid_planning.result import load_result
    from ellipsoid_planning.scenario import load_scenario
    from planners.cli.tables import report_table
    from planners.verify import verify_result

    given = None if scenario is None else load_scenario(scenario)
    try:
        loaded = load_result(result)
    except ContradictionError as error:
        say(f"Not verified: {error}")
        raise typer.Exit(NO_PATH) from None
    with working(f"Verifying {result}"):
        report = verify_result(loaded, given)
    result_console().print(report_table(report))
    raise typer.Exit(SOLVED if report.passed else NO_PATH)
