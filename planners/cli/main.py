"""The command `ellipsoid-planning`."""

from __future__ import annotations

import shlex
import sys
from typing import Annotated

import typer

from ellipsoid_planning import __version__
from planners.cli.benchmark import benchmark
from planners.cli.command_group import CommandGroup
from planners.cli.crystal import app as crystal
from planners.cli.family import family
from planners.cli.faults import DEBUG, leave
from planners.cli.figure import figure
from planners.cli.group import app as group
from planners.cli.import_urdf import urdf
from planners.cli.interrupt import end_on_interrupt
from planners.cli.joints import joints
from planners.cli.measure import measure
from planners.cli.minkowski import minkowski
from planners.cli.plan import plan
from planners.cli.rotations import rotations
from planners.cli.scenarios import scenarios
from planners.cli.schema import schema
from planners.cli.show import show
from planners.cli.streams import prepare_streams
from planners.cli.verify import verify

PROGRAM = "ellipsoid-planning"

app = typer.Typer(
    cls=CommandGroup,
    name=PROGRAM,
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"{PROGRAM} {__version__}")
        raise typer.Exit


@app.callback(
    epilog=(
        "Exit codes: 0 done, solved, verified; 1 no path within the limit, not verified; "
        "2 bad input; 70 a fault of this program; 71 out of memory; 130 interrupted, "
        "143 terminated. Results go to stdout, everything else to stderr."
    )
)
def _root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
    debug: Annotated[
        bool, typer.Option(DEBUG, help="Show tracebacks of errors; allowed after the command, too.")
    ] = False,
) -> None:
    """Plan collision-free paths for robots made of ellipsoids, and prove them.

    Get going:

    [bold]ellipsoid-planning scenarios[/bold]  (what there is to plan)

    [bold]ellipsoid-planning plan rabbit-3d-open --output path.json --html path.html[/bold]

    [bold]ellipsoid-planning verify path.json[/bold]
    """


for command in (
    plan,
    show,
    figure,
    scenarios,
    joints,
    family,
    measure,
    minkowski,
    rotations,
    verify,
    benchmark,
    schema,
):
    app.command(context_settings={"help_option_names": ["-h", "--help"]})(command)

imports = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")
imports.command(context_settings={"help_option_names": ["-h", "--help"]})(urdf)


@imports.callback()
def _imports() -> None:
    """Bring robots in from other descriptions."""


app.add_typer(imports, name="import")
app.add_typer(group, name="group")
app.add_typer(crystal, name="crystal")


def main() -> None:
    """Run the command line; the process ends with the exit code."""
    prepare_streams()
    end_on_interrupt()
    try:
        app(prog_name=PROGRAM)
    except Exception as error:  # noqa: BLE001  whatever it is, it must not look like "no path"
        leave(error, shlex.join([PROGRAM, *sys.argv[1:]]))


if __name__ == "__main__":
    main()
