"""Growing two trees towards each other: RRT-Connect (Kuffner and LaValle 2000) with proofs.

Samples are free poses, drawn from free intervals, or poses given from outside. A tree is extended
from its node nearest to a sample by the whole motion at once, for a proof costs about the same
whatever the motion's length; if that is refused, by the longest piece of it that bisection finds
a proof for. If there is none, the other tree is extended to the same sample instead. The tree that
was not extended then is, to the new node and in the same way, until it arrives or is refused.

Every edge is proved in the direction in which a path from a start to a goal takes it.
"""

from .compile import kernel
from .layout import new_placed
from .sampling import NUMBERS, draw_free
from .tree_extension import copy_pose, extend, is_same_pose
from .tree_nearest import distance, insert, nearest
from .tree_tables import (
    BLOCKED_DRAWS,
    GROW,
    GROWING,
    MEETING,
    NONE,
    ROWS_USED,
    SOLVED,
    STEPS,
)

# Random numbers of a step: those of a draw, then one that chooses what to draw.
CHOICE = NUMBERS
ROW = NUMBERS + 1
# Extensions of the other tree in one step, at most: those of a short range go on next time.
LONGEST = 64


@kernel
def grow(scene, trees, kind, rest, gates, numbers, gate_share, uniform, reach, weight, halvings):
    """One step a row of ``numbers`` (k, ROW), uniform in [0, 1): GROWING, SOLVED or GROW.

    Args:
        scene: packed (kernels.layout).
        trees: both with a root.
        kind: of orientations (kernels.sampling).
        rest: pose (7,) with the orientation of a robot that does not rotate.
        gates: poses (P, 7) that are tried as samples.
        numbers: counters[ROWS_USED] says how many rows were used.
        gate_share: fraction of the samples that are gates, if there are any.
        uniform: fraction of the others that are uniform on free space; the rest favours places
            that are narrow along a line.
        reach: longest extension.
        weight: of the metric (kernels.tree_nearest).
        halvings: of an extension that is refused.

    When SOLVED, counters[MEETING] and the one behind it are nodes of the two trees between which
    the motion is proved.
    """
    counters, sample, target = trees.counters, trees.ends[0], trees.ends[1]
    placed = new_placed(scene)
    for k in range(numbers.shape[0]):
        counters[ROWS_USED] = k
        if max(counters[0], counters[1]) + LONGEST + 2 > trees.poses.shape[1]:
            return GROW
        counters[ROWS_USED] = k + 1
        tree = counters[STEPS] % 2
        counters[STEPS] += 1
        choice = numbers[k, CHOICE]
        share = gate_share if gates.shape[0] > 0 else 0.0
        if choice < share:
            copy_pose(gates[int(choice / share * gates.shape[0])], sample)
        elif not draw_free(
            scene,
            kind,
            rest,
            -1.0,
            choice < share + (1.0 - share) * uniform,
            numbers[k : k + 1],
            sample,
        ):
            counters[BLOCKED_DRAWS] += 1
            continue
        copy_pose(sample, target)
        start, active, node = NONE, tree, nearest(trees, tree, sample, weight)
        for extension in range(2 + LONGEST):
            # A gate that was reached before is a node already.
            known = start == NONE and is_same_pose(trees.poses[active, node], target)
            part, most = 1.0, 1.0
            if not known:
                away = distance(trees.poses[active, node], target, weight)
                most = min(1.0, reach / away) if away > 0.0 else 1.0
                part = extend(scene, trees, active, node, target, most, halvings, placed)
            if part == 1.0 and active != tree:
                counters[MEETING + tree], counters[MEETING + active] = start, node
                return SOLVED
            if part == 0.0 and extension == 0:
                # The other tree may have a better place to start from.
                tree = 1 - tree
                active = tree
                node = nearest(trees, tree, target, weight)
                continue
            if part == 0.0:
                break
            if not known:
                node = insert(scene, trees, active, trees.ends[2], node, weight)
            if start == NONE:
                copy_pose(trees.poses[active, node], target)
                start, active = node, 1 - tree
                node = nearest(trees, active, target, weight)
            elif part < most:
                break
    return GROWING
