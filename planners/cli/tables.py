"""Short tables for people."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

if TYPE_CHECKING:
    from ellipsoid_planning.result import PathResult, PlanResult
    from planners.verify.report import Check, VerificationReport

COLOURS = {"solved": "green", "timeout": "yellow", "exhausted": "yellow"}


def result_table(result: PlanResult) -> Table:
    """Status, times, path and the planner's own counts of one result."""
    table = Table(title=escape(result.scenario.name), show_header=False, title_justify="left")
    table.add_column(style="bold")
    table.add_column(justify="right", overflow="fold")
    colour = COLOURS.get(result.status, "red")
    table.add_row("status", f"[{colour}]{result.status}[/{colour}]")
    table.add_row("planner", escape(result.planner))
    if result.seed is not None:
        table.add_row("seed", str(result.seed))
    for name, seconds in result.time.items():
        if seconds is not None:
            table.add_row(f"{name} time", _duration(seconds))
    if result.path is not None:
        _add_path(table, result.path)
    table.add_section()
    for name, value in result.statistics.items():
        table.add_row(escape(name.replace("_", " ")), escape(_text(name, value)))
    return table


def _add_path(table: Table, path: PathResult) -> None:
    table.add_section()
    table.add_row("states", str(len(path.configurations)))
    table.add_row("length", f"{path.length:.6g}")
    table.add_row("base travel", f"{path.base_travel:.6g}")
    table.add_row("clearance at least", f"{path.min_clearance:.6g}")
    table.add_row("certified", "[green]yes[/green]" if path.certified else "[red]no[/red]")


def _duration(seconds: float) -> str:
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3f} s"


def _text(name: str, value: Any) -> str:
    if name.endswith("_time") and isinstance(value, float):
        return _duration(value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def report_table(report: VerificationReport) -> Table:
    """Every check of a verification, and its numbers."""
    table = Table(show_header=False)
    table.add_column(style="bold")
    table.add_column()
    table.add_column(overflow="fold")
    table.add_row("scenario", "", escape(report.scenario))
    table.add_section()
    for check in report.checks:
        table.add_row(escape(check.name), _passed(check), escape(check.detail))
    table.add_section()
    if not report.samples:
        return _with_verdict(table, report)
    table.add_row("configurations", "", str(report.samples))
    table.add_row("sampled clearance", "", f"{report.sampled_clearance:.9g}")
    table.add_row("proved", "", f"{100.0 * report.resolved:.4g} % of the path")
    table.add_row("tested by FCL", "", str(report.fcl_samples))
    return _with_verdict(table, report)


def _with_verdict(table: Table, report: VerificationReport) -> Table:
    colour = "green" if report.passed else "red"
    verdict = report.verdict if report.passed else report.verdict.upper()
    table.add_row("verdict", "", f"[{colour}]{verdict}[/{colour}]")
    return table


def _passed(check: Check) -> str:
    if check.passed:
        return "[green]passed[/green]"
    return "[yellow]open[/yellow]" if check.open else "[red]FAILED[/red]"
