"""Exact validity of states, for any OMPL planner."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from ompl import base as ob

from ellipsoid_planning.kernels.articulated_states import UNIT_TOLERANCE
from ellipsoid_planning.kernels.validity import configuration_is_free, planar_is_free

from .articulated_states import articulated_state_check, tabulated_state_check
from .spaces import check_space, fixed_quaternion, is_articulated, read_configuration

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.safety.tabulated import TabulatedSafety

StateCheck = Callable[[ob.State], bool]


class EllipsoidValidityChecker(ob.StateValidityChecker):
    """Valid: provably free, at the required clearance, inside every arena and the bounds.

    An articulated robot also keeps its joints' limits and its parts apart from each other. A
    heading (or value of a continuous joint) outside [-pi, pi] or a quaternion with
    | |q|^2 - 1 | > 1e-9 is invalid as well: OMPL's motions misbehave there.

    Attributes:
        cspace: the C-space; planners reach it through ``si.getStateValidityChecker().cspace``.
    """

    def __init__(self, si: ob.SpaceInformation, cspace: CSpace) -> None:
        """Create a checker for the states of ``si``, which is not kept.

        Raises:
            PlannerError: the space of ``si`` does not fit ``cspace``.
        """
        super().__init__(si)
        check_space(si.getStateSpace(), cspace)
        self.cspace = cspace
        self._check = state_check(cspace)

    def isValid(self, state: ob.State) -> bool:  # noqa: N802
        """Whether ``state`` is valid."""
        return self._check(state)

    def clearance(self, state: ob.State) -> float:
        """Signed distance to obstacles and arena boundaries, see `CSpace.clearance`."""
        return float(self.cspace.clearance(read_configuration(state, self.cspace)))


class TabulatedValidityChecker(EllipsoidValidityChecker):
    """The same answers from a tabulated safety function (thesis 6.4).

    Attributes:
        safety: the safety function.
    """

    def __init__(self, si: ob.SpaceInformation, safety: TabulatedSafety) -> None:
        """Create a checker for the states of ``si``, which is not kept.

        Raises:
            PlannerError: the space of ``si`` does not fit the C-space of ``safety``.
        """
        super().__init__(si, safety.cspace)
        self.safety = safety
        self._check = tabulated_state_check(safety)


def state_check(cspace: CSpace) -> StateCheck:
    """The fastest way from a state of ``cspace`` to its validity: its numbers into one kernel."""
    if is_articulated(cspace):
        return articulated_state_check(cspace)
    if cspace.rotates:
        return _check_se2(cspace) if cspace.dimension == 2 else _check_se3(cspace)
    return _check_vector(cspace)


def _check_se2(cspace: CSpace) -> StateCheck:
    scene, pi = cspace.scene, math.pi

    def check(state: ob.State) -> bool:
        yaw = state.getYaw()
        if not -pi <= yaw <= pi:
            return False
        free: bool = planar_is_free(scene, state.getX(), state.getY(), yaw)
        return free

    return check


def _check_se3(cspace: CSpace) -> StateCheck:
    scene = cspace.scene
    low, high = 1.0 - UNIT_TOLERANCE, 1.0 + UNIT_TOLERANCE

    def check(state: ob.State) -> bool:
        q = state.rotation()
        qx, qy, qz, qw = q.x, q.y, q.z, q.w
        if not low <= qx * qx + qy * qy + qz * qz + qw * qw <= high:
            return False
        x, y, z = state.getX(), state.getY(), state.getZ()
        free: bool = configuration_is_free(scene, x, y, z, qx, qy, qz, qw)
        return free

    return check


def _check_vector(cspace: CSpace) -> StateCheck:
    scene, planar = cspace.scene, cspace.dimension == 2
    qx, qy, qz, qw = fixed_quaternion(cspace)

    def check(state: ob.State) -> bool:
        z = 0.0 if planar else state[2]
        free: bool = configuration_is_free(scene, state[0], state[1], z, qx, qy, qz, qw)
        return free

    return check
