"""What ``joints`` tells about a robot: as data, and as tables for people."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import combinations
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from ellipsoid_planning.cspace.joint_limits import excluding_limits
from ellipsoid_planning.cspace.joint_ranges import MEET, NEVER, UNDECIDED, JointBoxes
from ellipsoid_planning.robots.joint import LIMITED, PRISMATIC
from ellipsoid_planning.robots.reach import joint_reaches

if TYPE_CHECKING:
    from ellipsoid_planning.robots.articulated import ArticulatedRobot
    from ellipsoid_planning.scenario import Scenario

NEIGHBOURS = "neighbours"
IGNORED = "ignored"
RIGID = "rigid"

_WORDS = {
    NEVER: "[green]never meet[/green]",
    MEET: "[yellow]can meet[/yellow]",
    UNDECIDED: "undecided",
    NEIGHBOURS: "[dim]neighbours[/dim]",
    IGNORED: "[dim]ignored[/dim]",
    RIGID: "[dim]rigidly joined[/dim]",
}


def joints_report(scenario: Scenario) -> dict[str, Any]:
    """Joints and pairs of links with parts, JSON-able; angles in radians."""
    robot: Any = scenario.robot
    search = JointBoxes(robot)
    tested = set(search.pairs())
    names = [link.name for link in robot.links if link.parts]
    pairs = []
    for first, second in combinations(names, 2):
        if (first, second) in tested:
            pairs.append(_verdict(search, first, second, scenario.start))
        else:
            pairs.append({"links": [first, second], "verdict": _untested(robot, first, second)})
    return {"scenario": scenario.name, "joints": _joints(robot), "pairs": pairs}


def _joints(robot: ArticulatedRobot) -> list[dict[str, Any]]:
    reaches = joint_reaches(robot)
    return [
        {
            "name": joint.name,
            "type": joint.type,
            "parent": joint.parent,
            "child": joint.child,
            "limits": [joint.lower, joint.upper] if joint.type in LIMITED else None,
            "weight": float(weight),
            "reach": float(reaches[joint.name]),
        }
        for joint, weight in zip(robot.moving_joints, robot.joint_weights, strict=True)
    ]


def _untested(robot: ArticulatedRobot, first: str, second: str) -> str:
    pair = frozenset((first, second))
    if pair in robot.ignored:
        return IGNORED
    joined = any(frozenset((joint.parent, joint.child)) == pair for joint in robot.joints)
    return NEIGHBOURS if joined else RIGID


def _verdict(search: JointBoxes, first: str, second: str, start: Any) -> dict[str, Any]:
    found = search.decide(first, second)
    row: dict[str, Any] = {
        "links": [first, second],
        "verdict": found.verdict,
        "joints": list(found.joints),
    }
    if found.verdict == MEET:
        row["example"] = found.example
        limits = excluding_limits(search, first, second, start)
        row["excluded_by"] = [asdict(each) for each in limits]
    return row


def joint_tables(report: Mapping[str, Any]) -> Iterator[Table]:
    """The report as two tables, angles in degrees."""
    table = Table(title=escape(report["scenario"]), title_justify="left")
    for name in ("joint", "type", "parent", "child"):
        table.add_column(name, overflow="fold", no_wrap=name == "joint")
    for name in ("limits", "weight", "reach"):
        table.add_column(name, justify="right")
    kinds = {joint["name"]: joint["type"] for joint in report["joints"]}
    for joint in report["joints"]:
        words = [escape(joint[key]) for key in ("name", "type", "parent", "child")]
        limits = "" if joint["limits"] is None else _range(joint["limits"], joint["type"])
        table.add_row(*words, limits, f"{joint['weight']:.4g}", f"{joint['reach']:.4g}")
    yield table
    table = Table()
    table.add_column("links", overflow="fold")
    table.add_column("verdict")
    table.add_column("where, and what would exclude it", overflow="fold")
    for pair in report["pairs"]:
        first, second = map(escape, pair["links"])
        table.add_row(f"{first}, {second}", _WORDS[pair["verdict"]], _detail(pair, kinds))
    yield table


def _detail(pair: Mapping[str, Any], kinds: Mapping[str, str]) -> str:
    if pair["verdict"] != MEET:
        return ""
    values = [f"{name} = {_value(value, kinds[name])}" for name, value in pair["example"].items()]
    lines = ["at " + ", ".join(values)]
    for limits in pair["excluded_by"]:
        kind = kinds[limits["joint"]]
        within = _range((limits["lower"], limits["upper"]), kind)
        around = _value(limits["around"], kind)
        lines.append(f"never with {limits['joint']} in {within} (around its start, {around})")
    return escape("\n".join(lines))


def _value(value: Any, kind: str) -> str:
    if isinstance(value, float):
        return f"{value:.6g}" if kind == PRISMATIC else f"{math.degrees(value):.6g}°"
    return "(" + ", ".join(f"{number:.4g}" for number in value) + ")"


def _range(limits: Sequence[float], kind: str) -> str:
    """Limits in words, rounded inwards, so that what is proved stays so."""
    lower, upper = limits
    scale, unit = (1.0, "") if kind == PRISMATIC else (math.degrees(1.0), "°")
    step = 10.0 ** (math.floor(math.log10((upper - lower) * scale)) - 5)
    # What a value that was given in degrees has lost on its way is no reason to lose a step.
    low = math.ceil(lower * scale / step - 1e-6) * step
    high = math.floor(upper * scale / step + 1e-6) * step
    return f"{low:.9g}{unit} … {high:.9g}{unit}"
