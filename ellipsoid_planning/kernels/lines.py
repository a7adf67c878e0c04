"""Free intervals of a sweep line in a layer (thesis eq. 6.1).

A layer is one value of everything but translation: its parts are placed once, with the base at
the origin. The whitening of a pair (part, body) is computed when a line first needs it and kept in
``table``, a cache of rows addressed by key modulo their number: key = ``base`` + i · bodies + j,
obstacles first, then arenas. ``keys`` tells whose row it is at present, −1 for none.
"""

from .broad_phase import next_overlap
from .chords import HIT, arena_chord, obstacle_chord
from .compile import inlined, kernel
from .containment import inverse_size
from .layout import (
    BODY_WHITEN,
    CLEARANCE,
    HIGH,
    LOW,
    NODE_OBSTACLE,
    PLACED_CENTRE,
    PLACED_EXTENT,
    SCALE,
    TOLERANCE,
    arena_rows,
    obstacle_rows,
    tree_rows,
)
from .whitening import whiten

CAPACITY = 64


@inlined
def _split(intervals, count, k, low, high):
    """Replace interval ``k`` by its parts below ``low`` and above ``high``."""
    if count == intervals.shape[0]:
        # No room: the shorter part is given up, which only loses free space.
        if low - intervals[k, 0] >= intervals[k, 1] - high:
            intervals[k, 1] = low
        else:
            intervals[k, 0] = high
        return count
    for m in range(count, k + 1, -1):
        intervals[m, 0], intervals[m, 1] = intervals[m - 1, 0], intervals[m - 1, 1]
    intervals[k + 1, 0], intervals[k + 1, 1] = high, intervals[k, 1]
    intervals[k, 1] = low
    return count + 1


@kernel
def subtract(intervals, count, low, high, shortest):
    """Remove [low, high] from the disjoint sorted ``intervals``; returns the new count.

    Pieces not longer than ``shortest`` go too.
    """
    kept = 0
    for k in range(count):
        first, last = intervals[k, 0], intervals[k, 1]
        if first < high and last > low:
            left, right = low - first > shortest, last - high > shortest
            if left and right:
                return _split(intervals, count, k, low, high)
            if not left and not right:
                continue
            if left:
                last = low
            else:
                first = high
        intervals[kept, 0], intervals[kept, 1] = first, last
        kept += 1
    return kept


@kernel
def _whitened_row(bodies, j, placed, i, key, table, keys, scratch):
    """The row of ``table`` that holds the whitening of a pair, computed if it is not there."""
    row = key % keys.shape[0]
    if keys[row] != key:
        whiten(bodies, j, placed, i, scratch, table, row)
        keys[row] = key
    return row


@inlined
def _arena_interval(arenas, scene, placed, base, table, keys, scratch, columns, axis, x, y, z):
    """Where all parts are inside all arenas and bounds: (low, high), empty if low > high."""
    low, high = scene[LOW + axis], scene[HIGH + axis]
    first = columns - arenas.shape[0]
    for i in range(placed.shape[0]):
        for j in range(arenas.shape[0]):
            key = base + i * columns + first + j
            row = _whitened_row(arenas, j, placed, i, key, table, keys, scratch)
            size = inverse_size(arenas, j, BODY_WHITEN)
            slack = TOLERANCE * (1.0 + size * scene[SCALE])
            inside, a, b = arena_chord(arenas, j, placed, i, table, row, slack, axis, x, y, z)
            if not inside:
                return 1.0, 0.0
            low, high = max(low, a), min(high, b)
            if low > high:
                return low, high
    return low, high


@kernel
def free_intervals(scene, placed, base, table, keys, scratch, axis, x, y, z, intervals):
    """Free intervals of the line through (x, y, z) along ``axis``: their count.

    ``intervals`` (capacity, 2) receives them sorted, as values of the swept coordinate. Every
    point in them keeps the scene's clearance and TOLERANCE · scale more. The swept coordinate of
    (x, y, z) is ignored.
    """
    obstacles, arenas, tree = obstacle_rows(scene), arena_rows(scene), tree_rows(scene)
    x = 0.0 if axis == 0 else x
    y = 0.0 if axis == 1 else y
    z = 0.0 if axis == 2 else z
    for k in range(3):
        value = x if k == 0 else (y if k == 1 else z)
        if k != axis and (value < scene[LOW + k] or value > scene[HIGH + k]):
            return 0
    columns = obstacles.shape[0] + arenas.shape[0]
    low, high = _arena_interval(
        arenas, scene, placed, base, table, keys, scratch, columns, axis, x, y, z
    )
    tolerance, clearance = TOLERANCE * scene[SCALE], scene[CLEARANCE]
    if high - low <= tolerance:
        return 0
    intervals[0, 0], intervals[0, 1] = low, high
    count = 1
    for i in range(placed.shape[0]):
        cx = x + placed[i, PLACED_CENTRE]
        cy = y + placed[i, PLACED_CENTRE + 1]
        cz = z + placed[i, PLACED_CENTRE + 2]
        ex = placed[i, PLACED_EXTENT] + clearance + 2.0 * tolerance
        ey = placed[i, PLACED_EXTENT + 1] + clearance + 2.0 * tolerance
        ez = placed[i, PLACED_EXTENT + 2] + clearance + 2.0 * tolerance
        x0, y0, z0, x1, y1, z1 = cx - ex, cy - ey, cz - ez, cx + ex, cy + ey, cz + ez
        if axis == 0:
            x0, x1 = x0 + low, x1 + high
        elif axis == 1:
            y0, y1 = y0 + low, y1 + high
        else:
            z0, z1 = z0 + low, z1 + high
        node = next_overlap(tree, 0, x0, y0, z0, x1, y1, z1)
        while node >= 0:
            j = int(tree[node, NODE_OBSTACLE])
            key = base + i * columns + j
            row = _whitened_row(obstacles, j, placed, i, key, table, keys, scratch)
            hit, a, b = obstacle_chord(
                obstacles, j, placed, i, table, row, clearance, tolerance, axis, x, y, z
            )
            if hit == HIT:
                count = subtract(intervals, count, a, b, tolerance)
                if count == 0:
                    return 0
            node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    return count
