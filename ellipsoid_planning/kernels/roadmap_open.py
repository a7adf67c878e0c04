"""The search's open list."""

from .compile import inlined, kernel
from .containers import push
from .roadmap_tables import ENTRIES, FREE_ENTRY, OPEN


@inlined
def open_entry(rm, priority, cost, leave, target, parent, line):
    """Open an edge to the node ``target``, or if that is −1 a promise of ``line`` or a passage.

    ``cost`` is that of reaching it over ``parent``, which is left at the coordinate ``leave``.
    """
    _add_entry(
        rm.counters,
        rm.heap,
        rm.heap_items,
        rm.entry_reals,
        rm.entry_integers,
        priority,
        cost,
        leave,
        target,
        parent,
        line,
    )


@kernel
def _add_entry(counters, heap, items, reals, integers, priority, cost, leave, target, parent, line):
    entry = counters[FREE_ENTRY]
    if entry >= 0:
        counters[FREE_ENTRY] = integers[entry, 0]
    else:
        entry = counters[ENTRIES]
        counters[ENTRIES] += 1
    reals[entry, 0], reals[entry, 1] = cost, leave
    integers[entry, 0] = target
    integers[entry, 1] = parent
    integers[entry, 2] = line
    counters[OPEN] = push(heap, items, counters[OPEN], priority, entry)
