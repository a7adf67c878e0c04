"""Arrangements as OMPL sees them: points of a box, free or not, with FCF as distance to the goal.

The box is [-1, 1]^K around a candidate, so that angles and lengths weigh alike.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.trace import Trace
from planners.spaces import StateAccess, write_vector

Array = NDArray[np.float64]
Arrangement = Callable[[ob.State], Array]

# A step that finds this many arrangements blocked in a row is hopeless.
CHECKS_PER_STEP = 200


class Box:
    """The neighbourhood of a configuration, and its states.

    Attributes:
        centre: (K,), the configuration in the middle.
        reach: (K,), how far it goes along each coordinate; more than 0.
        access: reads and writes states of its space.
    """

    def __init__(self, centre: Array, reach: Array) -> None:
        self.centre, self.reach = centre, reach
        self.access = StateAccess(len(centre), self._read, write_vector)

    def _read(self, state: ob.State) -> tuple[float, ...]:
        return tuple(state[0 : len(self.centre)])

    def configuration(self, state: ob.State) -> Array:
        """The configuration (K,) of a state."""
        return self.centre + self.reach * self._read(state)

    def space(self) -> ob.RealVectorStateSpace:
        """Its OMPL space."""
        space = ob.RealVectorStateSpace(len(self.centre))
        bounds = ob.RealVectorBounds(len(self.centre))
        bounds.setLow(-1.0)
        bounds.setHigh(1.0)
        space.setBounds(bounds)
        return space


class Budget:
    """Ends a solve after so many costs, by the condition that the solve was given.

    Counted, not timed, so that the same seed gives the same tree.
    """

    def __init__(self, costs: int, condition: ob.PlannerTerminationCondition) -> None:
        self._costs, self._checks = costs, costs * CHECKS_PER_STEP
        self._condition = condition

    def one_cost(self) -> None:
        """A cost was computed."""
        self._costs -= 1
        if self._costs <= 0:
            self._condition.terminate()

    def one_check(self) -> None:
        """A state was checked."""
        self._checks -= 1
        if self._checks <= 0:
            self._condition.terminate()


class FreeArrangements(ob.StateValidityChecker):
    """Valid: all copies of the molecule are proved apart."""

    def __init__(
        self, si: ob.SpaceInformation, model: PackingModel, box: Box, budget: Budget
    ) -> None:
        """Create a checker for states of ``box``; ``si`` is not kept."""
        super().__init__(si)
        self._model, self._box, self._budget = model, box, budget

    def isValid(self, state: ob.State) -> bool:  # noqa: N802
        """Whether the arrangement of ``state`` is free."""
        self._budget.one_check()
        return self._model.is_free(self._box.configuration(state))


class LowCost(ob.GoalRegion):
    """The goal: FCF at most a threshold. OMPL's RRT remembers the state that is nearest to it.

    A goal written in Python is safe here because RRT runs in one thread.

    Attributes:
        trace: every arrangement whose cost was asked for.
    """

    def __init__(
        self,
        si: ob.SpaceInformation,
        cost: FourierCost,
        box: Box,
        threshold: float,
        budget: Budget,
    ) -> None:
        """Create the goal region of costs up to ``threshold``."""
        super().__init__(si)
        self.setThreshold(threshold)
        self._cost, self._box, self._budget = cost, box, budget
        self.trace = Trace()

    def distanceGoal(self, state: ob.State) -> float:  # noqa: N802
        """FCF of the arrangement of ``state``."""
        configuration = self._box.configuration(state)
        value = self._cost.value(configuration)
        self.trace.add(configuration, value)
        self._budget.one_cost()
        return value
