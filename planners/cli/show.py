"""``show``: a page with the scene, the roadmap, the path and the moving robot."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from planners.cli.outputs import check_outputs
from planners.cli.sources import load_source
from planners.cli.terminal import say, working


def show(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SCENARIO|RESULT.json",
            help="A YAML file, the name of a bundled scenario, or a result of [bold]plan[/bold].",
        ),
    ],
    html: Annotated[
        Path | None,
        typer.Option(metavar="FILE.html", help="Write one file that opens without a server."),
    ] = None,
    open_: Annotated[
        bool, typer.Option("--open", help="Open the page in a browser (the default).")
    ] = False,
) -> None:
    """Show a scenario or a planned path in 3-D.

    [dim]Examples:[/dim]

    ellipsoid-planning show rabbit-3d-open

    ellipsoid-planning show path.json --html path.html
    """
    check_outputs(html=html)
    scenario, result = load_source(source)
    from planners.cli.pages import scene_page
    from planners.view.meshcat_page import open_in_browser, write_page

    with working("Drawing the page"):
        page = scene_page(scenario, result)
    if html is not None and not open_:
        write_page(page, html)
        say(f"Wrote {html}")
    else:
        say(f"Wrote {open_in_browser(page, html)}")
