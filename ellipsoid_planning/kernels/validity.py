"""Validity and clearance of single configurations."""

import math

from .broad_phase import near_obstacle, next_overlap
from .compile import inlined, kernel
from .containment import GROW_PART, SHRINK_ARENA, arena_extent
from .depths import depth_outside, least_depth
from .layout import (
    BODY_CENTRE,
    BODY_RADIUS,
    CLEARANCE,
    DIMENSION,
    HIGH,
    LOW,
    NODE_OBSTACLE,
    PART_RADIUS,
    PLACED_CENTRE,
    PLACED_EXTENT,
    ROUNDING,
    SCALE,
    arena_rows,
    new_placed,
    obstacle_rows,
    part_rows,
    tree_rows,
)
from .linear import norm
from .placement import place
from .separation import CONVERGE, DECIDE, separation


@kernel
def in_bounds(scene, x, y, z):
    """Whether the base position lies in the closed box of the bounds."""
    return (
        x >= scene[LOW]
        and x <= scene[HIGH]
        and y >= scene[LOW + 1]
        and y <= scene[HIGH + 1]
        and z >= scene[LOW + 2]
        and z <= scene[HIGH + 2]
    )


@kernel
def is_rotation(qx, qy, qz, qw):
    """Whether a quaternion of any length (1e-50 to 1e50) stands for a rotation.

    Beyond that products of two of them, or their squares, overflow or vanish.
    """
    square = qx * qx + qy * qy + qz * qz + qw * qw
    return square > 1e-100 and square < 1e100


@inlined
def in_arena(arenas, a, placed, i, scene):
    """Whether part ``i`` provably keeps the scene's clearance inside arena ``a``."""
    clearance, planar = scene[CLEARANCE], scene[DIMENSION] == 2.0
    scale = scene[SCALE]
    if arena_extent(arenas, a, placed, i, scale, clearance, planar, GROW_PART, False) <= 1.0:
        return True
    if clearance <= 0.0:
        return False
    return arena_extent(arenas, a, placed, i, scale, clearance, planar, SHRINK_ARENA, False) <= 1.0


@kernel
def part_is_free(scene, placed, i):
    """Whether placed part ``i`` provably keeps its clearance from obstacles and arenas."""
    obstacles, arenas = obstacle_rows(scene), arena_rows(scene)
    parts, tree = part_rows(scene), tree_rows(scene)
    required = scene[CLEARANCE] + ROUNDING * scene[SCALE]
    for a in range(arenas.shape[0]):
        if not in_arena(arenas, a, placed, i, scene):
            return False
    cx = placed[i, PLACED_CENTRE]
    cy = placed[i, PLACED_CENTRE + 1]
    cz = placed[i, PLACED_CENTRE + 2]
    ex = placed[i, PLACED_EXTENT] + required
    ey = placed[i, PLACED_EXTENT + 1] + required
    ez = placed[i, PLACED_EXTENT + 2] + required
    x0, y0, z0, x1, y1, z1 = cx - ex, cy - ey, cz - ez, cx + ex, cy + ey, cz + ez
    node = next_overlap(tree, 0, x0, y0, z0, x1, y1, z1)
    while node >= 0:
        j = int(tree[node, NODE_OBSTACLE])
        reach = obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS] + 2.0 * required
        distance = norm(
            cx - obstacles[j, BODY_CENTRE],
            cy - obstacles[j, BODY_CENTRE + 1],
            cz - obstacles[j, BODY_CENTRE + 2],
        )
        if distance <= reach:
            start = obstacles[j, BODY_RADIUS]
            lam = start / (start + parts[i, PART_RADIUS])
            value = separation(obstacles, j, placed, i, lam, required, DECIDE)[0]
            if not value > required:
                return False
        node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    return True


@kernel
def placed_is_free(scene, placed):
    """Whether the placed robot provably keeps its clearance from obstacles and arenas."""
    for i in range(placed.shape[0]):  # noqa: SIM110 (numba compiles loops best)
        if not part_is_free(scene, placed, i):
            return False
    return True


@kernel
def configuration_is_free(scene, x, y, z, qx, qy, qz, qw):
    """Whether a configuration is provably free, in bounds and at the scene's clearance."""
    if not (in_bounds(scene, x, y, z) and is_rotation(qx, qy, qz, qw)):
        return False
    placed = new_placed(scene)
    place(scene, x, y, z, qx, qy, qz, qw, placed)
    return placed_is_free(scene, placed)


@kernel
def planar_is_free(scene, x, y, yaw):
    """:func:`configuration_is_free` of a planar configuration."""
    return configuration_is_free(
        scene, x, y, 0.0, 0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw)
    )


@kernel
def are_free(scene, poses, out):
    """:func:`configuration_is_free` of every row (x, y, z, q_x, q_y, q_z, q_w) of ``poses``."""
    placed = new_placed(scene)
    for k in range(poses.shape[0]):
        p = poses[k]
        out[k] = in_bounds(scene, p[0], p[1], p[2]) and is_rotation(p[3], p[4], p[5], p[6])
        if out[k]:
            place(scene, p[0], p[1], p[2], p[3], p[4], p[5], p[6], placed)
            out[k] = placed_is_free(scene, placed)


@kernel
def _arena_gap(arenas, a, placed, i, scene):
    """Lower bound of the distance of part ``i`` from the wall of arena ``a``.

    Minus how far it sticks out where it is not inside.
    """
    planar, scale = scene[DIMENSION] == 2.0, scene[SCALE]
    if arena_extent(arenas, a, placed, i, scale, 0.0, planar, GROW_PART, True) > 1.0:
        return min(-depth_outside(arenas, a, placed, i, planar), 0.0)
    low, high = 0.0, arenas[a, BODY_RADIUS]
    while high - low > 1e-6 * high + ROUNDING * scale:
        middle = 0.5 * (low + high)
        if arena_extent(arenas, a, placed, i, scale, middle, planar, GROW_PART, False) <= 1.0:
            low = middle
        else:
            high = middle
    return low


@kernel
def _signed_gap(obstacles, j, parts, placed, i, scene):
    """Converged distance of part ``i`` and obstacle ``j``, minus the depth where they meet."""
    lam = obstacles[j, BODY_RADIUS] / (obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS])
    value, ux, uy, uz, _ = separation(obstacles, j, placed, i, lam, math.inf, CONVERGE)
    if value <= 0.0:
        planar = scene[DIMENSION] == 2.0
        value = max(value, least_depth(obstacles, j, placed, i, ux, uy, uz, planar))
    return value


@kernel
def _obstacle_gap(obstacles, j, parts, placed, i, scene):
    """Lower bound of the signed distance of part ``i`` and obstacle ``j``."""
    return _signed_gap(obstacles, j, parts, placed, i, scene) - ROUNDING * scene[SCALE]


@kernel
def obstacle_gaps(scene, placed, out):
    """Proved gaps, shape (k, m), of every part and obstacle; minus the depth where they meet."""
    obstacles, parts = obstacle_rows(scene), part_rows(scene)
    for i in range(placed.shape[0]):
        for j in range(obstacles.shape[0]):
            out[i, j] = _obstacle_gap(obstacles, j, parts, placed, i, scene)


@kernel
def arena_gaps(scene, placed, out):
    """Distances (k, a) of every part from every arena's wall; minus what sticks out."""
    arenas = arena_rows(scene)
    for i in range(placed.shape[0]):
        for a in range(arenas.shape[0]):
            out[i, a] = _arena_gap(arenas, a, placed, i, scene)


@kernel
def clearance_of(scene, x, y, z, qx, qy, qz, qw):
    """Signed clearance: a lower bound of the distance to obstacles and arenas' walls.

    Infinite in an empty world. Where the robot meets something, minus the deepest penetration of a
    pair of bodies, each the shallowest that was found, or minus how far it sticks out of an arena.
    """
    placed = new_placed(scene)
    place(scene, x, y, z, qx, qy, qz, qw, placed)
    return placed_clearance(scene, placed)


@kernel
def placed_clearance(scene, placed):
    """:func:`clearance_of` a robot whose parts are placed already."""
    obstacles, arenas = obstacle_rows(scene), arena_rows(scene)
    parts, tree = part_rows(scene), tree_rows(scene)
    best = math.inf
    for i in range(placed.shape[0]):
        for a in range(arenas.shape[0]):
            best = min(best, _arena_gap(arenas, a, placed, i, scene))
    for i in range(placed.shape[0]):
        cx = placed[i, PLACED_CENTRE]
        cy = placed[i, PLACED_CENTRE + 1]
        cz = placed[i, PLACED_CENTRE + 2]
        # A near obstacle comes first, so that the box is small from the beginning.
        near = near_obstacle(tree, cx, cy, cz)
        if near >= 0:
            best = min(best, _obstacle_gap(obstacles, near, parts, placed, i, scene))
        node = 0
        while node >= 0 and node < tree.shape[0]:
            # The box shrinks as better distances are found.
            room = max(best, 0.0) if best < math.inf else 1e300
            ex = placed[i, PLACED_EXTENT] + room
            ey = placed[i, PLACED_EXTENT + 1] + room
            ez = placed[i, PLACED_EXTENT + 2] + room
            node = next_overlap(tree, node, cx - ex, cy - ey, cz - ez, cx + ex, cy + ey, cz + ez)
            if node < 0:
                break
            j = int(tree[node, NODE_OBSTACLE])
            if j != near:
                best = min(best, _obstacle_gap(obstacles, j, parts, placed, i, scene))
            node += 1
    return best


@kernel
def in_arenas(scene, placed, out):
    """Whether, shape (k, a), every part keeps the clearance inside every arena."""
    arenas = arena_rows(scene)
    for i in range(placed.shape[0]):
        for a in range(arenas.shape[0]):
            out[i, a] = in_arena(arenas, a, placed, i, scene)
