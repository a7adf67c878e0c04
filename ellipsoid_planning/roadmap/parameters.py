"""The parameters of the highway roadmap."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ellipsoid_planning.errors import PlannerError


@dataclass(frozen=True)
class RoadmapParameters:
    """How fine the roadmap is and how it is searched; None leaves a choice to the planner.

    Attributes:
        layers: orientations of the first level; 60 in space (the icosahedral group), 36 in the
            plane.
        lines: sweep lines of the first level along the longest side that they stand across;
            10 in space, 24 in the plane.
        axis: the swept axis, 0 for x; the last one by default.
        neighbours: layers that each layer is joined to; 12 in space, 4 in the plane.
        inflation: weight of the heuristic in the first search, at least 1; larger is greedier.
        refine: how many times an exhausted roadmap is replaced by a finer one; 0 for never.
        anytime: improve the path until the time is over.
        seed: of the orientations of finer levels and of the improvement of paths.
        metric_weight: length that a turn of one radian counts for in the search, in the
            scenario's unit; half the robot's reach by default.

    Raises:
        PlannerError: if a value is out of its range.
    """

    layers: int | None = None
    lines: int | None = None
    axis: int | None = None
    neighbours: int | None = None
    inflation: float = 3.0
    refine: int = 8
    anytime: bool = False
    seed: int = 1
    metric_weight: float | None = None

    def __post_init__(self) -> None:
        for name in ("layers", "lines", "neighbours"):
            value = getattr(self, name)
            if value is not None and value < 1:
                raise PlannerError(f"{name}: expected an integer of at least 1, got {value}")
        if self.refine < 0:
            raise PlannerError(f"refine: expected an integer of at least 0, got {self.refine}")
        if not 1.0 <= self.inflation < math.inf:
            raise PlannerError(f"inflation: expected a number of at least 1, got {self.inflation}")
        weight = self.metric_weight
        if weight is not None and not 0.0 <= weight < math.inf:
            raise PlannerError(f"metric_weight: expected a number of at least 0, got {weight}")

    def layer_count(self, dimension: int) -> int:
        """Orientations of the first level in a world of ``dimension``."""
        return self.layers or (36 if dimension == 2 else 60)

    def line_count(self, dimension: int) -> int:
        """Sweep lines of the first level along the longest side."""
        return self.lines or (24 if dimension == 2 else 10)

    def neighbour_count(self, dimension: int) -> int:
        """Layers that each layer is joined to."""
        return self.neighbours or (4 if dimension == 2 else 12)

    def checked_axis(self, dimension: int) -> int:
        """The swept axis in a world of ``dimension``.

        Raises:
            PlannerError: if the world has no such axis.
        """
        axis = dimension - 1 if self.axis is None else self.axis
        if not 0 <= axis < dimension:
            raise PlannerError(f"axis: expected 0 to {dimension - 1}, got {self.axis}")
        return axis
