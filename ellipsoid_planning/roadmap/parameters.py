"""The parameters of the highway roadmap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.numbers_shown import shown
from ellipsoid_planning.roadmap.layer_grids import MOST_LAYERS, check_orientations
from ellipsoid_planning.sizes import MOST_LENGTH, MOST_SEED

MOST_REFINEMENTS = 100
MOST_INFLATION = 1e9
# Name, least and most of the integers that may be left to the planner.
_CHOICES = (
    ("layers", 1, MOST_LAYERS),
    ("lines", 1, 1 << 18),
    ("axis", 0, 2),
    ("neighbours", 1, 1000),
)


@dataclass(frozen=True)
class RoadmapParameters:
    """How fine the roadmap is and how it is searched; None leaves a choice to the planner.

    Attributes:
        layers: orientations of the first level, at most 100,000; 60 in space (the icosahedral
            group), 36 in the plane, 300 for robots with joints.
        lines: sweep lines of the first level along the longest side that they stand across;
            10 in space, 24 in the plane.
        axis: the swept axis, 0 for x; by default the axes take turns at each resolution, the last
            one first.
        neighbours: layers that each layer is joined to, at most 1000; 12 in space, 4 in the
            plane, 20 for robots with joints.
        inflation: weight of the heuristic in the first search, from 1 to 1e9; larger is greedier.
        refine: how many times an exhausted roadmap is replaced by a finer one; 0 for never, at
            most 100.
        anytime: improve the path until the time is over.
        seed: of the orientations of finer levels and of the improvement of paths.
        orientations: {grid: NAME, count: N} or {grid: NAME, resolution_deg: D}: the grid of
            rotations that the first level's layers are (``headings`` in the plane), instead of
            ``layers``; with its own neighbours. Finer levels have finer ones. See
            roadmap.layer_grids; not for robots with joints.
        metric_weight: length that a turn of one radian counts for in the search, in the
            scenario's unit, at most 1e12; half the robot's reach by default.

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
    orientations: Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        for name, least, most in _CHOICES:
            if getattr(self, name) is not None:
                self._check(name, Integral, least, most)
        self._check("refine", Integral, 0, MOST_REFINEMENTS)
        self._check("seed", Integral, 0, MOST_SEED)
        self._check("inflation", Real, 1, MOST_INFLATION)
        if self.metric_weight is not None:
            self._check("metric_weight", Real, 0, MOST_LENGTH)
        if self.orientations is not None:
            check_orientations(self.orientations)
        if not isinstance(self.anytime, bool):
            raise PlannerError(f"anytime: expected true or false, got {self.anytime!r}")

    def _check(self, name: str, kind: type, least: int, most: float) -> None:
        value = getattr(self, name)
        fits = isinstance(value, kind) and not isinstance(value, bool)
        if not fits or not least <= value <= most:
            noun = "an integer" if kind is Integral else "a number"
            reach = (
                f"from {least} to {most}" if isinstance(most, int) else f"from {least} to {most:g}"
            )
            raise PlannerError(f"{name}: expected {noun} {reach}, got {shown(value)}")
        # Kernels are compiled for one type; another would be compiled for while a query waits.
        object.__setattr__(self, name, int(value) if kind is Integral else float(value))

    def layer_count(self, dimension: int, articulated: bool = False) -> int:
        """Layers of the first level in a world of ``dimension``."""
        if articulated:
            return self.layers or 300
        return self.layers or (36 if dimension == 2 else 60)

    def line_count(self, dimension: int) -> int:
        """Sweep lines of the first level along the longest side."""
        return self.lines or (24 if dimension == 2 else 10)

    def neighbour_count(self, dimension: int, articulated: bool = False) -> int:
        """Layers that each layer is joined to."""
        if articulated:
            return self.neighbours or 20
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
