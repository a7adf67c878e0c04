"""Pieces of an articulated robot's motions: its parts against each other (articulated_motion)."""

from .articulated_pieces import place_piece
from .compile import kernel
from .kinematics import owners_of, pair_matrix, shape_rows
from .layout import (
    PART_RADIUS,
    PLACED_CENTRE,
    PLACED_EXTENT,
    PLACED_MATRIX,
    ROUNDING,
    SCALE,
    part_rows,
)
from .linear import norm, transposed_times
from .self_collision import as_body, sort_along_x
from .separation import AIM, separation


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
def self_piece(scene, kinematics, work, level, half):
    """Look at one piece of the robot's motion against itself: as articulated_world.world_piece."""
    place_piece(scene, kinematics, work, level, half)
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
