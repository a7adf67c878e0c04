"""Gaps around a pose and how they change as the robot moves: a linear model of clearance.

A step (t, r) in ℝ⁶ moves the base by t and turns the robot about it by the rotation vector r/ρ,
ρ being the robot's reach, so that all six components are lengths. A row of the model holds the gap
of one pair, clearance taken off, and its gradient with respect to such steps.
"""

import math

import numpy as np

from .broad_phase import next_overlap
from .compile import inlined, kernel
from .containment import extent_in_arena, inverse_size
from .layout import (
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_RADIUS,
    CLEARANCE,
    NODE_OBSTACLE,
    PART_RADIUS,
    PLACED_CENTRE,
    PLACED_EXTENT,
    PLACED_MATRIX,
    SCALE,
    arena_rows,
    obstacle_rows,
    part_rows,
    tree_rows,
)
from .linear import cross, norm, product, times, transposed_times
from .placement import place
from .separation import CONVERGE, polish, separation

GAP = 0
GRADIENT = 1
# The part of the gradient along a direction that steps stay across, kept by centring.
ALONG = 7
MODEL = 8
# Rows of a model; the widest gaps are left out if there are more pairs.
CAPACITY = 32
# Steps of the ascent to where a part is near a wall, and how near to each other, in units of its
# size, two such places are one.
_ASCENTS = 6
_SAME = 1e-2


@inlined
def _enter(model, count, gap, ux, uy, uz, px, py, pz, inverse_reach):
    """Add the row of a gap that grows as the point p, seen from the base, moves along u."""
    row = count
    if count == CAPACITY:
        for k in range(CAPACITY):
            if row == CAPACITY or model[k, GAP] > model[row, GAP]:
                row = k
        if model[row, GAP] <= gap:
            return count
    tx, ty, tz = cross(px, py, pz, ux, uy, uz)
    model[row, GAP] = gap
    model[row, 1], model[row, 2], model[row, 3] = ux, uy, uz
    model[row, 4] = tx * inverse_reach
    model[row, 5] = ty * inverse_reach
    model[row, 6] = tz * inverse_reach
    return min(count + 1, CAPACITY)


@kernel
def _farthest(placed, i, ux, uy, uz):
    """The point of placed part ``i`` that lies farthest along u."""
    a, b, c = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
    length = norm(a, b, c)
    scale = 1.0 / length if length > 0.0 else 0.0
    x, y, z = times(placed, i, PLACED_MATRIX, scale * a, scale * b, scale * c)
    return (
        placed[i, PLACED_CENTRE] + x,
        placed[i, PLACED_CENTRE + 1] + y,
        placed[i, PLACED_CENTRE + 2] + z,
    )


@inlined
def _enter_wall(model, count, arenas, a, px, py, pz, pose, within, clearance, inverse_reach):
    """Add the row of the gap between the point p of the robot and the wall of arena ``a``."""
    wx, wy, wz = times(
        arenas,
        a,
        BODY_INVERSE,
        px - arenas[a, BODY_CENTRE],
        py - arenas[a, BODY_CENTRE + 1],
        pz - arenas[a, BODY_CENTRE + 2],
    )
    root = norm(wx, wy, wz)
    nx, ny, nz = transposed_times(arenas, a, BODY_INVERSE, wx, wy, wz)
    steep = norm(nx, ny, nz)
    if not steep > 0.0:
        return count
    # The wall lies at |w| = 1, and |w| grows by steep/|w| a unit of length.
    gap = (1.0 - root) * root / steep - clearance
    if gap < within:
        ux, uy, uz = -nx / steep, -ny / steep, -nz / steep
        px, py, pz = px - pose[0], py - pose[1], pz - pose[2]
        count = _enter(model, count, gap, ux, uy, uz, px, py, pz, inverse_reach)
    return count


@kernel
def _enter_walls(model, count, arenas, a, placed, i, pose, within, scene, inverse_reach):
    """Add rows of part ``i`` and the wall of arena ``a``, which it can be near at several places.

    They are local maxima of |w| over the part, looked for from the tips of its axes.
    """
    clearance = scene[CLEARANCE]
    wx, wy, wz = times(
        arenas,
        a,
        BODY_INVERSE,
        placed[i, PLACED_CENTRE] - arenas[a, BODY_CENTRE],
        placed[i, PLACED_CENTRE + 1] - arenas[a, BODY_CENTRE + 1],
        placed[i, PLACED_CENTRE + 2] - arenas[a, BODY_CENTRE + 2],
    )
    size = norm(
        placed[i, PLACED_EXTENT], placed[i, PLACED_EXTENT + 1], placed[i, PLACED_EXTENT + 2]
    )
    if norm(wx, wy, wz) + (size + within + clearance) * inverse_size(arenas, a, BODY_INVERSE) < 1.0:
        return count
    _, ux, uy, uz = extent_in_arena(arenas, a, placed, i, scene[SCALE], BODY_INVERSE, True)
    length = norm(ux, uy, uz)
    fx, fy, fz = (
        placed[i, PLACED_CENTRE],
        placed[i, PLACED_CENTRE + 1],
        placed[i, PLACED_CENTRE + 2],
    )
    if length > 0.0:
        fx, fy, fz = _farthest(placed, i, ux / length, uy / length, uz / length)
    count = _enter_wall(model, count, arenas, a, fx, fy, fz, pose, within, clearance, inverse_reach)
    for k in range(6):
        sign, axis = 1.0 - 2.0 * (k % 2), k // 2
        ax = placed[i, PLACED_MATRIX + axis]
        ay = placed[i, PLACED_MATRIX + 3 + axis]
        az = placed[i, PLACED_MATRIX + 6 + axis]
        size = norm(ax, ay, az)
        if not size > 0.0:
            continue
        px = placed[i, PLACED_CENTRE] + sign * ax
        py = placed[i, PLACED_CENTRE + 1] + sign * ay
        pz = placed[i, PLACED_CENTRE + 2] + sign * az
        for _ in range(_ASCENTS):
            # The part's farthest point along the gradient is farther out.
            wx, wy, wz = times(
                arenas,
                a,
                BODY_INVERSE,
                px - arenas[a, BODY_CENTRE],
                py - arenas[a, BODY_CENTRE + 1],
                pz - arenas[a, BODY_CENTRE + 2],
            )
            nx, ny, nz = transposed_times(arenas, a, BODY_INVERSE, wx, wy, wz)
            px, py, pz = _farthest(placed, i, nx, ny, nz)
        if norm(px - fx, py - fy, pz - fz) > _SAME * size:
            count = _enter_wall(
                model, count, arenas, a, px, py, pz, pose, within, clearance, inverse_reach
            )
    return count


@inlined
def _gap(obstacles, j, parts, placed, i, keys, known):
    """Gap of a pair with its direction, sought from where it was found last."""
    key = j * placed.shape[0] + i
    row = key % keys.shape[0]
    gap, ux, uy, uz = -math.inf, 1.0, 0.0, 0.0
    if keys[row] == key:
        gap, ux, uy, uz = polish(
            obstacles,
            j,
            placed,
            i,
            known[row, 0],
            known[row, 1],
            known[row, 2],
            math.inf,
            CONVERGE,
        )
    same = ux * known[row, 0] + uy * known[row, 1] + uz * known[row, 2]
    if not (gap > 0.0 and same > 0.9):
        # From the wrong side of a flat body, one climbs to a depth even where there is a gap.
        lam = obstacles[j, BODY_RADIUS] / (obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS])
        gap, ux, uy, uz, _ = separation(obstacles, j, placed, i, lam, math.inf, CONVERGE)
    keys[row] = key
    known[row, 0], known[row, 1], known[row, 2] = ux, uy, uz
    return gap, ux, uy, uz


@kernel
def contact_model(scene, placed, pose, within, inverse_reach, model, work, keys, known):
    """Fill ``model`` (CAPACITY, MODEL) with every pair whose gap is below ``within``: their count.

    ``inverse_reach`` is 1/ρ, or 0 for a robot that does not turn. ``work`` (1,) counts the pairs
    looked at; ``keys`` and ``known`` remember directions of gaps. Gaps are negative where bodies
    meet. Those of arenas are first-order estimates, exact at contact.
    """
    place(scene, pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], placed)
    obstacles, arenas = obstacle_rows(scene), arena_rows(scene)
    parts, tree = part_rows(scene), tree_rows(scene)
    clearance = scene[CLEARANCE]
    count = 0
    for i in range(placed.shape[0]):
        work[0] += arenas.shape[0]
        for a in range(arenas.shape[0]):
            count = _enter_walls(
                model, count, arenas, a, placed, i, pose, within, scene, inverse_reach
            )
        cx = placed[i, PLACED_CENTRE]
        cy = placed[i, PLACED_CENTRE + 1]
        cz = placed[i, PLACED_CENTRE + 2]
        room = within + clearance
        ex = placed[i, PLACED_EXTENT] + room
        ey = placed[i, PLACED_EXTENT + 1] + room
        ez = placed[i, PLACED_EXTENT + 2] + room
        x0, y0, z0, x1, y1, z1 = cx - ex, cy - ey, cz - ez, cx + ex, cy + ey, cz + ez
        node = next_overlap(tree, 0, x0, y0, z0, x1, y1, z1)
        while node >= 0:
            work[0] += 1
            j = int(tree[node, NODE_OBSTACLE])
            gap, ux, uy, uz = _gap(obstacles, j, parts, placed, i, keys, known)
            gap -= clearance
            if gap < within:
                px, py, pz = _farthest(placed, i, -ux, -uy, -uz)
                px, py, pz = px - pose[0], py - pose[1], pz - pose[2]
                count = _enter(model, count, gap, ux, uy, uz, px, py, pz, inverse_reach)
            node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    return count


@kernel
def smallest_gap(model, count, within):
    """The smallest gap of a model, at most ``within``."""
    least = within
    for k in range(count):
        least = min(least, model[k, GAP])
    return least


@kernel
def moved(pose, step, inverse_reach, out):
    """Write ``pose`` moved by ``step`` (6,) to ``out`` (7,)."""
    for k in range(3):
        out[k] = pose[k] + step[k]
    rx, ry, rz = step[3] * inverse_reach, step[4] * inverse_reach, step[5] * inverse_reach
    angle = norm(rx, ry, rz)
    sine = 0.5 if angle < 1e-12 else math.sin(0.5 * angle) / angle
    q = product(
        sine * rx, sine * ry, sine * rz, math.cos(0.5 * angle), pose[3], pose[4], pose[5], pose[6]
    )
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    for k in range(4):
        out[3 + k] = q[k] / length


@kernel
def samples_along(first, step, inverse_reach, out):
    """Write poses evenly along ``step`` (6,) from ``first``, ends excluded, to ``out`` (m, 7)."""
    part = np.empty(6)
    for k in range(out.shape[0]):
        for m in range(6):
            part[m] = step[m] * (k + 1.0) / (out.shape[0] + 1.0)
        moved(first, part, inverse_reach, out[k])


@kernel
def difference(first, last, reach, out):
    """Write the step (6,) that moves the pose ``first`` to ``last``, the shorter way round."""
    for k in range(3):
        out[k] = last[k] - first[k]
    x, y, z, w = product(
        last[3], last[4], last[5], last[6], -first[3], -first[4], -first[5], first[6]
    )
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = norm(x, y, z)
    scale = 2.0 if sine < 1e-12 else 2.0 * math.atan2(sine, w) / sine
    out[3], out[4], out[5] = reach * scale * x, reach * scale * y, reach * scale * z
