"""``crystal schema``: the formats of packing models and targets for editors and programs."""

from __future__ import annotations

from typing import Annotated

import typer

from planners.cli.outputs import print_json


def schema(
    target: Annotated[
        bool, typer.Option("--target", help="That of targets, in place of packing models.")
    ] = False,
) -> None:
    """Print the JSON schema of packing models, or of targets.

    [dim]Example:[/dim] ellipsoid-planning crystal schema > packing-model.schema.json
    """
    from ellipsoid_planning.crystal.packing.model_format import packing_model_schema, target_schema

    chosen = target_schema() if target else packing_model_schema()
    print_json(chosen)
