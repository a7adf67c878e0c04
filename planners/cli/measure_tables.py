"""A measurement as tables for people."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from ellipsoid_planning.measure import Measurement


def measurement_tables(found: Measurement) -> list[Table]:
    """Free space and bounds; the narrowest openings, if there are any."""
    tables = [_space(found)]
    if found.openings:
        tables.append(_openings(found))
    return tables


def _space(found: Measurement) -> Table:
    from ellipsoid_planning.measure import measure_of, percentage

    free = found.free
    table = Table(title=escape(found.scenario.name), show_header=False, title_justify="left")
    table.add_column(style="bold")
    table.add_column(justify="right", overflow="fold")
    table.add_row("free fraction", percentage(free.fraction))
    low, high = free.volume_interval
    table.add_row("free volume", f"{free.volume:.6g} ({low:.6g} to {high:.6g})")
    table.add_row("of", f"{free.whole:.6g} = {measure_of(found.scenario)}")
    if free.method != "exact":
        unit = "configurations" if free.method == "configurations" else "sweep lines"
        confidence = f"{100.0 * free.fraction.confidence:g} %"
        table.add_row("confidence", f"{confidence}, {free.fraction.lines} {unit}")
    _add_layers(table, found)
    table.add_section()
    bound = found.bound
    if bound.kind == "exact":
        table.add_row("closed form", f"{bound.upper:.6g}, exact")
    else:
        low_text = "" if bound.lower is None else f"{bound.lower:.6g} to "
        table.add_row("closed form", f"{low_text or 'at most '}{bound.upper:.6g}")
        for reason in bound.reasons:
            table.add_row("", f"[dim]{escape(reason)}[/dim]")
    table.add_section()
    table.add_row("robot's least width", f"{found.width:.6g}")
    table.add_row("time", f"{found.time['total']:.2f} s")
    return table


def _add_layers(table: Table, found: Measurement) -> None:
    from ellipsoid_planning.measure import percentage

    if found.layers:
        table.add_section()
    for name, layer in found.layers.items():
        label = "freest layer drawn" if name == "freest" else f"{name}'s layer"
        table.add_row(label, percentage(layer.fraction))
    quartiles, closed = found.quartiles, found.closed_layers
    if quartiles is not None and closed is not None:
        middle = f"{100.0 * quartiles[1]:.3g} % to {100.0 * quartiles[3]:.3g} %"
        table.add_row(f"half of {len(found.free.layers)} layers", middle)
        table.add_row("layers without free lines", f"{100.0 * closed:.3g} %")


def _openings(found: Measurement) -> Table:
    table = Table(title="Narrowest openings", title_justify="left")
    table.add_column("between", overflow="fold")
    for head in ("gap", "robot's width", "play"):
        table.add_column(head, justify="right")
    for one in found.openings:
        colour = "green" if one.play > 0.0 else "yellow"
        play = f"[{colour}]{one.play:.4g}[/{colour}]"
        share = f" ({100.0 * one.play / one.width:.2g} %)" if one.play > 0.0 else ""
        names = escape(", ".join(one.bodies))
        table.add_row(names, f"{one.gap:.6g}", f"{one.width:.6g}", play + share)
    return table
