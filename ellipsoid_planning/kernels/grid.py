"""Who neighbours whom: layers of a grid, and columns and layers that starts and goals bring."""

import math

import numpy as np

from .compile import inlined, kernel
from .roadmap_metric import turn_length

# First entry of a layer's row of neighbours that has not been looked for yet.
UNKNOWN = -2


@kernel
def _apart(joints, p, q, weight):
    """What orders layers by their distance; without joints the cosine does, which is cheaper."""
    if joints.shape[0] > 0:
        return turn_length(joints, p, q, weight)
    return 1.0 - abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3])


@kernel
def find_nearest(orientations, joints, neighbours, layer, own, joined, weight):
    """Enter the nearest ``joined`` of the first ``own`` layers in the row of ``layer``."""
    p = orientations[layer]
    distances = np.empty(joined)
    for k in range(joined):
        distances[k] = math.inf
        neighbours[layer, k] = -1
    for other in range(own):
        q = orientations[other]
        distance = _apart(joints, p, q, weight)
        if other == layer or distance >= distances[joined - 1]:
            continue
        k = joined - 1
        while k > 0 and distances[k - 1] > distance:
            distances[k], neighbours[layer, k] = distances[k - 1], neighbours[layer, k - 1]
            k -= 1
        distances[k], neighbours[layer, k] = distance, other


@inlined
def _link(neighbours, row, first, other):
    """Enter ``other`` in a row from place ``first`` on; where it is full, for a late entry."""
    width = neighbours.shape[1]
    for k in range(first, width):
        if neighbours[row, k] < 0 or neighbours[row, k] == other:
            neighbours[row, k] = other
            return
    neighbours[row, width - 1 - other % ((width - first + 3) // 4)] = other


@kernel
def _join_nearest(distances, neighbours, new, count, first, both_ways):
    """Join row ``new`` to the ``count`` rows before it of least distance.

    If ``both_ways``, their own rows take it from place ``first`` on.
    """
    for _ in range(min(count, new)):
        best = 0
        for k in range(1, new):
            if distances[k] < distances[best]:
                best = k
        if not distances[best] < math.inf:
            return
        _link(neighbours, new, 0, best)
        if both_ways:
            _link(neighbours, best, first, new)
        distances[best] = math.inf


@kernel
def find_column(columns, neighbours, count, distances, passing, joins, x, y, z):
    """Index of the column at (x, y, z), whose swept coordinate is 0: an old one, or ``count``.

    A new one is written there and joined to the 4 nearest columns that are not ``passing`` (C,);
    both ways if ``joins``, else it is passing itself. ``distances`` (≥ count) is workspace.
    """
    for k in range(count):
        dx, dy, dz = columns[k, 0] - x, columns[k, 1] - y, columns[k, 2] - z
        distances[k] = math.sqrt(dx * dx + dy * dy + dz * dz)
        if distances[k] == 0.0:
            return k
        if passing[k]:
            distances[k] = math.inf
    columns[count, 0], columns[count, 1], columns[count, 2] = x, y, z
    passing[count] = not joins
    _join_nearest(distances, neighbours, count, 4, 0, joins)
    return count


@kernel
def find_layer(
    orientations, joints, neighbours, count, distances, passing, joins, q, joined, weight
):
    """Index of the layer with exactly the row ``q`` (4 + V,): an old one, or ``count``.

    A new one is written there and joined to its ``joined`` nearest layers that are not
    ``passing`` (L,); both ways if ``joins``, else it is passing itself.
    """
    for k in range(count):
        p = orientations[k]
        distances[k] = _apart(joints, p, q, weight)
        same = True
        for m in range(q.shape[0]):
            same = same and p[m] == q[m]
        if same:
            return k
        if passing[k]:
            distances[k] = math.inf
    for m in range(q.shape[0]):
        orientations[count, m] = q[m]
    passing[count] = not joins
    _join_nearest(distances, neighbours, count, joined, joined, joins)
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
