"""What is planned: named scenarios, the same in every run, or families, drawn anew in each."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.benchmark.run import slug

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario


@dataclass(frozen=True)
class Problem:
    """One row of scenarios to compare planners on.

    Attributes:
        name: unique in a campaign, fit for file names and OMPL's logs.
        scenarios: in their file format; one for all runs, or one for each.
        family: the family that it belongs to, if any.
        clearance: the family's parameter: free play over the robot's width at the passage.
    """

    name: str
    scenarios: tuple[Mapping[str, Any], ...]
    family: str | None = None
    clearance: float | None = None

    def scenario(self, run: int) -> Mapping[str, Any]:
        """The scenario of a run, counted from 0."""
        return self.scenarios[run if len(self.scenarios) > 1 else 0]

    def digest(self) -> str:
        """A fingerprint of all scenarios."""
        text = json.dumps(list(self.scenarios), sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def parameters(self) -> dict[str, str]:
        """The experiment's parameters for OMPL's log, values by "name TYPE"."""
        if self.family is None or self.clearance is None:
            return {}
        return {"family TEXT": self.family, "clearance REAL": repr(self.clearance)}


_FAMILY_NAME = re.compile(
    r"(?P<family>\S+) (?P<dimension>[23])-D, clearance (?P<clearance>[^\s,]+)"
)
"""How the command ``family`` begins a scenario's name; it may go on with a seed."""


def scenario_problems(scenarios: Iterable[Scenario]) -> tuple[Problem, ...]:
    """A problem for each scenario; scenarios of one name are numbered.

    Those that the command ``family`` made are told from their names.
    """
    problems: dict[str, Problem] = {}
    for scenario in scenarios:
        name = _unused(slug(scenario.name), problems)
        problems[name] = Problem(name, (scenario.to_dict(),), *_family_of(scenario.name))
    return tuple(problems.values())


def _family_of(name: str) -> tuple[str | None, float | None]:
    found = _FAMILY_NAME.match(name)
    if found is None or name.endswith(("blocked", "without passage")):
        return None, None
    try:
        clearance = float(found["clearance"])
    except ValueError:
        return None, None
    return _family_title(found["family"], int(found["dimension"])), clearance


def _family_title(family: str, dimension: int) -> str:
    suffix = f"-{dimension}d"
    return slug(family).removesuffix(suffix) + suffix


def _unused(name: str, taken: Iterable[str]) -> str:
    known, number, new = set(taken), 1, name
    while new in known:
        number += 1
        new = f"{name}-{number}"
    return new


def family_problems(
    family: str, clearances: Sequence[float], dimension: int | None, runs: int, seed: int
) -> tuple[Problem, ...]:
    """A problem for each clearance of a family, each run with the scenario of its own seed.

    Raises:
        EllipsoidPlanningError: unknown family, or one that does not exist in this dimension or
            at this clearance.
    """
    from ellipsoid_planning.families import make_family

    problems = []
    for clearance in clearances:
        drawn = [make_family(family, clearance, dimension, seed + run) for run in range(runs)]
        title = _family_title(family, drawn[0].dimension)
        scenarios = tuple(scenario.to_dict() for scenario in drawn)
        problems.append(Problem(f"{title}-{scientific(clearance)}", scenarios, title, clearance))
    return tuple(problems)


def scientific(value: float) -> str:
    """A positive number in short: 1e-3, 2.5e-4."""
    exponent = math.floor(math.log10(value) + 1e-12)
    mantissa = f"{value / 10.0**exponent:.4g}"
    return f"{mantissa}e{exponent}"


def clearances_from(text: str) -> tuple[float, ...]:
    """The clearances in a text like "1e-1,1e-3".

    Raises:
        EllipsoidPlanningError: one is no positive finite number, or is named twice.
    """
    values = []
    for entry in text.split(","):
        try:
            value = float(entry)
        except ValueError:
            value = math.nan
        if not 0.0 < value < math.inf:
            raise EllipsoidPlanningError(
                f"--clearances: expected positive numbers separated by commas, got {entry!r}"
            )
        if value in values:
            raise EllipsoidPlanningError(f"--clearances: {entry.strip()} is named twice")
        values.append(value)
    return tuple(values)
