"""Drawing free configurations of articulated robots.

Everything but the base's position is drawn at random; if the robot then keeps its parts apart, the
free intervals of a line are computed for it, and one is drawn from. A fixed base leaves nothing to
compute: whole configurations are drawn and tested.

Random numbers come in as a table of uniforms in [0, 1), one row an attempt: those of
kernels.sampling, one for the base's rotation, and four for each joint.
"""

import math

import numpy as np

from .articulated_validity import row_is_free
from .compile import kernel
from .kinematics import (
    BALL,
    CONTINUOUS,
    JOINT_HIGH,
    JOINT_KIND,
    JOINT_LOW,
    JOINT_VALUE,
    JOINT_WEIGHT,
    joint_rows,
    new_frames,
    place_robot,
)
from .layout import (
    ARENA_COUNT,
    OBSTACLE_COUNT,
    PART_COUNT,
    new_placed,
    part_rows,
)
from .linear import product
from .lines import CAPACITY
from .sampling import NUMBERS, PLANAR, SPATIAL, draw_position, random_rotation, random_turn
from .self_collision import first_self_contact, new_body, new_order
from .whitening import WHITEN

# Kinds of base beside those of kernels.sampling: FIXED is a base that only translates there.
IMMOBILE = 3

BASE_NUMBERS = NUMBERS + 1
JOINT_NUMBERS = 4


@kernel
def _draw_joint(joint, near, room, numbers, row):
    """Write one joint's value, within ``room`` of that in ``near`` if it is not negative."""
    kind, v = int(joint[JOINT_KIND]), int(joint[JOINT_VALUE])
    reach = math.inf
    if room >= 0.0 and joint[JOINT_WEIGHT] > 0.0:
        reach = room / joint[JOINT_WEIGHT]
    if kind == BALL:
        if reach >= 0.5 * math.pi:
            q = random_rotation(numbers[0], numbers[1], numbers[2])
        else:
            turn = random_turn(numbers[0], numbers[1], numbers[2], reach)
            q = product(*turn, near[v], near[v + 1], near[v + 2], near[v + 3])
        row[v], row[v + 1], row[v + 2], row[v + 3] = q
        return
    low, high = joint[JOINT_LOW], joint[JOINT_HIGH]
    if kind != CONTINUOUS:
        low, high = max(low, near[v] - reach), min(high, near[v] + reach)
    elif reach < math.pi:
        low, high = near[v] - reach, near[v] + reach
    value = min(low + numbers[0] * (high - low), high)  # rounding may go beyond
    if kind == CONTINUOUS and abs(value) > math.pi:
        value -= math.copysign(2.0 * math.pi, value)
    row[v] = value


@kernel
def draw_turns(joints, kind, near, distance, numbers, row):
    """Write everything of a row but its position, and return the distance left for that.

    The distance is split at random between position, base and joints (all splits alike).
    """
    share, total = 0.0, 0.0
    if distance >= 0.0:
        share = -math.log(1.0 - numbers[8])
        total = share
        if kind in (PLANAR, SPATIAL):
            total -= math.log(1.0 - numbers[9])
        for j in range(joints.shape[0]):
            total -= math.log(1.0 - numbers[BASE_NUMBERS + JOINT_NUMBERS * j + 3])
    unit = distance / total if total > 0.0 else distance
    q = (near[3], near[4], near[5], near[6])
    room = -unit * math.log(1.0 - numbers[9])
    if kind == SPATIAL:
        if distance < 0.0:
            q = random_rotation(numbers[0], numbers[1], numbers[2])
        else:
            turn = random_turn(numbers[0], numbers[1], numbers[2], room)
            q = product(*turn, *q)
    elif kind == PLANAR:
        # SE(2) weighs a heading's change by 1/2.
        half = math.pi * (numbers[0] - 0.5)
        if distance >= 0.0:
            half = min(room, 0.5 * math.pi) * (2.0 * numbers[0] - 1.0)
            q = product(0.0, 0.0, math.sin(half), math.cos(half), *q)
        else:
            q = (0.0, 0.0, math.sin(half), math.cos(half))
    row[3], row[4], row[5], row[6] = q
    for j in range(joints.shape[0]):
        first = BASE_NUMBERS + JOINT_NUMBERS * j
        own = numbers[first : first + JOINT_NUMBERS]
        room = -1.0 if distance < 0.0 else -unit * math.log(1.0 - own[3])
        _draw_joint(joints[j], near, room, own, row)
    return -1.0 if distance < 0.0 else unit * share


@kernel
def draw_articulated(scene, kinematics, kind, near, distance, uniform, numbers, out):
    """Write a free row (7 + V,) to ``out``; False if every attempt was refused.

    ``kind`` is the base's: that of kernels.sampling, or IMMOBILE. ``distance`` < 0 draws from the
    whole space, else within that distance of the row ``near`` in OMPL's metric; ``near`` also gives
    what does not vary. ``uniform`` makes the draw exactly uniform, see kernels.sampling.
    """
    joints, parts = joint_rows(kinematics), part_rows(scene)
    pairs = max(1, int(scene[PART_COUNT] * (scene[OBSTACLE_COUNT] + scene[ARENA_COUNT])))
    rows = min(pairs, 64)
    table, keys = np.empty((rows, WHITEN)), np.empty(rows, np.int64)
    scratch, intervals = np.empty((1, 9)), np.empty((CAPACITY, 2))
    frames, placed = new_frames(kinematics), new_placed(scene)
    order, body = new_order(kinematics), new_body()
    point = np.zeros(3)
    for attempt in range(numbers.shape[0]):
        row = numbers[attempt]
        room = draw_turns(joints, kind, near, distance, row, out)
        if kind == IMMOBILE:
            out[0], out[1], out[2] = near[0], near[1], near[2]
            if row_is_free(scene, kinematics, out, frames, placed, order, body):
                return True
            continue
        out[0], out[1], out[2] = 0.0, 0.0, 0.0
        place_robot(parts, kinematics, out, frames, placed)
        if first_self_contact(scene, kinematics, frames, placed, order, body)[0] >= 0:
            continue
        if draw_position(
            scene, placed, near, distance >= 0.0, room, uniform, row, table, keys, scratch,
            intervals, point, out,
        ):  # fmt: skip
            return True
    return False
