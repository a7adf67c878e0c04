"""The summary as text: the same cells for the terminal and Markdown, plain numbers for CSV."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Iterable, Sequence

from ellipsoid_planning.csv_text import csv_text
from planners.benchmark.growth import growth_notes
from planners.benchmark.run import RunRecord
from planners.benchmark.summary import Quantile, Quartiles, Row

HEADER = (
    "problem",
    "planner",
    "solved",
    "certified",
    "time (quartiles)",
    "length (quartiles)",
    "clearance (quartiles)",
    "failures",
)
"""Of the columns that people read: medians with their quartiles."""

RUN_COLUMNS = (
    "problem",
    "label",
    "planner",
    "checker",
    "run",
    "seed",
    "status",
    "reason",
    "seconds",
    "simplification",
    "length",
    "clearance",
    "proved_clearance",
    "certified",
    "verified",
    "memory",
)


def cells(row: Row) -> tuple[str, ...]:
    """A row of the table for people, in the order of `HEADER`."""
    return (
        row.problem,
        row.label,
        f"{row.solved}/{row.runs}",
        f"{row.certified}/{row.solved}" if row.solved else "",
        _texts(row.time, *_time_unit(row.time.median.value)),
        _texts(row.length),
        _texts(row.path_clearance),
        ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in row.failures),
    )


def duration(seconds: float) -> str:
    """A time in a unit that suits it, with three digits."""
    scale, unit = _time_unit(seconds)
    return f"{scale * seconds:.3g} {unit}"


def _time_unit(seconds: float) -> tuple[float, str]:
    if seconds < 1e-3:
        return 1e6, "µs"
    return (1e3, "ms") if seconds < 1.0 else (1.0, "s")


def _texts(values: Quartiles, scale: float = 1.0, unit: str = "") -> str:
    """The median with its unit, and the quartiles where they say more than the median does."""
    if math.isnan(values.median.value):
        return ""
    median = f"{_text(values.median, scale)} {unit}".rstrip()
    first, third = _text(values.first, scale), _text(values.third, scale)
    if first == third == _text(values.median, scale):
        return median
    return f"{median} ({first}–{third})"  # noqa: RUF001  a range


def _text(quantile: Quantile, scale: float) -> str:
    return f"{'>' if quantile.is_bound else ''}{scale * quantile.value:.4g}"


def notes(rows: Iterable[Row]) -> list[str]:
    """Sentences for below the table: what counts how, families, and paths that are not free."""
    rows = list(rows)
    lines = growth_notes(rows)
    if any(row.solved < row.runs for row in rows):
        lines.append("Runs without a path count as the time limit at least (>).")
    for row in rows:
        lines.extend(
            f"Not free, and counted as a failure: the path of {key}" for key in row.not_free
        )
    return lines


def markdown(rows: Sequence[Row]) -> str:
    """The table in Markdown, with its notes."""
    lines = [_markdown_row(HEADER), _markdown_row(("---",) * 2 + ("---:",) * 5 + ("---",))]
    lines.extend(_markdown_row(cells(row)) for row in rows)
    below = notes(rows)
    if below:
        lines.extend(["", *(f"- {_markdown_text(note)}" for note in below)])
    return "\n".join(lines) + "\n"


def _markdown_row(entries: Iterable[str]) -> str:
    return "| " + " | ".join(map(_markdown_text, entries)) + " |"


def _markdown_text(text: str) -> str:
    """Text that Markdown shows as it is written: neither markup nor HTML."""
    text = html.escape(" ".join(text.splitlines()), quote=False)
    return re.sub(r"([\\`*_\[\]|~])", r"\\\1", text)


def summary_csv(rows: Iterable[Row]) -> str:
    """The summary as CSV: times in seconds; ``_is_bound`` marks lower bounds."""
    entries = [_summary_entries(row) for row in rows]
    header = list(entries[0]) if entries else []
    return _csv(header, [list(entry.values()) for entry in entries])


def _summary_entries(row: Row) -> dict[str, object]:
    entries: dict[str, object] = {
        "problem": row.problem,
        "family": row.family,
        "family_clearance": row.clearance,
        "label": row.label,
        "planner": row.planner,
        "checker": row.checker,
        "runs": row.runs,
        "solved": row.solved,
        "success_rate": row.success,
        "certified": row.certified,
    }
    for name, values in (
        ("time", row.time),
        ("length", row.length),
        ("clearance", row.path_clearance),
    ):
        for part in ("first", "median", "third"):
            entries[f"{name}_{_QUARTILES[part]}"] = _plain(getattr(values, part).value)
    entries["time_median_is_bound"] = row.time.median.is_bound
    entries["time_q3_is_bound"] = row.time.third.is_bound
    entries["failures"] = "; ".join(f"{count} {status}" for status, count in row.failures)
    entries["not_free"] = "; ".join(row.not_free)
    return entries


_QUARTILES = {"first": "q1", "median": "median", "third": "q3"}


def _plain(value: float) -> float | None:
    return None if math.isnan(value) else value


def runs_csv(records: Iterable[RunRecord]) -> str:
    """All runs as CSV, one row each."""
    rows = [[getattr(record, name) for name in RUN_COLUMNS] for record in records]
    return _csv(list(RUN_COLUMNS), rows)


def _csv(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    return csv_text([header, *rows])
