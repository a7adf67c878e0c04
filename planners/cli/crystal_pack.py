"""``crystal pack``: the arrangements of a molecule in its crystal that keep all copies apart."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.crystal_candidates import (
    Candidates,
    Choice,
    Chosen,
    Method,
    Spread,
    Starts,
    StepDeg,
    by_grid,
    by_potential,
)
from planners.cli.crystal_runs import (
    Cluster,
    Figure,
    Html,
    Jobs,
    Json,
    Model,
    Run,
    Workplace,
    session,
)
from planners.cli.outputs import check_outputs, print_json
from planners.cli.terminal import result_console, say

if TYPE_CHECKING:
    from rich.table import Table

    from ellipsoid_planning.crystal.packing.model import PackingModel

FOUND, NOTHING_FREE = 0, 1


def pack(
    model: Model,
    method: Chosen = Method.grid,
    list_: Annotated[
        int, typer.Option("--list", metavar="N", min=0, help="Also print the first N of them.")
    ] = 0,
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json|.csv",
            help="Write the result with all free arrangements; a CSV has the arrangements alone.",
        ),
    ] = None,
    run: Run = None,
    jobs: Jobs = None,
    cluster: Cluster = None,
    spread: Spread = None,
    step_deg: StepDeg = None,
    starts: Starts = None,
    json: Json = False,
    figure: Figure = None,
    html: Html = None,
) -> None:
    """Find the arrangements of a molecule in its crystal in which no two copies overlap.

    The JSON result has [bold]configurations[/bold] and [bold]free[/bold] (how many were looked
    at, and are free), model, group, method, keys (the coordinates' names), fingerprint (of the
    model), time (search and total, in seconds, of this session), version, and, with --list or
    --output, arrangements: number (in the grid) and configuration (by key, angles in degrees; as
    in a target's file); by potential also its value, smallest first. Free is proved: no two copies
    reach deeper into each other than the model allows (packing.overlap, search.slack; 0 without).

    [dim]Exit codes: 0 some are free, 1 none is, 2 bad input, 130 interrupted.[/dim]

    [dim]Examples:[/dim]

    ellipsoid-planning crystal pack rabbit-p1 --json

    ellipsoid-planning crystal pack rabbit-p212121 --run p212121 --output free.csv

    ellipsoid-planning crystal pack rabbit-plane --method potential --list 5 --figure plane.png

    ellipsoid-planning crystal pack MODEL.yaml --run big --cluster tcp://10.0.0.5:8786
    """
    from ellipsoid_planning.crystal.packing.model import load_model
    from ellipsoid_planning.crystal.phasing.run_store import run_settings
    from planners.cli.crystal_output import arrangements, save_arrangements

    check_outputs(output=output, figure=figure, html=html)
    _check_suffixes(output, figure)
    began = time.perf_counter()
    choice = Choice(method, spread, step_deg, starts)
    loaded = load_model(model)
    search = choice.search(loaded)
    with session(
        Workplace(run, cluster, jobs),
        lambda: run_settings(loaded, "pack", **choice.settings(loaded)),
    ) as working:
        found = by_grid(loaded, working) if search is None else by_potential(search, working)
    result = _result(loaded, method, found, time.perf_counter() - began)
    listed = min(list_, len(found))
    if output is not None:
        every = slice(0, len(found))
        save_arrangements(result, loaded, found.columns(every), found.configurations(every), output)
    first = slice(0, listed)
    if listed:
        shown = found.columns(first), found.configurations(first)
        result["arrangements"] = arrangements(loaded, *shown)
    _draw(loaded, found, figure, html)
    if json:
        print_json(result)
    else:
        result_console().print(_table(loaded, result))
    raise typer.Exit(FOUND if len(found) else NOTHING_FREE)


def _check_suffixes(output: Path | None, figure: Path | None) -> None:
    from ellipsoid_planning.errors import EllipsoidPlanningError
    from planners.cli.crystal_output import ARRANGEMENT_SUFFIXES

    if output is not None and output.suffix.lower() not in ARRANGEMENT_SUFFIXES:
        raise EllipsoidPlanningError(
            f"--output {output}: unknown format {output.suffix!r}; expected "
            + " or ".join(ARRANGEMENT_SUFFIXES)
        )
    if figure is not None:
        from planners.view.figures import check_format

        check_format(figure)


def _result(
    model: PackingModel, method: Method, found: Candidates, seconds: float
) -> dict[str, Any]:
    from ellipsoid_planning import __version__
    from ellipsoid_planning.crystal.packing.fingerprint import fingerprint

    return {
        "model": model.name,
        "group": model.group.name,
        "method": method.value,
        "configurations": found.looked_at,
        "free": len(found),
        "keys": list(model.keys),
        "fingerprint": fingerprint(model),
        "time": {"search": round(found.seconds, 4), "total": round(seconds, 4)},
        "version": __version__,
    }


def _draw(model: PackingModel, found: Candidates, figure: Path | None, html: Path | None) -> None:
    """The first candidate: of a grid the one in the middle, which is more telling."""
    if figure is None and html is None:
        return
    if not len(found):
        say("Nothing is free, so nothing is drawn.")
        return
    from planners.cli.crystal_drawing import draw_cell

    shown = found.shown
    draw_cell(model, found.configurations(slice(shown, shown + 1))[0], figure, html)


def _table(model: PackingModel, result: dict[str, Any]) -> Table:
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=escape(model.name), title_justify="left", show_header=False)
    table.add_column(style="bold")
    table.add_column(justify="right", overflow="fold")
    table.add_row("group", escape(model.group.name))
    table.add_row("configurations", f"{result['configurations']:,}")
    table.add_row("free", f"{result['free']:,}")
    table.add_row("time", f"{result['time']['search']:.3f} s")
    for entry in result.get("arrangements", ()):
        values = entry["configuration"].items()
        shown = ", ".join(f"{key} {value:.4g}" for key, value in values)
        table.add_row(f"number {entry['number']}", escape(shown))
    return table
