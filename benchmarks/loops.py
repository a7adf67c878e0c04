"""Compiled loops over kernels that the package calls one at a time, to time them from inside."""

from __future__ import annotations

import math

import numba

from ellipsoid_planning.kernels.chords import obstacle_chord
from ellipsoid_planning.kernels.containment import extent_in_arena
from ellipsoid_planning.kernels.layout import BODY_INVERSE, PLACED_CENTRE, ROUNDING
from ellipsoid_planning.kernels.separation import CONVERGE, DECIDE, separation


@numba.njit(error_model="numpy")
def converged_gaps(bodies, placed, out):
    for k in range(bodies.shape[0]):
        out[k] = separation(bodies, k, placed, k, 0.5, math.inf, CONVERGE)[0]


@numba.njit(error_model="numpy")
def decided_gaps(bodies, placed, out):
    for k in range(bodies.shape[0]):
        out[k] = separation(bodies, k, placed, k, 0.5, 8.0 * ROUNDING, DECIDE)[0]


@numba.njit(error_model="numpy")
def extents(bodies, placed, out):
    for k in range(bodies.shape[0]):
        out[k] = extent_in_arena(bodies, k, placed, k, 8.0, BODY_INVERSE, False)[0]


@numba.njit(error_model="numpy")
def chords(bodies, placed, table, out):
    """Blocked interval of each pair's line along x through the part's own place."""
    for k in range(bodies.shape[0]):
        out[k, 0], out[k, 1], out[k, 2] = obstacle_chord(
            bodies, k, placed, k, table, k, 0.0, 8.0 * ROUNDING, 0, 0.0, 0.0, 0.0
        )


@numba.njit(error_model="numpy")
def sampled_chords(bodies, placed, low, high, count, out):
    """The same by gaps at ``count`` places from ``low`` to ``high``; ``placed`` is restored."""
    for k in range(bodies.shape[0]):
        own = placed[k, PLACED_CENTRE]
        out[k] = 0
        for m in range(count):
            placed[k, PLACED_CENTRE] = own + low + (high - low) * m / (count - 1)
            value = separation(bodies, k, placed, k, 0.5, 8.0 * ROUNDING, DECIDE)[0]
            out[k] += 0 if value > 8.0 * ROUNDING else 1
        placed[k, PLACED_CENTRE] = own
