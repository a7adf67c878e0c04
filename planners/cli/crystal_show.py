"""``crystal show``: a packing model at a glance, and one of its arrangements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.crystal_runs import Figure, Html, Json, Model
from planners.cli.outputs import check_outputs
from planners.cli.terminal import result_console

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from rich.table import Table

    from ellipsoid_planning.crystal.packing.model import PackingModel

LONGEST_LIST = 10


def show(
    model: Model,
    target: Annotated[
        str | None,
        typer.Option(
            metavar="TARGET.yaml|NAME|RESULT.json",
            help="The arrangement to look at, by file or bundled name, or the one that "
            "[bold]crystal phase[/bold] found.",
        ),
    ] = None,
    configuration: Annotated[
        str | None,
        typer.Option(
            metavar="KEY=VALUE,...",
            help="The arrangement to look at, angles in degrees; what is not named stands in the "
            "middle of its range.",
        ),
    ] = None,
    number: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="The arrangement to look at, by its number in the model's grid."
        ),
    ] = None,
    json: Json = False,
    figure: Figure = None,
    html: Html = None,
) -> None:
    """Show a packing model: group, cell, coordinates, and whether an arrangement is free.

    Where copies meet, it says which parts of which copies do, and how deep. The JSON has name,
    group, operations, cell, volume_ratio (of the molecules to the cell, their parts' overlaps
    counted once), coordinates, arrangements (of the grid) and configuration, free, meetings (of
    the arrangement).

    [dim]Examples:[/dim]

    ellipsoid-planning crystal show rabbit-p212121

    ellipsoid-planning crystal show rabbit-p1 --target rabbit-p1-target --html cell.html

    ellipsoid-planning crystal show rabbit-plane --configuration yaw_deg=100,left_ear_deg=3
    --figure cell.png
    """
    from ellipsoid_planning.crystal.packing.model import load_model
    from planners.cli.outputs import print_json

    check_outputs(figure=figure, html=html)
    if figure is not None:
        from planners.view.figures import check_format

        check_format(figure)
    loaded = load_model(model)
    chosen = _chosen(loaded, target, configuration, number)
    summary = _summary(loaded, chosen)
    if figure is not None or html is not None:
        from planners.cli.crystal_drawing import draw_cell

        draw_cell(loaded, _middle(loaded) if chosen is None else chosen, figure, html)
    if json:
        print_json(summary)
        return
    console = result_console()
    console.print(_table(loaded, summary), _coordinates(summary))


def _chosen(
    model: PackingModel, target: str | None, configuration: str | None, number: int | None
) -> NDArray[np.float64] | None:
    """The arrangement that the options name, None without any."""
    from ellipsoid_planning.crystal.packing.model import load_target
    from ellipsoid_planning.errors import CrystalError

    given = {"target": target, "configuration": configuration, "number": number}
    named = [f"--{name}" for name, value in given.items() if value is not None]
    if len(named) > 1:
        raise CrystalError(f"expected one arrangement, got {' and '.join(named)}; remove one")
    if target is not None and target.lower().endswith(".json"):
        return _found(model, target)
    if target is not None:
        return load_target(target, model)
    if configuration is not None:
        return _configuration(model, configuration)
    if number is None:
        return None
    if not 0 <= number < model.grid.count:
        raise CrystalError(
            f"--number {number}: expected the number of an arrangement, 0 to {model.grid.count - 1}"
        )
    return model.grid.configurations([number])[0]


def _found(model: PackingModel, file: str) -> NDArray[np.float64]:
    """The arrangement of a result."""
    import json as json_format

    from ellipsoid_planning.errors import CrystalError, ResultError
    from ellipsoid_planning.input_files import read_text

    try:
        values = json_format.loads(read_text(file))["arrangement"]
        return model.configuration(values["configuration"])
    except OSError as error:
        raise ResultError(f"{file}: cannot read the file: {error.strerror}") from None
    except CrystalError as error:
        raise ResultError(f"{file}: it is another model's result: {error}") from None
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ResultError(
            f"{file}: expected a result that crystal phase wrote, with an arrangement; give one, "
            "or a target's YAML file"
        ) from None


def _configuration(model: PackingModel, text: str) -> NDArray[np.float64]:
    from ellipsoid_planning.errors import CrystalError

    values = model.values_of(_middle(model))
    for entry in filter(None, (entry.strip() for entry in text.split(","))):
        key, _, value = entry.partition("=")
        try:
            values[key.strip()] = float(value)
        except ValueError:
            raise CrystalError(
                f"--configuration {entry!r}: expected KEY=NUMBER; keys are {', '.join(model.keys)}"
            ) from None
    try:
        return model.configuration(values)
    except CrystalError as error:
        raise CrystalError(f"--configuration: {error}") from None


def _middle(model: PackingModel) -> NDArray[np.float64]:
    """The arrangement (K,) in the middle of all ranges."""
    import numpy as np

    return np.array([0.5 * (r.lower + r.upper) for r in model.grid.ranges])


def _summary(model: PackingModel, chosen: NDArray[np.float64] | None) -> dict[str, Any]:
    from ellipsoid_planning.crystal.packing.fingerprint import fingerprint
    from ellipsoid_planning.geometry.covering import union_volume

    copies = model.group.order
    bodies = model.molecule.bodies(_middle(model) if chosen is None else chosen)
    summary = {
        "name": model.name,
        "description": model.description,
        "group": model.group.name,
        "operations": [operation.triplet() for operation in model.group.operations],
        "cell": {
            "lengths": [float(length) for length in model.cell.lengths],
            "angles_deg": [float(angle) for angle in model.cell.angles_deg],
            "volume": model.cell.volume,
        },
        "volume_ratio": copies * union_volume(bodies) / model.cell.volume,
        "parts": [part.name for part in model.parts],
        "resolution": model.resolution,
        "coordinates": _ranges(model),
        "arrangements": model.grid.count,
        "fingerprint": fingerprint(model),
    }
    return summary if chosen is None else summary | _arrangement(model, chosen)


def _ranges(model: PackingModel) -> list[dict[str, Any]]:
    import math

    rows = []
    for coordinate, values in zip(model.molecule.coordinates, model.grid.ranges, strict=True):
        unit = 180.0 / math.pi if coordinate.turns else 1.0
        lower, upper, step = (round(v * unit, 9) for v in (values.lower, values.upper, values.step))
        rows.append(
            {
                "key": coordinate.key,
                "lower": lower,
                "upper": upper,
                "step": step,
                "values": len(values.values),
            }
        )
    return rows


def _arrangement(model: PackingModel, chosen: NDArray[np.float64]) -> dict[str, Any]:
    from ellipsoid_planning.crystal.packing.meetings import meetings

    operations = [operation.triplet() for operation in model.group.operations]
    return {
        "configuration": model.values_of(chosen),
        "free": model.is_free(chosen),
        "meetings": [
            {
                "first": meeting.first,
                "second": meeting.second,
                "operation": operations[meeting.operation],
                "lattice": list(meeting.lattice),
                "depth": meeting.depth,
            }
            for meeting in meetings(model, chosen)
        ],
    }


def _table(model: PackingModel, summary: dict[str, Any]) -> Table:
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=escape(model.name), title_justify="left", show_header=False)
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    unit = "area" if model.dimension == 2 else "volume"
    rows = {
        "group": f"{model.group.name}, {model.group.order} "
        + ("operation" if model.group.order == 1 else "operations"),
        "cell": f"{_numbers(summary['cell']['lengths'])}; "
        f"{_numbers(summary['cell']['angles_deg'])} degrees",
        f"{unit} of the molecules": f"{summary['volume_ratio']:.1%} of the cell's"
        + ("" if len(summary["parts"]) == 1 else ", to about 1 % of it; parts' overlaps once"),
        "parts": ", ".join(summary["parts"]),
        "resolution": f"{model.resolution:g}",
        "arrangements": f"{model.grid.count:,} in the grid",
    }
    for name, text in rows.items():
        table.add_row(name, escape(text))
    if "free" in summary:
        _add_arrangement(table, summary)
    return table


def _add_arrangement(table: Table, summary: dict[str, Any]) -> None:
    from rich.markup import escape

    table.add_section()
    values = summary["configuration"].items()
    table.add_row("arrangement", escape(", ".join(f"{key} {value:.6g}" for key, value in values)))
    free = "[green]yes, proved[/green]" if summary["free"] else "[red]no[/red]"
    table.add_row("free", free)
    found = summary["meetings"]
    for meeting in found[:LONGEST_LIST]:
        text = (
            f"{meeting['first']} and {meeting['second']} of the copy {meeting['operation']} + "
            f"({_numbers(meeting['lattice'])}), {meeting['depth']:.3g} deep"
        )
        table.add_row("meeting", escape(text))
    if len(found) > LONGEST_LIST:
        table.add_row("", f"and {len(found) - LONGEST_LIST} more")


def _coordinates(summary: dict[str, Any]) -> Table:
    from rich.markup import escape
    from rich.table import Table

    table = Table(title="Coordinates", title_justify="left")
    table.add_column("key", style="bold")
    for name in ("lower", "upper", "step", "values"):
        table.add_column(name, justify="right")
    for row in summary["coordinates"]:
        numbers = (f"{row[name]:g}" for name in ("lower", "upper", "step", "values"))
        table.add_row(escape(row["key"]), *numbers)
    return table


def _numbers(values: list[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)
