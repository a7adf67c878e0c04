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
) -> None:
    """Check a planned path again, independently of what planned it.

    Every motion is sampled densely and tested in plain numpy by support functions, and with
    FCL beside it; ends, bounds, arenas, clearance and all that the result states are checked.

    Exit 0 if everything holds, 1 if anything does not.
    """
    from ellipsoid_planning.errors import ContradictionError
    from ellipsoid_planning.result import load_result
    from planners.cli.tables import report_table
    from planners.verify import verify_result

    try:
        loaded = load_result(result)
    except ContradictionError as error:
        say(f"Not verified: {error}")
        raise typer.Exit(NO_PATH) from None
    with working(f"Verifying {result}"):
        report = verify_result(loaded)
    result_console().print(report_table(report))
    raise typer.Exit(SOLVED if report.passed else NO_PATH)
