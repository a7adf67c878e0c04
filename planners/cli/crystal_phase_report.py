"""What ``crystal phase`` ends with: the result as data, tables and drawings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from planners.cli.terminal import say, working

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.table import Table

    from planners.cli.crystal_data import Data
    from planners.cli.crystal_phase import Phased
    from planners.crystal.parameters import Refinement
    from planners.crystal.phasing import Tried


def result(data: Data, phased: Phased, refinement: Refinement, seconds: float) -> dict[str, Any]:
    """Everything as data for JSON; see the command's help."""
    from ellipsoid_planning import __version__
    from ellipsoid_planning.crystal.packing.fingerprint import fingerprint

    model, outcome = data.cost.model, phased.outcome
    times = {"search": phased.search_seconds, "total": seconds}
    if outcome is not None:
        times["refinement"] = outcome.seconds
    return {
        "model": model.name,
        "group": model.group.name,
        "target": data.to_dict(),
        "found": outcome is not None and outcome.solved,
        "configurations": phased.looked_at,
        "free": phased.ranking.looked_at,
        "keys": list(model.keys),
        "threshold": refinement.cost_share * data.cost.norm,
        "refine": refinement.method,
        "seed": refinement.seed,
        "arrangement": None if outcome is None else _tried(data, outcome.best),
        "candidates": _candidates(data, phased),
        "refined": [] if outcome is None else [_tried(data, one) for one in outcome.tried],
        "fingerprint": fingerprint(model),
        "time": {name: round(value, 4) for name, value in times.items()},
        "version": __version__,
    }


def _tried(data: Data, tried: Tried) -> dict[str, Any]:
    refined = tried.refined
    return {
        "candidate": tried.number + 1,
        "configuration": data.cost.model.values_of(refined.configuration),
        "cost": refined.cost,
        "cost_share": refined.cost / data.cost.norm,
        "free": refined.free,
        "trees": refined.rounds,
        "looked_at": len(refined.trace),
        "seconds": round(refined.seconds, 4),
        **_errors(data, refined.configuration),
    }


def _candidates(data: Data, phased: Phased) -> list[dict[str, Any]]:
    model, ranking = data.cost.model, phased.ranking
    rows = zip(
        ranking.numbers.tolist(), ranking.configurations, ranking.costs.tolist(), strict=True
    )
    return [
        {
            "number": number,
            "configuration": model.values_of(configuration),
            "cost": cost,
            "cost_share": cost / data.cost.norm,
            **_errors(data, configuration),
        }
        for number, configuration, cost in rows
    ]


def _errors(data: Data, configuration: NDArray[np.float64]) -> dict[str, Any]:
    from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors

    if data.target is None:
        return {}
    errors = arrangement_errors(data.cost.model, configuration, data.target)
    return {"errors": errors.to_dict()}


SHOWN = 10
"""Candidates in tables and pictures."""


def tables(data: Data, phased: Phased, result: dict[str, Any]) -> list[Table]:
    """The candidates, and the arrangement that was found."""
    from planners.view.crystal_tables import candidates_table

    given = phased.ranking
    found = [_summary(data, result)]
    if len(given):
        title = f"{data.cost.model.name}: candidates"
        first, costs = given.configurations[:SHOWN], given.costs[:SHOWN]
        columns = _columns(data, first)
        table = candidates_table(data.cost.model, first, costs, data.target, columns, title)
        found.insert(0, table)
    return found


def _columns(data: Data, configurations: NDArray[np.float64]) -> dict[str, list[float]] | None:
    from planners.view.crystal_tables import error_columns

    if data.target is None:
        return None
    return error_columns(data.cost.model, configurations, data.target)


def _summary(data: Data, result: dict[str, Any]) -> Table:
    from rich.markup import escape
    from rich.table import Table

    table = Table(title="Found" if result["found"] else "Not found", title_justify="left")
    table.show_header = False
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    table.add_row("arrangements", f"{result['configurations']:,}, {result['free']:,} free")
    table.add_row("reflections", f"{len(data.cost.magnitudes)}")
    found = result["arrangement"]
    if found is not None:
        values = found["configuration"].items()
        table.add_row("arrangement", escape(", ".join(f"{key} {v:.6g}" for key, v in values)))
        share = f"{found['cost_share']:.3g} of an empty cell's"
        table.add_row("cost", f"{found['cost']:.4g}, {share}; threshold {result['threshold']:.3g}")
        table.add_row("free", "yes, proved" if found["free"] else "no")
        table.add_row("from candidate", str(found["candidate"]))
        for name, value in found.get("errors", {}).items():
            if isinstance(value, float):
                table.add_row(name, f"{value:.4g}")
    times = ", ".join(f"{name} {value:.2f} s" for name, value in result["time"].items())
    table.add_row("time", times)
    return table


def draw(
    data: Data, phased: Phased, figure: Path | None, trends: Path | None, html: Path | None
) -> None:
    """Write what is wished.

    Raises:
        EllipsoidPlanningError: a file cannot be written.
    """
    if phased.outcome is None:
        if any(file is not None for file in (figure, trends, html)):
            say("Nothing is free, so nothing is drawn.")
        return
    if figure is not None:
        _write(figure, _candidates_picture(data, phased, figure))
    if trends is not None:
        _write(trends, _trends_picture(data, phased, trends))
    if html is not None:
        from planners.cli.crystal_drawing import draw_cell

        title = f"{data.cost.model.name}: {'found' if phased.outcome.solved else 'best'}"
        draw_cell(data.cost.model, phased.outcome.configuration, None, html, title)


def _write(file: Path, content: bytes) -> None:
    from planners.view.writing import write_whole

    write_whole(file, content)
    say(f"Wrote {file}")


def _candidates_picture(data: Data, phased: Phased, file: Path) -> bytes:
    from planners.view.figures_crystal_candidates import picture_of_candidates

    given, outcome = phased.ranking, phased.outcome
    found = None if outcome is None else (outcome.configuration, outcome.best.refined.cost)
    with working("Drawing the candidates"):
        return picture_of_candidates(
            data.cost.model,
            given.configurations[:SHOWN],
            given.costs[:SHOWN],
            file.suffix[1:].lower(),
            data.target,
            _columns(data, given.configurations[:SHOWN]),
            found=found,
        )


def _trends_picture(data: Data, phased: Phased, file: Path) -> bytes:
    from ellipsoid_planning.crystal.phasing.trace import trend
    from planners.view.figures_crystal_trends import picture_of_trends, trends_of

    if phased.outcome is None:
        return b""
    model = data.cost.model
    with working("Drawing the trends"):
        every = [trend(one.refined.trace, model, data.target) for one in phased.outcome.tried]
        return picture_of_trends(trends_of(every), file.suffix[1:].lower(), model.name)
