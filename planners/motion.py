"""Continuous-time motions, certified in one callback."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from ompl import base as ob

from ellipsoid_planning.kernels.articulated_states import UNIT_TOLERANCE
from ellipsoid_planning.kernels.motion import planar_motion_is_free, spatial_motion_is_free

from .articulated_states import articulated_motion_check
from .spaces import check_space, fixed_quaternion, is_articulated

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
    """The fastest way from two states of ``cspace`` to the certificate: numbers into one kernel."""
    if is_articulated(cspace):
        return articulated_motion_check(cspace)
    if cspace.rotates:
        return _check_se2(cspace) if cspace.dimension == 2 else _check_se3(cspace)
    return _check_vector(cspace)


def _check_se2(cspace: CSpace) -> MotionCheck:
    scene, pi = cspace.scene, math.pi

    def check(first: ob.State, second: ob.State) -> bool:
        yaw0, yaw1 = first.getYaw(), second.getYaw()
        if not (-pi <= yaw0 <= pi and -pi <= yaw1 <= pi):
            return False
        x1, y1 = second.getX(), second.getY()
        free: bool = planar_motion_is_free(scene, first.getX(), first.getY(), yaw0, x1, y1, yaw1)
        return free

    return check


def _check_se3(cspace: CSpace) -> MotionCheck:
    scene = cspace.scene
    low, high = 1.0 - UNIT_TOLERANCE, 1.0 + UNIT_TOLERANCE

    def check(first: ob.State, second: ob.State) -> bool:
        p, q = first.rotation(), second.rotation()
        px, py, pz, pw = p.x, p.y, p.z, p.w
        qx, qy, qz, qw = q.x, q.y, q.z, q.w
        if not low <= px * px + py * py + pz * pz + pw * pw <= high:
            return False
        if not low <= qx * qx + qy * qy + qz * qz + qw * qw <= high:
            return False
        x0, y0, z0 = first.getX(), first.getY(), first.getZ()
        x1, y1, z1 = second.getX(), second.getY(), second.getZ()
        free: bool = spatial_motion_is_free(
            scene, x0, y0, z0, px, py, pz, pw, x1, y1, z1, qx, qy, qz, qw
        )
        return free

    return check


def _check_vector(cspace: CSpace) -> MotionCheck:
    scene, planar = cspace.scene, cspace.dimension == 2
    q = fixed_quaternion(cspace)

    def check(first: ob.State, second: ob.State) -> bool:
        z0, z1 = (0.0, 0.0) if planar else (first[2], second[2])
        free: bool = spatial_motion_is_free(
            scene, first[0], first[1], z0, *q, second[0], second[1], z1, *q
        )
        return free

    return check
