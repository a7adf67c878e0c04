"""Pieces of motions of articulated robots against obstacles and arenas (see articulated_motion)."""

import math

from .articulated_pieces import place_piece
from .broad_phase import next_overlap
from .compile import inlined, kernel
from .containment import GROW_PART, SHRINK_ARENA, arena_extent, inverse_size
from .layout import (
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_RADIUS,
    BODY_WHITEN,
    CLEARANCE,
    DIMENSION,
    NODE_OBSTACLE,
    PART_RADIUS,
    PLACED_CENTRE,
    ROUNDING,
    SCALE,
    arena_rows,
    obstacle_rows,
    part_rows,
    tree_rows,
)
from .linear import norm
from .separation import AIM, gap_along, separation


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
def world_piece(scene, kinematics, work, level, half, clearance):
    """Look at one piece of the motion in the world: how many parts are left to prove, or −1.

    ``work.left[level]`` says which parts are looked at, and afterwards which are left.
    """
    place_piece(scene, kinematics, work, level, half)
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
