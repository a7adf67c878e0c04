"""Continuous-time motions, certified in one callback."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from ompl import base as ob

from .spaces import check_space, state_access

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace

MotionCheck = Callable[[ob.State, ob.State], bool]


class CertifiedMotionValidator(ob.MotionValidator):
    """A motion is valid when it is proved free from end to end, not at samples of it.

    The motion is OMPL's own interpolation between two states of the plain space. OMPL's form of
    `checkMotion` with a third argument, the last valid state, reaches this class as the form with
    two, and its third argument stays as the caller set it: planners that would keep the valid
    beginning of a motion (KPIECE1, BKPIECE1) drop such motions instead. The counters of
    the base class stay at 0.

    Attributes:
        cspace: the C-space whose motions are certified.
    """

    def __init__(self, si: ob.SpaceInformation, cspace: CSpace) -> None:
        """Create a validator for the motions of ``si``, which must not be kept (it would leak).

        Raises:
            PlannerError: the space of ``si`` does not fit ``cspace``.
        """
        super().__init__(si)
        check_space(si.getStateSpace(), cspace)
        self.cspace = cspace
        self._check = motion_check(cspace)

    def checkMotion(self, first: ob.State, second: ob.State) -> bool:  # noqa: N802
        """Whether the motion from ``first`` to ``second``, both included, is proved free."""
        return self._check(first, second)


def motion_check(cspace: CSpace) -> MotionCheck:
    """The fastest way from two states of ``cspace`` to the certificate of their motion."""
    read = state_access(cspace).read

    def check(first: ob.State, second: ob.State) -> bool:
        return bool(cspace.is_motion_valid(np.array(read(first)), np.array(read(second))))

    return check
