"""Containers on plain arrays: a hash map from int64 to int64 and a binary min-heap."""

import numpy as np

from .compile import kernel

EMPTY = -1


@kernel
def _slot(keys, key):
    """Index of ``key``, or of the free slot where it belongs; the size is a power of two."""
    mask = keys.shape[0] - 1
    # Keys are made of two numbers, one in the high bits: both have to count.
    folded = np.uint64(key) ^ (np.uint64(key) >> np.uint64(29))
    mixed = folded * np.uint64(0x9E3779B97F4A7C15)
    slot = np.int64(mixed >> np.uint64(32)) & mask
    while keys[slot] != EMPTY and keys[slot] != key:
        slot = (slot + 1) & mask
    return slot


@kernel
def lookup(table, key):
    """Value of ``key`` ≥ 0 in the map ``table`` (2, size), or EMPTY."""
    slot = _slot(table[0], key)
    return table[1, slot] if table[0, slot] == key else EMPTY


@kernel
def store(table, key, value):
    """Set the value of ``key``; the caller keeps the map at most half full."""
    slot = _slot(table[0], key)
    table[0, slot] = key
    table[1, slot] = value


@kernel
def rehash(table, larger):
    """Copy all entries of ``table`` to the empty map ``larger``."""
    for k in range(table.shape[1]):
        if table[0, k] != EMPTY:
            store(larger, table[0, k], table[1, k])


@kernel
def push(heap, items, count, priority, item):
    """Add ``item`` to the heap of ``count`` elements; returns the new count."""
    k = count
    while k > 0:
        above = (k - 1) // 2
        if heap[above] <= priority:
            break
        heap[k], items[k] = heap[above], items[above]
        k = above
    heap[k], items[k] = priority, item
    return count + 1


@kernel
def pop(heap, items, count):
    """Remove the item of lowest priority from a heap that is not empty; returns it."""
    best = items[0]
    priority, item = heap[count - 1], items[count - 1]
    count -= 1
    k = 0
    while 2 * k + 1 < count:
        below = 2 * k + 1
        if below + 1 < count and heap[below + 1] < heap[below]:
            below += 1
        if priority <= heap[below]:
            break
        heap[k], items[k] = heap[below], items[below]
        k = below
    heap[k], items[k] = priority, item
    return best
