"""Shortening a path by proved shortcuts."""

from .compile import kernel
from .motion import motion_workspaces
from .robot_model import prove_way


@kernel
def shortcut(model, path, kept):
    """Mark in ``kept`` (m,) the poses of ``path`` (m, 7 + V) that remain: their number.

    From each pose that remains, the farthest later pose that is joined by a proved motion comes
    next; the farthest is looked for by halving, which finds one without trying all.
    """
    workspaces = motion_workspaces()
    last = path.shape[0] - 1
    kept[:] = False
    kept[0] = True
    here, count = 0, 1
    while here < last:
        there = last
        while there > here + 1:
            if prove_way(model, path[here], path[there], workspaces) > 0:
                break
            there = here + (there - here) // 2
        kept[there] = True
        count += 1
        here = there
    return count
