"""Extending a search tree by one proved motion, as far as it goes."""

import math

from .compile import inlined, kernel
from .layout import CLEARANCE
from .motion import prove_motion
from .placement import place
from .tree_tables import PROVED, REFUTED
from .validity import placed_is_free


@kernel
def copy_pose(pose, out):
    """Write a pose (7,) to ``out``."""
    for k in range(7):
        out[k] = pose[k]


@kernel
def is_same_pose(first, last):
    """Whether two poses (7,) are equal in every bit."""
    same = True
    for k in range(7):
        same = same and first[k] == last[k]
    return same


@inlined
def _write_between(first, last, s, out):
    """Write to ``out`` the pose at ``s`` in [0, 1] between two: linear, and the shortest arc."""
    dot = 0.0
    for k in range(3):
        out[k] = first[k] + s * (last[k] - first[k])
    for k in range(3, 7):
        dot += first[k] * last[k]
    arc = math.acos(min(abs(dot), 1.0))
    a, b = 1.0 - s, s
    if arc > 1e-6:
        a, b = math.sin((1.0 - s) * arc), math.sin(s * arc)
    if dot < 0.0:
        b = -b
    square = 0.0
    for k in range(3, 7):
        out[k] = a * first[k] + b * last[k]
        square += out[k] * out[k]
    for k in range(3, 7):
        out[k] /= math.sqrt(square)


@inlined
def extend(scene, trees, tree, node, target, most, halvings, placed):
    """How much of the motion from ``node`` to ``target`` is proved: 0, or at most ``most`` ≤ 1.

    All of ``most`` is tried first, then ``halvings`` times what bisection says. The end of the
    longest piece that is proved is written to ``trees.ends[2]``. In tree 1 motions are proved
    backwards, as a path from a start to a goal takes them. ``placed`` is workspace.
    """
    reached, trial = trees.ends[2], trees.ends[3]
    origin = trees.poses[tree, node]
    proved, refused, s = 0.0, most, most
    for _ in range(1 + halvings):
        # Most motions that are not free show it half-way, most pieces of them at their end.
        probe = 0.5 if s == 1.0 else s
        _write_between(origin, target, probe, trial)
        place(scene, trial[0], trial[1], trial[2], trial[3], trial[4], trial[5], trial[6], placed)
        free = placed_is_free(scene, placed)
        if free:
            if s == 1.0:
                copy_pose(target, trial)
            first, last = (origin, trial) if tree == 0 else (trial, origin)
            proofs = prove_motion(
                scene,
                first,
                last,
                scene[CLEARANCE],
                trees.motion,
                trees.motion_placed,
                trees.motion_stack,
            )
            free = proofs > 0
            trees.counters[PROVED if free else REFUTED] += 1
            probe = s
        if free:
            copy_pose(trial, reached)
            proved = s
            if s == most:
                break
        else:
            refused = probe
        s = 0.5 * (proved + refused)
    return proved
