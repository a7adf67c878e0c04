"""How arrangements are refined, and when one is good enough."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from ellipsoid_planning.errors import PlannerError

Method = Literal["polish", "rrt", "both"]
EXACT, TREES_ALONE = 1e-6, 0.02
METHODS: tuple[Method, ...] = get_args(Method)


@dataclass(frozen=True)
class Refinement:
    """The parameters of refinement, for one candidate and for the loop over candidates.

    Attributes:
        method: "polish", least squares on the magnitudes; "rrt", OMPL's RRT as in the thesis;
            "both", least squares first, and for candidates that it leaves above the threshold
            the RRT, whose every round ends in least squares.
        threshold: the cost C that is low enough, as a share of the cost of an empty cell; by
            default 1e-6 where least squares ends the search, 0.02 for trees alone. Exact
            magnitudes can be met to rounding; measured ones cannot.
        reach: how many steps of the model's grid an arrangement may move to either side at a time:
            a tree, or least squares, which goes on when it ends at the edge.
        rounds: trees one after another, each rooted at the best so far.
        steps: arrangements that join a tree.
        trees: with method "both", for how many of the candidates, the best ones, trees are grown
            when least squares has solved none; the thesis keeps ten.
        shrink: what the reach is multiplied by from one round to the next.
        seed: of the RRT.

    Raises:
        PlannerError: a value is out of its range; says which.
    """

    method: Method = "both"
    threshold: float | None = None
    reach: float = 2.0
    rounds: int = 6
    steps: int = 300
    trees: int = 10
    shrink: float = 0.6
    seed: int = 1

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise PlannerError(f"method: expected {', '.join(METHODS)}, got {self.method!r}")
        for name in ("rounds", "steps", "trees"):
            if type(value := getattr(self, name)) is not int or value < 1:
                raise PlannerError(f"{name}: expected an integer of 1 or more, got {value!r}")
        for name in ("cost_share", "reach", "shrink"):
            if not (math.isfinite(value := getattr(self, name)) and value > 0.0):
                shown = "threshold" if name == "cost_share" else name
                raise PlannerError(f"{shown}: expected a positive number, got {value!r}")
        if self.shrink > 1.0:
            raise PlannerError(f"shrink: expected at most 1, got {self.shrink!r}")
        if type(self.seed) is not int or not 0 <= self.seed < 2**32 - self.rounds:
            raise PlannerError(
                f"seed: expected an integer from 0 to {2**32 - self.rounds - 1}, got {self.seed!r}"
            )

    @property
    def cost_share(self) -> float:
        """The threshold in use."""
        if self.threshold is None:
            return TREES_ALONE if self.method == "rrt" else EXACT
        return self.threshold
