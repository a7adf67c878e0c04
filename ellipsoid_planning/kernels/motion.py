"""Certified motion: proofs that a whole motion is free, in continuous time.

Position is linear and rotation about a fixed axis in s from 0 to 1, as OMPL interpolates.

*Obstacles.* For a fixed direction u the gap f(s) of a pair along u is a linear function of s, plus
the centre's circle, minus |Bᵀu| of the turning part. |Bᵀu|² is a trigonometric polynomial P of
degree two whose second derivative is bounded in closed form, and the root lies below its tangent,
so f(s) ≥ f + f′Δ − KΔ²/2 with all three known. Each proof starts from the middle of what is left
of [0, 1] and covers as much as the parabola allows on both sides; about ε^(−½) of them suffice at
clearance ε.

*Arenas.* A ball is convex in the arena's own norm: if a point of the part has the margin δ at both
ends of a piece, it stays inside as long as its path bulges less than δ from the chord, which is at
most K (b − a)²/8 for paths of acceleration K.

*Rounding.* With ε the spacing of doubles at 1 and S the scene's scale, which nothing that is added
here exceeds but for a factor of 2 or the angle (≤ π):

- A part at s is a body moved by at most 20 ε S: the quaternion is off by a few ε whatever its
  length, and the axis' error, ε over the sine, counts only times the angle.
- Value, f′ and K are those of that very body up to the last sums: its matrix' column of length a is
  off by a few ε a, so that f is off by 10 ε S, f′ by 10 ε (|Δx| + φ reach), however thin the body
  is along u, and Δ ≤ 1/2 from the middle of a piece. Together less than 50 ε S.
- Where the terms of K cancel, K is off by 20 ε φ² a: both are small against |Bᵀu| only where the
  other is not. Relative errors of K, and of f′, are covered by the hair that each reach lacks.
- Ends of pieces are off by ε/2 in s: as much as 2 ε S.

All of it is less than the 2 ROUNDING S = 64 ε S by which the gap must exceed the clearance.
"""

import math

import numpy as np

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
    PART_REACH,
    PLACED,
    PLACED_CENTRE,
    PLACED_MATRIX,
    ROUNDING,
    SCALE,
    arena_rows,
    obstacle_rows,
    part_rows,
    tree_rows,
)
from .linear import cross, norm, product, rotation_matrix, transposed_times
from .placement import place_part
from .separation import AIM, separation
from .validity import in_bounds, is_rotation

# OMPL leaves the orientation at the first state's below a rotation of about 9e-5 rad; of 1.5e-4
# if the lengths of its quaternions are off by 1e-9, the most that it takes for valid.
SMALL_ROTATION = 2e-4
# Below this cosine of half the angle, rounding decides which way OMPL turns.
HALF_TURN = 1e-9
# Where a motion's workspace tells how many proofs a pair may take before it is refused.
BUDGET = 14
# Where it tells how far [rad] OMPL's rotation may be from the motion's at the same s.
UNEVEN = 15
MOTION = 16
# Squares of quaternions that differ from 1 by more are no state of OMPL's.
_MOST_UNEVEN = 2e-9
_MOST_PROOFS = 1e6
_STACK = 128


@kernel
def _place_at(parts, i, motion, s, placed):
    """Write part ``i`` at parameter ``s`` of the motion to ``placed[0]``: its lever (3 numbers).

    That is the part's centre relative to the base. ``motion`` holds x₀ (3), Δx (3), q₀ (4), the
    axis (3) and the angle.
    """
    half = 0.5 * s * motion[13]
    sine = math.sin(half)
    rotation = rotation_matrix(
        *product(
            sine * motion[10],
            sine * motion[11],
            sine * motion[12],
            math.cos(half),
            motion[6],
            motion[7],
            motion[8],
            motion[9],
        )
    )
    # The lever comes first: far from the origin it would be lost in the difference of positions.
    place_part(parts, i, 0.0, 0.0, 0.0, rotation, placed, 0)
    rx, ry, rz = (
        placed[0, PLACED_CENTRE],
        placed[0, PLACED_CENTRE + 1],
        placed[0, PLACED_CENTRE + 2],
    )
    placed[0, PLACED_CENTRE] = motion[0] + s * motion[3] + rx
    placed[0, PLACED_CENTRE + 1] = motion[1] + s * motion[4] + ry
    placed[0, PLACED_CENTRE + 2] = motion[2] + s * motion[5] + rz
    return rx, ry, rz


@kernel
def _parabola(motion, placed, rx, ry, rz, ux, uy, uz):
    """(f′, K) of the gap along u at the placed part, whose centre is r from the base."""
    nx, ny, nz, angle = motion[10], motion[11], motion[12], motion[13]
    slope = ux * motion[3] + uy * motion[4] + uz * motion[5]
    if angle == 0.0:
        return slope, 0.0
    along = ux * nx + uy * ny + uz * nz
    tx, ty, tz = cross(nx, ny, nz, ux, uy, uz)
    # u·(n × r) = −r·(n × u)
    slope -= angle * (rx * tx + ry * ty + rz * tz)
    rn = rx * nx + ry * ny + rz * nz
    radius = norm(rx - rn * nx, ry - rn * ny, rz - rn * nz)
    circle = norm(tx, ty, tz) * radius
    q0, q1, q2 = transposed_times(placed, 0, PLACED_MATRIX, ux, uy, uz)
    a0, a1, a2 = transposed_times(placed, 0, PLACED_MATRIX, along * nx, along * ny, along * nz)
    b0, b1, b2 = q0 - a0, q1 - a1, q2 - a2
    c0, c1, c2 = transposed_times(placed, 0, PLACED_MATRIX, tx, ty, tz)
    height = norm(q0, q1, q2)
    if not height > 0.0:
        return slope, math.inf
    slope += angle * (q0 * c0 + q1 * c1 + q2 * c2) / height
    first = norm(a0 * b0 + a1 * b1 + a2 * b2, a0 * c0 + a1 * c1 + a2 * c2, 0.0)
    second = norm(
        0.5 * (b0 * b0 + b1 * b1 + b2 * b2 - c0 * c0 - c1 * c1 - c2 * c2),
        b0 * c0 + b1 * c1 + b2 * c2,
        0.0,
    )
    bend = circle + (2.0 * first + 4.0 * second) / (2.0 * height)
    return slope, angle * angle * bend


@kernel
def _reach(value, slope, bend):
    """Largest Δ ≥ 0 with value + slope Δ − bend Δ²/2 ≥ 0, a hair less.

    For value > 0 and bend ≥ 0. Either form adds numbers of one sign, so its relative error is a few
    units of rounding, which the hair (1e-6) covers; root − |slope| would be noise where value is
    tiny against slope². What is too large to tell, or no number, reaches nowhere.
    """
    root = math.sqrt(slope * slope + 2.0 * bend * value)
    if not root < math.inf:
        return 0.0
    # No less than |slope| even where the squares are too small for doubles.
    root = max(root, abs(slope))
    if slope < 0.0:
        return 0.999999 * 2.0 * value / (root - slope)
    if bend == 0.0:
        return math.inf
    return 0.999999 * (slope + root) / bend


@inlined
def _pair_is_free(obstacles, j, parts, i, motion, required, placed, stack):
    """Prove one pair along the whole motion: number of proofs, or its negative if refused."""
    lam = obstacles[j, BODY_RADIUS] / (obstacles[j, BODY_RADIUS] + parts[i, PART_RADIUS])
    stack[0, 0], stack[0, 1] = 0.0, 1.0
    depth, count = 1, 0
    while depth > 0:
        depth -= 1
        low, high = stack[depth, 0], stack[depth, 1]
        middle = 0.5 * (low + high)
        rx, ry, rz = _place_at(parts, i, motion, middle, placed)
        value, ux, uy, uz, lam = separation(obstacles, j, placed, 0, lam, required, AIM)
        lam = min(max(lam, 1e-9), 1.0 - 1e-9)
        count += 1
        if not value > required or count > motion[BUDGET] or high - low < 1e-14:
            return -count
        slope, bend = _parabola(motion, placed, rx, ry, rz, ux, uy, uz)
        half = 0.5 * (high - low)
        left = _reach(value - required, -slope, bend)
        right = _reach(value - required, slope, bend)
        if depth + 2 > stack.shape[0]:
            return -count
        if not left >= half:
            stack[depth, 0], stack[depth, 1] = low, middle - left
            depth += 1
        if not right >= half:
            stack[depth, 0], stack[depth, 1] = middle + right, high
            depth += 1
    return count


@kernel
def _arena_margin(scene, arenas, a, parts, i, motion, s, clearance, way, exact, placed):
    _place_at(parts, i, motion, s, placed)
    planar = scene[DIMENSION] == 2.0
    g = arena_extent(arenas, a, placed, 0, scene[SCALE], clearance, planar, way, exact)
    return 1.0 - math.sqrt(g)


@kernel
def unevenness(row, v):
    """By how much the square of the quaternion at ``v`` differs from 1; 0 if OMPL refuses it.

    Such a one stands for its rotation, whatever its length. OMPL interpolates the others as they
    are: between two whose squares differ from 1 by d₁ and d₂, its rotation at s is off by at
    most (d₁ + d₂)/2, most of it half-way through half a turn (d₁ ≠ d₂ shifts the mixture's weights,
    and the angle is that of the product). Twice that also covers the rounding of both.
    """
    square = row[v] ** 2 + row[v + 1] ** 2 + row[v + 2] ** 2 + row[v + 3] ** 2
    away = abs(square - 1.0)
    return away if away <= _MOST_UNEVEN else 0.0


@kernel
def _stays_in_arena(scene, arenas, a, parts, i, motion, clearance, way, placed, stack):
    """Prove that part ``i`` stays in arena ``a``: number of proofs, or its negative if refused."""
    nx, ny, nz, angle = motion[10], motion[11], motion[12], motion[13]
    rx, ry, rz = _place_at(parts, i, motion, 0.0, placed)
    rn = rx * nx + ry * ny + rz * nz
    radius = norm(rx - rn * nx, ry - rn * ny, rz - rn * nz) + parts[i, PART_RADIUS]
    size = inverse_size(arenas, a, BODY_WHITEN if way == SHRINK_ARENA else BODY_INVERSE)
    bulge = angle * angle * radius * size / 8.0
    slack = motion[UNEVEN] * parts[i, PART_REACH] * size
    count = 2
    first = _arena_margin(scene, arenas, a, parts, i, motion, 0.0, clearance, way, False, placed)
    last = _arena_margin(scene, arenas, a, parts, i, motion, 1.0, clearance, way, False, placed)
    if min(first, last) >= bulge + slack:
        return count
    first = _arena_margin(scene, arenas, a, parts, i, motion, 0.0, clearance, way, True, placed)
    last = _arena_margin(scene, arenas, a, parts, i, motion, 1.0, clearance, way, True, placed)
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0.0, 1.0, first, last
    depth = 1
    while depth > 0:
        depth -= 1
        low, high, first, last = stack[depth, 0], stack[depth, 1], stack[depth, 2], stack[depth, 3]
        if not min(first, last) >= slack or count > motion[BUDGET] or high - low < 1e-14:
            return -count
        if min(first, last) >= bulge * (high - low) ** 2 + slack:
            continue
        middle = 0.5 * (low + high)
        count += 1
        at = _arena_margin(scene, arenas, a, parts, i, motion, middle, clearance, way, True, placed)
        if depth + 2 > stack.shape[0]:
            return -count
        stack[depth, 0], stack[depth, 1] = low, middle
        stack[depth, 2], stack[depth, 3] = first, at
        stack[depth + 1, 0], stack[depth + 1, 1] = middle, high
        stack[depth + 1, 2], stack[depth + 1, 3] = at, last
        depth += 2
    return count


@kernel
def _distance_to_segment(px, py, pz, ax, ay, az, dx, dy, dz):
    """Distance of the point p from the segment a + [0, 1] d."""
    px, py, pz = px - ax, py - ay, pz - az
    length = dx * dx + dy * dy + dz * dz
    t = 0.0
    if length > 0.0:
        t = min(max((px * dx + py * dy + pz * dz) / length, 0.0), 1.0)
    return norm(px - t * dx, py - t * dy, pz - t * dz)


@kernel
def _sweep_is_free(scene, motion, clearance, placed, stack):
    """Prove one interpolation: number of proofs, or its negative if refused."""
    obstacles, arenas = obstacle_rows(scene), arena_rows(scene)
    parts, tree = part_rows(scene), tree_rows(scene)
    nx, ny, nz, angle = motion[10], motion[11], motion[12], motion[13]
    total = 0
    for i in range(parts.shape[0]):
        for a in range(arenas.shape[0]):
            count = _stays_in_arena(
                scene, arenas, a, parts, i, motion, clearance, GROW_PART, placed, stack
            )
            if count < 0 and clearance > 0.0 and clearance == scene[CLEARANCE]:
                count = _stays_in_arena(
                    scene, arenas, a, parts, i, motion, clearance, SHRINK_ARENA, placed, stack
                )
            if count < 0:
                return count - total
            total += count
    for i in range(parts.shape[0]):
        required = clearance + 2.0 * ROUNDING * scene[SCALE]
        required += motion[UNEVEN] * parts[i, PART_REACH]
        rx, ry, rz = _place_at(parts, i, motion, 0.5, placed)
        rn = rx * nx + ry * ny + rz * nz
        swing = 2.0 * norm(rx - rn * nx, ry - rn * ny, rz - rn * nz) * math.sin(0.25 * angle)
        spread = swing + parts[i, PART_RADIUS] + 2.0 * required
        ax, ay, az = motion[0] + rx, motion[1] + ry, motion[2] + rz
        dx, dy, dz = motion[3], motion[4], motion[5]
        x0, x1 = ax + min(dx, 0.0) - spread, ax + max(dx, 0.0) + spread
        y0, y1 = ay + min(dy, 0.0) - spread, ay + max(dy, 0.0) + spread
        z0, z1 = az + min(dz, 0.0) - spread, az + max(dz, 0.0) + spread
        node = next_overlap(tree, 0, x0, y0, z0, x1, y1, z1)
        while node >= 0:
            j = int(tree[node, NODE_OBSTACLE])
            cx, cy = obstacles[j, BODY_CENTRE], obstacles[j, BODY_CENTRE + 1]
            cz = obstacles[j, BODY_CENTRE + 2]
            away = _distance_to_segment(cx, cy, cz, ax, ay, az, dx, dy, dz)
            if away <= spread + obstacles[j, BODY_RADIUS]:
                count = _pair_is_free(obstacles, j, parts, i, motion, required, placed, stack)
                if count < 0:
                    return count - total
                total += count
            node = next_overlap(tree, node + 1, x0, y0, z0, x1, y1, z1)
    return total + 1


@kernel
def _set_motion(motion, first, move, turn, ax, ay, az, angle):
    """Fill ``motion``: from ``first``, by Δx = ``move``, turning by ``angle`` about the axis."""
    for k in range(3):
        motion[k] = first[k]
        motion[3 + k] = move[k]
    for k in range(4):
        motion[6 + k] = turn[k]
    motion[10], motion[11], motion[12], motion[13] = ax, ay, az, angle


@inlined
def _small_turn_is_free(scene, first, last, move, axis, angle, clearance, motion, placed, stack):
    """Everything OMPL may do at a tiny rotation: hold either orientation, turn, or jump."""
    ax, ay, az = axis
    still = (0.0, 0.0, 0.0)
    total = 0
    for k in range(5):
        if k == 0:
            _set_motion(motion, first, move, first[3:7], ax, ay, az, angle)
        elif k == 1:
            _set_motion(motion, first, move, first[3:7], ax, ay, az, 0.0)
        elif k == 2:
            _set_motion(motion, first, move, last[3:7], ax, ay, az, 0.0)
        elif k == 3:
            _set_motion(motion, first, still, first[3:7], ax, ay, az, angle)
        else:
            _set_motion(motion, last, still, first[3:7], ax, ay, az, angle)
        count = _sweep_is_free(scene, motion, clearance, placed, stack)
        if count < 0:
            return count - total
        total += count
    return total


@kernel
def prove_motion(scene, first, last, clearance, motion, placed, stack):
    """Prove the motion between two poses (7,) at ``clearance``.

    Returns the number of proofs it took (≥ 1), or a negative number if it was refused. The
    workspaces are those of :func:`motion_workspaces`.
    """
    for end in (first, last):
        if not (
            in_bounds(scene, end[0], end[1], end[2]) and is_rotation(end[3], end[4], end[5], end[6])
        ):
            return -1
    motion[UNEVEN] = unevenness(first, 3) + unevenness(last, 3)
    move = (last[0] - first[0], last[1] - first[1], last[2] - first[2])
    # Orientations r and q are joined by r q⁻¹, in the world frame.
    tx, ty, tz, tw = product(
        last[3], last[4], last[5], last[6], -first[3], -first[4], -first[5], first[6]
    )
    if tw < 0.0:
        tx, ty, tz, tw = -tx, -ty, -tz, -tw
    # Quaternions have any length.
    size = math.sqrt(tx * tx + ty * ty + tz * tz + tw * tw)
    tx, ty, tz, tw = tx / size, ty / size, tz / size, tw / size
    sine = norm(tx, ty, tz)
    if sine <= 1e-15:
        _set_motion(motion, first, move, first[3:7], 0.0, 0.0, 1.0, 0.0)
        return _sweep_is_free(scene, motion, clearance, placed, stack)
    ax, ay, az = tx / sine, ty / sine, tz / sine
    angle = 2.0 * math.atan2(sine, tw)
    if angle < SMALL_ROTATION and scene[DIMENSION] == 3.0:
        axis = (ax, ay, az)
        return _small_turn_is_free(
            scene, first, last, move, axis, angle, clearance, motion, placed, stack
        )
    _set_motion(motion, first, move, first[3:7], ax, ay, az, angle)
    total = _sweep_is_free(scene, motion, clearance, placed, stack)
    if tw < HALF_TURN and total > 0:
        _set_motion(motion, first, move, first[3:7], -ax, -ay, -az, 2.0 * math.pi - angle)
        count = _sweep_is_free(scene, motion, clearance, placed, stack)
        total = count + total if count > 0 else count - total
    return total


@kernel
def motion_workspaces():
    """Fresh workspaces for :func:`prove_motion`: (motion, placed, stack)."""
    motion = np.empty(MOTION)
    motion[BUDGET] = _MOST_PROOFS
    return motion, np.empty((1, PLACED)), np.empty((_STACK, 4))


@kernel
def spatial_motion_is_free(scene, x0, y0, z0, a0, b0, c0, d0, x1, y1, z1, a1, b1, c1, d1):
    """Whether the motion between two spatial poses is proved free at the scene's clearance."""
    ends = np.empty((2, 7))
    ends[0, 0], ends[0, 1], ends[0, 2] = x0, y0, z0
    ends[0, 3], ends[0, 4], ends[0, 5], ends[0, 6] = a0, b0, c0, d0
    ends[1, 0], ends[1, 1], ends[1, 2] = x1, y1, z1
    ends[1, 3], ends[1, 4], ends[1, 5], ends[1, 6] = a1, b1, c1, d1
    motion, placed, stack = motion_workspaces()
    return prove_motion(scene, ends[0], ends[1], scene[CLEARANCE], motion, placed, stack) > 0


@kernel
def planar_motion_is_free(scene, x0, y0, yaw0, x1, y1, yaw1):
    """:func:`spatial_motion_is_free` between two planar configurations."""
    return spatial_motion_is_free(
        scene,
        x0,
        y0,
        0.0,
        0.0,
        0.0,
        math.sin(0.5 * yaw0),
        math.cos(0.5 * yaw0),
        x1,
        y1,
        0.0,
        0.0,
        0.0,
        math.sin(0.5 * yaw1),
        math.cos(0.5 * yaw1),
    )


@kernel
def motions_are_free(scene, first, last, counts):
    """:func:`prove_motion` of every pair of rows (m, 7) at the scene's clearance."""
    motion, placed, stack = motion_workspaces()
    for k in range(first.shape[0]):
        counts[k] = prove_motion(scene, first[k], last[k], scene[CLEARANCE], motion, placed, stack)
