"""The parameters of the tree planner."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral, Real

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.numbers_shown import shown
from ellipsoid_planning.sizes import LEAST_LENGTH, MOST_LENGTH, MOST_SEED

MOST_HALVINGS = 50


@dataclass(frozen=True)
class TreeParameters:
    """How the trees are grown; None leaves a choice to the planner.

    Attributes:
        range: longest extension at once, in the metric of ``metric_weight``; any length by
            default, for a proof costs about the same whatever the motion's length.
        halvings: how many pieces of a motion that is refused are tried, each half as much shorter
            or longer than the one before.
        uniform: fraction of the samples that are uniform on free space; the others favour places
            that are narrow along a line.
        gate_share: fraction of the samples that are poses in narrow passages, found at saddle
            points of clearance, or given from outside; 0 looks for none.
        anytime: improve the path until the time is over.
        seed: of the samples, and of the improvement of paths.
        metric_weight: length that a turn of one radian counts for, in the scenario's unit; half
            the robot's reach by default.

    Raises:
        PlannerError: if a value is out of its range.
    """

    range: float | None = None
    halvings: int = 3
    uniform: float = 0.2
    gate_share: float = 0.2
    anytime: bool = False
    seed: int = 1
    metric_weight: float | None = None

    def __post_init__(self) -> None:
        if self.range is not None:
            wanted = f"a number from {LEAST_LENGTH:g} to {MOST_LENGTH:g}"
            self._check("range", Real, LEAST_LENGTH, MOST_LENGTH, wanted)
        self._check("halvings", Integral, 0, MOST_HALVINGS, f"an integer from 0 to {MOST_HALVINGS}")
        for name in ("uniform", "gate_share"):
            self._check(name, Real, 0, 1, "a number from 0 to 1")
        self._check("seed", Integral, 0, MOST_SEED, f"an integer from 0 to {MOST_SEED}")
        if self.metric_weight is not None:
            wanted = f"a number from 0 to {MOST_LENGTH:g}"
            self._check("metric_weight", Real, 0, MOST_LENGTH, wanted)
        if not isinstance(self.anytime, bool):
            raise PlannerError(f"anytime: expected true or false, got {self.anytime!r}")

    def _check(self, name: str, kind: type, least: float, most: float, wanted: str) -> None:
        value = getattr(self, name)
        fits = isinstance(value, kind) and not isinstance(value, bool)
        if not fits or not least <= value <= most:
            raise PlannerError(f"{name}: expected {wanted}, got {shown(value)}")
        # Kernels are compiled for one type; another would be compiled for while a query waits.
        object.__setattr__(self, name, int(value) if kind is Integral else float(value))
