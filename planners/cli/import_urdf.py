"""``import urdf``: robots of ellipsoids from robot descriptions."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from planners.cli.outputs import check_outputs
from planners.cli.terminal import result_console, say, working

if TYPE_CHECKING:
    from rich.table import Table

    from planners.importing import ImportedRobot


def urdf(
    file: Annotated[Path, typer.Argument(metavar="FILE.urdf", help="The robot's description.")],
    mesh_dir: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Where meshes are, or the packages of package:// names; the URDF's own folder "
            "is looked at too.",
        ),
    ] = None,
    parts: Annotated[
        int, typer.Option(metavar="N", min=1, help="How many ellipsoids a link gets at most.")
    ] = 1,
    base: Annotated[
        str, typer.Option(metavar="fixed|translating|free", help="How the robot's base moves.")
    ] = "fixed",
    mimic: Annotated[
        str,
        typer.Option(
            metavar="independent|fixed",
            help="Joints that mimic others: let them move by themselves, or fix them where the "
            "joint that they mimic is at 0.",
        ),
    ] = "independent",
    output: Annotated[
        Path | None, typer.Option(metavar="FILE.yaml", help="The robot, to go into a scenario.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the report as JSON in place of tables.")
    ] = False,
) -> None:
    """Enclose a URDF's collision geometry in ellipsoids, and carry its joints over.

    The ellipsoids have the minimum volume, and contain all of it; the report tells how much
    larger than the convex hulls they are. What is written is the entry robot of a scenario, to
    stdout without --output; the report then goes to stderr.

    [dim]Examples:[/dim]

    ellipsoid-planning import urdf arm.urdf --output robot.yaml

    ellipsoid-planning import urdf arm.urdf --mesh-dir packages --parts 3 --output robot.yaml
    """
    check_outputs(output=output)
    from planners.importing import import_urdf

    with working(f"Importing {file}"):
        imported = import_urdf(file, mesh_dir=mesh_dir, parts=parts, base=base, mimic=mimic)
    _warn(imported)
    if output is not None:
        _write(imported, output)
    if as_json:
        sys.stdout.write(json.dumps(_report(imported, whole=output is None), indent=2) + "\n")
    elif output is not None:
        for table in _tables(imported):
            result_console().print(table)
    else:
        _print(imported)


def _warn(imported: ImportedRobot) -> None:
    """Say what is not as in the description."""
    for joint in imported.joints:
        if joint.changed:
            say(f"Joint {joint.name!r} ({joint.type}) {joint.fate}.")
    dropped = sorted({name for joint in imported.joints for name in joint.dropped})
    if dropped:
        say(f"Plans do not heed what the URDF says of joints' {', '.join(dropped)}: left out.")
    for first, second in imported.ignored:
        say(f"Links {first!r} and {second!r} always touch: their self-collision is ignored.")
    for first, second in imported.touching:
        say(
            f"Links {first!r} and {second!r} touch when all joints are at 0; more --parts may help."
        )


def _write(imported: ImportedRobot, output: Path) -> None:
    from ellipsoid_planning import atomic
    from ellipsoid_planning.errors import EllipsoidPlanningError
    from ellipsoid_planning.scenario_yaml import document_text

    try:
        atomic.write_text(output, document_text(imported.document()))
    except OSError as error:
        raise EllipsoidPlanningError(f"{output}: cannot write the file: {error.strerror}") from None
    say(f"Wrote {output}")


def _report(imported: ImportedRobot, *, whole: bool) -> dict[str, object]:
    """The report, with the robot itself if it goes nowhere else."""
    return {**imported.to_dict(), **(imported.document() if whole else {})}


def _print(imported: ImportedRobot) -> None:
    from rich.console import Console

    from ellipsoid_planning.scenario_yaml import document_text

    for table in _tables(imported):
        Console(stderr=True, emoji=False).print(table)
    sys.stdout.write(document_text(imported.document()))


def _tables(imported: ImportedRobot) -> tuple[Table, Table]:
    from rich.markup import escape
    from rich.table import Table

    links = Table(title=escape(imported.name), title_justify="left")
    links.add_column("link", style="bold", overflow="fold")
    for column in ("shapes", "vertices inside", "ellipsoids", "volume / hull's"):
        links.add_column(column, justify="right")
    for link in imported.links:
        counts = str(link.solids), str(link.vertices), str(link.parts)
        links.add_row(escape(link.name), *counts, _ratio(link.excess, flat=link.solids > 0))
    links.add_section()
    links.add_row("all", *_totals(imported), _ratio(imported.excess, flat=True))
    joints = Table()
    for column in ("joint", "type", ""):
        joints.add_column(column, overflow="fold")
    for joint in imported.joints:
        colour = "yellow" if joint.changed else "green"
        fate = f"[{colour}]{escape(joint.fate)}[/{colour}]"
        joints.add_row(escape(joint.name), escape(joint.type), fate)
    return links, joints


def _totals(imported: ImportedRobot) -> tuple[str, str, str]:
    links = imported.links
    return (
        str(sum(link.solids for link in links)),
        str(sum(link.vertices for link in links)),
        str(sum(link.parts for link in links)),
    )


def _ratio(excess: float | None, *, flat: bool) -> str:
    if excess is None:
        return "flat" if flat else ""
    return f"{excess:.3f}"
