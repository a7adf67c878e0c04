"""The hash map and the heap on plain arrays against Python's own."""

import heapq

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from ellipsoid_planning.kernels.containers import EMPTY, lookup, pop, push, rehash, store

KEYS = st.integers(0, 2**62) | st.integers(0, 20) | st.integers(0, 60).map(lambda k: k << 20)


def empty_map(size):
    return np.full((2, size), EMPTY, dtype=np.int64)


@settings(deadline=None, max_examples=200)
@given(st.lists(st.tuples(KEYS, st.integers(0, 2**62)), max_size=32), st.lists(KEYS, max_size=8))
def test_the_map_is_a_dict(pairs, others):
    table, larger, known = empty_map(64), empty_map(256), {}
    for key, value in pairs:
        store(table, key, value)
        known[key] = value
    rehash(table, larger)
    for key in [*known, *others]:
        assert lookup(table, key) == known.get(key, EMPTY)
        assert lookup(larger, key) == known.get(key, EMPTY)


def test_keys_that_differ_in_high_bits_alone_do_not_crowd():
    table = empty_map(2048)
    keys = np.arange(1000) << 40
    for key in keys:
        store(table, key, key >> 40)
    assert all(lookup(table, key) == key >> 40 for key in keys)
    longest = max(map(len, "".join("x" if k != EMPTY else " " for k in table[0]).split()))
    assert longest < 60


PRIORITIES = st.floats(-1e9, 1e9) | st.integers(0, 3).map(float)


@settings(deadline=None, max_examples=200)
@given(st.lists(PRIORITIES | st.none(), max_size=60))
def test_the_heap_is_heapq(actions):
    heap, items, count, known = np.empty(64), np.empty(64, dtype=np.int64), 0, []
    for k, priority in enumerate(actions):
        if priority is not None:
            count = push(heap, items, count, priority, k)
            heapq.heappush(known, (priority, k))
        elif known:
            lowest = heap[0]
            item = pop(heap, items, count)
            count -= 1
            assert lowest == known[0][0]
            # Equal priorities may leave in any order.
            assert (lowest, item) in known
            known.remove((lowest, item))
            heapq.heapify(known)
        assert count == len(known)
