"""``crystal models``: the bundled packing models and targets."""

from __future__ import annotations

from planners.cli.terminal import result_console


def models() -> None:
    """List the bundled packing models and targets.

    [dim]Example:[/dim] ellipsoid-planning crystal models
    """
    from rich.markup import escape
    from rich.table import Table

    from ellipsoid_planning.crystal.packing.model import load_model
    from ellipsoid_planning.crystal.packing.model_files import bundled_models
    from ellipsoid_planning.scenario_files import read_document

    table = Table()
    table.add_column("name", style="bold", no_wrap=True)
    table.add_column("group")
    table.add_column("arrangements", justify="right")
    table.add_column("description")
    for name, file in sorted(bundled_models().items()):
        document, _ = read_document(file)
        description = escape(str(document.get("description", "")))
        if "molecule" in document:
            model = load_model(file)
            table.add_row(name, escape(model.group.name), f"{model.grid.count:,}", description)
        else:
            table.add_row(name, "", "target", description)
    result_console().print(table)
