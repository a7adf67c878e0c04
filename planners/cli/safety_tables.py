"""Tables of safety functions are made before a plan begins, with a progress bar."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from planners.cli.terminal import say

if TYPE_CHECKING:
    from ellipsoid_planning.safety.tabulated import TabulatedSafety
    from ellipsoid_planning.scenario import Scenario


def make_tables(scenario: Scenario) -> TabulatedSafety:
    """Load the tables of a scenario's links from the user's cache, or make and keep them there.

    Raises:
        TableError: a table cannot be made, kept or read.
    """
    from ellipsoid_planning.safety.tabulated import TabulatedSafety

    safety = _with_bar(scenario) if sys.stderr.isatty() else TabulatedSafety(scenario.cspace())
    report = safety.report()
    verb = "Loaded" if all(table.loaded for table in report.tables) else "Made"
    say(
        f"{verb} {len(report.tables)} safety table(s), {report.memory / 1e6:.2g} MB,"
        f" in {report.seconds:.2g} s"
    )
    return safety


def _with_bar(scenario: Scenario) -> TabulatedSafety:
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import Progress

    from ellipsoid_planning.safety.tabulated import TabulatedSafety

    with Progress(console=Console(stderr=True, emoji=False), transient=True) as bar:
        task = bar.add_task(f"Safety tables of {escape(scenario.name)}", total=None)
        return TabulatedSafety(
            scenario.cspace(),
            on_progress=lambda done, total: bar.update(task, completed=done, total=total),
        )
