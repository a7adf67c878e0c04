"""The highway roadmap as an OMPL planner."""

from __future__ import annotations

import traceback
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.roadmap import highway
from ellipsoid_planning.roadmap.graph import RoadmapGraph, explored_graph
from ellipsoid_planning.roadmap.parameters import RoadmapParameters

from . import bindings
from .spaces import StateAccess, state_access
from .validity import EllipsoidValidityChecker

Statuses = ob.PlannerStatus.PlannerStatusType
_OPTIONAL = type(None)


def cspace_of(si: ob.SpaceInformation) -> CSpace:
    """The C-space behind the validity checker of ``si``.

    Raises:
        PlannerError: the checker is not the plug-in's.
    """
    checker = si.getStateValidityChecker()
    if not isinstance(checker, EllipsoidValidityChecker):
        raise PlannerError(
            "HighwayRoadmap needs the plug-in's EllipsoidValidityChecker in its SpaceInformation;"
            " install it with planners.setup.install(si, cspace)"
        )
    return checker.cspace


class HighwayRoadmap(ob.Planner):
    """Plans on layers of free intervals; every motion of its paths is proved free.

    It is built from a `SpaceInformation` that has the plug-in's checker, so the class itself is a
    planner allocator. The direct motion is tried first. The roadmap is kept: later queries on the
    same scene reuse its intervals and proofs until `clear`.

    Parameters are plain attributes, read at every `solve`; see
    ellipsoid_planning.roadmap.parameters.RoadmapParameters for what they mean: ``layers``,
    ``lines``, ``axis``, ``neighbours``, ``inflation``, ``refine``, ``anytime``, ``seed`` and
    ``metric_weight``. Changing one discards the roadmap.

    Attributes:
        error: the traceback of an exception that ended the last solve with CRASH, or None.
    """

    PARAMETERS: ClassVar[dict[str, Any]] = {
        "layers": (int, _OPTIONAL),
        "lines": (int, _OPTIONAL),
        "axis": (int, _OPTIONAL),
        "neighbours": (int, _OPTIONAL),
        "inflation": float,
        "refine": int,
        "anytime": bool,
        "seed": int,
        "metric_weight": (float, int, _OPTIONAL),
    }

    # The values of ``anytime`` whose kernels this process has loaded.
    _warm: ClassVar[set[bool]] = set()

    def __init__(self, si: ob.SpaceInformation) -> None:
        """Create a planner; the scene is looked up in ``si`` when it solves."""
        super().__init__(si, "HighwayRoadmap")
        for name, value in vars(RoadmapParameters()).items():
            setattr(self, name, value)
        self.error: str | None = None
        self._roadmap: highway.HighwayRoadmap | None = None

    def solve(self, ptc: ob.PlannerTerminationCondition | float) -> ob.PlannerStatus:
        """Plan until a path is found, nothing is left to try, or ``ptc`` holds (or seconds passed).

        With ``anytime`` the path is improved until ``ptc`` holds; every better one is added to
        the problem definition. An exception ends the solve with CRASH and is kept in ``error``.
        """
        self.error = None
        if isinstance(ptc, int | float):
            ptc = bindings.stop_after(ptc)
        try:
            return ob.PlannerStatus(self._solve(ptc))
        # An exception that crosses the bindings would end a whole benchmark.
        except Exception:  # noqa: BLE001
            self.error = traceback.format_exc()
            return ob.PlannerStatus(Statuses.CRASH)

    def _solve(self, ptc: ob.PlannerTerminationCondition) -> Any:
        roadmap = self._current()
        access = state_access(roadmap.cspace)
        starts = bindings.start_configurations(self, access)
        if len(starts) == 0:
            return Statuses.INVALID_START
        goals = bindings.goal_configurations(self, access)
        if len(goals) == 0:
            return Statuses.INVALID_GOAL

        def add(path: NDArray[np.float64]) -> None:
            self._add_path(path, access)

        outcome = roadmap.solve(starts, goals, ptc, add)
        if outcome.status == highway.SOLVED:
            return Statuses.EXACT_SOLUTION
        # Exhausted at the finest resolution allowed is no proof that there is no path.
        return Statuses.TIMEOUT

    def _add_path(self, path: NDArray[np.float64], access: StateAccess) -> None:
        solution = bindings.path_from_configurations(self.getSpaceInformation(), path, access)
        self.getProblemDefinition().addSolutionPath(solution, False, 0.0, self.getName())

    def _parameters(self) -> RoadmapParameters:
        return RoadmapParameters(**{name: getattr(self, name) for name in self.PARAMETERS})

    def _current(self) -> highway.HighwayRoadmap:
        """The roadmap of the present scene and parameters, a new one if either has changed."""
        parameters, cspace = self._parameters(), cspace_of(self.getSpaceInformation())
        kept = self._roadmap
        if kept is None or kept.cspace is not cspace or kept.parameters != parameters:
            kept = highway.HighwayRoadmap(cspace, parameters)
            self._roadmap = kept
        return kept

    def setup(self) -> None:
        """Lay out the first level's lines and layers, which depend on no query.

        The first planner of a process also loads the kernels, or compiles them on a machine that
        has not yet run them, which takes about half a minute.
        """
        super().setup()
        if self.anytime not in HighwayRoadmap._warm:
            self.warm_up()
        self._current().prepare()

    @classmethod
    def check_values(cls, values: Mapping[str, Any]) -> None:
        """Check values of parameters as far as that is possible without a scene.

        Raises:
            PlannerError: a value is out of its range.
        """
        RoadmapParameters(**values)

    def check_parameters(self) -> None:
        """Check the present parameters.

        Raises:
            PlannerError: a value is out of its range, or there is no such axis.
        """
        self._current().prepare()

    def clear(self) -> None:
        """Forget the roadmap and the query."""
        super().clear()
        self._roadmap = None

    def clearQuery(self) -> None:  # noqa: N802
        """Forget the query only; the roadmap is kept for the next one."""
        super().clearQuery()

    def warm_up(self) -> None:
        """Compile every kernel that a solve can call, leaving the planner as it was."""
        cspace = cspace_of(self.getSpaceInformation())
        highway.HighwayRoadmap(cspace, self._parameters()).compile_kernels()
        HighwayRoadmap._warm.add(self.anytime)

    @property
    def statistics(self) -> dict[str, Any]:
        """Counts since the last `clear`: levels, layers, lines, intervals, edges, expansions."""
        return {} if self._roadmap is None else dict(self._roadmap.statistics)

    def roadmap_graph(self) -> RoadmapGraph:
        """What has been explored so far as a graph whose edges are proved motions.

        It stands in for OMPL's `getPlannerData`, which aborts the process when it is overridden
        in Python.
        """
        return explored_graph(self._current())
