"""Gaps around a pose and how they change as the robot moves: a linear model of clearance.

A step (t, r) in ℝ⁶ moves the base by t and turns the robot about it by the rotation vector r/ρ,
ρ being the robot's reach, so that all six components are lengths. A row of the model holds the gap
of one pair, clearance taken off, and its gradient with respect to such steps. Articulated robots
have more components (articulated_steps), and rows for their own parts against each other.

``robot`` stands for what kernels know of a robot and its world (robot_model).
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
from .robot_model import (
    add_joints,
    base_moves,
    move_other,
    next_own_pair,
    other_difference,
    own_gap,
    place_at,
    scene_of,
    step_size,
)
from .separation import CONVERGE, polish, separation

GAP = 0
GRADIENT = 1
# A row holds a gap, its gradient, and last the part of it along a direction that steps stay across.
MODEL = 2
# Rows of a model; the widest gaps are left out if there are more pairs.
CAPACITY = 32
# Steps of the ascent to where a part is near a wall, and how near to each other, in units of its
# size, two such places are one.
_ASCENTS = 6
_SAME = 1e-2


@inlined
def _enter(robot, model, count, gap, i, ux, uy, uz, px, py, pz, pose, inverse_reach):
    """Add the row of a gap that grows as the point p of part ``i`` moves along u."""
    row = _free_row(model, count, gap)
    if row < 0:
        return count
    moves = base_moves(robot)
    tx, ty, tz = cross(px - pose[0], py - pose[1], pz - pose[2], ux, uy, uz)
    model[row, GAP] = gap
    model[row, 1], model[row, 2], model[row, 3] = moves * ux, moves * uy, moves * uz
    model[row, 4] = tx * inverse_reach
    model[row, 5] = ty * inverse_reach
    model[row, 6] = tz * inverse_reach
    for m in range(6, step_size(robot)):
        model[row, GRADIENT + m] = 0.0
    add_joints(robot, i, 1.0, ux, uy, uz, px, py, pz, model[row, GRADIENT:])
    return min(count + 1, CAPACITY)


@kernel
def _free_row(model, count, gap):
    """The row for one more gap: a new one, that of the widest gap, or −1 if that is narrower."""
    if count < CAPACITY:
        return count
    row = 0
    for k in range(CAPACITY):
        if model[k, GAP] > model[row, GAP]:
            row = k
    return row if model[row, GAP] > gap else -1


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
def _enter_wall(
    robot, model, count, arenas, a, i, px, py, pz, pose, within, clearance, inverse_reach
):
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
        count = _enter(robot, model, count, gap, i, ux, uy, uz, px, py, pz, pose, inverse_reach)
    return count


@kernel
def _enter_walls(robot, model, count, arenas, a, placed, i, pose, within, inverse_reach):
    """Add rows of part ``i`` and the wall of arena ``a``, which it can be near at several places.

    They are local maxima of |w| over the part, looked for from the tips of its axes.
    """
    scene = scene_of(robot)
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
    count = _enter_wall(
        robot, model, count, arenas, a, i, fx, fy, fz, pose, within, clearance, inverse_reach
    )
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
                robot,
                model,
                count,
                arenas,
                a,
                i,
                px,
                py,
                pz,
                pose,
                within,
                clearance,
                inverse_reach,
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
def contact_model(robot, placed, pose, within, inverse_reach, model, work, keys, known):
    """Fill ``model`` (CAPACITY, ·) with every pair whose gap is below ``within``: their count.

    ``inverse_reach`` is 1/ρ, or 0 for a robot that does not turn. ``work`` (1,) counts the pairs
    looked at; ``keys`` and ``known`` remember directions of gaps. Gaps are negative where bodies
    meet. Those of arenas are first-order estimates, exact at contact.
    """
    place_at(robot, pose, placed)
    scene = scene_of(robot)
    obstacles, arenas = obstacle_rows(scene), arena_rows(scene)
    parts, tree = part_rows(scene), tree_rows(scene)
    clearance = scene[CLEARANCE]
    count = 0
    for i in range(placed.shape[0]):
        work[0] += arenas.shape[0]
        for a in range(arenas.shape[0]):
            count = _enter_walls(
                robot, model, count, arenas, a, placed, i, pose, within, inverse_reach
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
                count = _enter(
                    robot, model, count, gap, i, ux, uy, uz, px, py, pz, pose, inverse_reach
                )
            node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    pair = next_own_pair(robot, placed, -1, within)
    while pair >= 0:
        work[0] += 1
        count = _enter_own(robot, model, count, placed, pair, within)
        pair = next_own_pair(robot, placed, pair, within)
    return count


@inlined
def _enter_own(robot, model, count, placed, pair, within):
    """Add the row of two of the robot's own parts, whatever the clearance is."""
    i, j = pair // placed.shape[0], pair % placed.shape[0]
    gap, ux, uy, uz, _ = own_gap(robot, placed, i, j)
    row = _free_row(model, count, gap)
    if not gap < within or row < 0:
        return count
    model[row, GAP] = gap
    for m in range(step_size(robot)):
        model[row, GRADIENT + m] = 0.0
    px, py, pz = _farthest(placed, j, -ux, -uy, -uz)
    add_joints(robot, j, 1.0, ux, uy, uz, px, py, pz, model[row, GRADIENT:])
    px, py, pz = _farthest(placed, i, ux, uy, uz)
    add_joints(robot, i, -1.0, ux, uy, uz, px, py, pz, model[row, GRADIENT:])
    return min(count + 1, CAPACITY)


@kernel
def smallest_gap(model, count, within):
    """The smallest gap of a model, at most ``within``."""
    least = within
    for k in range(count):
        least = min(least, model[k, GAP])
    return least


@kernel
def moved(robot, pose, step, inverse_reach, out):
    """Write ``pose`` moved by ``step`` to ``out``; joints stay within their limits."""
    move_other(robot, pose, step, out)
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
def samples_along(robot, first, step, inverse_reach, out):
    """Write poses evenly along ``step`` from ``first``, ends excluded, to ``out`` (m, 7 + V)."""
    part = np.empty(step.shape[0])
    for k in range(out.shape[0]):
        for m in range(step.shape[0]):
            part[m] = step[m] * (k + 1.0) / (out.shape[0] + 1.0)
        moved(robot, first, part, inverse_reach, out[k])


@kernel
def difference(robot, first, last, reach, out):
    """Write the step that moves the pose ``first`` to ``last``, the shorter way round."""
    other_difference(robot, first, last, out)
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
