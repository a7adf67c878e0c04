"""Following a passage from a pose inside it, in all of C-space: proved motions end to end.

Each step goes on along the last one, centres the robot across it and proves the motion. Steps grow
while proofs succeed and shrink when one is refused, so that a passage that is bent by κ and leaves
a play ε is followed in steps of about √(ε/κ), a straight one in one.
"""

import math

from .centring import centre, robot_reach
from .compile import inlined, kernel
from .contact_model import GAP, GRADIENT, contact_model, difference, moved, smallest_gap
from .layout import CLEARANCE
from .motion import SMALL_ROTATION, prove_motion

# How far following has come (PROGRESS[STATE]).
NEW = 0.0
FOLLOWING = 1.0
OPEN = 2.0
BLOCKED = 3.0
CLOSED = 4.0

# What is remembered between two calls.
STATE = 0
SIZE = 1
TRAVELLED = 2
PROGRESS = 3

_CENTRING = 12
_FIRST_CENTRING = 60
_SECANTS = 16
# Shortest step, in units of the robot's reach.
_SHORTEST = 1e-7
# What is left of a unit vector if it counts as independent of others.
_INDEPENDENT = 0.05


@kernel
def direction_length(direction):
    """Euclidean length of a step (6,)."""
    square = 0.0
    for m in range(6):
        square += direction[m] * direction[m]
    return math.sqrt(square)


@inlined
def _begin(scene, progress, direction, turns, within, wide, path, work):
    """Move the first pose to the narrowest place near it, centred across ``direction``.

    There the gap of centred poses, as a function of where they lie along the direction, has the
    slope 0; the secant method finds it, also through poses that are not free.
    """
    reach = robot_reach(scene)
    inverse_reach = 1.0 / reach if turns else 0.0
    length = max(direction_length(direction), 1e-300)
    for m in range(6):
        direction[m] /= length
    here, ahead = path[0], work.ahead
    gap, slope = centre(scene, here, direction, turns, within, wide, _FIRST_CENTRING, work)
    if gap >= wide:
        progress[STATE] = OPEN
        return
    size = -0.2 * reach if slope > 0.0 else 0.2 * reach
    low, high, low_slope, high_slope = -math.inf, math.inf, 0.0, 0.0
    place = 0.0
    for _ in range(_SECANTS):
        if slope < 0.0:
            low, low_slope = place, slope
        else:
            high, high_slope = place, slope
        if low > -math.inf and high < math.inf:
            # Regula falsi, kept away from the ends.
            share = min(max(low_slope / (low_slope - high_slope), 0.05), 0.95)
            target = low + share * (high - low)
            if high - low < 1e-7 * reach or abs(slope) < 1e-6:
                break
        else:
            target = place + size
            size *= 1.7
            if abs(target) > 2.0 * reach:
                break
        for m in range(6):
            ahead[m] = (target - place) * direction[m]
        moved(here, ahead, inverse_reach, here)
        place = target
        gap, slope = centre(scene, here, direction, turns, within, wide, _FIRST_CENTRING, work)
        if gap >= wide:
            break
    if gap <= 0.0:
        progress[STATE] = CLOSED
    else:
        progress[STATE] = OPEN if gap >= wide else FOLLOWING


@inlined
def _along_walls(scene, pose, inverse_reach, within, direction, work):
    """Turn ``direction`` so that the robot slides along the bodies that are nearest to it.

    Then their hyperplanes clear a straight translation of any length. If there is no such
    direction (the bodies cage the robot, or it would have to turn), nothing is changed.
    """
    model, normals = work.first, work.second
    count = contact_model(scene, work.placed, pose, within, inverse_reach, model, work.pairs)
    gap = smallest_gap(model, count, within)
    rank = 0
    for k in range(count):
        if model[k, GAP] > 1.5 * gap or rank == 3:
            continue
        for m in range(3):
            normals[rank, m] = model[k, GRADIENT + m]
        if _orthogonalise(normals, rank, normals[rank]) > _INDEPENDENT:
            rank += 1
    slide = work.ahead
    for m in range(6):
        slide[m] = direction[m] if m < 3 else 0.0
    if _orthogonalise(normals, rank, slide) > _INDEPENDENT:
        for m in range(6):
            direction[m] = slide[m]


@kernel
def _orthogonalise(rows, count, vector):
    """Make the first three numbers of ``vector`` a unit vector orthogonal to unit ``rows``.

    Returns how long it was when orthogonal; below a hundredth it is left orthogonal only.
    """
    for k in range(count):
        dot = rows[k, 0] * vector[0] + rows[k, 1] * vector[1] + rows[k, 2] * vector[2]
        for m in range(3):
            vector[m] -= dot * rows[k, m]
    length = math.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    if length > 0.01:
        for m in range(3):
            vector[m] /= length
    return length


@kernel
def _next_pose(scene, here, size, direction, turns, within, wide, straight, work):
    """Write the next pose along a passage to ``work.next_pose``: (its gap, length of the step)."""
    reach = robot_reach(scene)
    inverse_reach = 1.0 / reach if turns else 0.0
    ahead, pose = work.ahead, work.next_pose
    for m in range(6):
        ahead[m] = size * direction[m]
    moved(here, ahead, inverse_reach, pose)
    steps = 0 if straight else _CENTRING
    gap, _ = centre(scene, pose, direction, turns, within, wide, steps, work)
    difference(here, pose, reach if turns else 0.0, ahead)
    turned = math.sqrt(ahead[3] ** 2 + ahead[4] ** 2 + ahead[5] ** 2)
    if turned > 0.0 and turned <= 1.1 * SMALL_ROTATION * reach:
        # OMPL does not interpolate rotations that are so small: rather do not turn at all.
        for m in range(4):
            pose[3 + m] = here[3 + m]
        gap, _ = centre(scene, pose, direction, False, within, wide, steps, work)
        difference(here, pose, 0.0, ahead)
    return gap, direction_length(ahead)


@kernel
def follow(
    scene, progress, direction, turns, within, wide, longest, path, count, limit, work, motion
):
    """Follow a passage from its pose ``path[count − 1]`` along ``direction`` (6,) for a while.

    ``path`` (≥ limit, 7) receives poses joined by proved motions, until there are ``limit`` or
    ``progress`` (PROGRESS,) says that the passage is OPEN (the smallest gap, looked at up to
    ``within``, is ``wide``) or BLOCKED (nothing more is proved, or longer than ``longest``).
    At first its state is NEW: then ``path[0]`` is moved to the narrowest place near it before
    anything is followed, and the passage is CLOSED if that leaves no gap. Returns the number of
    poses.
    """
    reach = robot_reach(scene)
    inverse_reach = 1.0 / reach if turns else 0.0
    workspace, placed, stack = motion
    if progress[STATE] == NEW:
        progress[SIZE], progress[TRAVELLED] = reach, 0.0
        _begin(scene, progress, direction, turns, within, wide, path, work)
        return count
    if progress[TRAVELLED] == 0.0:
        _along_walls(scene, path[count - 1], inverse_reach, within, direction, work)
    ahead, next_pose = work.ahead, work.next_pose
    while progress[STATE] == FOLLOWING and count < limit:
        size, here = progress[SIZE], path[count - 1]
        straight = progress[TRAVELLED] == 0.0 and size > 0.1 * reach
        gap, length = _next_pose(
            scene, here, size, direction, turns, within, wide, straight, work
        )
        proved = gap > 0.0 and length < 2.0 * size
        if proved:
            proved = (
                prove_motion(scene, here, next_pose, scene[CLEARANCE], workspace, placed, stack) > 0
            )
        if not proved:
            progress[SIZE] = 0.4 * size
            if progress[SIZE] < _SHORTEST * reach:
                progress[STATE] = BLOCKED
            continue
        for m in range(7):
            path[count, m] = next_pose[m]
        for m in range(6):
            direction[m] = ahead[m] / length
        count += 1
        progress[TRAVELLED] += length
        progress[SIZE] = min(2.0 * size, reach)
        if gap >= wide:
            progress[STATE] = OPEN
        elif progress[TRAVELLED] > longest:
            progress[STATE] = BLOCKED
    return count
