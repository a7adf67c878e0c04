"""How much of many sweep lines is free: the sums that the free fraction is estimated from.

A layer is looked at along ``lines`` parallel lines, evenly spread over the box that its arenas
leave for the base and moved together by a random shift. Rotation, joint values and shift come from
points of an additive sequence, one a layer, which several copies shift at random: point k of copy
r has the coordinates frac(shift[r] + k · step). Each copy's mean is an unbiased estimate of the
free fraction, and the copies are independent.
"""

import math

import numpy as np

from .articulated_sampling import IMMOBILE, draw_turns
from .articulated_validity import row_is_free
from .compile import kernel
from .kinematics import joint_rows, new_frames, place_robot
from .layout import (
    ARENA_COUNT,
    BODY_CENTRE,
    BODY_EXTENT,
    DIMENSION,
    HIGH,
    LOW,
    OBSTACLE_COUNT,
    PART_COUNT,
    PLACED_CENTRE,
    PLACED_EXTENT,
    arena_rows,
    new_placed,
    part_rows,
)
from .lines import CAPACITY, free_intervals
from .placement import place
from .sampling import PLANAR, SPATIAL, random_rotation
from .self_collision import first_self_contact, new_body, new_order
from .whitening import WHITEN

_ROWS = 4096
_INTERVALS = 4096


@kernel
def _new_cache(scene):
    """Whitening table, its keys, scratch, intervals, and the box of a layer."""
    pairs = int(scene[PART_COUNT] * (scene[OBSTACLE_COUNT] + scene[ARENA_COUNT]))
    rows = min(max(pairs, 1), _ROWS)
    room = min(max(pairs + 2, CAPACITY), _INTERVALS)
    return (
        np.empty((rows, WHITEN)),
        np.empty(rows, np.int64),
        np.empty((1, 9)),
        np.empty((room, 2)),
        np.empty((3, 2)),
    )


@kernel
def _layer_box(scene, placed, box):
    """Write the box (3, 2) that holds every base position inside all arenas; its share.

    The share is of the bounds' volume, 0 if there is no room. ``placed`` has the base at 0.
    """
    arenas, share = arena_rows(scene), 1.0
    for k in range(int(scene[DIMENSION])):
        low, high = scene[LOW + k], scene[HIGH + k]
        for j in range(arenas.shape[0]):
            for i in range(placed.shape[0]):
                centre = arenas[j, BODY_CENTRE + k] - placed[i, PLACED_CENTRE + k]
                half = arenas[j, BODY_EXTENT + k] - placed[i, PLACED_EXTENT + k]
                low, high = max(low, centre - half), min(high, centre + half)
        box[k, 0], box[k, 1] = low, high
        share *= max(0.0, high - low) / (scene[HIGH + k] - scene[LOW + k])
    return share


@kernel
def _layer_share(scene, placed, lines, step, first, second, cache):
    """The estimated free fraction of a layer, of the bounds' volume.

    Lines run along the longest side of its box. Across it they form the lattice of points
    (l / lines, l · step) shifted by (``first``, ``second``), modulo 1; in the plane its first
    coordinate alone.
    """
    table, keys, scratch, intervals, box = cache
    share = _layer_box(scene, placed, box)
    if share == 0.0:
        return 0.0
    dimension = int(scene[DIMENSION])
    axis = 0
    for k in range(1, dimension):
        if box[k, 1] - box[k, 0] > box[axis, 1] - box[axis, 0]:
            axis = k
    keys[:] = -1
    point = np.zeros(3)
    total = 0.0
    for line in range(lines):
        at = (first + line / lines) % 1.0
        for k in range(dimension):
            if k != axis:
                point[k] = box[k, 0] + at * (box[k, 1] - box[k, 0])
                at = (second + line * step) % 1.0
        count = free_intervals(
            scene, placed, 0, table, keys, scratch, axis, point[0], point[1], point[2], intervals
        )
        for k in range(count):
            total += intervals[k, 1] - intervals[k, 0]
    return share * total / (lines * (box[axis, 1] - box[axis, 0]))


@kernel
def rigid_layers(scene, kind, near, shifts, steps, first, lines, step, numbers, shares):
    """Write the estimated free fraction of layer ``first + k`` of copy r to ``shares[r, k]``.

    ``kind`` says what is drawn (kernels.sampling); ``near`` (4,) is the orientation if nothing is.
    ``shifts`` (copies, numbers) and ``steps`` (numbers,) make the sequence: the last two numbers
    shift the lines, those before are the rotation's. ``numbers`` is room for one point.
    """
    placed, cache = new_placed(scene), _new_cache(scene)
    size = steps.shape[0]
    for r in range(shifts.shape[0]):
        for k in range(shares.shape[1]):
            for m in range(size):
                numbers[m] = (shifts[r, m] + (first + k) * steps[m]) % 1.0
            q = (near[0], near[1], near[2], near[3])
            if kind == SPATIAL:
                q = random_rotation(numbers[0], numbers[1], numbers[2])
            elif kind == PLANAR:
                half = math.pi * (numbers[0] - 0.5)
                q = (0.0, 0.0, math.sin(half), math.cos(half))
            place(scene, 0.0, 0.0, 0.0, q[0], q[1], q[2], q[3], placed)
            shares[r, k] = _layer_share(
                scene, placed, lines, step, numbers[size - 2], numbers[size - 1], cache
            )


@kernel
def articulated_layers(
    scene, kinematics, kind, near, drawn, shifts, steps, first, lines, step, numbers, shares
):
    """As :func:`rigid_layers` for an articulated robot; a layer that self-collides has none.

    ``near`` (7 + V,) is the row if not ``drawn``, and what is not drawn. A base that is IMMOBILE
    has no lines: a share is then 1 if the configuration is free, else 0.
    """
    placed, cache = new_placed(scene), _new_cache(scene)
    frames, order, body = new_frames(kinematics), new_order(kinematics), new_body()
    joints, parts = joint_rows(kinematics), part_rows(scene)
    row = near.copy()
    size = steps.shape[0]
    for r in range(shifts.shape[0]):
        for k in range(shares.shape[1]):
            for m in range(size):
                numbers[m] = (shifts[r, m] + (first + k) * steps[m]) % 1.0
            if drawn:
                draw_turns(joints, kind, near, -1.0, numbers, row)
            shares[r, k] = 0.0
            if kind == IMMOBILE:
                if row_is_free(scene, kinematics, row, frames, placed, order, body):
                    shares[r, k] = 1.0
                continue
            row[0], row[1], row[2] = 0.0, 0.0, 0.0
            place_robot(parts, kinematics, row, frames, placed)
            if first_self_contact(scene, kinematics, frames, placed, order, body)[0] < 0:
                shares[r, k] = _layer_share(
                    scene, placed, lines, step, numbers[size - 2], numbers[size - 1], cache
                )
