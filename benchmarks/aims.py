"""What the project aims at, and whether it was measured."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass

from benchmarks.cases import OURS
from benchmarks.command import CommandTimes
from benchmarks.plans import HIGHWAY, PEERS
from benchmarks.ratios import Ratio, Row, Table, ratio, rounded
from benchmarks.timing import CaseTime
from ellipsoid_planning.scenario import load_scenario

AGAINST_FCL = 50.0
AGAINST_PLUGIN = 5.0
OPEN_LIMIT = 2.0
MOTION_LIMIT = 10e-6
CHECKER_RATIO = 10.0
FIRST_RUN, LATER_RUN = 30.0, 2.0
_NOT_MEASURED = "not measured"


@dataclass(frozen=True)
class Check:
    """One aim with what was measured; ``met`` is None if that does not tell."""

    aim: str
    measured: str
    met: bool | None

    def __str__(self) -> str:
        """One line."""
        verdict = {True: "met", False: "NOT MET", None: "undecided"}[self.met]
        return f"{verdict:9s}  {self.aim}: {self.measured}"


def plan_checks(table: Table) -> Iterator[Check]:
    """The aims of whole plans, scenario by scenario, then checker against checker."""
    for name, row in table.items():
        if HIGHWAY not in row:
            continue
        if "open" in name:
            yield _open_check(name, row)
        elif load_scenario(name).dimension == 3:
            yield _faster(name, row, "fcl", AGAINST_FCL)
            yield _faster(name, row, "plugin", AGAINST_PLUGIN)
    for planner in dict.fromkeys(planner for planner, _ in PEERS):
        yield _checker_check(planner, table)


def _faster(name: str, row: Row, checker: str, aim: float) -> Check:
    text = f"{name}: HighwayRoadmap at least {aim:g} times faster than RRTConnect + {checker}"
    peer = row.get(("RRTConnect", checker))
    if peer is None:
        return Check(text, _NOT_MEASURED, None)
    found = ratio(peer, row[HIGHWAY])
    return Check(text, f"{found}", _at_least(found, aim))


def _at_least(found: Ratio, aim: float) -> bool | None:
    if not found.known:
        return False
    if found.value >= aim:
        return True
    return None if found.lowest else False


def _open_check(name: str, row: Row) -> Check:
    text = f"{name}: HighwayRoadmap at most {OPEN_LIMIT:g} times slower than RRTConnect + plugin"
    peer = row.get(("RRTConnect", "plugin"))
    if peer is None:
        return Check(text, _NOT_MEASURED, None)
    found = ratio(row[HIGHWAY], peer)
    if not found.known:
        return Check(text, "RRTConnect finds no path", True)
    return Check(text, str(found), found.value <= OPEN_LIMIT and not found.lowest)


def _checker_check(planner: str, table: Table) -> Check:
    text = f"{planner} at least {CHECKER_RATIO:g} times faster with the plug-in than with FCL"
    found = {}
    for name, row in table.items():
        ours, theirs = row.get((planner, "plugin")), row.get((planner, "fcl"))
        if ours is not None and theirs is not None:
            found[name] = ratio(theirs, ours)
    known = {name: one for name, one in found.items() if one.known}
    if not known:
        return Check(text, _NOT_MEASURED, None)
    worst = min(known, key=lambda name: known[name].value)
    middle = statistics.median(one.value for one in known.values())
    silent = len(found) - len(known)
    note = f"; {silent} scenarios where the plug-in found no path tell nothing" if silent else ""
    measured = f"median {rounded(middle)}, least {known[worst]} on {worst}{note}"
    verdicts = [_at_least(one, CHECKER_RATIO) for one in known.values()]
    met = False if False in verdicts else (None if None in verdicts else True)
    return Check(text, measured, met)


def kernel_checks(times: list[CaseTime]) -> Iterator[Check]:
    """The aim of certified motion."""
    for one in times:
        if one.topic == "validity of one motion" and one.method == OURS:
            text = f"a certified 3-D motion in about {MOTION_LIMIT * 1e6:g} µs in the kernel"
            yield Check(text, f"{one.median * 1e6:.1f} µs", one.median <= 1.2 * MOTION_LIMIT)


def command_checks(times: CommandTimes) -> Iterator[Check]:
    """The aims of the command's wall time."""
    text = f"first run of plan {times.scenario}, compiling, under {FIRST_RUN:g} s"
    measured = f"{times.first:.1f} s ({times.first_cpu:.1f} s of processor time)"
    yield Check(text, measured, times.first < FIRST_RUN)
    if times.later:
        slowest = max(times.later)
        text = f"later runs under {LATER_RUN:g} s"
        middle = statistics.median(times.later)
        yield Check(text, f"median {middle:.2f} s, slowest {slowest:.2f} s", slowest < LATER_RUN)
