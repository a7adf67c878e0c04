"""``figure``: a picture of the workspace, a layer, and the clearance along the path."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from planners.cli.outputs import check_outputs
from planners.cli.sources import load_source
from planners.cli.terminal import say, working


def figure(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SCENARIO|RESULT.json",
            help="A YAML file, the name of a bundled scenario, or a result of [bold]plan[/bold].",
        ),
    ],
    output: Annotated[
        Path, typer.Option(metavar="FILE.png", help="The picture; its suffix chooses the format.")
    ],
) -> None:
    """Draw a scenario or a planned path.

    [dim]Examples:[/dim]

    ellipsoid-planning figure rabbit-2d-open --output scenario.png

    ellipsoid-planning figure path.json --output path.svg
    """
    check_outputs(output=output)
    scenario, result = load_source(source)
    from planners.view import figures

    with working("Drawing the figure"):
        figures.figure(scenario if result is None else result, output)
    say(f"Wrote {output}")
