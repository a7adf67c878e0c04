"""Drawing free configurations: a line's free intervals are computed, then one is drawn from.

Random numbers come in as a table of uniforms in [0, 1), one row an attempt: three for the
rotation, three for the position, one for the axis, one for acceptance, one for the place.
"""

import math

import numpy as np

from .compile import kernel
from .layout import (
    ARENA_COUNT,
    DIMENSION,
    HIGH,
    LOW,
    OBSTACLE_COUNT,
    PART_COUNT,
    new_placed,
)
from .linear import product
from .lines import CAPACITY, free_intervals
from .placement import place
from .whitening import WHITEN

NUMBERS = 9
FIXED = 0
PLANAR = 1
SPATIAL = 2


@kernel
def random_rotation(a, b, c):
    """A uniformly random quaternion from three uniforms (Shoemake 1992)."""
    r, s = math.sqrt(1.0 - a), math.sqrt(a)
    t, u = 2.0 * math.pi * b, 2.0 * math.pi * c
    return r * math.sin(t), r * math.cos(t), s * math.sin(u), s * math.cos(u)


@kernel
def random_turn(a, b, c, arc):
    """A rotation about a random axis with a quaternion arc of at most ``arc``."""
    height = 2.0 * a - 1.0
    ring = math.sqrt(max(0.0, 1.0 - height * height))
    half = min(arc, 0.5 * math.pi) * c ** (1.0 / 3.0)
    sine = math.sin(half)
    t = 2.0 * math.pi * b
    return sine * ring * math.cos(t), sine * ring * math.sin(t), sine * height, math.cos(half)


@kernel
def clip(intervals, count, low, high):
    """Cut the intervals to [low, high]: (count, total length)."""
    kept, total = 0, 0.0
    for k in range(count):
        a, b = max(intervals[k, 0], low), min(intervals[k, 1], high)
        if b > a:
            intervals[kept, 0], intervals[kept, 1] = a, b
            total += b - a
            kept += 1
    return kept, total


@kernel
def place_in(intervals, count, amount):
    """The point at arc length ``amount`` along the intervals."""
    for k in range(count):
        length = intervals[k, 1] - intervals[k, 0]
        if amount <= length:
            return min(intervals[k, 0] + amount, intervals[k, 1])
        amount -= length
    return intervals[count - 1, 1]


@kernel
def draw_position(
    scene, placed, near, bounded, room, uniform, row, table, keys, scratch, intervals, point, out
):
    """Draw the base's position for a robot placed at the origin: whether its line has any room.

    If ``bounded``, it is at most ``room`` from that of ``near``. ``row`` holds the random numbers
    of this attempt, ``out`` receives the position; the others are workspaces.
    """
    dimension = int(scene[DIMENSION])
    axis = dimension - 1
    if not uniform:
        axis = min(int(row[6] * dimension), dimension - 1)
    width = room / math.sqrt(dimension)
    for k in range(dimension):
        low, high = scene[LOW + k], scene[HIGH + k]
        if bounded:
            low, high = max(low, near[k] - width), min(high, near[k] + width)
        point[k] = low + row[3 + k] * (high - low)
    keys[:] = -1
    count = free_intervals(
        scene, placed, 0, table, keys, scratch, axis, point[0], point[1], point[2], intervals
    )
    low, high = scene[LOW + axis], scene[HIGH + axis]
    if bounded:
        low, high = max(low, near[axis] - width), min(high, near[axis] + width)
    count, total = clip(intervals, count, low, high)
    if count == 0 or (uniform and row[7] * (high - low) >= total):
        return False
    point[axis] = place_in(intervals, count, row[3 + axis] * total)
    out[0], out[1], out[2] = point[0], point[1], point[2]
    return True


@kernel
def draw_free(scene, kind, near, distance, uniform, numbers, out):
    """Write a free pose (7,) to ``out``; False if the line of every attempt was refused.

    ``distance`` < 0 draws from the whole space, else within that distance of the pose ``near`` in
    OMPL's metric. ``near`` gives the orientation of a robot that does not rotate. ``uniform``
    accepts a line with probability (free length)/(longest possible), which makes the draw exactly
    uniform; otherwise the line's axis is random too and any free line is taken.
    """
    parts = int(scene[PART_COUNT])
    pairs = max(1, parts * int(scene[OBSTACLE_COUNT] + scene[ARENA_COUNT]))
    placed = new_placed(scene)
    # A few rows do: the whitening of a pair is needed again only by chance.
    rows = min(pairs, 64)
    table, keys = np.empty((rows, WHITEN)), np.empty(rows, np.int64)
    scratch, intervals = np.empty((1, 9)), np.empty((CAPACITY, 2))
    point = np.zeros(3)
    for attempt in range(numbers.shape[0]):
        row = numbers[attempt]
        room = distance
        q = (near[3], near[4], near[5], near[6])
        if kind != FIXED:
            if distance < 0.0:
                if kind == SPATIAL:
                    q = random_rotation(row[0], row[1], row[2])
                else:
                    half = math.pi * (row[0] - 0.5)
                    q = (0.0, 0.0, math.sin(half), math.cos(half))
            elif kind == SPATIAL:
                arc = distance * row[8]
                room = distance - arc
                turn = random_turn(row[0], row[1], row[2], arc)
                q = product(*turn, *q)
            else:
                # SE(2) weighs a heading's change by 1/2.
                turn_by = distance * row[8]
                room = distance - turn_by
                half = min(turn_by, 0.5 * math.pi) * (2.0 * row[0] - 1.0)
                q = product(0.0, 0.0, math.sin(half), math.cos(half), *q)
        place(scene, 0.0, 0.0, 0.0, q[0], q[1], q[2], q[3], placed)
        if not draw_position(
            scene, placed, near, distance >= 0.0, room, uniform, row, table, keys, scratch,
            intervals, point, out,
        ):  # fmt: skip
            continue
        out[3], out[4], out[5], out[6] = q
        return True
    return False
