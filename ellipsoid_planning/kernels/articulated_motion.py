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

from .articulated_itself import self_piece
from .articulated_pieces import MotionWorkspace, new_motion_workspace
from .articulated_rates import keep_rates, set_bounds, set_rates, turn_other_way
from .articulated_world import world_piece
from .compile import inlined, kernel
from .kinematics import row_at, within_limits
from .layout import CLEARANCE
from .validity import in_bounds, is_rotation

__all__ = [
    "MotionWorkspace",
    "articulated_motion_is_free",
    "articulated_motions_are_free",
    "new_motion_workspace",
    "prove_articulated_motion",
]


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
            more = self_piece(scene, kinematics, work, level, half)
        else:
            more = world_piece(scene, kinematics, work, level, half, clearance)
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
