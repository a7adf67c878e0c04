"""Who takes part: planners, each with the checkers that it can work with."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ellipsoid_planning.errors import PlannerError
from planners.registry import PlannerEntry, find_planner
from planners.setup import CHECKERS, PLUGIN_CHECKERS, Checker

DEFAULT_PLANNERS = ("HighwayRoadmap", "PRM", "RRT", "RRTConnect")


@dataclass(frozen=True)
class Contender:
    """A planner with a checker.

    Attributes:
        planner: a name for `planners.registry.find_planner`.
        checker: "plugin", "tabulated" or "fcl".
        label: the planner, with the checker where that planner takes part with both.
    """

    planner: str
    checker: Checker
    label: str


@dataclass(frozen=True)
class Line:
    """The contenders, and notes on those left out."""

    contenders: tuple[Contender, ...]
    notes: tuple[str, ...] = ()


def line_up(planners: Sequence[str], checkers: Sequence[str]) -> Line:
    """Every planner with every checker that it can work with.

    Raises:
        PlannerError: unknown planner or checker, one named twice, none at all, or a planner
            that can work with none of the checkers.
    """
    for option, names in (("--planners", planners), ("--checkers", checkers)):
        _check_names(option, names)
    known = [_known_checker(name) for name in checkers]
    contenders: list[Contender] = []
    notes: list[str] = []
    for name in planners:
        entry = find_planner(name)
        own = [known_ for known_ in known if known_ in PLUGIN_CHECKERS or not entry.needs_plugin]
        if not own:
            raise PlannerError(
                f"{entry.name} works with the plug-in checker only; "
                "add plugin to --checkers, or leave it out of --planners"
            )
        notes.extend(_left_out(entry, known, own))
        contenders.extend(
            Contender(name, checker, entry.name if len(own) == 1 else f"{entry.name} ({checker})")
            for checker in own
        )
    _check_labels(contenders)
    return Line(tuple(contenders), tuple(notes))


def _check_names(option: str, names: Sequence[str]) -> None:
    if not names:
        raise PlannerError(f"{option}: expected names separated by commas, got none")
    for name in names:
        if names.count(name) > 1:
            raise PlannerError(f"{option}: {name} is named twice")


def _known_checker(name: str) -> Checker:
    for checker in CHECKERS:
        if checker == name:
            return checker
    raise PlannerError(f"--checkers: expected some of {', '.join(CHECKERS)}, got {name!r}")


def _left_out(
    entry: PlannerEntry, asked: Iterable[Checker], used: Sequence[Checker]
) -> Iterable[str]:
    missing = [checker for checker in asked if checker not in used]
    if missing:
        yield f"{entry.name} runs with the plug-in checker only, not with {', '.join(missing)}."


def _check_labels(contenders: Sequence[Contender]) -> None:
    labels = [contender.label for contender in contenders]
    for label in labels:
        if labels.count(label) > 1:
            raise PlannerError(f"--planners: two different planners are called {label}; rename one")
