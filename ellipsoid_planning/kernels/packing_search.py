"""Exhaustive search of a grid of arrangements, pruned part by part.

A *limb* is a link of the molecule with all its parts; the chain of joints above it has a grid of
values of its own, and its poses against the base, in ``placements``, are known beforehand. Limb 0
is the base: it is looked at once for each pose of the base, and where it meets its own copies,
everything above it is settled. Each other limb's poses are looked at once for each pose of the
base (against the base and against the limb's own copies), each pair of limbs once for each two
poses, and only where the search comes to them.
"""

import numpy as np

from .compile import released
from .layout import BODY, PLACED
from .molecule import FRAME, compose
from .packing import copies_apart, own_apart, pose_body

UNKNOWN, FREE, BLOCKED = 0, 1, 2


@released
def limbs_apart(bodies, limbs, one, first, other, second, own, crystal, required, copy):
    """Whether all copies of two limbs' bodies keep apart, and they themselves where ``own``.

    The bodies of the limbs ``one`` and ``other`` begin at the rows ``first`` and ``second``.
    """
    operations, basis, inverse, reaches = crystal
    for p in range(limbs[one, 3]):
        i = first + p
        for q in range(p if one == other else 0, limbs[other, 3]):
            j = second + q
            watched = own[limbs[one, 2] + p, limbs[other, 2] + q]
            if watched and not own_apart(bodies, i, j, required, copy):
                return False
            if not copies_apart(
                bodies, i, j, i == j, operations, basis, inverse, reaches, required, copy
            ):
                return False
    return True


@released
def search_grid(
    bases,
    first,
    last,
    limbs,
    shapes,
    placements,
    strides,
    levels,
    counts,
    own,
    crystal,
    required,
    found,
):
    """Write the free arrangements of the base poses ``first`` to ``last``; (how many, next pose).

    Args:
        bases: (N, FRAME), all poses of the base.
        first: the first of them to look at.
        last: the one after the last of them.
        limbs: (L, 5): first row in ``placements``, number of poses, first row in ``shapes``,
            number of parts, first row of its bodies in the table of all poses' bodies.
        shapes: (P, BODY), parts in their limb's frame.
        placements: (sum of poses, FRAME), the limbs' poses in the base frame.
        strides: (L, C), what a step of each joint adds to a limb's pose.
        levels: (L,), from which joint on a limb's pose is settled (-1: the base).
        counts: (C,), values of each joint; the last one varies fastest.
        own: (P, P), which two parts of one molecule must keep apart, numbered as in ``shapes``.
        crystal: operations, basis, inverse, reaches; see `copies_apart`.
        required: the distance to be proved.
        found: where to write base pose · (number of joint values) + joint values' number. The
            search stops before a base pose that might not fit.
    """
    limb_count, joints = strides.shape
    total = 1
    for c in range(joints):
        total *= counts[c]
    rows = 0
    cells = 0
    for limb in range(limb_count):
        rows = max(rows, limbs[limb, 4] + limbs[limb, 1] * limbs[limb, 3])
    pair_first = np.zeros((limb_count, limb_count), np.int64)
    for a in range(1, limb_count):
        for b in range(1, a):
            pair_first[a, b] = cells
            cells += limbs[a, 1] * limbs[b, 1]
    pairs = np.zeros(cells, np.int8)
    alone = np.zeros(placements.shape[0], np.int8)
    bodies = np.zeros((rows, BODY))
    frame = np.zeros((1, FRAME))
    copy = np.zeros((1, PLACED))
    digits = np.zeros(joints, np.int64)
    poses = np.zeros(limb_count, np.int64)
    written = 0
    for base in range(first, last):
        if written + total > found.size:
            return written, base
        if not _start_base(
            bases, base, limbs, shapes, placements, own, crystal, required, bodies, frame, copy
        ):
            continue
        pairs[:] = UNKNOWN
        alone[:] = UNKNOWN
        level = 0
        for c in range(joints):
            digits[c] = 0
        while True:
            # Everything above `level` holds; see how far these digits go.
            free = True
            while level < joints:
                free = _level_free(
                    level,
                    bases,
                    base,
                    limbs,
                    shapes,
                    placements,
                    strides,
                    levels,
                    own,
                    crystal,
                    required,
                    bodies,
                    frame,
                    copy,
                    digits,
                    poses,
                    alone,
                    pairs,
                    pair_first,
                )
                if not free:
                    break
                level += 1
            if free:
                number = 0
                for c in range(joints):
                    number = number * counts[c] + digits[c]
                found[written] = base * total + number
                written += 1
                level = joints - 1
            # The next digits that differ at `level` or before it.
            while level >= 0 and digits[level] == counts[level] - 1:
                digits[level] = 0
                level -= 1
            if level < 0:
                break
            digits[level] += 1
            for c in range(level + 1, joints):
                digits[c] = 0
    return written, last


@released
def _start_base(
    bases, base, limbs, shapes, placements, own, crystal, required, bodies, frame, copy
):
    """Place the base's bodies, and see whether their copies keep apart."""
    _place_limb(bases, base, limbs, shapes, placements, 0, 0, bodies, frame)
    row = limbs[0, 4]
    return limbs_apart(bodies, limbs, 0, row, 0, row, own, crystal, required, copy)


@released
def _place_limb(bases, base, limbs, shapes, placements, limb, pose, bodies, frame):
    """Fill the bodies of a limb in one of its poses."""
    compose(bases, base, placements, limbs[limb, 0] + pose, frame, 0)
    count = limbs[limb, 3]
    row = limbs[limb, 4] + pose * count
    for p in range(count):
        pose_body(frame, 0, shapes, limbs[limb, 2] + p, bodies, row + p)


@released
def _level_free(
    level,
    bases,
    base,
    limbs,
    shapes,
    placements,
    strides,
    levels,
    own,
    crystal,
    required,
    bodies,
    frame,
    copy,
    digits,
    poses,
    alone,
    pairs,
    pair_first,
):
    """Whether the limbs that joint ``level`` settles keep apart from all before them."""
    joints = strides.shape[1]
    for limb in range(1, limbs.shape[0]):
        if levels[limb] != level:
            continue
        pose = 0
        for c in range(joints):
            pose += strides[limb, c] * digits[c]
        poses[limb] = pose
        count = limbs[limb, 3]
        row = limbs[limb, 4] + pose * count
        state = limbs[limb, 0] + pose
        if alone[state] == UNKNOWN:
            _place_limb(bases, base, limbs, shapes, placements, limb, pose, bodies, frame)
            free = limbs_apart(
                bodies, limbs, 0, limbs[0, 4], limb, row, own, crystal, required, copy
            ) and limbs_apart(bodies, limbs, limb, row, limb, row, own, crystal, required, copy)
            alone[state] = FREE if free else BLOCKED
        if alone[state] == BLOCKED:
            return False
        for other in range(1, limb):
            entry = pair_first[limb, other] + pose * limbs[other, 1] + poses[other]
            if pairs[entry] == UNKNOWN:
                at = limbs[other, 4] + poses[other] * limbs[other, 3]
                free = limbs_apart(
                    bodies, limbs, other, at, limb, row, own, crystal, required, copy
                )
                pairs[entry] = FREE if free else BLOCKED
            if pairs[entry] == BLOCKED:
                return False
    return True
