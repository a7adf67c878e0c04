"""Motions of articulated robots as rates: what each joint does while s runs from 0 to 1.

The motion is OMPL's interpolation of a compound space: positions and bounded joints linear,
continuous joints and planar headings the shorter way, rotations along the shorter arc.
"""

import math

from .compile import kernel
from .kinematics import (
    BALL,
    CONTINUOUS,
    FRAME_SPIN,
    JOINT_KIND,
    JOINT_PARENT,
    JOINT_TRANSLATION,
    JOINT_VALUE,
    PRISMATIC,
    joint_rows,
)
from .layout import DIMENSION
from .linear import norm, product
from .motion import SMALL_ROTATION, unevenness

# Below this rotation OMPL surely keeps the first orientation until the end, if the squares of both
# quaternions are 1 to within _UNIT: their product then exceeds 1 - 4.5e-10 - 5e-10.
HELD_ROTATION = 6e-5
_UNIT = 5e-10
# From this turn on rounding may decide which way OMPL turns.
_HALF_TURN = math.pi - 1e-8
# A joint's value start + s·rate takes three roundings here, and as many in OMPL.
_VALUE_ROUNDING = 4.0 * 2.220446049250313e-16
# Columns of the bounds on a body's motion: angular rate (signed in the plane), the speed of its
# frame's origin, and how far the rotation [rad] and the origin may be from where a row puts them.
BOUND_SPIN = 0
BOUND_SPEED = 1
BOUND_ANGLE_ERROR = 2
BOUND_PLACE_ERROR = 3
BOUNDS = 4
# Columns of the bounds on a piece: angular rate and its change, what bends the ways of points of
# the body by their distance from its origin, and that origin's acceleration.
LOCAL_RATE = 0
LOCAL_CHANGE = 1
LOCAL_TURN = 2
LOCAL_ACCELERATION = 3
LOCAL = 4


@kernel
def _rotation_rate(first, last, v, rates, at):
    """Write the rotation vector between the quaternions at ``v`` to ``rates``: its angle.

    In the fourth place it writes how far [rad] OMPL's rotation may be from this one at the same s
    (see motion.unevenness).
    """
    rates[at + 3] = unevenness(first, v) + unevenness(last, v)
    x, y, z, w = product(
        last[v], last[v + 1], last[v + 2], last[v + 3],
        -first[v], -first[v + 1], -first[v + 2], first[v + 3],
    )  # fmt: skip
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = norm(x, y, z)
    if sine <= 1e-15 * (sine + w):  # quaternions have any length
        rates[at], rates[at + 1], rates[at + 2] = 0.0, 0.0, 0.0
        return 0.0
    angle = 2.0 * math.atan2(sine, w)
    scale = angle / sine
    rates[at], rates[at + 1], rates[at + 2] = scale * x, scale * y, scale * z
    return angle


@kernel
def _is_surely_held(first, last, v, angle):
    """Whether OMPL surely keeps the first orientation: it depends on the lengths, too."""
    unit = True
    for row in (first, last):
        square = row[v] ** 2 + row[v + 1] ** 2 + row[v + 2] ** 2 + row[v + 3] ** 2
        unit = unit and abs(square - 1.0) <= _UNIT
    return unit and angle <= HELD_ROTATION


@kernel
def set_rates(scene, kinematics, first, last, rates):
    """Write the rates of the motion between two rows: (number of half turns, small, unsure).

    At a half turn rounding decides which way OMPL turns. ``small`` counts the rotations in space
    that OMPL may hold, ``unsure`` those of them for which that is not certain.
    """
    joints = joint_rows(kinematics)
    ties, small, unsure = 0, 0, 0
    for k in range(3):
        rates[k] = last[k] - first[k]
    angle = _rotation_rate(first, last, 3, rates, 3)
    ties += norm(rates[3], rates[4], rates[5]) > _HALF_TURN
    if scene[DIMENSION] == 3.0 and 0.0 < angle < SMALL_ROTATION:
        small += 1
        unsure += not _is_surely_held(first, last, 3, angle)
    for j in range(joints.shape[0]):
        v, kind = int(joints[j, JOINT_VALUE]), int(joints[j, JOINT_KIND])
        if kind == BALL:
            angle = _rotation_rate(first, last, v, rates, v)
            ties += norm(rates[v], rates[v + 1], rates[v + 2]) > _HALF_TURN
            if 0.0 < angle < SMALL_ROTATION:
                small += 1
                unsure += not _is_surely_held(first, last, v, angle)
            continue
        rates[v] = last[v] - first[v]
        if kind == CONTINUOUS:
            if abs(rates[v]) > math.pi:
                rates[v] -= math.copysign(2.0 * math.pi, rates[v])
            ties += abs(rates[v]) > _HALF_TURN
    return ties, small, unsure


@kernel
def _reverse(rates, at):
    """Turn the other way round by the rotation vector at ``at``."""
    angle = norm(rates[at], rates[at + 1], rates[at + 2])
    scale = (angle - 2.0 * math.pi) / angle
    for k in range(3):
        rates[at + k] *= scale


@kernel
def turn_other_way(kinematics, rates):
    """Make whatever turns by half a turn go the other way round: how many there were."""
    joints = joint_rows(kinematics)
    count = 0
    if norm(rates[3], rates[4], rates[5]) > _HALF_TURN:
        _reverse(rates, 3)
        count += 1
    for j in range(joints.shape[0]):
        v, kind = int(joints[j, JOINT_VALUE]), int(joints[j, JOINT_KIND])
        if kind == BALL and norm(rates[v], rates[v + 1], rates[v + 2]) > _HALF_TURN:
            _reverse(rates, v)
            count += 1
        elif kind == CONTINUOUS and abs(rates[v]) > _HALF_TURN:
            rates[v] -= math.copysign(2.0 * math.pi, rates[v])
            count += 1
    return count


@kernel
def keep_rates(kinematics, small, rates):
    """Set to 0 the small rotations in space (or, if not ``small``, everything else)."""
    joints = joint_rows(kinematics)
    tiny = norm(rates[3], rates[4], rates[5]) < SMALL_ROTATION
    for k in range(3):
        if small:
            rates[k] = 0.0
        if tiny != small:
            rates[3 + k] = 0.0
    for j in range(joints.shape[0]):
        v = int(joints[j, JOINT_VALUE])
        if int(joints[j, JOINT_KIND]) != BALL:
            if small:
                rates[v] = 0.0
            continue
        tiny = norm(rates[v], rates[v + 1], rates[v + 2]) < SMALL_ROTATION
        if tiny != small:
            for k in range(3):
                rates[v + k] = 0.0


@kernel
def set_bounds(scene, kinematics, start, rates, with_base, bounds):
    """Write what bounds the motion of each body's points to ``bounds`` (B, BOUNDS).

    A body whose rotation is a product of rotations at constant rates α_k about axes fixed in each
    other's frames turns at a rate of at most w = Σ|α_k|, in the plane w = Σα_k, and its second
    derivative is at most w². Without ``with_base`` the base is held, which changes nothing between
    the robot's own parts.

    The scene's margin covers the rounding of values up to some turns. A joint far from 0 is off by
    its value's own rounding (1e-10 rad at 1e6), which long levers make large: this and uneven
    quaternions are summed up along the way, an angle's error moving all that hangs on it.
    """
    joints = joint_rows(kinematics)
    planar = scene[DIMENSION] == 2.0
    spin, speed, angle_error = 0.0, 0.0, 0.0
    if with_base:
        spin = rates[5] if planar else norm(rates[3], rates[4], rates[5])
        speed = norm(rates[0], rates[1], rates[2])
        angle_error = rates[6]
    bounds[0, BOUND_SPIN], bounds[0, BOUND_SPEED] = spin, speed
    bounds[0, BOUND_ANGLE_ERROR], bounds[0, BOUND_PLACE_ERROR] = angle_error, 0.0
    for j in range(joints.shape[0]):
        p, b = int(joints[j, JOINT_PARENT]), j + 1
        v, kind, t = int(joints[j, JOINT_VALUE]), int(joints[j, JOINT_KIND]), JOINT_TRANSLATION
        spin = bounds[p, BOUND_SPIN]
        arm = norm(joints[j, t], joints[j, t + 1], joints[j, t + 2])
        angle_error, place_error = bounds[p, BOUND_ANGLE_ERROR], bounds[p, BOUND_PLACE_ERROR]
        slide, value_error = 0.0, _VALUE_ROUNDING * (abs(start[v]) + abs(rates[v]))
        if kind == PRISMATIC:
            slide = abs(rates[v])
            arm += max(abs(start[v]), abs(start[v] + rates[v]))
            place_error += value_error
        bounds[b, BOUND_SPEED] = bounds[p, BOUND_SPEED] + abs(spin) * arm + slide
        bounds[b, BOUND_PLACE_ERROR] = place_error + angle_error * arm
        if kind == BALL:
            spin += norm(rates[v], rates[v + 1], rates[v + 2])
            angle_error += rates[v + 3]
        elif kind != PRISMATIC:
            spin += rates[v] if planar else abs(rates[v])
            angle_error += value_error
        bounds[b, BOUND_SPIN], bounds[b, BOUND_ANGLE_ERROR] = spin, angle_error


@kernel
def set_local_bounds(scene, kinematics, start, rates, frames, half, bounds, local):
    """Write sharper bounds for a piece [m − half, m + half] to ``local`` (B, LOCAL).

    ``frames`` are those of m, with velocities. There the angular velocity ω is known, and it
    changes by no more than |ω̇| ≤ Σ|ω_k||α_k|, summed over the joints on the way, ω_k being that of
    the body that joint k hangs on (in the plane not at all). A point at r from the origin of its
    body's frame accelerates by at most a + t|r|, t ≥ |ω̇| + |ω|².
    """
    joints = joint_rows(kinematics)
    planar = scene[DIMENSION] == 2.0
    local[0, LOCAL_RATE], local[0, LOCAL_CHANGE] = abs(bounds[0, BOUND_SPIN]), 0.0
    local[0, LOCAL_TURN], local[0, LOCAL_ACCELERATION] = bounds[0, BOUND_SPIN] ** 2, 0.0
    for j in range(joints.shape[0]):
        p, b = int(joints[j, JOINT_PARENT]), j + 1
        v, kind, t = int(joints[j, JOINT_VALUE]), int(joints[j, JOINT_KIND]), JOINT_TRANSLATION
        arm = norm(joints[j, t], joints[j, t + 1], joints[j, t + 2])
        slide, turn = 0.0, 0.0
        if kind == PRISMATIC:
            slide = abs(rates[v])
            arm += max(abs(start[v]), abs(start[v] + rates[v]))
        elif kind == BALL:
            turn = norm(rates[v], rates[v + 1], rates[v + 2])
        elif not planar:
            turn = abs(rates[v])
        change = local[p, LOCAL_CHANGE] + local[p, LOCAL_RATE] * turn
        s = FRAME_SPIN
        rate = norm(frames[b, s], frames[b, s + 1], frames[b, s + 2]) * (1.0 + 1e-12)
        rate = min(abs(bounds[b, BOUND_SPIN]), rate + change * half)
        local[b, LOCAL_RATE], local[b, LOCAL_CHANGE] = rate, change
        local[b, LOCAL_TURN] = min(change + rate * rate, bounds[b, BOUND_SPIN] ** 2)
        local[b, LOCAL_ACCELERATION] = (
            local[p, LOCAL_ACCELERATION]
            + local[p, LOCAL_TURN] * arm
            + 2.0 * local[p, LOCAL_RATE] * slide
        )
