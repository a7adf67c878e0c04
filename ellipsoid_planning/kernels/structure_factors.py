"""Structure factors of a molecule of ellipsoids in a crystal, and how they change.

A part with centre c and matrix A (the unit ball's image) has at the reciprocal vector s the
transform  weight · f(w) · exp(2πi s·c),  w = 2π|Aᵀs|,  f the unit ball's transform (see bessel) and
weight = density · det A. The molecule's transform M is the sum over its parts. A group operation
x -> W x + w makes of it exp(2πi h·w) M(hW), so that F(h) is a sum of few terms
coefficient · M(spot), or of conj M(spot) = M(-spot); the spots of all reflections and operations
are collected once (crystal.structure_factors), each is evaluated once.

Two bundles of arrays:
    molecule: kinds, parents, origins, axes, part_frames, parts (see kernels.molecule), weights (P,)
    table: spots (3, S), firsts (R + 1,), term_spots (T,), terms (4, T)
Reflection r has the terms firsts[r] to firsts[r + 1] - 1; each is a matrix of 2 by 2, row-major, by
which the real and the imaginary part of M(spot) are multiplied.
"""

import math

import numpy as np

from .bessel import ball, ball_slope, disc, disc_slope
from .compile import kernel, released
from .molecule import FRAME, POSED, motion_axes, place_frames, pose_parts
from .sines import sine_cosine

TWO_PI = 2.0 * math.pi

# Rows of the scratch of `part_waves`.
SIZE, SLOPE, COSINE, SINE, SWELL = 0, 1, 2, 3, 4
WORK = 7


@kernel
def spot_amplitudes(posed, first, last, weights, planar, spots, amplitudes):
    """Fill ``amplitudes`` (2, S) with the transform of the parts ``first`` to ``last`` - 1.

    ``posed`` is (P, POSED), ``weights`` (P,), ``spots`` (3, S).
    """
    for s in range(spots.shape[1]):
        amplitudes[0, s] = amplitudes[1, s] = 0.0
    for p in range(first, last):
        if planar:
            add_ellipse(posed, p, weights[p], spots, amplitudes)
        else:
            add_ellipsoid(posed, p, weights[p], spots, amplitudes)


@kernel
def add_ellipse(posed, p, weight, spots, amplitudes):
    """Add the transform of the ellipse ``posed[p]`` to ``amplitudes`` (2, S)."""
    a0, a1, b0, b1 = posed[p, 3], posed[p, 6], posed[p, 4], posed[p, 7]
    c0, c1 = posed[p, 0], posed[p, 1]
    for s in range(spots.shape[1]):
        x, y = spots[0, s], spots[1, s]
        a, b = a0 * x + a1 * y, b0 * x + b1 * y
        size = weight * disc(TWO_PI * math.sqrt(a * a + b * b))
        sine, cosine = sine_cosine(TWO_PI * (x * c0 + y * c1))
        amplitudes[0, s] += size * cosine
        amplitudes[1, s] += size * sine


@kernel
def add_ellipsoid(posed, p, weight, spots, amplitudes):
    """Add the transform of the ellipsoid ``posed[p]`` to ``amplitudes`` (2, S)."""
    a0, a1, a2 = posed[p, 3], posed[p, 6], posed[p, 9]
    b0, b1, b2 = posed[p, 4], posed[p, 7], posed[p, 10]
    c0, c1, c2 = posed[p, 5], posed[p, 8], posed[p, 11]
    d0, d1, d2 = posed[p, 0], posed[p, 1], posed[p, 2]
    for s in range(spots.shape[1]):
        x, y, z = spots[0, s], spots[1, s], spots[2, s]
        a = a0 * x + a1 * y + a2 * z
        b = b0 * x + b1 * y + b2 * z
        c = c0 * x + c1 * y + c2 * z
        size = weight * ball(TWO_PI * math.sqrt(a * a + b * b + c * c))
        sine, cosine = sine_cosine(TWO_PI * (x * d0 + y * d1 + z * d2))
        amplitudes[0, s] += size * cosine
        amplitudes[1, s] += size * sine


@kernel
def combine(table, amplitudes, factors):
    """Fill ``factors`` (2, R) from the molecule's ``amplitudes`` (2, S); real, then imaginary."""
    _, firsts, term_spots, terms = table
    for r in range(factors.shape[1]):
        real = imaginary = 0.0
        for t in range(firsts[r], firsts[r + 1]):
            spot = term_spots[t]
            a, b = amplitudes[0, spot], amplitudes[1, spot]
            real += terms[0, t] * a + terms[1, t] * b
            imaginary += terms[2, t] * a + terms[3, t] * b
        factors[0, r] = real
        factors[1, r] = imaginary


@released
def structure_factors(molecule, planar, configurations, table, factors):
    """Fill ``factors`` (m, 2, R), real and imaginary, for the ``configurations`` (m, K)."""
    kinds, parents, origins, axes, part_frames, parts, weights = molecule
    frames = np.empty((kinds.size, FRAME))
    posed = np.empty((part_frames.size, POSED))
    amplitudes = np.empty((2, table[0].shape[1]))
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        pose_parts(frames, part_frames, parts, posed)
        spot_amplitudes(posed, 0, part_frames.size, weights, planar, table[0], amplitudes)
        combine(table, amplitudes, factors[index])


@kernel
def misfit(magnitudes, target, weights, scaled):
    """√(Σ weight (target − k · magnitude)²), k = 1 or the best one where ``scaled``; all (R,)."""
    scale = best_scale(magnitudes, target, weights) if scaled else 1.0
    total = 0.0
    for r in range(target.size):
        difference = target[r] - scale * magnitudes[r]
        total += weights[r] * difference * difference
    return math.sqrt(total)


@kernel
def best_scale(magnitudes, target, weights):
    """The factor k that makes Σ weight (target − k · magnitude)² smallest; 0 if all are 0."""
    mixed = own = 0.0
    for r in range(target.size):
        mixed += weights[r] * target[r] * magnitudes[r]
        own += weights[r] * magnitudes[r] * magnitudes[r]
    return mixed / own if own > 0.0 else 0.0


@released
def misfits(molecule, planar, configurations, table, target, weights, scaled, costs):
    """Fill ``costs`` (m,) with the `misfit` of the ``configurations`` (m, K)."""
    kinds, parents, origins, axes, part_frames, parts, sizes = molecule
    frames = np.empty((kinds.size, FRAME))
    posed = np.empty((part_frames.size, POSED))
    amplitudes = np.empty((2, table[0].shape[1]))
    factors = np.empty((2, target.size))
    magnitudes = np.empty(target.size)
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        pose_parts(frames, part_frames, parts, posed)
        spot_amplitudes(posed, 0, part_frames.size, sizes, planar, table[0], amplitudes)
        combine(table, amplitudes, factors)
        for r in range(target.size):
            magnitudes[r] = math.sqrt(factors[0, r] * factors[0, r] + factors[1, r] * factors[1, r])
        costs[index] = misfit(magnitudes, target, weights, scaled)


@kernel
def spot_rates(posed, lines, kinds, carried, weights, planar, spots, work, amplitudes, rates):
    """Fill ``amplitudes`` (2, S) and their derivatives ``rates`` (K, 2, S) by the coordinates.

    A coordinate that turns by a about a point p moves a centre c at a × (c − p) and changes A at
    [a]× A, so that w dw = (2π)² (Aᵀs)·(d(Aᵀ)s) = (2π)² a · (AAᵀs × s).

    Args:
        posed: (P, POSED).
        lines: (K, 6), axis and point of each coordinate (see `motion_axes`).
        kinds: (K,), 0 for a turn.
        carried: (K, P), which parts each coordinate moves.
        weights: (P,).
        planar: whether the parts are ellipses.
        spots: (3, S).
        work: (WORK, S), scratch.
        amplitudes: (2, S), written.
        rates: (K, 2, S), written.
    """
    for s in range(spots.shape[1]):
        amplitudes[0, s] = amplitudes[1, s] = 0.0
        for k in range(kinds.size):
            rates[k, 0, s] = rates[k, 1, s] = 0.0
    for p in range(posed.shape[0]):
        part_waves(posed, p, weights[p], planar, spots, work)
        for s in range(spots.shape[1]):
            amplitudes[0, s] += work[SIZE, s] * work[COSINE, s]
            amplitudes[1, s] += work[SIZE, s] * work[SINE, s]
        for k in range(kinds.size):
            if not carried[k, p]:
                continue
            i, j, m = lines[k, 0], lines[k, 1], lines[k, 2]
            u0, u1, u2 = i, j, m
            turn = 0.0
            if kinds[k] == 0:
                d0 = posed[p, 0] - lines[k, 3]
                d1 = posed[p, 1] - lines[k, 4]
                d2 = posed[p, 2] - lines[k, 5]
                u0, u1, u2 = j * d2 - m * d1, m * d0 - i * d2, i * d1 - j * d0
                turn = 1.0
            u0, u1, u2 = TWO_PI * u0, TWO_PI * u1, TWO_PI * u2
            i, j, m = turn * i, turn * j, turn * m
            for s in range(spots.shape[1]):
                swell = i * work[SWELL, s] + j * work[SWELL + 1, s] + m * work[SWELL + 2, s]
                along = u0 * spots[0, s] + u1 * spots[1, s] + u2 * spots[2, s]
                along *= work[SIZE, s]
                rates[k, 0, s] += swell * work[COSINE, s] - along * work[SINE, s]
                rates[k, 1, s] += swell * work[SINE, s] + along * work[COSINE, s]


@kernel
def part_waves(posed, p, weight, planar, spots, work):
    """Fill ``work`` (WORK, S) for the part ``posed[p]``.

    SIZE is weight · f(w), COSINE and SINE those of 2πs·c, the three rows from SWELL on
    (2π)² weight · f′(w)/w · (AAᵀs × s).
    """
    for s in range(spots.shape[1]):
        x, y, z = spots[0, s], spots[1, s], spots[2, s]
        a = posed[p, 3] * x + posed[p, 6] * y + posed[p, 9] * z
        b = posed[p, 4] * x + posed[p, 7] * y + posed[p, 10] * z
        c = posed[p, 5] * x + posed[p, 8] * y + posed[p, 11] * z
        work[SIZE, s] = TWO_PI * math.sqrt(a * a + b * b + c * c)
        sine, cosine = sine_cosine(TWO_PI * (x * posed[p, 0] + y * posed[p, 1] + z * posed[p, 2]))
        work[COSINE, s] = cosine
        work[SINE, s] = sine
        v0 = posed[p, 3] * a + posed[p, 4] * b + posed[p, 5] * c
        v1 = posed[p, 6] * a + posed[p, 7] * b + posed[p, 8] * c
        v2 = posed[p, 9] * a + posed[p, 10] * b + posed[p, 11] * c
        work[SWELL, s] = v1 * z - v2 * y
        work[SWELL + 1, s] = v2 * x - v0 * z
        work[SWELL + 2, s] = v0 * y - v1 * x
    if planar:
        for s in range(spots.shape[1]):
            w = work[SIZE, s]
            work[SIZE, s] = weight * disc(w)
            work[SLOPE, s] = weight * TWO_PI * TWO_PI * disc_slope(w)
    else:
        for s in range(spots.shape[1]):
            w = work[SIZE, s]
            work[SIZE, s] = weight * ball(w)
            work[SLOPE, s] = weight * TWO_PI * TWO_PI * ball_slope(w)
    for row in range(SWELL, SWELL + 3):
        for s in range(spots.shape[1]):
            work[row, s] *= work[SLOPE, s]


@released
def factors_and_rates(molecule, carried, planar, configuration, table, factors, rates):
    """Fill ``factors`` (2, R) and their derivatives ``rates`` (K, 2, R) by the coordinates."""
    kinds, parents, origins, axes, part_frames, parts, weights = molecule
    spots = table[0]
    frames = np.empty((kinds.size, FRAME))
    posed = np.empty((part_frames.size, POSED))
    lines = np.empty((kinds.size, 6))
    amplitudes = np.empty((2, spots.shape[1]))
    work = np.empty((WORK, spots.shape[1]))
    slopes = np.empty((kinds.size, 2, spots.shape[1]))
    place_frames(kinds, parents, origins, axes, configuration, frames)
    pose_parts(frames, part_frames, parts, posed)
    motion_axes(axes, frames, lines)
    spot_rates(posed, lines, kinds, carried, weights, planar, spots, work, amplitudes, slopes)
    combine(table, amplitudes, factors)
    for k in range(kinds.size):
        combine(table, slopes[k], rates[k])
