"""Refinement of one arrangement: OMPL's RRT around it, least squares, or both."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.phasing.polish import neighbourhood, polish
from ellipsoid_planning.crystal.phasing.trace import Trace
from ellipsoid_planning.errors import CrystalError

from .parameters import Refinement

Array = NDArray[np.float64]

# Least squares that ends beyond this share of its reach goes on from there, so often in all.
EDGE = 0.99
POLISHES = 4


@dataclass(frozen=True, eq=False)
class Refined:
    """An arrangement after its refinement.

    Attributes:
        configuration: (K,), the free arrangement with the lowest cost that was met; where none
            was free, simply the one with the lowest cost.
        cost: its FCF.
        free: whether it is proved free; False only if the start was not.
        trace: what was looked at, in order, the start first.
        rounds: how many trees were grown.
        seconds: that it took.
    """

    configuration: Array
    cost: float
    free: bool
    trace: Trace
    rounds: int
    seconds: float


def refine(cost: FourierCost, start: ArrayLike, parameters: Refinement | None = None) -> Refined:
    """Look for a free arrangement of lower FCF around ``start`` (K,).

    The same input gives the same result.

    Args:
        cost: the Fourier cost, which knows the model.
        start: the arrangement, best a free one; the RRT needs that.
        parameters: how; the defaults if None.

    Raises:
        CrystalError: the RRT is asked for from an arrangement that collides.
        PlannerError: a parameter is out of its range.
        KeyboardInterrupt: SIGINT arrived while a tree grew.
    """
    began = time.perf_counter()
    task = _Task(cost, np.array(start, dtype=float), parameters or Refinement())
    task.run()
    seconds = time.perf_counter() - began
    return Refined(task.best, task.lowest, task.free, task.trace, task.rounds, seconds)


class _Task:
    """The best so far, and the ways to make it better."""

    def __init__(self, cost: FourierCost, start: Array, parameters: Refinement) -> None:
        self._cost, self._parameters = cost, parameters
        self._threshold = parameters.cost_share * cost.norm
        self._reach = neighbourhood(cost.model, parameters.reach, start)
        self._start_is_free = cost.model.is_free(start)
        self._start = start
        self.best, self.lowest, self.free = start, cost.value(start), self._start_is_free
        self.trace = Trace()
        self.trace.add(start, self.lowest)
        self.rounds = 0

    def run(self) -> None:
        if self._parameters.method != "rrt":
            self._polish(self._start)
        if self._parameters.method == "polish" or self._solved:
            return
        if self.free:
            self._grow_trees(self._start if self._start_is_free else self.best)
        elif self._parameters.method == "rrt":
            raise CrystalError(
                "the RRT needs a free arrangement to start from, and this one collides: "
                f"{self._cost.model.values_of(self._start)}; use method polish or both"
            )

    @property
    def _solved(self) -> bool:
        return self.free and self.lowest <= self._threshold

    def _grow_trees(self, root: Array) -> None:
        """Trees in smaller and smaller boxes, each rooted at the best of the one before.

        Least squares branches off from each tree's best, but no tree starts where it ended: that
        may be the bottom of another valley.
        """
        from .tree import grow_tree

        chosen = self._parameters
        for number in range(chosen.rounds):
            reach = self._reach * chosen.shrink**number
            found = grow_tree(
                self._cost, root, reach, chosen.steps, self._threshold, chosen.seed + number
            )
            self.rounds += 1
            root = found[0]
            self._take(*found, free=True)
            if chosen.method == "both" and not self._solved:
                self._polish(root)
            if self._solved:
                return

    def _polish(self, start: Array) -> None:
        """Least squares, again from where it ended as long as that is the edge of its reach."""
        for _ in range(POLISHES):
            found = polish(self._cost, start, self._reach)
            if self._start_is_free and not found.free:
                return
            self._take(found.configuration, found.cost, found.trace, found.free)
            away = np.abs(found.configuration - start)
            if not np.any((away >= EDGE * self._reach) & (self._reach > 0.0)):
                return
            start = found.configuration

    def _take(self, configuration: Array, value: float, trace: Trace, free: bool) -> None:
        """Keep an arrangement if it is better: free ones are better than all that collide."""
        self.trace.extend(trace)
        if (not free, value) < (not self.free, self.lowest):
            self.best, self.lowest, self.free = configuration, value, free
