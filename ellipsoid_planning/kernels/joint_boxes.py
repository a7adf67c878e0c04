"""Can two links meet within boxes of joint values? Branch and bound, proved either way.

Only the joints on the way from the first link to the second matter. Each gives a *coordinate*, a
ball joint three: its rotation is Rz(α) Rx(β) Rz(γ) with α, γ in [−π, π] and β in [0, π], which
covers all rotations. A box is an interval of each.

Within a box, points stay close to where they stand at its centre. Hold the body between two
neighbouring coordinates: those on its one side move the first link, the others the second one.
Take the joints of one side from the held body outwards, each with those beyond it still at the
centre: a turn by up to h moves a point by at most 2 r sin(h/2), where r is its distance from the
joint's axis *at the centre*, as what comes before moves both rigidly. So if the gap at the centre
exceeds the sum over all coordinates, at any split, the links meet nowhere in the box. As a second
proof, a link may be replaced by a ball about a point of the axis (or the centre) of its nearest
joint: turning a ball moves it by what it moves its centre, which here is nothing.
"""

import math

import numpy as np

from .compile import inlined, kernel
from .containers import pop, push
from .kinematics import (
    FRAME_TRANSLATION,
    JOINT_PARENT,
    JOINT_ROTATION,
    JOINT_VALUE,
    WIDTH,
    hang,
    joint_rows,
    new_frames,
    owners_of,
    shape_rows,
)
from .layout import PART_RADIUS, PLACED, PLACED_CENTRE, PLACED_MATRIX
from .linear import cross, norm
from .placement import place_part
from .self_collision import as_body, new_body
from .separation import DECIDE, separation

# Coordinate rows: the joint, what of it, the limits.
COORDINATE_JOINT = 0
COORDINATE_ROLE = 1
COORDINATE_LOW = 2
COORDINATE_HIGH = 3
COORDINATE = 4

SLIDE = 0
TURN = 1
ALPHA = 2
BETA = 3
GAMMA = 4

NEVER = 0
MEET = 1
UNDECIDED = 2

# Sums of a few dozen rounded products; a millionfold of what they can be off.
_MARGIN = 1.0 + 1e-9

_LINE = 6  # a point, and a unit vector


@kernel
def set_values(joints, coordinates, values, row):
    """Write the coordinates' ``values`` (D,) to the joints' places in ``row``."""
    for k in range(coordinates.shape[0]):
        v = int(joints[int(coordinates[k, COORDINATE_JOINT]), JOINT_VALUE])
        role = int(coordinates[k, COORDINATE_ROLE])
        if role <= TURN:
            row[v] = values[k]
        elif role == BETA:
            down = int(coordinates[k - 1, COORDINATE_ROLE]) == ALPHA
            alpha, gamma = values[k - 1], values[k + 1]
            if not down:
                alpha, gamma = gamma, alpha
            c, s = math.cos(0.5 * values[k]), math.sin(0.5 * values[k])
            row[v] = s * math.cos(0.5 * (alpha - gamma))
            row[v + 1] = s * math.sin(0.5 * (alpha - gamma))
            row[v + 2] = c * math.sin(0.5 * (alpha + gamma))
            row[v + 3] = c * math.cos(0.5 * (alpha + gamma))


@kernel
def _write_lines(joints, coordinates, values, frames, lines):
    """Write the axes of all coordinates, (D, _LINE), where the frames stand."""
    for k in range(coordinates.shape[0]):
        j = int(coordinates[k, COORDINATE_JOINT])
        role, parent = int(coordinates[k, COORDINATE_ROLE]), int(joints[j, JOINT_PARENT])
        for m in range(3):
            lines[k, m] = frames[j + 1, FRAME_TRANSLATION + m]
            lines[k, 3 + m] = frames[j + 1, 3 * m + 2]
        if role <= TURN or role == GAMMA:
            continue
        x, y, z = 0.0, 0.0, 1.0
        if role == BETA:
            down = int(coordinates[k - 1, COORDINATE_ROLE]) == ALPHA
            alpha = values[k - 1] if down else values[k + 1]
            x, y, z = math.cos(alpha), math.sin(alpha), 0.0
        o = JOINT_ROTATION
        px = joints[j, o] * x + joints[j, o + 1] * y + joints[j, o + 2] * z
        py = joints[j, o + 3] * x + joints[j, o + 4] * y + joints[j, o + 5] * z
        pz = joints[j, o + 6] * x + joints[j, o + 7] * y + joints[j, o + 8] * z
        for m in range(3):
            f = frames[parent]
            lines[k, 3 + m] = f[3 * m] * px + f[3 * m + 1] * py + f[3 * m + 2] * pz


@kernel
def _from_line(lines, k, x, y, z):
    """Distance of a point from the axis of coordinate ``k``."""
    x, y, z = x - lines[k, 0], y - lines[k, 1], z - lines[k, 2]
    x, y, z = cross(lines[k, 3], lines[k, 4], lines[k, 5], x, y, z)
    return norm(x, y, z)


@kernel
def _thickness(lines, k, placed, i, radius):
    """How far points of a placed part get from its centre, across the axis of ``k``."""
    total = 0.0
    for m in range(3):
        c = PLACED_MATRIX + m
        x, y, z = cross(
            lines[k, 3], lines[k, 4], lines[k, 5], placed[i, c], placed[i, c + 3], placed[i, c + 6]
        )
        total += x * x + y * y + z * z
    return min(radius, math.sqrt(total))


@inlined
def _swing(half):
    """How far a turn by up to ``half`` moves a point at distance 1 from the axis."""
    return 2.0 * math.sin(0.5 * min(half, math.pi))


@kernel
def _least_split(moves):
    """Least sum over all splits of ``moves`` (D, 2), and the coordinate that counts most in it."""
    count = moves.shape[0]
    total = 0.0
    for k in range(count):
        total += moves[k, 1]
    best, split = total, 0
    for k in range(count):
        total += moves[k, 0] - moves[k, 1]
        if total < best:
            best, split = total, k + 1
    # Summed anew, since differences cancel.
    best, largest, widest = 0.0, -1.0, 0
    for k in range(count):
        move = moves[k, 0] if k < split else moves[k, 1]
        best += move
        if move > largest:
            largest, widest = move, k
    return best * _MARGIN, widest


@kernel
def _part_moves(coordinates, halves, lines, parts, placed, i, side, moves):
    """Write by how much the coordinates move part ``i``, which is on ``side`` 0 or 1."""
    c = PLACED_CENTRE
    for k in range(coordinates.shape[0]):
        if int(coordinates[k, COORDINATE_ROLE]) == SLIDE:
            moves[k, side] = halves[k]
            continue
        far = _from_line(lines, k, placed[i, c], placed[i, c + 1], placed[i, c + 2])
        far += _thickness(lines, k, placed, i, parts[i, PART_RADIUS])
        moves[k, side] = _swing(halves[k]) * far


@kernel
def _ball_moves(coordinates, halves, lines, parts, placed, i, side, moves, centre):
    """As :func:`_part_moves` for a ball about the part; writes its centre, returns its radius."""
    end = 0 if side == 0 else coordinates.shape[0] - 1
    role = int(coordinates[end, COORDINATE_ROLE])
    along = 0.0
    for m in range(3):
        along += lines[end, 3 + m] * (placed[i, PLACED_CENTRE + m] - lines[end, m])
    for m in range(3):
        at = placed[i, PLACED_CENTRE + m]
        if role == TURN:
            at = lines[end, m] + along * lines[end, 3 + m]
        elif role != SLIDE:
            at = lines[end, m]
        centre[m] = at
    c = PLACED_CENTRE
    offset = norm(
        placed[i, c] - centre[0], placed[i, c + 1] - centre[1], placed[i, c + 2] - centre[2]
    )
    for k in range(coordinates.shape[0]):
        far = _from_line(lines, k, centre[0], centre[1], centre[2])
        slide = int(coordinates[k, COORDINATE_ROLE]) == SLIDE
        moves[k, side] = halves[k] if slide else _swing(halves[k]) * far
    return offset + parts[i, PART_RADIUS]


@kernel
def _judge_parts(
    coordinates, halves, lines, parts, shapes, frame, placed, i, j, required, body, moves, centres
):
    """Two parts in a box: (by how much they are proved apart, gap, what to halve).

    The gap is only good for telling whether it exceeds ``required``.
    """
    _part_moves(coordinates, halves, lines, parts, placed, i, 0, moves)
    _part_moves(coordinates, halves, lines, parts, placed, j, 1, moves)
    bound, widest = _least_split(moves)
    c = PLACED_CENTRE
    gap = norm(
        placed[i, c] - placed[j, c],
        placed[i, c + 1] - placed[j, c + 1],
        placed[i, c + 2] - placed[j, c + 2],
    )
    gap -= parts[i, PART_RADIUS] + parts[j, PART_RADIUS]
    if gap > bound + required:
        return gap - bound, gap, widest
    as_body(shapes, i, frame, placed, body)
    lam = parts[i, PART_RADIUS] / (parts[i, PART_RADIUS] + parts[j, PART_RADIUS])
    gap = separation(body, 0, placed, j, lam, bound + required, DECIDE)[0]
    if gap > bound + required or not gap > required:
        return gap - bound, gap, widest
    radii = _ball_moves(coordinates, halves, lines, parts, placed, i, 0, moves, centres[0])
    radii += _ball_moves(coordinates, halves, lines, parts, placed, j, 1, moves, centres[1])
    room, other = _least_split(moves)
    a, b = centres[0], centres[1]
    apart = norm(a[0] - b[0], a[1] - b[1], a[2] - b[2]) - radii
    if apart - room > gap - bound and apart > required:
        return apart - room, gap, other
    return gap - bound, gap, widest


@kernel
def search_boxes(
    kinematics, parts, route, top, coordinates, first, second, tolerance, required, budget, example
):
    """Whether two links meet within limits: (verdict, number of pairs of parts tested).

    ``route`` are the joints on the way, parents before children, ``top`` the body that all of them
    hang on; ``coordinates`` (D, COORDINATE) lead from the first link to the second, whose parts
    are ``first`` and ``second``. MEET writes the values (D,) of an ``example`` within the limits
    where two parts are not proved more than ``required`` apart; NEVER is a proof for the limits
    widened by ``tolerance``; UNDECIDED if ``budget`` tests do not do.
    """
    joints, shapes, owners = joint_rows(kinematics), shape_rows(kinematics), owners_of(kinematics)
    count = coordinates.shape[0]
    boxes = np.empty((budget + 2, 2, count))
    heap, items, free, used = np.empty(budget + 2), np.empty(budget + 2, np.int64), 0, 1
    frames, placed = new_frames(kinematics), np.empty((parts.shape[0], PLACED))
    row, lines, moves = (
        np.zeros(int(kinematics[WIDTH])),
        np.empty((count, _LINE)),
        np.empty((count, 2)),
    )
    halves, centres, body = np.empty(count), np.empty((2, 3)), new_body()
    frames[top] = 0.0
    frames[top, 0] = frames[top, 4] = frames[top, 8] = 1.0
    for k in range(count):
        boxes[0, 0, k] = coordinates[k, COORDINATE_LOW] - tolerance
        boxes[0, 1, k] = coordinates[k, COORDINATE_HIGH] + tolerance
    box, children, widest, tests = 0, 1, 0, 0
    splits = np.empty(budget + 2, np.int64)
    stuck = False
    while True:
        for child in range(children):
            current = box if child == 0 else used - 1
            for k in range(count):
                low, high = boxes[current, 0, k], boxes[current, 1, k]
                middle = max(0.5 * (low + high), coordinates[k, COORDINATE_LOW])
                middle = min(middle, coordinates[k, COORDINATE_HIGH])
                example[k], halves[k] = middle, max(high - middle, middle - low)
            set_values(joints, coordinates, example, row)
            for j in route:
                hang(joints, j, int(joints[j, JOINT_PARENT]), row, frames)
            _write_lines(joints, coordinates, example, frames, lines)
            for side in range(2):
                for i in first if side == 0 else second:
                    f = frames[int(owners[i])]
                    turn = (f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])
                    place_part(parts, i, f[9], f[10], f[11], turn, placed, i)
            worst = math.inf
            for i in first:
                for j in second:
                    if tests >= budget:
                        return UNDECIDED, tests
                    tests += 1
                    frame = frames[int(owners[i])]
                    slack, gap, split = _judge_parts(
                        coordinates, halves, lines, parts, shapes, frame, placed, i, j, required,
                        body, moves, centres,
                    )  # fmt: skip
                    if not gap > required:
                        return MEET, tests
                    if slack < worst:
                        worst, widest = slack, split
            if worst > required:
                continue
            if halves[widest] <= 2.0 * tolerance:
                stuck = True  # as small as boxes get
                continue
            splits[current] = widest
            free = push(heap, items, free, worst, current)
        if free == 0:
            return (UNDECIDED if stuck else NEVER), tests
        box = pop(heap, items, free)
        free -= 1
        k = splits[box]
        for side in range(2):
            for m in range(count):
                boxes[used, side, m] = boxes[box, side, m]
        middle = 0.5 * (boxes[box, 0, k] + boxes[box, 1, k])
        boxes[box, 1, k] = boxes[used, 0, k] = middle
        used += 1
        children = 2
