"""``schema``: the scenario format for editors and other programs."""

from __future__ import annotations

from planners.cli.outputs import print_json


def schema() -> None:
    """Print the JSON schema of the scenario format."""
    from ellipsoid_planning.scenario import scenario_schema

    print_json(scenario_schema())
