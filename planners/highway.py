"""The highway roadmap as an OMPL planner."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.outcome import Outcome
from ellipsoid_planning.roadmap import highway
from ellipsoid_planning.roadmap.graph import RoadmapGraph, explored_graph
from ellipsoid_planning.roadmap.parameters import RoadmapParameters

from .core_planner import CorePlanner
from .spaces import is_articulated

Array = NDArray[np.float64]
_OPTIONAL = type(None)


class HighwayRoadmap(CorePlanner):
    """Plans on layers of free intervals; every motion of its paths is proved free.

    It is built from a `SpaceInformation` that has the plug-in's checker, so the class itself is a
    planner allocator. The direct motion is tried first. The roadmap is kept: later queries on the
    same scene reuse its intervals and proofs until `clear`. It can also be saved to a file, and
    loaded for the same scene. With ``anytime`` the path is improved until the planner is stopped;
    every better one is added to the problem definition.

    Parameters are plain attributes, read at every `solve`; see
    ellipsoid_planning.roadmap.parameters.RoadmapParameters for what they mean: ``layers``,
    ``lines``, ``axis``, ``neighbours``, ``inflation``, ``refine``, ``anytime``, ``seed``,
    ``metric_weight`` and ``orientations``. Changing one discards the roadmap.

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
        "metric_weight": (float, _OPTIONAL),
        "orientations": (dict, _OPTIONAL),
    }
    PARAMETER_CLASS = RoadmapParameters
    RIGID_ONLY = False

    def new_core(self, cspace: CSpace, parameters: RoadmapParameters) -> highway.HighwayRoadmap:
        """An empty roadmap."""
        return highway.HighwayRoadmap(cspace, parameters)

    def run(
        self,
        starts: Array,
        goals: Array,
        should_stop: Callable[[], bool],
        on_path: Callable[[Array], None],
    ) -> Outcome:
        """Search from ``starts`` (S, d) to ``goals`` (G, d)."""
        outcome: Outcome = self.core().solve(starts, goals, should_stop, on_path)
        return outcome

    def kernels_in_use(self) -> tuple[Any, ...]:
        """Improving a path takes kernels of its own, and articulated robots have theirs."""
        return type(self), self.anytime, is_articulated(self._cspace())

    def check_parameters(self) -> None:
        """Check the present parameters, and lay out the first level, which depends on no query.

        Raises:
            PlannerError: a value is out of its range, or there is no such axis.
        """
        self.core().prepare()

    def save_roadmap(self, path: str | Path) -> None:
        """Write the roadmap to a file, completely or not at all; an older roadmap is replaced.

        Raises:
            RoadmapError: the file cannot be written, or is there already and no roadmap.
            PlannerError: a parameter is out of its range.
        """
        self.core().save(path)

    def load_roadmap(self, path: str | Path) -> None:
        """Go on with the roadmap of a file; it answers as the one that was saved would.

        What came from a file is proved again before it is given out.

        Raises:
            RoadmapError: the file cannot be read, is no roadmap or a damaged one, or belongs to
                another world, robot or clearance, to parameters that make another roadmap, or to
                another version of this package.
            PlannerError: a parameter is out of its range.
        """
        self._core = highway.HighwayRoadmap.load(path, self._cspace(), self._parameters())

    def clearQuery(self) -> None:  # noqa: N802
        """Forget the query only; the roadmap is kept for the next one."""
        # OMPL's own calls `clear`.
        kept = self._core
        super().clearQuery()
        self._core = kept

    def roadmap_graph(self) -> RoadmapGraph:
        """What has been explored so far as a graph whose edges are proved motions.

        It stands in for OMPL's `getPlannerData`, which aborts the process when it is overridden
        in Python.
        """
        return explored_graph(self.core())
