"""Passages in the search: from each node that comes near an end, the way through is tried."""

from .compile import inlined, kernel
from .roadmap_metric import heuristic, write_pose
from .roadmap_nodes import node_at
from .roadmap_open import open_entry
from .roadmap_proofs import is_proved, middle_is_free
from .roadmap_tables import (
    END_LENGTH,
    END_NEAREST,
    END_TRIED,
    END_USED,
    ENDS,
    FIRST_PASSAGE,
    FIRST_REACHED,
    KNOWN_ENDS,
    NODE_COLUMN,
    NODE_COST,
    NODE_ENTRY,
    NODE_LAYER,
    NODE_NEXT,
    OFFERED,
    PASSAGES_USED,
    PROVED,
    QUERY,
    REFUTED,
)

# A passage is tried from a node only if that is nearer to it by this factor than those before.
NEARER = 0.8
# So it is tried from no more nodes than this at once.
OFFERS = 64


@kernel
def offer_passages(rm, node, first, axis, goals, inflation, weight):
    """Open the ways from ``node`` into passages to whose end it is the nearest node yet."""
    layer, column = rm.node_integers[node, NODE_LAYER], rm.node_integers[node, NODE_COLUMN]
    entry, query = rm.node_reals[node, NODE_ENTRY], rm.counters[QUERY]
    for end in range(first, rm.counters[ENDS]):
        if rm.end_integers[end, END_USED] == query:
            continue
        row = rm.end_reals[end : end + 1]
        away = heuristic(
            rm.orientations, rm.joints, rm.columns, layer, column, entry, axis, row, weight
        )
        tried = rm.end_integers[end, END_TRIED] == query
        if tried and away > NEARER * rm.end_reals[end, END_NEAREST]:
            continue
        rm.end_integers[end, END_TRIED] = query
        rm.end_reals[end, END_NEAREST] = away
        cost = rm.node_reals[node, NODE_COST] + away
        priority = 0.0
        if end < rm.counters[KNOWN_ENDS]:
            other = rm.end_reals[end ^ 1]
            place = int(other[0]), int(other[4]), other[1 + axis]
            priority = cost + other[END_LENGTH]
            priority += inflation * heuristic(
                rm.orientations,
                rm.joints,
                rm.columns,
                place[0],
                place[1],
                place[2],
                axis,
                goals,
                weight,
            )
        # What was found because the search got nowhere else goes ahead of everything.
        open_entry(rm, priority, cost, entry, -1, node, FIRST_PASSAGE - end)


@inlined
def offer_new_passages(rm, axis, goals, inflation, weight):
    """Offer passages that were found since the query's last step to the nodes reached so far."""
    if rm.counters[OFFERED] < rm.counters[ENDS]:
        node = rm.counters[FIRST_REACHED]
        while node >= 0:
            offer_passages(rm, node, rm.counters[OFFERED], axis, goals, inflation, weight)
            node = rm.node_integers[node, NODE_NEXT]
        rm.counters[OFFERED] = rm.counters[ENDS]


@inlined
def pass_through(model, rm, parent, end, axis, ends, placed, intervals):
    """The node at the other side of a passage that is entered from ``parent``, or −1."""
    if rm.end_integers[end, END_USED] == rm.counters[QUERY]:
        return -1
    entry = rm.node_reals[parent, NODE_ENTRY]
    write_pose(rm.orientations, rm.columns, rm.node_integers, parent, entry, axis, ends[0])
    for m in range(3):
        ends[1, m] = rm.end_reals[end, 1 + m]
    for m in range(rm.orientations.shape[1]):
        ends[1, 3 + m] = rm.orientations[int(rm.end_reals[end, 0]), m]
    if not (middle_is_free(model, rm, ends, placed) and is_proved(model, rm, ends)):
        rm.counters[REFUTED] += 1
        return -1
    rm.counters[PROVED] += 1
    rm.counters[PASSAGES_USED] += 1
    rm.end_integers[end, END_USED] = rm.counters[QUERY]
    rm.end_integers[end ^ 1, END_USED] = rm.counters[QUERY]
    other = rm.end_reals[end ^ 1]
    return node_at(model, rm, int(other[0]), int(other[4]), other[1 + axis], axis, intervals)
