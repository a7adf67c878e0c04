"""``group``: calculations with space groups (thesis, appendix A)."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.outputs import check_outputs, print_json
from planners.cli.terminal import say, working

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup

YES, NO = 0, 1

Name = Annotated[
    str | None,
    typer.Argument(
        metavar="NAME",
        help="Symbol or number of a space group, such as P212121 or 19, or a plane group's symbol "
        "in small letters, such as p4.",
        show_default=False,
    ),
]
File = Annotated[
    Path | None,
    typer.Option(
        metavar="OPS.txt",
        help="Instead of NAME, a file with an operation (x,y,z) a line, the identity first; "
        "lines 'Coset 1' are skipped.",
    ),
]
Elements = Annotated[
    str,
    typer.Option(
        metavar="1,2,...", help="The elements' numbers, from 1, as 'group show' lists them."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")]
Csv = Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Also write a spreadsheet.")]

app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich")


@app.callback()
def _root() -> None:
    """Space groups: operations, tables, subgroups, cosets.

    Groups are taken modulo the translations of the conventional cell, so that they are finite;
    centring translations are elements of them.
    """


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def show(
    name: Name = None,
    file: File = None,
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="OPS.txt", help="Write the operations to a file that --file reads again."
        ),
    ] = None,
    csv: Csv = None,
    json: Json = False,
) -> None:
    """A group's operations, type and kind: symmorphic, Bieberbach, Sohncke, enantiomorphic.

    [dim]Examples:[/dim]

    ellipsoid-planning group show P212121

    ellipsoid-planning group show --file operations.txt --json
    """
    check_outputs(output=output, csv=csv)
    group = _group(name, file)
    from planners.cli import group_report, group_tables

    report = group_report.show(group)
    if output is not None:
        from ellipsoid_planning.crystal.symmetry.group_text import print_group
        from planners.view.writing import write_whole

        write_whole(output, print_group(group).encode())
        say(f"Wrote {output}")
    _write(csv, group_report.show_rows(group))
    _print(report, group_tables.show(report), json=json)


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def table(name: Name = None, file: File = None, csv: Csv = None, json: Json = False) -> None:
    """The multiplication table: row i, column j has the number of g_i o g_j, first g_j.

    The spreadsheet has the numbers only, as the thesis' has.

    [dim]Example:[/dim]

    ellipsoid-planning group table P4132 --csv table.csv
    """
    check_outputs(csv=csv)
    group = _group(name, file)
    from planners.cli import group_report, group_tables

    report = group_report.table(group)
    _write(csv, report["table"])
    _print(report, group_tables.table(report), json=json)


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def subgroups(name: Name = None, file: File = None, csv: Csv = None, json: Json = False) -> None:
    """All subgroups, their conjugacy classes, which are normal, generators and types.

    They are the subgroups that contain the translations of the group's cell. The types are found
    whatever the axes and the origin.

    [dim]Example:[/dim]

    ellipsoid-planning group subgroups P432 --json
    """
    check_outputs(csv=csv)
    group = _group(name, file)
    from planners.cli import group_report, group_tables

    with working(f"Searching the subgroups of {group.name}"):
        report = group_report.subgroups(group)
    _write(csv, group_report.subgroup_rows(report))
    _print(report, group_tables.subgroups(group.name, report), json=json)


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def is_subgroup(
    elements: Elements,
    name: Name = None,
    file: File = None,
    csv: Csv = None,
    json: Json = False,
) -> None:
    """Whether some elements are a subgroup; if not, a product of two that falls outside.

    The exit code is 0 for yes, 1 for no, 2 for bad input.

    [dim]Example:[/dim]

    ellipsoid-planning group is-subgroup P212121 --elements 1,2
    """
    check_outputs(csv=csv)
    group = _group(name, file)
    from planners.cli import group_report

    report = group_report.is_subgroup(group, _numbers(elements))
    _answer(report, "subgroup", csv, json=json)


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def is_normal(
    elements: Elements,
    name: Name = None,
    file: File = None,
    csv: Csv = None,
    json: Json = False,
) -> None:
    """Whether some elements are a normal subgroup; if not, a conjugate that falls outside.

    The exit code is 0 for yes, 1 for no, 2 for bad input.

    [dim]Example:[/dim]

    ellipsoid-planning group is-normal P4132 --elements 1,3
    """
    check_outputs(csv=csv)
    group = _group(name, file)
    from planners.cli import group_report

    report = group_report.is_normal(group, _numbers(elements))
    _answer(report, "normal", csv, json=json)


@app.command(context_settings={"help_option_names": ["-h", "--help"]})
def cosets(
    elements: Elements,
    name: Name = None,
    file: File = None,
    csv: Csv = None,
    json: Json = False,
) -> None:
    """The left and right cosets of a subgroup, and whether the two spaces agree.

    [dim]Example:[/dim]

    ellipsoid-planning group cosets P4132 --elements 1,3
    """
    check_outputs(csv=csv)
    group = _group(name, file)
    from planners.cli import group_report, group_tables

    report = group_report.cosets(group, _numbers(elements))
    _write(csv, group_report.coset_rows(report))
    _print(report, group_tables.cosets(report), json=json)


def _group(name: str | None, file: Path | None) -> SpaceGroup:
    from ellipsoid_planning.crystal.symmetry.catalogue import space_group
    from ellipsoid_planning.crystal.symmetry.group_text import space_group_from_text
    from ellipsoid_planning.errors import CrystalError

    if file is not None and name is None:
        return space_group_from_text(file)
    if name is None or file is not None:
        got = "neither" if name is None else f"both {name} and {file}"
        raise CrystalError(f"expected either a group's NAME or --file OPS.txt, got {got}")
    return space_group(name)


def _numbers(elements: str) -> list[int]:
    from ellipsoid_planning.errors import CrystalError

    try:
        return [int(piece) for piece in elements.split(",")]
    except ValueError:
        raise CrystalError(
            f"--elements {elements}: expected numbers separated by commas, such as 1,2"
        ) from None


def _write(csv: Path | None, rows: list[list[Any]]) -> None:
    if csv is None:
        return
    from ellipsoid_planning.csv_text import csv_text
    from planners.view.writing import write_whole

    write_whole(csv, csv_text(rows).encode())
    say(f"Wrote {csv}")


def _print(report: dict[str, Any], text: Any, *, json: bool) -> None:
    """The report as JSON, or a text or table for people."""
    if json:
        print_json(report)
        return
    if isinstance(text, str):
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
        return
    from planners.cli.terminal import result_console

    for part in text:
        result_console().print(part)


def _answer(report: dict[str, Any], key: str, csv: Path | None, *, json: bool) -> None:
    from planners.cli import group_report

    _write(csv, group_report.answer_rows(report))
    _print(report, report["message"], json=json)
    raise typer.Exit(YES if report[key] else NO)
