"""OMPL's PRM grown to a number of milestones with one checker or another, each in a process."""

from __future__ import annotations

import gc
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.safety_scenes import configurations, scene

CHECKERS = ("plugin", "tabulated", "fcl")
NAMES = {
    "plugin": "exact safety function",
    "tabulated": "tabulated safety function",
    "fcl": "FCL",
}
_SLICE = 2e-3
"""PRM grows for a time [s], not to a number: the slices that it is given."""


@dataclass(frozen=True)
class Growth:
    """How a roadmap grew.

    Attributes:
        milestones, edges: what it has in the end.
        seconds: growing it.
        tables: seconds of filling tables, part of nothing else.
    """

    milestones: int
    edges: int
    seconds: float
    tables: float

    def seconds_for(self, milestones: int) -> float:
        """Time for so many milestones; growing stops a few after the last one asked for."""
        return self.seconds * milestones / self.milestones


def grown(name: str, checker: str, milestones: int, seed: int) -> Growth:
    """A roadmap of a scene grown in a process of its own, which nothing before it has touched."""
    command = [sys.executable, "-m", "benchmarks.safety_roadmaps", name, checker]
    done = subprocess.run(  # noqa: S603
        [*command, str(milestones), str(seed)], check=True, capture_output=True, text=True
    )
    return Growth(**json.loads(done.stdout))


def _grow(name: str, checker: str, milestones: int, seed: int) -> Growth:
    from ompl import base as ob
    from ompl import geometric as og

    from ellipsoid_planning.safety import TabulatedSafety
    from planners.bindings import ompl_output, set_seed
    from planners.fcl import FclValidityChecker, check_motions_discretely
    from planners.motion import CertifiedMotionValidator
    from planners.spaces import state_space
    from planners.validity import EllipsoidValidityChecker, TabulatedValidityChecker

    set_seed(seed)
    cspace, tables = scene(name), 0.0
    si = ob.SpaceInformation(state_space(cspace))
    if checker == "fcl":
        si.setStateValidityChecker(FclValidityChecker(si, cspace))
        check_motions_discretely(si)
    else:
        si.setMotionValidator(CertifiedMotionValidator(si, cspace))
    if checker == "plugin":
        si.setStateValidityChecker(EllipsoidValidityChecker(si, cspace))
    if checker == "tabulated":
        with tempfile.TemporaryDirectory() as folder:
            TabulatedSafety(cspace, folder=Path(folder))  # compiles what is not compiled yet
        began = time.perf_counter()
        safety = TabulatedSafety(cspace, keep=False)
        tables = time.perf_counter() - began
        si.setStateValidityChecker(TabulatedValidityChecker(si, safety))
    si.setup()
    with ompl_output("silent"):
        _warm_up(si, cspace)
        problem = ob.ProblemDefinition(si)
        planner = og.PRM(si)
        planner.setProblemDefinition(problem)
        planner.setup()
        began = time.perf_counter()
        while planner.milestoneCount() < milestones:
            planner.growRoadmap(_SLICE)
        seconds = time.perf_counter() - began
        found = Growth(planner.milestoneCount(), planner.edgeCount(), seconds, tables)
        del planner, problem
        gc.collect()
    return found


def _warm_up(si, cspace) -> None:
    """Compile what is called later on."""
    from planners.spaces import write_configuration

    first, last = si.allocState(), si.allocState()
    rows = configurations(cspace, 2000)
    valid = rows[cspace.are_valid(rows)][:2]
    for state, row in zip((first, last), valid, strict=True):
        write_configuration(state, row, cspace)
        si.isValid(state)
    si.checkMotion(first, last)


if __name__ == "__main__":
    found = _grow(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
    sys.stdout.write(json.dumps(asdict(found)) + "\n")
