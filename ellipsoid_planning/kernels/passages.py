"""Following a passage from a pose inside it, in all of C-space: proved motions end to end.

Each step goes on along the last one, centres the robot across it and proves the motion. Steps grow
while proofs succeed and shrink when one is refused, so that a passage that is bent by κ and leaves
a play ε is followed in steps of about √(ε/κ), a straight one in one.
"""

import math

from .centring import centre, step_length
from .compile import inlined, kernel
from .contact_model import GAP, GRADIENT, contact_model, difference, moved, smallest_gap
from .motion import SMALL_ROTATION
from .robot_model import hold_other, limit_proofs, pairs_looked_at, prove_way, reach_of

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
# How many more steps are taken before a straight one is tried again.
BENT = 3
# The gap at the last pose; 0 if unknown.
LAST_GAP = 4
PROGRESS = 5

_CENTRING = 12
# Proofs that a step may take of one pair; shorter steps take fewer.
_PROOFS = 2000.0
_FIRST_CENTRING = 60
_SECANTS = 16
# To which share of the gap robots are centred.
_ROUGH = 1e-2
_PRECISE = 1e-4
# The gap at a narrowest place may be smaller by this share than where it was taken for found.
_FALL = 0.05
# Shortest step, in units of the robot's reach.
_SHORTEST = 1e-7
# What is left of a unit vector if it counts as independent of others.
_INDEPENDENT = 0.05
# Which share of a step's length its translation must have for centring across that alone.
_TRANSLATES = 0.3
# After how many steps along a bent passage a straight one is tried again.
_BENT = 6.0


@inlined
def _begin(robot, progress, direction, turns, within, wide, path, work):
    """Move the first pose to the narrowest place near it, centred across ``direction``.

    There the gap of centred poses, as a function of where they lie along the direction, has the
    slope 0; the secant method finds it, also through poses that are not free.
    """
    reach = reach_of(robot)
    inverse_reach = 1.0 / reach if turns else 0.0
    length = max(step_length(direction), 1e-300)
    for m in range(direction.shape[0]):
        direction[m] /= length
    here, ahead = path[0], work.ahead
    gap, slope = centre(robot, here, direction, turns, within, wide, _ROUGH, _FIRST_CENTRING, work)
    progress[LAST_GAP] = gap
    if gap >= wide or gap <= 0.0:
        # The narrowest place leaves even less room than this one.
        progress[STATE] = OPEN if gap >= wide else CLOSED
        return
    size = -0.2 * reach if slope > 0.0 else 0.2 * reach
    low, high, low_slope, high_slope = -math.inf, math.inf, 0.0, 0.0
    low_gap, high_gap, low_tangent, high_tangent = gap, gap, slope, slope
    place, side = 0.0, 0
    for _ in range(_SECANTS):
        # Illinois: an end that stays twice counts half, or the other would creep.
        if slope < 0.0:
            high_slope *= 0.5 if side < 0 else 1.0
            low, low_slope, side = place, slope, -1
            low_gap, low_tangent = gap, slope
        else:
            low_slope *= 0.5 if side > 0 else 1.0
            high, high_slope, side = place, slope, 1
            high_gap, high_tangent = gap, slope
        if low > -math.inf and high < math.inf:
            # The secant's root, kept away from the ends.
            share = min(max(low_slope / (low_slope - high_slope), 0.02), 0.98)
            target = low + share * (high - low)
            # Where the tangents of both ends meet is about the least that the gap falls to.
            meet = high_gap - low_gap + low_tangent * low - high_tangent * high
            meet /= min(low_tangent - high_tangent, -1e-300)
            least = low_gap + low_tangent * (meet - low)
            if high - low < 1e-7 * reach or gap - least < _FALL * gap:
                break
        else:
            target = place + size
            size *= 1.7
            if abs(target) > 2.0 * reach:
                break
        for m in range(direction.shape[0]):
            ahead[m] = (target - place) * direction[m]
        moved(robot, here, ahead, inverse_reach, here)
        place = target
        gap, slope = centre(
            robot, here, direction, turns, within, wide, _ROUGH, _FIRST_CENTRING, work
        )
        if gap >= wide or gap <= 0.0:
            break
    if gap > 0.0:
        gap, slope = centre(
            robot, here, direction, turns, within, wide, _PRECISE, _FIRST_CENTRING, work
        )
    progress[LAST_GAP] = gap
    if gap <= 0.0:
        progress[STATE] = CLOSED
    else:
        progress[STATE] = OPEN if gap >= wide else FOLLOWING


@inlined
def _along_walls(robot, pose, inverse_reach, within, direction, slide, work):
    """Write to ``slide`` the translation near ``direction`` along the bodies nearest to the robot.

    Their hyperplanes clear it, at any length. If there is none (the bodies cage the robot, or it
    would have to turn), ``slide`` is ``direction`` itself.
    """
    model, normals = work.first, work.second
    count = contact_model(
        robot, work.placed, pose, within, inverse_reach, model, work.pairs, work.keys, work.known
    )
    gap = smallest_gap(model, count, within)
    rank = 0
    for k in range(count):
        if model[k, GAP] > 1.5 * gap or rank == 3:
            continue
        for m in range(3):
            normals[rank, m] = model[k, GRADIENT + m]
        if _orthogonalise(normals, rank, normals[rank]) > _INDEPENDENT:
            rank += 1
    for m in range(direction.shape[0]):
        slide[m] = direction[m] if m < 3 else 0.0
    if _orthogonalise(normals, rank, slide) <= _INDEPENDENT:
        for m in range(direction.shape[0]):
            slide[m] = direction[m]


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
def _next_pose(robot, here, size, direction, turns, within, wide, steps, work):
    """Write the next pose along a passage to ``work.next_pose``: (its gap, length of the step).

    It is centred in up to ``steps`` steps, across the translation where that is most of the way.
    """
    reach = reach_of(robot)
    inverse_reach = 1.0 / reach if turns else 0.0
    ahead, pose, across = work.ahead, work.next_pose[: here.shape[0]], work.across
    for m in range(direction.shape[0]):
        ahead[m] = size * direction[m]
        across[m] = direction[m] if m < 3 else 0.0
    moved(robot, here, ahead, inverse_reach, pose)
    length = step_length(across)
    for m in range(direction.shape[0]):
        across[m] = across[m] / length if length > _TRANSLATES else direction[m]
    gap, _ = centre(robot, pose, across, turns, within, wide, _PRECISE, steps, work)
    difference(robot, here, pose, reach if turns else 0.0, ahead)
    turned = math.sqrt(ahead[3] ** 2 + ahead[4] ** 2 + ahead[5] ** 2)
    if turned > 0.0 and turned <= 1.1 * SMALL_ROTATION * reach:
        # OMPL does not interpolate rotations that are so small: rather do not turn at all.
        for m in range(4):
            pose[3 + m] = here[3 + m]
        gap, _ = centre(robot, pose, across, False, within, wide, _PRECISE, steps, work)
        difference(robot, here, pose, 0.0, ahead)
    hold_other(robot, here, pose)
    return gap, step_length(ahead)


@kernel
def follow(
    robot, progress, direction, turns, within, wide, longest, path, count, pairs, work, motion
):
    """Follow a passage from its pose ``path[count − 1]`` along ``direction`` for a while.

    ``path`` (m, 7 + V) receives poses joined by proved motions, until it is full, about ``pairs``
    pairs of bodies were looked at, or ``progress`` (PROGRESS,) says that the passage is OPEN (the
    smallest gap, looked at up to ``within``, is ``wide``) or BLOCKED (nothing more is proved, or
    longer than ``longest``).
    At first its state is NEW: then ``path[0]`` is moved to the narrowest place near it before
    anything is followed, and the passage is CLOSED if that leaves no gap. Returns the number of
    poses.
    """
    reach = reach_of(robot)
    inverse_reach = 1.0 / reach if turns else 0.0
    limit_proofs(robot, motion, _PROOFS)
    if progress[STATE] == NEW:
        progress[SIZE] = reach
        _begin(robot, progress, direction, turns, within, wide, path, work)
        return count
    ahead, next_pose, slide = work.ahead, work.next_pose[: path.shape[1]], work.slide
    until = work.pairs[0] + pairs
    while progress[STATE] == FOLLOWING and count < path.shape[0] and work.pairs[0] < until:
        size, here = progress[SIZE], path[count - 1]
        proved, gap, length = False, 0.0, 0.0
        straight = progress[BENT] <= 0.0
        if straight:
            _along_walls(robot, here, inverse_reach, within, direction, slide, work)
        for attempt in range(0 if straight else 1, 2):
            if proved:
                continue
            steps, course = (0, slide) if attempt == 0 else (_CENTRING, direction)
            gap, length = _next_pose(robot, here, size, course, turns, within, wide, steps, work)
            if gap > 0.0 and length < 2.0 * size:
                proved = prove_way(robot, here, next_pose, motion) > 0
                work.pairs[0] += pairs_looked_at(robot)
            if attempt == 0 and not proved:
                progress[BENT] = _BENT
        if not proved:
            progress[SIZE] = 0.4 * size
            progress[BENT] -= 1.0
            # A step shorter than the gap would be proved if it went anywhere.
            if progress[SIZE] < max(_SHORTEST * reach, 0.2 * progress[LAST_GAP]):
                progress[STATE] = BLOCKED
            continue
        for m in range(path.shape[1]):
            path[count, m] = next_pose[m]
        for m in range(direction.shape[0]):
            direction[m] = ahead[m] / length
        count += 1
        progress[TRAVELLED] += length
        progress[LAST_GAP] = gap
        progress[BENT] -= 1.0
        progress[SIZE] = min(2.0 * size, reach)
        if gap >= wide:
            progress[STATE] = OPEN
        elif progress[TRAVELLED] > longest:
            progress[STATE] = BLOCKED
    return count
