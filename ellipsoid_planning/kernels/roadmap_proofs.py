"""Edges of the roadmap, proved when the search first wants to use them."""

from .compile import inlined, kernel
from .containers import EMPTY, lookup, store
from .layout import CLEARANCE
from .motion import prove_motion
from .placement import place
from .roadmap_metric import write_pose
from .roadmap_tables import EDGES, NODE_BITS, NODE_HIGH, NODE_LOW, PROVED, REFUTED
from .validity import placed_is_free


@kernel
def crossing(nodes, a, b, entry, choice):
    """Candidate ``choice`` of where an edge leaves ``a`` and enters ``b``: (z_a, z_b, exists)."""
    low_a, high_a = nodes[a, NODE_LOW], nodes[a, NODE_HIGH]
    low_b, high_b = nodes[b, NODE_LOW], nodes[b, NODE_HIGH]
    low, high = max(low_a, low_b), min(high_a, high_b)
    if choice == 3:
        return 0.5 * (low_a + high_a), 0.5 * (low_b + high_b), True
    if low > high:
        return 0.0, 0.0, False
    width = high - low
    if choice == 0:
        swept = min(max(entry, low + 0.25 * width), high - 0.25 * width)
    elif choice == 1:
        swept = 0.5 * (low + high)
    else:
        swept = low + (0.1 if entry < 0.5 * (low + high) else 0.9) * width
    return swept, swept, True


@inlined
def is_proved(scene, rm, ends):
    """Whether the motion between the two poses ``ends`` is proved free."""
    proofs = prove_motion(
        scene, ends[0], ends[1], scene[CLEARANCE], rm.motion, rm.motion_placed, rm.motion_stack
    )
    return proofs > 0


@inlined
def middle_is_free(scene, ends, placed):
    """Whether the robot is free half-way, which most long motions that are not free show."""
    first, last = ends[0], ends[1]
    dot = 0.0
    for m in range(3, 7):
        dot += first[m] * last[m]
    # The sum of two unit quaternions, the shorter way round, points half-way between them.
    sign = -1.0 if dot < 0.0 else 1.0
    place(
        scene,
        0.5 * (first[0] + last[0]),
        0.5 * (first[1] + last[1]),
        0.5 * (first[2] + last[2]),
        first[3] + sign * last[3],
        first[4] + sign * last[4],
        first[5] + sign * last[5],
        first[6] + sign * last[6],
        placed,
    )
    return placed_is_free(scene, placed)


@inlined
def prove_edge(scene, rm, a, b, entry, axis, ends):
    """Where a proved edge leaves ``a`` and enters ``b``: (z_a, z_b, proved), remembered."""
    key = (min(a, b) << NODE_BITS) | max(a, b)
    known = lookup(rm.edges, key)
    if known != EMPTY:
        row = rm.edge_reals[known]
        if a < b:
            return row[1], row[2], row[0] > 0.0
        return row[2], row[1], row[0] > 0.0
    za, zb, proved = 0.0, 0.0, False
    for choice in range(4):
        za, zb, exists = crossing(rm.node_reals, a, b, entry, choice)
        if not exists:
            continue
        write_pose(rm.orientations, rm.columns, rm.node_integers, a, za, axis, ends[0])
        write_pose(rm.orientations, rm.columns, rm.node_integers, b, zb, axis, ends[1])
        proved = is_proved(scene, rm, ends)
        if proved:
            break
    edge = rm.counters[EDGES]
    rm.counters[EDGES] += 1
    rm.counters[PROVED if proved else REFUTED] += 1
    rm.edge_reals[edge, 0] = 1.0 if proved else 0.0
    rm.edge_reals[edge, 1], rm.edge_reals[edge, 2] = (za, zb) if a < b else (zb, za)
    store(rm.edges, key, edge)
    return za, zb, proved
