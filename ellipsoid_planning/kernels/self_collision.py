"""Parts of a robot against each other: boxes sorted along x, then the pairs that are left."""

import numpy as np

from .compile import inlined, kernel
from .kinematics import SHAPE_INVERSE, SHAPE_MATRIX, owners_of, pair_matrix, shape_rows
from .layout import (
    BODY,
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_MATRIX,
    PART_RADIUS,
    PLACED_CENTRE,
    PLACED_EXTENT,
    ROUNDING,
    SCALE,
    part_rows,
)
from .separation import DECIDE, separation


@kernel
def new_body():
    """Room for one part as an obstacle, shape (1, BODY)."""
    return np.empty((1, BODY))


@kernel
def as_body(shapes, i, frame, placed, body):
    """Write placed part ``i``, whose own body has ``frame``, as an obstacle to ``body[0]``."""
    for k in range(3):
        body[0, BODY_CENTRE + k] = placed[i, PLACED_CENTRE + k]
        a, b, c = frame[3 * k], frame[3 * k + 1], frame[3 * k + 2]
        for m in range(3):
            s = SHAPE_MATRIX + m
            body[0, BODY_MATRIX + 3 * k + m] = (
                a * shapes[i, s] + b * shapes[i, s + 3] + c * shapes[i, s + 6]
            )
            # A⁻¹Rᵀ
            s = SHAPE_INVERSE + 3 * m
            body[0, BODY_INVERSE + 3 * m + k] = (
                shapes[i, s] * a + shapes[i, s + 1] * b + shapes[i, s + 2] * c
            )


@kernel
def sort_along_x(placed, order):
    """Sort the part numbers in ``order`` (P,) by where their boxes begin (Shell's sort).

    The order of an earlier call is a good beginning.
    """
    count = order.shape[0]
    step = 1
    while step < count // 3:
        step = 3 * step + 1
    while step > 0:
        for k in range(step, count):
            item = order[k]
            low = placed[item, PLACED_CENTRE] - placed[item, PLACED_EXTENT]
            m = k
            while m >= step:
                other = order[m - step]
                if placed[other, PLACED_CENTRE] - placed[other, PLACED_EXTENT] <= low:
                    break
                order[m] = other
                m -= step
            order[m] = item
        step //= 3


@inlined
def boxes_meet(placed, i, j, room):
    """Whether the boxes of two placed parts, grown by ``room`` in all, meet in y and z."""
    meet = True
    for k in range(1, 3):
        away = abs(placed[i, PLACED_CENTRE + k] - placed[j, PLACED_CENTRE + k])
        reach = placed[i, PLACED_EXTENT + k] + placed[j, PLACED_EXTENT + k] + room
        meet = meet and away <= reach
    return meet


@kernel
def parts_meet(shapes, owners, frames, parts, placed, i, j, required, body):
    """Whether the two placed parts are not proved to be ``required`` apart."""
    as_body(shapes, i, frames[int(owners[i])], placed, body)
    lam = parts[i, PART_RADIUS] / (parts[i, PART_RADIUS] + parts[j, PART_RADIUS])
    value = separation(body, 0, placed, j, lam, required, DECIDE)[0]
    return not value > required


@kernel
def first_self_contact(scene, kinematics, frames, placed, order, body):
    """The first pair of parts found that may not meet and is not proved apart, or (−1, −1)."""
    parts, pairs = part_rows(scene), pair_matrix(kinematics)
    shapes, owners = shape_rows(kinematics), owners_of(kinematics)
    required = 2.0 * ROUNDING * scene[SCALE]
    sort_along_x(placed, order)
    for a in range(order.shape[0]):
        i = order[a]
        high = placed[i, PLACED_CENTRE] + placed[i, PLACED_EXTENT] + required
        for b in range(a + 1, order.shape[0]):
            j = order[b]
            if placed[j, PLACED_CENTRE] - placed[j, PLACED_EXTENT] > high:
                break
            if pairs[i, j] == 0.0 or not boxes_meet(placed, i, j, required):
                continue
            if parts_meet(shapes, owners, frames, parts, placed, i, j, required, body):
                return i, j
    return -1, -1


@kernel
def new_order(kinematics):
    """The parts in the order of their numbers, shape (P,)."""
    return np.arange(owners_of(kinematics).shape[0])
