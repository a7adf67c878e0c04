"""Certified motions of articulated robots in continuous time.

*The hull of a piece.* Over a piece [m − h, m + h] of the motion let E₋ and E₊ be a part's ellipsoid
at m moved on along its tangent, (c ± h c′, M ± h M′). Every point of the part follows its own
tangent up to K h²/2, K bounding its acceleration. So what the part sweeps over lies in the convex
hull of E₋ and E₊, grown by K h²/2:

- it stays clear of a convex body if one hyperplane has E₋ and E₊ on its side with that room;
- it stays inside an arena if E₋ and E₊ are inside with that room in the arena's norm, as a ball
  is convex;
- of two parts the one stays clear of the other if a hyperplane separates E₋ from E₋ and E₊ from
  E₊ with the room of both (the base held, which changes nothing between them).

A piece in which something is not proved is halved, and only what is left is looked at again. The
room is of second order, so that about ε^(−½) pieces suffice at clearance ε.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .articulated_rates import (
    BOUND_SPEED,
    BOUND_SPIN,
    BOUNDS,
    LOCAL,
    LOCAL_ACCELERATION,
    LOCAL_TURN,
    keep_rates,
    set_bounds,
    set_local_bounds,
    set_rates,
    turn_other_way,
)
from .broad_phase import next_overlap
from .compile import inlined, kernel
from .containment import GROW_PART, SHRINK_ARENA, arena_extent, inverse_size
from .kinematics import (
    FRAME_SPIN,
    FRAME_TRANSLATION,
    FRAME_VELOCITY,
    WIDTH,
    body_frames,
    body_velocities,
    new_frames,
    owners_of,
    pair_matrix,
    place_on_frames,
    row_at,
    shape_rows,
    within_limits,
)
from .layout import (
    BODY,
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_RADIUS,
    BODY_WHITEN,
    CLEARANCE,
    DIMENSION,
    NODE_OBSTACLE,
    PART_RADIUS,
    PART_REACH,
    PLACED,
    PLACED_CENTRE,
    PLACED_EXTENT,
    PLACED_MATRIX,
    ROUNDING,
    SCALE,
    arena_rows,
    new_placed,
    obstacle_rows,
    part_rows,
    tree_rows,
)
from .linear import cross, norm, transposed_times
from .self_collision import as_body, sort_along_x
from .separation import AIM, gap_along, separation
from .validity import in_bounds, is_rotation

_DEPTH = 48
_MOST_PIECES = 100000


class MotionWorkspace(NamedTuple):
    """Arrays that proofs of motions work in."""

    row: NDArray[np.float64]
    start: NDArray[np.float64]
    rates: NDArray[np.float64]
    all_rates: NDArray[np.float64]
    frames: NDArray[np.float64]
    bounds: NDArray[np.float64]
    local: NDArray[np.float64]
    placed: NDArray[np.float64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]
    left: NDArray[np.bool_]
    stack: NDArray[np.float64]
    order: NDArray[np.int64]
    body: NDArray[np.float64]
    room: NDArray[np.float64]
    pieces: NDArray[np.int64]


@kernel
def new_motion_workspace(scene, kinematics):
    """A workspace for the robot of ``scene`` and ``kinematics``.

    ``pieces`` (2,) counts the pieces of one motion looked at, and says how many it may take.
    """
    width, parts = int(kinematics[WIDTH]), part_rows(scene).shape[0]
    frames = new_frames(kinematics)
    pieces = np.zeros(2, dtype=np.int64)
    pieces[1] = _MOST_PIECES
    return MotionWorkspace(
        np.empty(width),
        np.empty(width),
        np.empty(width),
        np.empty(width),
        frames,
        np.empty((frames.shape[0], BOUNDS)),
        np.empty((frames.shape[0], LOCAL)),
        new_placed(scene),
        np.empty((parts, PLACED)),
        np.empty((parts, PLACED)),
        np.empty((_DEPTH + 1, parts), dtype=np.bool_),
        np.empty((_DEPTH, 2)),
        np.arange(parts),
        np.empty((1, BODY)),
        np.empty(parts),
        pieces,
    )


@kernel
def _extrapolate(frames, b, placed, i, half, before, after):
    """Write placed part ``i`` of body ``b`` moved on along its tangent by ∓ ``half``."""
    f, c, m = frames[b], PLACED_CENTRE, PLACED_MATRIX
    sx, sy, sz = f[FRAME_SPIN], f[FRAME_SPIN + 1], f[FRAME_SPIN + 2]
    x, y, z = placed[i, c], placed[i, c + 1], placed[i, c + 2]
    t = FRAME_TRANSLATION
    dx, dy, dz = cross(sx, sy, sz, x - f[t], y - f[t + 1], z - f[t + 2])
    dx += f[FRAME_VELOCITY]
    dy += f[FRAME_VELOCITY + 1]
    dz += f[FRAME_VELOCITY + 2]
    before[i, c], before[i, c + 1], before[i, c + 2] = x - half * dx, y - half * dy, z - half * dz
    after[i, c], after[i, c + 1], after[i, c + 2] = x + half * dx, y + half * dy, z + half * dz
    for k in range(3):
        x, y, z = placed[i, m + k], placed[i, m + 3 + k], placed[i, m + 6 + k]
        dx, dy, dz = cross(sx, sy, sz, x, y, z)
        before[i, m + k], after[i, m + k] = x - half * dx, x + half * dx
        before[i, m + 3 + k], after[i, m + 3 + k] = y - half * dy, y + half * dy
        before[i, m + 6 + k], after[i, m + 6 + k] = z - half * dz, z + half * dz


@inlined
def _place_piece(scene, kinematics, work, level, half):
    """Place the robot in the middle of a piece, and the parts that are left at both tangents.

    ``work.room`` receives what their points may leave their tangents by.
    """
    parts, owners = part_rows(scene), owners_of(kinematics)
    body_frames(kinematics, work.row, work.frames)
    body_velocities(kinematics, work.rates, work.frames)
    place_on_frames(parts, owners, work.frames, work.placed)
    set_local_bounds(
        scene, kinematics, work.start, work.rates, work.frames, half, work.bounds, work.local
    )
    for i in range(parts.shape[0]):
        if work.left[level, i]:
            b = int(owners[i])
            reach = parts[i, PART_REACH]
            bend = work.local[b, LOCAL_ACCELERATION] + work.local[b, LOCAL_TURN] * reach
            speed = work.bounds[b, BOUND_SPEED] + abs(work.bounds[b, BOUND_SPIN]) * reach
            work.room[i] = 0.5 * bend * half * half + 2.0 * ROUNDING * (scene[SCALE] + speed)
            _extrapolate(work.frames, b, work.placed, i, half, work.before, work.after)


@kernel
def _stays_inside(arenas, a, placed, i, scene, clearance, way, room):
    """Whether part ``i`` is inside with so much room in the arena's norm; a rough look first."""
    planar, scale = scene[DIMENSION] == 2.0, scene[SCALE]
    g = arena_extent(arenas, a, placed, i, scale, clearance, planar, way, False)
    if math.sqrt(g) + room <= 1.0:
        return True
    g = arena_extent(arenas, a, placed, i, scale, clearance, planar, way, True)
    return math.sqrt(g) + room <= 1.0


@inlined
def _part_in_arenas(scene, work, i, clearance, way):
    """Whether part ``i`` is proved to stay in all arenas over a piece: 1, 0, or −1 if it is out."""
    arenas, planar = arena_rows(scene), scene[DIMENSION] == 2.0
    result = 1
    for a in range(arenas.shape[0]):
        if result != 1:
            continue
        size = inverse_size(arenas, a, BODY_WHITEN if way == SHRINK_ARENA else BODY_INVERSE)
        room = work.room[i] * size
        if not (
            _stays_inside(arenas, a, work.before, i, scene, clearance, way, room)
            and _stays_inside(arenas, a, work.after, i, scene, clearance, way, room)
        ):
            g = arena_extent(arenas, a, work.placed, i, scene[SCALE], clearance, planar, way, True)
            result = 0 if g <= 1.0 else -1
    return result


@inlined
def _part_clears_obstacles(scene, work, i, required):
    """Whether part ``i`` is proved clear of all obstacles over a piece: 1, 0, or −1 if it is not.

    The middle pose is what tells −1.
    """
    obstacles, tree, parts = obstacle_rows(scene), tree_rows(scene), part_rows(scene)
    before, after, placed = work.before, work.after, work.placed
    c = PLACED_CENTRE
    spread = parts[i, PART_RADIUS] + work.room[i] + required
    x0 = min(before[i, c], after[i, c]) - spread
    y0 = min(before[i, c + 1], after[i, c + 1]) - spread
    z0 = min(before[i, c + 2], after[i, c + 2]) - spread
    x1 = max(before[i, c], after[i, c]) + spread
    y1 = max(before[i, c + 1], after[i, c + 1]) + spread
    z1 = max(before[i, c + 2], after[i, c + 2]) + spread
    result = 1
    node = next_overlap(tree, 0, x0, y0, z0, x1, y1, z1)
    while node >= 0 and result >= 0:
        j = int(tree[node, NODE_OBSTACLE])
        reach = obstacles[j, BODY_RADIUS] + spread
        if _distance_to_way(obstacles, j, before, after, i) <= reach:
            lam = obstacles[j, BODY_RADIUS] / (obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS])
            value, ux, uy, uz, lam = separation(obstacles, j, placed, i, lam, required, AIM)
            if not value > required:
                result = -1
            elif result == 1:
                room = required + work.room[i]
                if not (
                    gap_along(obstacles, j, before, i, ux, uy, uz) > room
                    and gap_along(obstacles, j, after, i, ux, uy, uz) > room
                ):
                    result = 0
        node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    return result


@kernel
def _distance_to_way(obstacles, j, before, after, i):
    """Distance of an obstacle's centre from the segment between the part's centres."""
    c = PLACED_CENTRE
    ax, ay, az = before[i, c], before[i, c + 1], before[i, c + 2]
    dx, dy, dz = after[i, c] - ax, after[i, c + 1] - ay, after[i, c + 2] - az
    px = obstacles[j, BODY_CENTRE] - ax
    py = obstacles[j, BODY_CENTRE + 1] - ay
    pz = obstacles[j, BODY_CENTRE + 2] - az
    length = dx * dx + dy * dy + dz * dz
    t = 0.0
    if length > 0.0:
        t = min(max((px * dx + py * dy + pz * dz) / length, 0.0), 1.0)
    return norm(px - t * dx, py - t * dy, pz - t * dz)


@kernel
def _world_piece(scene, kinematics, work, level, half, clearance):
    """Look at one piece of the motion in the world: how many parts are left to prove, or −1.

    ``work.left[level]`` says which parts are looked at, and afterwards which are left.
    """
    _place_piece(scene, kinematics, work, level, half)
    count = 0
    shrinks = clearance > 0.0 and clearance == scene[CLEARANCE]
    for i in range(work.placed.shape[0]):
        if not work.left[level, i]:
            continue
        inside = _part_in_arenas(scene, work, i, clearance, GROW_PART)
        if inside != 1 and shrinks:
            inside = max(inside, _part_in_arenas(scene, work, i, clearance, SHRINK_ARENA))
        required = clearance + 2.0 * ROUNDING * scene[SCALE]
        clear = -1
        if inside >= 0:
            clear = _part_clears_obstacles(scene, work, i, required)
        if clear < 0:
            return -1
        work.left[level, i] = inside == 0 or clear == 0
        count += work.left[level, i]
    return count


@kernel
def _gap_between(first, i, second, j, ux, uy, uz):
    """Gap along u from placed part ``i`` of ``first`` to part ``j`` of ``second``."""
    c, m = PLACED_CENTRE, PLACED_MATRIX
    value = ux * (second[j, c] - first[i, c])
    value += uy * (second[j, c + 1] - first[i, c + 1]) + uz * (second[j, c + 2] - first[i, c + 2])
    px, py, pz = transposed_times(first, i, m, ux, uy, uz)
    qx, qy, qz = transposed_times(second, j, m, ux, uy, uz)
    return value - norm(px, py, pz) - norm(qx, qy, qz)


@kernel
def _self_piece(scene, kinematics, work, level, half):
    """Look at one piece of the robot's motion against itself: as :func:`_world_piece`."""
    _place_piece(scene, kinematics, work, level, half)
    parts, pairs = part_rows(scene), pair_matrix(kinematics)
    shapes, owners = shape_rows(kinematics), owners_of(kinematics)
    before, after, placed, left = work.before, work.after, work.placed, work.left
    count = placed.shape[0]
    required = 2.0 * ROUNDING * scene[SCALE]
    for i in range(count):
        if left[level, i]:
            # A box around the whole piece, from here on in the place of the part's own.
            reach = parts[i, PART_RADIUS] + work.room[i] + required
            for k in range(3):
                c = PLACED_CENTRE + k
                placed[i, PLACED_EXTENT + k] = reach + abs(after[i, c] - placed[i, c])
    sort_along_x(placed, work.order)
    again = left[level + 1]
    for i in range(count):
        again[i] = False
    for a in range(count):
        i = work.order[a]
        if not left[level, i]:
            continue
        high = placed[i, PLACED_CENTRE] + placed[i, PLACED_EXTENT]
        known = False
        for b in range(a + 1, count):
            j = work.order[b]
            if placed[j, PLACED_CENTRE] - placed[j, PLACED_EXTENT] > high:
                break
            if pairs[i, j] == 0.0 or not left[level, j]:
                continue
            apart = norm(
                placed[i, PLACED_CENTRE] - placed[j, PLACED_CENTRE],
                placed[i, PLACED_CENTRE + 1] - placed[j, PLACED_CENTRE + 1],
                placed[i, PLACED_CENTRE + 2] - placed[j, PLACED_CENTRE + 2],
            )
            if apart > norm(
                placed[i, PLACED_EXTENT] + placed[j, PLACED_EXTENT],
                placed[i, PLACED_EXTENT + 1] + placed[j, PLACED_EXTENT + 1],
                placed[i, PLACED_EXTENT + 2] + placed[j, PLACED_EXTENT + 2],
            ):
                continue
            if not known:
                as_body(shapes, i, work.frames[int(owners[i])], placed, work.body)
                known = True
            lam = parts[i, PART_RADIUS] / (parts[i, PART_RADIUS] + parts[j, PART_RADIUS])
            value, ux, uy, uz, lam = separation(work.body, 0, placed, j, lam, required, AIM)
            if not value > required:
                return -1
            room = required + work.room[i] + work.room[j]
            if not (
                _gap_between(before, i, before, j, ux, uy, uz) > room
                and _gap_between(after, i, after, j, ux, uy, uz) > room
            ):
                again[i], again[j] = True, True
    total = 0
    for i in range(count):
        left[level, i] = again[i]
        total += again[i]
    return total


@inlined
def _prove_pieces(scene, kinematics, work, clearance, itself):
    """Prove the motion of ``work.start`` and ``work.rates``: number of pieces, negative if refused.

    Against the world, or if ``itself`` the robot's parts against each other.
    """
    work.stack[0, 0], work.stack[0, 1] = 0.0, 1.0
    for i in range(work.left.shape[1]):
        work.left[0, i] = True
    depth, count, refused = 1, 0, False
    while depth > 0 and not refused:
        level = depth - 1
        low, high = work.stack[level, 0], work.stack[level, 1]
        half = 0.5 * (high - low)
        row_at(kinematics, work.start, work.rates, low + half, work.row)
        if itself:
            for k in range(7):
                work.row[k] = 0.0
            work.row[6] = 1.0
            more = _self_piece(scene, kinematics, work, level, half)
        else:
            more = _world_piece(scene, kinematics, work, level, half, clearance)
        count += 1
        work.pieces[0] += 1
        depth = level
        if more < 0:
            refused = True
        elif more > 0:
            if level + 2 > work.stack.shape[0] or half < 1e-13 or work.pieces[0] > work.pieces[1]:
                refused = True
                continue
            for i in range(work.left.shape[1]):
                work.left[level + 1, i] = work.left[level, i]
            work.stack[level, 0], work.stack[level, 1] = low + half, high
            work.stack[level + 1, 0], work.stack[level + 1, 1] = low, low + half
            depth = level + 2
    return -count if refused else count


@kernel
def _prove_rates(scene, kinematics, work, clearance):
    """Prove the motion of ``work.start`` and ``work.rates``: its pieces, negative if refused."""
    set_bounds(scene, kinematics, work.start, work.rates, True, work.bounds)
    total = _prove_pieces(scene, kinematics, work, clearance, False)
    if total < 0:
        return total
    for k in range(6):
        # Between the robot's own parts the base's motion makes no difference.
        work.all_rates[k], work.rates[k] = work.rates[k], 0.0
    set_bounds(scene, kinematics, work.start, work.rates, False, work.bounds)
    count = _prove_pieces(scene, kinematics, work, clearance, True)
    for k in range(6):
        work.rates[k] = work.all_rates[k]
    return total + count if count > 0 else count - total


@kernel
def _prove_small(scene, kinematics, first, last, clearance, work):
    """Prove what else OMPL may do with tiny rotations: hold them until the end, then jump.

    They are held at the first orientations or, as edges are used backwards, too, at the last
    ones. What turns by half a turn meanwhile does so both ways round.
    """
    total = 0
    for held in range(2):
        for part in range(3):
            for k in range(first.shape[0]):
                work.start[k] = first[k]
            set_rates(scene, kinematics, first, last, work.rates)
            # In the first two parts the tiny rotations are held; the third is their jump, where
            # everything else has come to its end, or has not begun.
            jumps = part == 2
            if (held == 1) != jumps:
                keep_rates(kinematics, not jumps, work.rates)
                row_at(kinematics, first, work.rates, 1.0, work.start)
                set_rates(scene, kinematics, first, last, work.rates)
            keep_rates(kinematics, jumps, work.rates)
            if part == 1 and turn_other_way(kinematics, work.rates) == 0:
                continue
            count = _prove_rates(scene, kinematics, work, clearance)
            if count < 0:
                return count - total
            total += count
    return total


@kernel
def prove_articulated_motion(scene, kinematics, first, last, clearance, work):
    """Prove the motion between two rows (7 + V,) at ``clearance``.

    Returns the number of pieces that it took (≥ 1), or a negative number if it was refused. It is
    refused with more than one half turn, and with several tiny rotations of which it is not
    certain what OMPL makes of them (6e-5 to 2e-4 rad).
    """
    for end in (first, last):
        if not (
            in_bounds(scene, end[0], end[1], end[2])
            and is_rotation(end[3], end[4], end[5], end[6])
            and within_limits(kinematics, end)
        ):
            return -1
    ties, small, unsure = set_rates(scene, kinematics, first, last, work.rates)
    if ties > 1 or (small > 1 and unsure > 0):
        return -1
    for k in range(first.shape[0]):
        work.start[k] = first[k]
    work.pieces[0] = 0
    total = _prove_rates(scene, kinematics, work, clearance)
    if total > 0 and ties == 1:
        if turn_other_way(kinematics, work.rates) != 1:
            return -total
        count = _prove_rates(scene, kinematics, work, clearance)
        total = total + count if count > 0 else count - total
    if total > 0 and small > 0:
        count = _prove_small(scene, kinematics, first, last, clearance, work)
        total = total + count if count > 0 else count - total
    return total


@kernel
def articulated_motion_is_free(scene, kinematics, first, last):
    """Whether the motion between two rows is proved free at the scene's clearance."""
    work = new_motion_workspace(scene, kinematics)
    return prove_articulated_motion(scene, kinematics, first, last, scene[CLEARANCE], work) > 0


@kernel
def articulated_motions_are_free(scene, kinematics, first, last, counts):
    """:func:`prove_articulated_motion` of every pair of rows (m, 7 + V)."""
    work = new_motion_workspace(scene, kinematics)
    for k in range(first.shape[0]):
        counts[k] = prove_articulated_motion(
            scene, kinematics, first[k], last[k], scene[CLEARANCE], work
        )
