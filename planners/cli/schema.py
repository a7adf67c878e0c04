"""``schema``: the scenario format for editors and other programs."""

from __future__ import annotations

import json
import sys


def schema() -> None:
    """Print the JSON schema of the scenario format."""
    from ellipsoid_planning.scenario import scenario_schema

    sys.stdout.write(json.dumps(scenario_schema(), indent=2) + "\n")
