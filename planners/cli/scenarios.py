"""``scenarios``: the list of the bundled ones."""

from __future__ import annotations

from planners.cli.terminal import result_console


def scenarios() -> None:
    """List the bundled scenarios."""
    from rich.markup import escape
    from rich.table import Table

    from ellipsoid_planning.scenario import bundled_scenarios, load_scenario

    table = Table()
    table.add_column("name", style="bold", no_wrap=True)
    table.add_column("dimension", justify="right")
    table.add_column("obstacles", justify="right")
    table.add_column("description")
    for name, file in bundled_scenarios().items():
        scenario = load_scenario(file)
        counts = str(scenario.dimension), str(len(scenario.world.obstacles))
        table.add_row(escape(name), *counts, escape(scenario.description))
    result_console().print(table)
