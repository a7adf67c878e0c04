"""``crystal``: molecules of ellipsoids packed in crystals, and phasing by them."""

from __future__ import annotations

import typer

from planners.cli.crystal_fit import fit
from planners.cli.crystal_models import models
from planners.cli.crystal_pack import pack
from planners.cli.crystal_phase import phase
from planners.cli.crystal_schema import schema
from planners.cli.crystal_show import show

app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")


@app.callback(
    epilog="Exit codes: 0 found, 1 not found, 2 bad input, 130 interrupted. "
    "Results go to stdout, everything else to stderr."
)
def _root() -> None:
    """Crystals: pack molecules of ellipsoids, and find arrangements by their diffraction.

    Get going:

    [bold]ellipsoid-planning crystal models[/bold]  (what there is to pack)

    [bold]ellipsoid-planning crystal show rabbit-p1 --html cell.html[/bold]

    [bold]ellipsoid-planning crystal pack rabbit-p1 --json[/bold]

    [bold]ellipsoid-planning crystal phase rabbit-p1 --target rabbit-p1-target[/bold]
    """


for command in (models, show, pack, phase, fit, schema):
    app.command(context_settings={"help_option_names": ["-h", "--help"]})(command)
