"""``crystal pack``: the arrangements of a molecule in its crystal that keep all copies apart."""

from __future__ import annotations

import time
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.crystal_runs import Cluster, Figure, Html, Jobs, Json, Model, Run, Workplace
from planners.cli.outputs import check_outputs
from planners.cli.terminal import result_console, say

if TYPE_CHECKING:
    from rich.table import Table

    from ellipsoid_planning.crystal.model import PackingModel
    from planners.cli.crystal_candidates import Candidates

FOUND, NOTHING_FREE = 0, 1


class Method(str, Enum):
    """How candidates are found."""

    grid = "grid"
    potential = "potential"


def pack(
    model: Model,
    method: Annotated[
        Method,
        typer.Option(
            help="grid: which arrangements of the model's grid are free. potential: where a "
            "potential of Gaussians is smallest in each cell of the grid, if that is free."
        ),
    ] = Method.grid,
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
    spread: Annotated[
        float | None,
        typer.Option(
            metavar="M_B", help="Of the potential: m_b, the larger, the narrower; 0.2 without it."
        ),
    ] = None,
    step_deg: Annotated[
        float | None,
        typer.Option(
            metavar="D", help="Of the potential: width of the cells, instead of the grid's steps."
        ),
    ] = None,
    starts: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Of the potential: starts of the minimisation in each cell; one."
        ),
    ] = None,
    json: Json = False,
    figure: Figure = None,
    html: Html = None,
) -> None:
    """Find the arrangements of a molecule in its crystal in which no two copies overlap.

    The JSON result has [bold]configurations[/bold] and [bold]free[/bold] (how many were looked
    at, and are free), model, group, method, keys (the coordinates' names), fingerprint (of the
    model), time (search and total, in seconds, of this session), version, and, with --list or
    --output, arrangements: number (in the grid) and configuration (by key, angles in degrees; as
    in a target's file); by potential also its value, smallest first. All free arrangements are
    proved free.

    [dim]Exit codes: 0 some are free, 1 none is, 2 bad input, 130 interrupted.[/dim]

    [dim]Examples:[/dim]

    ellipsoid-planning crystal pack rabbit-p1 --json

    ellipsoid-planning crystal pack rabbit-p212121 --run p212121 --output free.csv

    ellipsoid-planning crystal pack rabbit-plane --method potential --list 5 --figure plane.png

    ellipsoid-planning crystal pack MODEL.yaml --run big --cluster tcp://10.0.0.5:8786
    """
    from ellipsoid_planning.crystal.model import load_model
    from planners.cli.crystal_output import arrangements, print_json, save_arrangements

    check_outputs(output=output, figure=figure, html=html)
    _check_suffixes(output, figure)
    began = time.perf_counter()
    loaded = load_model(model)
    found = _candidates(loaded, method, (spread, step_deg, starts), Workplace(run, cluster, jobs))
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


def _candidates(
    model: PackingModel,
    method: Method,
    options: tuple[float | None, float | None, int | None],
    workplace: Workplace,
) -> Candidates:
    from ellipsoid_planning.errors import CrystalError
    from planners.cli import crystal_candidates as candidates

    if method is Method.grid:
        for name, value in zip(("spread", "step-deg", "starts"), options, strict=True):
            if value is not None:
                raise CrystalError(
                    f"--{name} {value}: it belongs to --method potential; add that or remove it"
                )
        return candidates.by_grid(model, workplace)
    raise CrystalError("--method potential: it is not built in yet; take --method grid")


def _result(
    model: PackingModel, method: Method, found: Candidates, seconds: float
) -> dict[str, Any]:
    from ellipsoid_planning import __version__
    from ellipsoid_planning.crystal.fingerprint import fingerprint

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
