"""Shortening a path by proved shortcuts."""

from .compile import kernel
from .layout import CLEARANCE
from .motion import motion_workspaces, prove_motion


@kernel
def shortcut(scene, path, kept):
    """Mark in ``kept`` (m,) the poses of ``path`` (m, 7) that remain: their number.

    From each pose that remains, the farthest later pose that is joined by a proved motion comes
    next; the farthest is looked for by halving, which finds one without trying all.
    """
    motion, placed, stack = motion_workspaces()
    last = path.shape[0] - 1
    kept[:] = False
    kept[0] = True
    here, count = 0, 1
    while here < last:
        there = last
        while there > here + 1:
            if (
                prove_motion(
                    scene, path[here], path[there], scene[CLEARANCE], motion, placed, stack
                )
                > 0
            ):
                break
            there = here + (there - here) // 2
        kept[there] = True
        count += 1
        here = there
    return count
