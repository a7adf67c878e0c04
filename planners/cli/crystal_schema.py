"""``crystal schema``: the format of packing models for editors and other programs."""

from __future__ import annotations

import json
import sys


def schema() -> None:
    """Print the JSON schema of packing models.

    [dim]Example:[/dim] ellipsoid-planning crystal schema > packing-model.schema.json
    """
    from ellipsoid_planning.crystal.model_format import packing_model_schema

    sys.stdout.write(json.dumps(packing_model_schema(), indent=2) + "\n")
