"""Reading a path off the roadmap once the search has reached a goal."""

import numpy as np

from .compile import inlined, kernel
from .roadmap_metric import write_pose
from .roadmap_proofs import is_proved
from .roadmap_tables import (
    END_FIRST,
    END_LAST,
    NODE_ENTRY,
    NODE_LEAVE,
    NODE_PARENT,
    NODE_VIA,
)


@kernel
def _append(path, count, pose):
    """Add a pose unless it repeats the last one; returns the new count."""
    if count > 0:
        same = True
        for m in range(path.shape[1]):
            same = same and path[count - 1, m] == pose[m]
        if same:
            return count
    for m in range(path.shape[1]):
        path[count, m] = pose[m]
    return count + 1


@inlined
def _append_passage(rm, end, path, count):
    """Add the poses of a passage that is entered at ``end``; returns the new count."""
    row, last = int(rm.end_reals[end, END_FIRST]), int(rm.end_reals[end, END_LAST])
    forward = 1 if last >= row else -1
    while row != last + forward:
        count = _append(path, count, rm.passage_poses[row])
        row += forward
    return count


@kernel
def path_room(rm, last):
    """How many poses the path to node ``last`` and a goal can have at most."""
    count, node = 1, last
    while node >= 0:
        count += 2
        via = rm.node_integers[node, NODE_VIA]
        if via >= 0:
            count += 1 + abs(int(rm.end_reals[via, END_LAST] - rm.end_reals[via, END_FIRST]))
        node = rm.node_integers[node, NODE_PARENT]
    return count


@kernel
def trace(model, rm, last, goal, goals, axis, path):
    """Write the path from the start over node ``last`` to a goal to ``path``: its length.

    Edges are proved already; the moves along intervals are proved here, once more than their ends
    were. Returns 0 if one is refused, which only bodies of extreme shape can bring about.
    """
    ends = np.empty((2, path.shape[1]))
    # Links point backwards: turn them round, in the column that this query is done with.
    node, after = last, -1
    while node >= 0:
        before = rm.node_integers[node, NODE_PARENT]
        rm.node_integers[node, NODE_PARENT] = after
        node, after = before, node
    count, node = 0, after
    while node >= 0:
        following = rm.node_integers[node, NODE_PARENT]
        entry = rm.node_reals[node, NODE_ENTRY]
        leave = entry if following < 0 else rm.node_reals[following, NODE_LEAVE]
        write_pose(rm.orientations, rm.columns, rm.node_integers, node, entry, axis, ends[0])
        write_pose(rm.orientations, rm.columns, rm.node_integers, node, leave, axis, ends[1])
        via = rm.node_integers[node, NODE_VIA]
        if via >= 0:
            count = _append_passage(rm, via, path, count)
        if leave != entry and not is_proved(model, rm, ends):
            return 0
        count = _append(path, count, ends[0])
        count = _append(path, count, ends[1])
        node = following
    for m in range(3):
        ends[0, m] = goals[goal, 1 + m]
    for m in range(rm.orientations.shape[1]):
        ends[0, 3 + m] = rm.orientations[int(goals[goal, 0]), m]
    return _append(path, count, ends[0])
