"""Saddle points of clearance in a layer: the places between two or three C-obstacles.

C-obstacle (i, j) is the set of base positions at which part i meets body j. The gap of i and j, as
a function of the base position x, is the distance from that convex set, so the largest of a few
such gaps is convex. Its minimiser is the centre of the smallest ball that touches all of them:
there the gaps are equal and the normals balance. Moving across, some gap shrinks; moving along,
all grow. That is a narrowest place of the passage between them.
"""

import math

from .compile import inlined, kernel
from .layout import (
    BODY_RADIUS,
    PART_RADIUS,
    PLACED_CENTRE,
)
from .separation import CONVERGE, separation
from .simplex import minimise

_STEPS = 40
# By how much gaps may differ at a saddle, in units of the gap or of the bodies' size: between flat
# bodies the last digits take long.
_EVEN = 1e-3
# A row of pairs: part, body.
PART_OF = 0
BODY_OF = 1


@inlined
def _shift(placed, pairs, count, sign, x, y, z):
    """Move the parts of the pairs by sign·(x, y, z), each part once."""
    for k in range(count):
        i = pairs[k, PART_OF]
        seen = False
        for m in range(k):
            seen = seen or pairs[m, PART_OF] == i
        if not seen:
            placed[i, PLACED_CENTRE] += sign * x
            placed[i, PLACED_CENTRE + 1] += sign * y
            placed[i, PLACED_CENTRE + 2] += sign * z


@inlined
def _model(obstacles, parts, placed, pairs, count, point, model):
    """Rows −gap, −∇gap of the pairs with the base at ``point``; returns the largest gap."""
    largest = -math.inf
    _shift(placed, pairs, count, 1.0, point[0], point[1], point[2])
    for k in range(count):
        i, j = pairs[k, PART_OF], pairs[k, BODY_OF]
        lam = obstacles[j, BODY_RADIUS] / (obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS])
        gap, ux, uy, uz, _ = separation(obstacles, j, placed, i, lam, math.inf, CONVERGE)
        model[k, 0] = -gap
        model[k, 1], model[k, 2], model[k, 3] = -ux, -uy, -uz
        model[k, 4], model[k, 5], model[k, 6] = 0.0, 0.0, 0.0
        largest = max(largest, gap)
    _shift(placed, pairs, count, -1.0, point[0], point[1], point[2])
    return largest


@kernel
def saddle(obstacles, parts, placed, pairs, count, size, point, normals, work):
    """Move ``point`` (3,) to the saddle between ``count`` C-obstacles: (gap there, found).

    ``placed`` are the layer's parts with the base at the origin. ``normals`` (≥ count, 3) receives
    the directions from the bodies to the parts. ``size`` is a length of the scene's bodies. Not
    found: the bodies leave no room (the gap is not positive), or one pair does not bound it.
    """
    here, there, step, trial = work.first, work.second, work.step, work.trial
    gap = _model(obstacles, parts, placed, pairs, count, point, here)
    work.pairs[0] += count
    proximal = size
    for _ in range(_STEPS):
        promised = minimise(here, count, proximal, work.matrix, work.active, work.weights, step)
        # Rows are −gap: the step raises −(largest gap).
        drop = promised + gap
        if gap <= 0.0 or drop <= 1e-9 * gap + 1e-14 * size:
            break
        for m in range(3):
            trial[m] = point[m] + step[m]
        value = _model(obstacles, parts, placed, pairs, count, trial, there)
        work.pairs[0] += count
        if value < gap - 0.1 * drop:
            proximal = min(2.0 * proximal, 1e3 * size) if value < gap - 0.5 * drop else proximal
            here, there = there, here
            gap = value
            for m in range(3):
                point[m] = trial[m]
        else:
            proximal *= 0.25
    found = gap > 0.0
    for k in range(count):
        found = found and gap + here[k, 0] < _EVEN * max(gap, size)
        for m in range(3):
            normals[k, m] = -here[k, 1 + m]
    return gap, found
