"""RRT-Connect on free intervals and proved motions as an OMPL planner."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.outcome import Outcome
from ellipsoid_planning.trees import connect
from ellipsoid_planning.trees.parameters import TreeParameters

from .core_planner import CorePlanner

Array = NDArray[np.float64]
_OPTIONAL = type(None)


class FreeIntervalRRTConnect(CorePlanner):
    """RRT-Connect that draws free states only and extends its trees by proved motions.

    The direct motion is tried first. Two trees then grow towards free states, drawn from the free
    intervals of random lines, and towards each other. A solve that was stopped goes on with its
    trees when it is called again; other starts or goals, `clear` and `clearQuery` begin new ones.
    It never finds out that there is no path: then it runs until it is stopped.

    Parameters are plain attributes, read at every `solve`; see
    ellipsoid_planning.trees.parameters.TreeParameters for what they mean: ``range``,
    ``halvings``, ``uniform``, ``gate_share``, ``anytime``, ``seed`` and ``metric_weight``.

    Attributes:
        seeds: poses (P, 7), say in narrow places, that are tried as samples; they need not be
            free. None for no such poses.
    """

    PARAMETERS: ClassVar[dict[str, Any]] = {
        "range": (float, _OPTIONAL),
        "halvings": int,
        "uniform": float,
        "gate_share": float,
        "anytime": bool,
        "seed": int,
        "metric_weight": (float, _OPTIONAL),
    }
    PARAMETER_CLASS = TreeParameters

    def __init__(self, si: ob.SpaceInformation) -> None:
        """Create a planner; the scene is looked up in ``si`` when it solves."""
        super().__init__(si)
        self.seeds: Array | None = None

    def new_core(
        self, cspace: CSpace, parameters: TreeParameters
    ) -> connect.FreeIntervalRRTConnect:
        """Two trees that have not been planted."""
        return connect.FreeIntervalRRTConnect(cspace, parameters)

    def run(
        self,
        starts: Array,
        goals: Array,
        should_stop: Callable[[], bool],
        on_path: Callable[[Array], None],
    ) -> Outcome:
        """Grow trees from ``starts`` (S, d) and ``goals`` (G, d)."""
        outcome: Outcome = self.core().solve(starts, goals, should_stop, on_path, self.seeds)
        return outcome

    def clearQuery(self) -> None:  # noqa: N802
        """Forget the query and its trees."""
        super().clearQuery()
        if self._core is not None:
            self._core.clear_query()

    def tree_edges(self) -> tuple[Array, Array]:
        """First and last configurations (k, d) of the trees' edges, proved motions all.

        They stand in for OMPL's `getPlannerData`, which aborts the process when it is overridden
        in Python.
        """
        edges: tuple[Array, Array] = self.core().edges()
        return edges
