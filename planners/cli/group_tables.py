"""The answers of ``group ...`` as tables for people."""

from __future__ import annotations

from typing import Any

from rich.markup import escape
from rich.table import Table

Report = dict[str, Any]


def show(report: Report) -> list[Table]:
    """The group's kind, then its operations."""
    kind = Table(title=escape(f"Group {report['name']}"), title_justify="left", show_header=False)
    kind.add_column("what")
    kind.add_column("value")
    number = f" (no. {report['number']})" if report["number"] else ""
    kind.add_row("type", f"{report['type'] or 'unknown'}{number}")
    kind.add_row("order modulo its cell's translations", str(report["order"]))
    for flag in ("symmorphic", "bieberbach", "sohncke", "enantiomorphic"):
        name = flag if flag in ("symmorphic", "enantiomorphic") else flag.capitalize()
        kind.add_row(name, "yes" if report[flag] else "no")
    operations = Table(title="Operations", title_justify="left", show_header=False)
    operations.add_column("number", justify="right", style="dim")
    operations.add_column("triplet")
    for place, triplet in enumerate(report["elements"], start=1):
        operations.add_row(str(place), triplet)
    return [kind, operations]


def table(report: Report) -> str:
    """The multiplication table in plain text: it may be wider than the terminal."""
    width = len(str(report["order"])) + 1
    numbers = range(1, report["order"] + 1)
    head = " " * width + " |" + "".join(f"{number:{width}}" for number in numbers)
    rule = "-" * (width + 1) + "+" + "-" * (width * report["order"])
    rows = zip(numbers, report["table"], strict=True)
    body = (f"{i:{width}} |" + "".join(f"{entry:{width}}" for entry in row) for i, row in rows)
    return "\n".join([head, rule, *body])


def subgroups(name: str, report: Report) -> list[Table]:
    """One row a subgroup."""
    found = report["subgroups"]
    normal = sum(entry["normal"] for entry in found)
    made = Table(
        title=f"{escape(name)}, order {report['order']}: {len(found)} subgroups "
        f"in {report['classes']} classes, {normal} normal",
        title_justify="left",
    )
    made.add_column("class", justify="right")
    made.add_column("order", justify="right")
    made.add_column("normal")
    made.add_column("type")
    made.add_column("generators")
    made.add_column("elements", style="dim")
    for entry in found:
        made.add_row(
            str(entry["class"]),
            str(entry["order"]),
            "yes" if entry["normal"] else "",
            entry["name"] or "",
            _list(entry["generators"]),
            _list(entry["numbers"]),
        )
    return [made]


def cosets(report: Report) -> list[Table]:
    """Left and right cosets side by side."""
    agree = "agree" if report["agree"] else "differ"
    made = Table(
        title=f"Cosets of {{{_list(report['numbers'])}}} in {report['name']}: left and right ones "
        f"{agree}",
        title_justify="left",
    )
    made.add_column("coset", justify="right", style="dim")
    made.add_column("left")
    made.add_column("right")
    made.add_column("left is right no.")
    rows = zip(report["left"], report["right"], report["matches"], strict=True)
    for place, (left, right, match) in enumerate(rows, start=1):
        numbers = (_list(left["numbers"]), _list(right["numbers"]))
        made.add_row(str(place), *numbers, "none" if match is None else str(match))
    return [made]


def _list(numbers: list[int]) -> str:
    return ", ".join(map(str, numbers))
