"""The arrangements of a grid whose structure factors come closest to given magnitudes.

All is linear in the molecule's limbs (see packing_search): for one turn of the base each limb's
transform at the spots is computed once for each of its poses; a shift of the base by x multiplies
it by exp(2πi s·x); the terms of kernels.structure_factors make structure factors of it, once for
each pose of a limb and of the base that is met; an arrangement's structure factors are the sum of
its limbs'. Costs are multiples of a quantum far above rounding errors and far below differences
that matter, so that equal arrangements have equal costs and the lower number goes first.
"""

import math

import numpy as np

from .compile import kernel, released
from .molecule import FRAME, POSED, compose, pose_part
from .structure_factors import best_scale, combine, spot_amplitudes

BLOCK = 16  # so many reflections are added before the sum is compared with the worst of the best
NOTHING = -1


@released
def rank_arrangements(
    numbers,
    turns,
    limbs,
    parts,
    sizes,
    planar,
    placements,
    strides,
    counts,
    waves,
    table,
    data,
    best,
):
    """Put those of ``numbers`` (m,) that are better than the worst of ``best`` in their places.

    Args:
        numbers: of arrangements, best in ascending order.
        turns: (N, FRAME), the base's frames with its shifts left out.
        limbs: (L, 4): first row in ``placements``, poses, first row in ``parts``, parts.
        parts: (P, POSED) in their limb's frame, in the limbs' order.
        sizes: (P,), density · det A of the parts.
        planar: whether they are ellipses.
        placements: (sum of poses, FRAME), the limbs' poses in the base frame.
        strides: (L, C), what a step of each joint adds to a limb's pose.
        counts: (C,), values of each joint; the last one varies fastest.
        waves: (shift_counts (D,), shift_waves (sum of shift_counts, S) complex): exp(2πi s·x) of
            each step along each direction that the base shifts in; the last one varies fastest.
        table: spots and terms, see kernels.structure_factors.
        data: (target (R,), weights (R,), scaled, quantum).
        best: (numbers (B,), keys (B,)), sorted by key and number, NOTHING in empty places; a key
            is a cost divided by the quantum, rounded.
    """
    target, weights, scaled, quantum = data
    shift_counts, shift_waves = waves
    spot_count, count = table[0].shape[1], target.size
    limb_count, joints = strides.shape
    combinations = 1
    for c in range(joints):
        combinations *= counts[c]
    shifts = 1
    for c in range(shift_counts.size):
        shifts *= shift_counts[c]
    frame = np.empty((1, FRAME))
    posed = np.empty((parts.shape[0], POSED))
    turned = np.empty((placements.shape[0], 2, spot_count))
    turned_for = np.full(placements.shape[0], NOTHING)
    shifted = np.empty((2, spot_count))
    wave = np.empty((2, spot_count))
    factors = np.empty((placements.shape[0], 2, count))
    ready_for = np.full(placements.shape[0], NOTHING)
    sums = np.zeros((limb_count + 1, 2, count))
    rows = np.full(limb_count, NOTHING)
    magnitudes = np.empty(count)
    at = NOTHING
    for index in range(numbers.size):
        base = numbers[index] // combinations
        if base != at:
            at = base
            rows[:] = NOTHING
            shift_wave(base % shifts, shift_counts, shift_waves, wave)
        changed = False
        for limb in range(limb_count):
            row = limb_row(numbers[index] % combinations, limb, limbs, strides, counts)
            if row == rows[limb] and not changed:
                continue
            changed = True
            rows[limb] = row
            if ready_for[row] != base:
                ready_for[row] = base
                turn = base // shifts
                if turned_for[row] != turn:
                    turned_for[row] = turn
                    compose(turns, turn, placements, row, frame, 0)
                    first = limbs[limb, 2]
                    last = first + limbs[limb, 3]
                    for p in range(first, last):
                        pose_part(frame, 0, parts, p, posed, p)
                    spot_amplitudes(posed, first, last, sizes, planar, table[0], turned[row])
                for s in range(spot_count):
                    a, b, c, d = turned[row, 0, s], turned[row, 1, s], wave[0, s], wave[1, s]
                    shifted[0, s] = a * c - b * d
                    shifted[1, s] = a * d + b * c
                combine(table, shifted, factors[row])
            for r in range(count):
                sums[limb + 1, 0, r] = sums[limb, 0, r] + factors[row, 0, r]
                sums[limb + 1, 1, r] = sums[limb, 1, r] + factors[row, 1, r]
        worst = best[1][best[1].size - 1]
        limit = math.inf if worst == NOTHING else ((worst + 1.0) * quantum) ** 2
        total = squares(sums[limb_count], target, weights, scaled, limit, magnitudes)
        if total <= limit:
            offer(best, numbers[index], round(math.sqrt(total) / quantum))


@kernel
def limb_row(number, limb, limbs, strides, counts):
    """The row in ``placements`` of a limb's pose for the joint values' number."""
    row = limbs[limb, 0]
    for c in range(counts.size - 1, -1, -1):
        row += strides[limb, c] * (number % counts[c])
        number //= counts[c]
    return row


@kernel
def shift_wave(number, counts, waves, wave):
    """Fill ``wave`` (2, S) with exp(2πi s·x) for the base's shift by number."""
    wave[0, :] = 1.0
    wave[1, :] = 0.0
    row = waves.shape[0]
    for c in range(counts.size - 1, -1, -1):
        row -= counts[c]
        at = row + number % counts[c]
        number //= counts[c]
        for s in range(wave.shape[1]):
            a, b, other = wave[0, s], wave[1, s], waves[at, s]
            wave[0, s] = a * other.real - b * other.imag
            wave[1, s] = a * other.imag + b * other.real


@kernel
def squares(factors, target, weights, scaled, limit, magnitudes):
    """Σ weight (target − k |F|)² of ``factors`` (2, R); anything above ``limit`` if above it.

    The sum only grows, so that it may stop there. ``magnitudes`` (R,) is scratch.
    """
    count = target.size
    total = 0.0
    if scaled:
        for r in range(count):
            magnitudes[r] = math.sqrt(factors[0, r] ** 2 + factors[1, r] ** 2)
        scale = best_scale(magnitudes, target, weights)
        for r in range(count):
            total += weights[r] * (target[r] - scale * magnitudes[r]) ** 2
        return total
    for first in range(0, count, BLOCK):
        last = min(first + BLOCK, count)
        for r in range(first, last):
            size = math.sqrt(factors[0, r] ** 2 + factors[1, r] ** 2)
            magnitudes[r] = weights[r] * (target[r] - size) ** 2
        for r in range(first, last):
            total += magnitudes[r]
        if total > limit:
            return total
    return total


@kernel
def offer(best, number, key):
    """Insert an arrangement where it belongs among the ``best``, if it does; the last one goes.

    Of several with one key, only that of the lowest number stays.
    """
    numbers, keys = best
    place = keys.size
    while place > 0 and (
        keys[place - 1] == NOTHING
        or keys[place - 1] > key
        or (keys[place - 1] == key and numbers[place - 1] > number)
    ):
        place -= 1
    if place > 0 and keys[place - 1] == key:
        return
    if place == keys.size:
        return
    if keys[place] == key:
        numbers[place] = number
        return
    for i in range(keys.size - 1, place, -1):
        keys[i], numbers[i] = keys[i - 1], numbers[i - 1]
    keys[place], numbers[place] = key, number
