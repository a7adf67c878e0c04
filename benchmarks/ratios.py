"""Ratios of median times, where either side may be known by a lower bound only."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from benchmarks.plans import Series

Row = dict[tuple[str, str], Series]
"""Series of one scenario by (planner, checker); only those with runs."""
Table = dict[str, Row]
"""Rows by scenario."""


@dataclass(frozen=True)
class Ratio:
    """How many times slower one series is than another.

    Attributes:
        value: the quotient of the medians.
        lowest: the quotient is at least ``value``: the slower one ran into the time limit.
        known: False if the faster one did; then ``value`` says nothing.
    """

    value: float
    lowest: bool = False
    known: bool = True

    def __str__(self) -> str:
        """As in a table."""
        if not self.known:
            return "?"
        return f"{'> ' if self.lowest else ''}{times(self.value)}"


def rounded(value: float) -> str:
    """Two or three digits, as many as such measurements deserve."""
    if value >= 100.0:
        digits = len(str(int(value)))
        return f"{round(value, 2 - digits):,.0f}"
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def times(value: float) -> str:
    """A factor as in a table."""
    return f"{rounded(value)}\u00d7"


def ratio(slower: Series, faster: Series) -> Ratio:
    """``slower``'s median over ``faster``'s."""
    return Ratio(slower.median / faster.median, slower.is_bound, not faster.is_bound)


def by_scenario(series: Iterable[Series]) -> Table:
    """The series that have runs, in a table."""
    table: Table = {}
    for one in series:
        if one.runs:
            table.setdefault(one.scenario, {})[one.planner, one.checker] = one
    return table
