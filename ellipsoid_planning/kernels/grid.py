"""Columns and layers that come with starts and goals, joined to those that are there."""

import math

from .compile import kernel


@kernel
def _link(neighbours, row, other):
    """Enter ``other`` in a row of neighbours; where it is full, in place of a late entry."""
    width = neighbours.shape[1]
    for k in range(width):
        if neighbours[row, k] < 0 or neighbours[row, k] == other:
            neighbours[row, k] = other
            return
    neighbours[row, width - 1 - other % (width // 4)] = other


@kernel
def _join_nearest(distances, neighbours, new, count):
    """Join row ``new`` both ways to the ``count`` rows before it of least distance."""
    for _ in range(min(count, new)):
        best = 0
        for k in range(1, new):
            if distances[k] < distances[best]:
                best = k
        _link(neighbours, new, best)
        _link(neighbours, best, new)
        distances[best] = math.inf


@kernel
def find_column(columns, neighbours, count, distances, x, y, z):
    """Index of the column at (x, y, z), whose swept coordinate is 0: an old one, or ``count``.

    A new one is written there and joined to the 4 nearest columns. ``distances`` (≥ count) is
    workspace.
    """
    for k in range(count):
        dx, dy, dz = columns[k, 0] - x, columns[k, 1] - y, columns[k, 2] - z
        distances[k] = math.sqrt(dx * dx + dy * dy + dz * dz)
        if distances[k] == 0.0:
            return k
    columns[count, 0], columns[count, 1], columns[count, 2] = x, y, z
    _join_nearest(distances, neighbours, count, 4)
    return count


@kernel
def find_layer(orientations, neighbours, count, distances, q, joined):
    """Index of the layer with exactly the quaternion ``q`` (4,): an old one, or ``count``.

    A new one is written there and joined to its ``joined`` nearest layers.
    """
    for k in range(count):
        p = orientations[k]
        distances[k] = 1.0 - abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3])
        if p[0] == q[0] and p[1] == q[1] and p[2] == q[2] and p[3] == q[3]:
            return k
    for m in range(4):
        orientations[count, m] = q[m]
    _join_nearest(distances, neighbours, count, joined)
    return count


@kernel
def between(first, last, out):
    """Fill ``out`` (m, 4) with orientations evenly between two quaternions, both excluded.

    Returns False, with nothing written, if the two are less than 2e-6 rad apart.
    """
    dot = 0.0
    for m in range(4):
        dot += first[m] * last[m]
    sign = -1.0 if dot < 0.0 else 1.0
    angle = math.acos(min(abs(dot), 1.0))
    if angle < 1e-6:
        return False
    count = out.shape[0]
    for k in range(count):
        s = (k + 1.0) / (count + 1.0)
        a, b = math.sin((1.0 - s) * angle), sign * math.sin(s * angle)
        for m in range(4):
            out[k, m] = (a * first[m] + b * last[m]) / math.sin(angle)
    return True
