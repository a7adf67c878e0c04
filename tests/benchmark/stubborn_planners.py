"""Planners that misbehave, each in its own way; a benchmark must survive them all."""

import os
import time

import numpy as np
from ompl import base as ob

from planners import bindings
from planners.core_planner import cspace_of
from planners.spaces import state_access

Statuses = ob.PlannerStatus.PlannerStatusType


class Stubborn(ob.Planner):
    """A planner whose `solve` calls `misbehave`."""

    NEEDS_PLUGIN = True

    def __init__(self, si):
        super().__init__(si, type(self).__name__)

    def solve(self, ptc):
        return ob.PlannerStatus(self.misbehave(ptc))

    def misbehave(self, ptc):
        """Whatever it is that this planner does wrong."""
        raise NotImplementedError


class Hanging(Stubborn):
    def misbehave(self, _):
        while True:
            pass


class Aborting(Stubborn):
    def misbehave(self, _):
        os.abort()


class Raising(Stubborn):
    def misbehave(self, _):
        raise ZeroDivisionError("no way out")


class Hoarding(Stubborn):
    def misbehave(self, _):
        hoard = []
        while True:
            hoard.append(np.ones(2**20))
            time.sleep(0.01)


class Leaving(Stubborn):
    def misbehave(self, _):
        os._exit(3)


class Quitting(Stubborn):
    def misbehave(self, _):
        os._exit(0)


class Lying(Stubborn):
    """Reports the straight way to the goal, whatever stands in it."""

    def misbehave(self, _):
        si = self.getSpaceInformation()
        access = state_access(cspace_of(si))
        ends = [f(self, access)[0] for f in (_starts, _goals)]
        path = bindings.path_from_configurations(si, np.array(ends), access)
        self.getProblemDefinition().addSolutionPath(path, False, 0.0, self.getName())
        return Statuses.EXACT_SOLUTION


class Sleeping(Stubborn):
    """Takes its time and finds nothing."""

    def misbehave(self, ptc):
        while not ptc():
            time.sleep(0.01)
        return Statuses.TIMEOUT


_starts = bindings.start_configurations
_goals = bindings.goal_configurations
