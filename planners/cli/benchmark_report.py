"""What a benchmark ends with: files in its folder, and the table on stdout."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planners.cli.terminal import result_console, say, working

if TYPE_CHECKING:
    from rich.table import Table

    from planners.benchmark.campaign import Campaign
    from planners.benchmark.run import RunRecord
    from planners.benchmark.summary import Row

_WIDTH = 200
"""Of the table in the text file [characters]."""
_TEXTS = ("planner", "failures")


def report(folder: Path, campaign: Campaign, records: Sequence[RunRecord]) -> None:
    """Write everything into ``folder`` and print the summary.

    Raises:
        EllipsoidPlanningError: something cannot be written.
    """
    from planners.benchmark.summary import summarised

    rows = summarised(campaign, records)
    with working("Writing database, tables and figures"):
        written = _write(folder, campaign, records, rows)
    _print(rows)
    for path in written:
        say(f"Wrote {path}")


def _write(
    folder: Path, campaign: Campaign, records: Sequence[RunRecord], rows: Sequence[Row]
) -> list[Path]:
    from ellipsoid_planning import atomic
    from planners.benchmark.outputs import write_outputs
    from planners.view.figures_benchmark import write_figures

    written = write_outputs(folder, campaign, records, rows)
    text = folder / "summary.txt"
    atomic.write_text(text, _text(rows))
    written.append(text)
    written.extend(write_figures(folder / "figures", campaign, records, rows))
    return written


def _print(rows: Sequence[Row]) -> None:
    from planners.benchmark.tables import notes

    if not sys.stdout.isatty():  # nothing is folded for a file or a pipe
        sys.stdout.write(_text(rows))
        sys.stdout.flush()
        return
    result_console().print(*_tables(rows), sep="\n")
    for note in notes(rows):
        say(f"Note: {note}")


def _tables(rows: Sequence[Row]) -> list[Table]:
    """A table for each problem."""
    from planners.benchmark.tables import HEADER, cells

    titles = dict.fromkeys(row.problem for row in rows)
    return [
        _table(title, HEADER[1:], [cells(row)[1:] for row in rows if row.problem == title])
        for title in titles
    ]


def _table(title: str, header: Sequence[str], lines: Sequence[Sequence[str]]) -> Table:
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    table = Table(title=escape(title), title_justify="left", title_style="bold", box=box.SIMPLE)
    for name in header:
        table.add_column(name, justify="left" if name in _TEXTS else "right")
    for line in lines:
        table.add_row(*map(escape, line))
    return table


def _text(rows: Sequence[Row]) -> str:
    from rich.console import Console

    from planners.benchmark.tables import notes

    text = io.StringIO()
    Console(file=text, width=_WIDTH, emoji=False).print(*_tables(rows), sep="\n")
    lines = [line.rstrip() for line in text.getvalue().splitlines()]
    return "\n".join([*lines, *notes(rows), ""])
