"""Structure factors of a molecule of ellipsoids in a crystal, and how they change.

A part with centre c and matrix A (the unit ball's image) has at the reciprocal vector s the
transform  weight · f(w) · exp(2πi s·c),  w = 2π|Aᵀs|,  f the unit ball's transform (see bessel) and
weight = density · det A. The molecule's transform M is the sum over its parts. A group operation
x -> W x + w makes of it exp(2πi h·w) M(hW), so that F(h) is a sum of few terms
coefficient · M(spot), or of conj M(spot) = M(-spot); the spots of all reflections and operations
are collected once (crystal.structure_factors), each is evaluated once.

Two bundles of arrays:
    molecule: kinds, parents, origins, axes, part_frames, parts (see kernels.molecule), weights (P,)
    table: spots (S, 3), firsts (R + 1,), term_spots (T,), term_signs (T,), coefficients (T,)
complex; reflection r has the terms firsts[r] to firsts[r + 1] - 1, sign -1 stands for conj.
"""

import math

import numpy as np

from .bessel import ball, ball_slope, disc, disc_slope
from .compile import kernel, released
from .molecule import FRAME, POSED, motion_axes, place_frames, pose_parts

TWO_PI = 2.0 * math.pi


@kernel
def spot_amplitudes(posed, first, last, weights, planar, spots, amplitudes):
    """Fill ``amplitudes`` (S,) complex with the transform of the parts ``first`` to ``last`` - 1.

    ``posed`` is (P, POSED), ``weights`` (P,), ``spots`` (S, 3).
    """
    for s in range(spots.shape[0]):
        x, y, z = spots[s, 0], spots[s, 1], spots[s, 2]
        real = imaginary = 0.0
        for p in range(first, last):
            a = posed[p, 3] * x + posed[p, 6] * y + posed[p, 9] * z
            b = posed[p, 4] * x + posed[p, 7] * y + posed[p, 10] * z
            c = posed[p, 5] * x + posed[p, 8] * y + posed[p, 11] * z
            w = TWO_PI * math.sqrt(a * a + b * b + c * c)
            size = weights[p] * (disc(w) if planar else ball(w))
            phase = TWO_PI * (x * posed[p, 0] + y * posed[p, 1] + z * posed[p, 2])
            real += size * math.cos(phase)
            imaginary += size * math.sin(phase)
        amplitudes[s] = complex(real, imaginary)


@kernel
def combine(table, r, amplitudes):
    """The structure factor of reflection r from the molecule's ``amplitudes`` (S,) at the spots."""
    _, firsts, term_spots, term_signs, coefficients = table
    real = imaginary = 0.0
    for t in range(firsts[r], firsts[r + 1]):
        value, factor = amplitudes[term_spots[t]], coefficients[t]
        part = term_signs[t] * value.imag
        real += factor.real * value.real - factor.imag * part
        imaginary += factor.real * part + factor.imag * value.real
    return complex(real, imaginary)


@released
def structure_factors(molecule, planar, configurations, table, factors):
    """Fill ``factors`` (m, R) complex for the ``configurations`` (m, K)."""
    kinds, parents, origins, axes, part_frames, parts, weights = molecule
    frames = np.empty((kinds.size, FRAME))
    posed = np.empty((part_frames.size, POSED))
    amplitudes = np.empty(table[0].shape[0], np.complex128)
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        pose_parts(frames, part_frames, parts, posed)
        spot_amplitudes(posed, 0, part_frames.size, weights, planar, table[0], amplitudes)
        for r in range(factors.shape[1]):
            factors[index, r] = combine(table, r, amplitudes)


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
    amplitudes = np.empty(table[0].shape[0], np.complex128)
    magnitudes = np.empty(target.size)
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        pose_parts(frames, part_frames, parts, posed)
        spot_amplitudes(posed, 0, part_frames.size, sizes, planar, table[0], amplitudes)
        for r in range(target.size):
            factor = combine(table, r, amplitudes)
            magnitudes[r] = math.sqrt(factor.real * factor.real + factor.imag * factor.imag)
        costs[index] = misfit(magnitudes, target, weights, scaled)


@kernel
def spot_rates(posed, lines, kinds, carried, weights, planar, spots, amplitudes, rates):
    """Fill ``amplitudes`` (S,) and their derivatives ``rates`` (K, S) by the coordinates.

    A coordinate that turns by a about a point p moves a centre c at a × (c − p) and changes A at
    [a]× A, so that w dw = (2π)² (Aᵀs)·(d(Aᵀ)s) = (2π)² a · (AAᵀs × s).

    Args:
        posed: (P, POSED).
        lines: (K, 6), axis and point of each coordinate (see `motion_axes`).
        kinds: (K,), 0 for a turn.
        carried: (K, P), which parts each coordinate moves.
        weights: (P,).
        planar: whether the parts are ellipses.
        spots: (S, 3).
        amplitudes: (S,) complex, written.
        rates: (K, S) complex, written.
    """
    for s in range(spots.shape[0]):
        x, y, z = spots[s, 0], spots[s, 1], spots[s, 2]
        amplitudes[s] = 0.0
        for k in range(kinds.size):
            rates[k, s] = 0.0
        for p in range(posed.shape[0]):
            a = posed[p, 3] * x + posed[p, 6] * y + posed[p, 9] * z
            b = posed[p, 4] * x + posed[p, 7] * y + posed[p, 10] * z
            c = posed[p, 5] * x + posed[p, 8] * y + posed[p, 11] * z
            w = TWO_PI * math.sqrt(a * a + b * b + c * c)
            size = weights[p] * (disc(w) if planar else ball(w))
            slope = weights[p] * (disc_slope(w) if planar else ball_slope(w))
            phase = TWO_PI * (x * posed[p, 0] + y * posed[p, 1] + z * posed[p, 2])
            wave = complex(math.cos(phase), math.sin(phase))
            amplitudes[s] += size * wave
            slope *= TWO_PI * TWO_PI
            size *= TWO_PI
            # v = A Aᵀ s, then v × s
            v0 = posed[p, 3] * a + posed[p, 4] * b + posed[p, 5] * c
            v1 = posed[p, 6] * a + posed[p, 7] * b + posed[p, 8] * c
            v2 = posed[p, 9] * a + posed[p, 10] * b + posed[p, 11] * c
            t0, t1, t2 = v1 * z - v2 * y, v2 * x - v0 * z, v0 * y - v1 * x
            for k in range(kinds.size):
                if not carried[k, p]:
                    continue
                i, j, m = lines[k, 0], lines[k, 1], lines[k, 2]
                if kinds[k] == 0:
                    d0 = posed[p, 0] - lines[k, 3]
                    d1 = posed[p, 1] - lines[k, 4]
                    d2 = posed[p, 2] - lines[k, 5]
                    # s · (axis × d)
                    along = x * (j * d2 - m * d1) + y * (m * d0 - i * d2) + z * (i * d1 - j * d0)
                    swell = slope * (i * t0 + j * t1 + m * t2)
                else:
                    along = x * i + y * j + z * m
                    swell = 0.0
                rates[k, s] += complex(swell, size * along) * wave


@released
def factors_and_rates(molecule, carried, planar, configuration, table, factors, rates):
    """Fill ``factors`` (R,) complex and their derivatives ``rates`` (R, K) by the coordinates."""
    kinds, parents, origins, axes, part_frames, parts, weights = molecule
    spots = table[0]
    frames = np.empty((kinds.size, FRAME))
    posed = np.empty((part_frames.size, POSED))
    lines = np.empty((kinds.size, 6))
    amplitudes = np.empty(spots.shape[0], np.complex128)
    slopes = np.empty((kinds.size, spots.shape[0]), np.complex128)
    place_frames(kinds, parents, origins, axes, configuration, frames)
    pose_parts(frames, part_frames, parts, posed)
    motion_axes(axes, frames, lines)
    spot_rates(posed, lines, kinds, carried, weights, planar, spots, amplitudes, slopes)
    for r in range(factors.size):
        factors[r] = combine(table, r, amplitudes)
        for k in range(kinds.size):
            rates[r, k] = combine(table, r, slopes[k])
