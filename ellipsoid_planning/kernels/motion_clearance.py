"""How much clearance a whole motion provably keeps."""

import math

from .compile import kernel
from .layout import CLEARANCE, SCALE
from .linear import norm, product
from .motion import motion_workspaces, prove_motion
from .validity import clearance_of


@kernel
def motion_clearance(scene, first, last, samples, steps):
    """A proved lower bound of the clearance along a motion, −inf if it is not proved free.

    Sampled clearances bound it from above; ``steps`` proofs bisect towards that.
    """
    motion, placed, stack = motion_workspaces()
    if not prove_motion(scene, first, last, scene[CLEARANCE], motion, placed, stack) > 0:
        return -math.inf
    low = scene[CLEARANCE]
    high = 2.0 * scene[SCALE]
    move = (last[0] - first[0], last[1] - first[1], last[2] - first[2])
    tx, ty, tz, tw = product(
        last[3], last[4], last[5], last[6], -first[3], -first[4], -first[5], first[6]
    )
    if tw < 0.0:
        tx, ty, tz, tw = -tx, -ty, -tz, -tw
    sine = norm(tx, ty, tz)
    half = math.atan2(sine, tw)
    for k in range(samples):
        s = k / (samples - 1.0)
        turn = math.sin(s * half) / sine if sine > 0.0 else 0.0
        qx, qy, qz, qw = product(
            turn * tx, turn * ty, turn * tz, math.cos(s * half),
            first[3], first[4], first[5], first[6],
        )  # fmt: skip
        x, y, z = first[0] + s * move[0], first[1] + s * move[1], first[2] + s * move[2]
        high = min(high, clearance_of(scene, x, y, z, qx, qy, qz, qw))
    if high <= low:
        return low
    trial = low + 0.999 * (high - low)
    for _ in range(steps):
        if prove_motion(scene, first, last, trial, motion, placed, stack) > 0:
            low = trial
        else:
            high = trial
        if high - low <= 1e-3 * high:
            break
        trial = 0.5 * (low + high)
    return low
