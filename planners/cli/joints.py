"""``joints``: a robot's joints, and which of its links can meet."""

from __future__ import annotations

import json
import sys
from typing import Annotated

import typer

from planners.cli.sources import say_notices
from planners.cli.terminal import result_console, working


def joints(
    source: Annotated[
        str,
        typer.Argument(metavar="SCENARIO", help="A YAML file, or the name of a bundled scenario."),
    ],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON, with angles in radians.")
    ] = False,
) -> None:
    """List an articulated robot's joints, and which of its links can meet.

    Joints stand in the order of configurations. Each pair of links is proved never to meet while
    all joints are in their limits, or an example shows where they do; then, with one or two joints
    between them, the limits of one joint that would exclude it, grown from the scenario's start.

    [dim]Examples:[/dim]

    ellipsoid-planning joints robot.yaml

    ellipsoid-planning joints robot.yaml --json
    """
    from ellipsoid_planning.errors import ScenarioError
    from ellipsoid_planning.robots.articulated import ArticulatedRobot
    from ellipsoid_planning.scenario import load_scenario

    scenario = load_scenario(source)
    say_notices(scenario)
    if not isinstance(scenario.robot, ArticulatedRobot):
        raise ScenarioError(
            f"{scenario.name}: the robot is rigid, it has no joints; expected a scenario with "
            "robot.links and robot.joints"
        )
    from planners.cli.joints_report import joint_tables, joints_report

    with working(f"Analysing the joints of {scenario.name}"):
        report = joints_report(scenario)
    if as_json:
        sys.stdout.write(json.dumps(report, indent=2) + "\n")
        return
    for table in joint_tables(report):
        result_console().print(table)
