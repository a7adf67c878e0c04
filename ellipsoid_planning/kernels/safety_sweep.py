"""Filling the tables of safety functions: free intervals of many lines at many orientations."""

import math

import numpy as np

from .compile import released
from .layout import arena_rows, new_placed, obstacle_rows
from .lines import CAPACITY, free_intervals
from .placement import place
from .whitening import WHITEN

# Pairs of bodies remembered at a time.
_MOST_WHITENED = 1 << 14


@released
def sweep(scene, quaternions, axis, low, spacing, counts, origin, per, sizes, out):
    """Free intervals along ``axis`` of a grid of lines at each orientation; the number of all.

    The grid has ``counts`` (3,) lines along each dimension, one along ``axis``, the first of them
    half a ``spacing`` (3,) from ``low`` (3,). Ends of intervals are counted from ``origin`` on,
    ``per`` to the unit of length, and rounded inwards. ``sizes`` receives the number of intervals
    of each line of each orientation, and ``out`` (room, 2) the intervals one after the other, as
    many as there is room for.
    """
    placed = new_placed(scene)
    bodies = obstacle_rows(scene).shape[0] + arena_rows(scene).shape[0]
    rows = min(max(placed.shape[0] * bodies, 1), _MOST_WHITENED)
    table, keys = np.empty((rows, WHITEN)), np.empty(rows, dtype=np.int64)
    scratch, found = np.empty((1, 9)), np.empty((CAPACITY, 2))
    used, line = 0, 0
    for q in range(quaternions.shape[0]):
        keys[:] = -1
        qx, qy, qz, qw = quaternions[q]
        place(scene, 0.0, 0.0, 0.0, qx, qy, qz, qw, placed)
        for i in range(counts[0]):
            x = low[0] + (i + 0.5) * spacing[0]
            for j in range(counts[1]):
                y = low[1] + (j + 0.5) * spacing[1]
                for k in range(counts[2]):
                    z = low[2] + (k + 0.5) * spacing[2]
                    number = free_intervals(
                        scene, placed, 0, table, keys, scratch, axis, x, y, z, found
                    )
                    first = used
                    for m in range(number):
                        a = math.ceil((found[m, 0] - origin) * per)
                        b = math.floor((found[m, 1] - origin) * per)
                        if b > a:
                            if used < out.shape[0]:
                                out[used, 0], out[used, 1] = a, b
                            used += 1
                    sizes[line] = used - first
                    line += 1
    return used
