"""States of articulated robots as planners hold them, checked and decided in one call.

A *state* is a configuration (d,): the base's values, then the joints'. A *form* is a flat array
that tells how a state becomes a row of the kernels (see kernels.kinematics): the kind of base, the
base's pose (7,) where it does not vary, the number of angles and their places in a state, the
number of quaternions and theirs.

States are taken as they are: an angle outside [-pi, pi] or a quaternion whose square differs from
1 by more than 1e-9 makes them invalid, because OMPL's motions misbehave there.
"""

import math

import numpy as np

from .articulated_motion import articulated_motion_is_free
from .articulated_validity import articulated_is_free
from .compile import kernel

BASE = 0
POSE = 1
ANGLES = 8

FIXED = 0
TRANSLATING_2D = 1
TRANSLATING_3D = 2
FREE_2D = 3
FREE_3D = 4
BASE_VALUES = (0, 2, 3, 3, 7)

UNIT_TOLERANCE = 1e-9


@kernel
def is_well_formed(form, state):
    """Whether every angle of a state lies in [-pi, pi] and every quaternion has unit length."""
    at = ANGLES + 1
    for k in range(int(form[ANGLES])):
        angle = state[int(form[at + k])]
        if not (angle >= -math.pi and angle <= math.pi):
            return False
    at += int(form[ANGLES])
    for k in range(int(form[at])):
        first = int(form[at + 1 + k])
        square = 0.0
        for m in range(first, first + 4):
            square += state[m] * state[m]
        if not abs(square - 1.0) <= UNIT_TOLERANCE:
            return False
    return True


@kernel
def row_of_state(form, state):
    """The row (7 + V,) of a state (d,)."""
    kind = int(form[BASE])
    size = BASE_VALUES[kind]
    row = np.empty(7 + state.size - size)
    for k in range(7):
        row[k] = form[POSE + k]
    if kind == FREE_3D:
        for k in range(7):
            row[k] = state[k]
    elif kind == FREE_2D:
        row[0], row[1] = state[0], state[1]
        row[5], row[6] = math.sin(0.5 * state[2]), math.cos(0.5 * state[2])
    else:
        for k in range(size):
            row[k] = state[k]
    for k in range(size, state.size):
        row[7 + k - size] = state[k]
    return row


@kernel
def state_is_free(scene, kinematics, form, states):
    """Whether a state (1, d) is well formed and proved free."""
    if not is_well_formed(form, states[0]):
        return False
    return articulated_is_free(scene, kinematics, row_of_state(form, states[0]))


@kernel
def motion_of_states_is_free(scene, kinematics, form, states):
    """Whether two states (2, d) are well formed, and the motion between them proved free."""
    if not (is_well_formed(form, states[0]) and is_well_formed(form, states[1])):
        return False
    first, last = row_of_state(form, states[0]), row_of_state(form, states[1])
    return articulated_motion_is_free(scene, kinematics, first, last)
