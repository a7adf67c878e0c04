"""The field's standard grids of rotations: Hopf with HEALPix, super-Fibonacci, Euler, random."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.quaternions import random_rotations
from ellipsoid_planning.groups.rotation_grid import FormulaGrid

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# The constants of Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of SO(3)"
# (CVPR 2022): psi is the real root of psi^4 = psi + 4 near 1.53.
_PHI = math.sqrt(2.0)
_PSI = 1.533751168755204288118041


def super_fibonacci(count: int) -> Array:
    """``count`` well spread rotations as quaternions (count, 4), deterministic (Alexa 2022)."""
    return _spiral(np.arange(count), count)


def _spiral(indices: Integers, count: int) -> Array:
    s = indices + 0.5
    radius, other = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    alpha, beta = 2.0 * np.pi * s / _PHI, 2.0 * np.pi * s / _PSI
    columns = radius * np.sin(alpha), radius * np.cos(alpha), other * np.sin(beta)
    return np.stack([*columns, other * np.cos(beta)], axis=-1)


def super_fibonacci_grid(count: int) -> FormulaGrid:
    """Super-Fibonacci spirals (Alexa 2022) of any count."""
    return FormulaGrid("super-fibonacci", count, lambda indices: _spiral(indices, count))


def healpix_directions(side: int, pixels: Integers) -> tuple[Array, Array]:
    """Height z and longitude [rad] of HEALPix pixels in the ring order.

    Górski et al., "HEALPix: a framework for high-resolution discretization" (ApJ 2005), equations
    (2) to (9): 12 side^2 equal areas. These formulas are shorter than a wrapper of healpy, which
    is under the GPL.
    """
    cap = 2 * side * (side - 1)
    south = 12 * side**2 - cap
    mirrored = np.where(pixels >= south, 12 * side**2 - 1 - pixels, pixels)
    polar = mirrored < cap
    ring = np.floor(0.5 * (1.0 + np.sqrt(1.0 + 2.0 * np.where(polar, mirrored, 0)))).astype(int)
    place = mirrored - 2 * ring * (ring - 1)
    longitude = np.pi * (place + 0.5) / (2 * ring)
    longitude = np.where(pixels >= south, 2.0 * np.pi - longitude, longitude)
    height = np.where(pixels >= south, -1.0, 1.0) * (1.0 - ring**2 / (3.0 * side**2))
    band = pixels - cap
    row = band // (4 * side)
    shift = 0.5 * ((row + 1) % 2)
    belt = np.pi * (band % (4 * side) + shift) / (2 * side)
    return (
        np.where(polar, height, (side - row) * (2.0 / (3.0 * side))),
        np.where(polar, longitude, belt),
    )


def hopf_count(side: int) -> int:
    """How many rotations the Hopf grid over HEALPix with 12 side^2 directions has, 72 side^3."""
    return 72 * side**3


def hopf_grid(side: int) -> FormulaGrid:
    """Hopf coordinates over HEALPix, 12 side^2 directions times 6 side turns.

    Yershova, Jain, LaValle and Mitchell, "Generating uniform incremental grids on SO(3) using the
    Hopf fibration" (IJRR 2010), for every side, not only powers of two.
    """
    if side < 1:
        raise GridError(f"the Hopf grid's side is at least 1, not {side}")
    turns = 6 * side

    def formula(indices: Integers) -> Array:
        pixel, turn = np.divmod(indices, turns)
        height, longitude = healpix_directions(side, pixel)
        half, tilt = np.pi * (turn + 0.5) / turns, 0.5 * np.arccos(height)
        columns = np.sin(tilt) * np.cos(longitude + half), np.sin(tilt) * np.sin(longitude + half)
        return np.stack([*columns, np.cos(tilt) * np.sin(half), np.cos(tilt) * np.cos(half)], -1)

    return FormulaGrid(f"hopf-{side}", hopf_count(side), formula)


def euler_grid(alphas: int, betas: int, gammas: int) -> FormulaGrid:
    """ZXZ Euler angles, alpha and gamma evenly spread and beta = arccos of evenly spread numbers.

    All three are at the centres of their intervals; every node has the same volume (thesis 4.1).
    """
    if min(alphas, betas, gammas) < 1:
        raise GridError("Euler angles need at least one value each")

    def formula(indices: Integers) -> Array:
        alpha, rest = np.divmod(indices, betas * gammas)
        beta, gamma = np.divmod(rest, gammas)
        alpha, gamma = 2.0 * np.pi * (alpha + 0.5) / alphas, 2.0 * np.pi * (gamma + 0.5) / gammas
        half = 0.5 * np.arccos(1.0 - 2.0 * (beta + 0.5) / betas)
        return _zxz(alpha, half, gamma)

    name, count = f"euler-{alphas}x{betas}x{gammas}", alphas * betas * gammas
    # C is sqrt(2/3) |cos beta|, largest at the first and the last beta.
    return FormulaGrid(name, count, formula, math.sqrt(2.0 / 3.0) * (1.0 - 1.0 / betas))


def _zxz(alpha: Array, half_beta: Array, gamma: Array) -> Array:
    plus, minus = 0.5 * (alpha + gamma), 0.5 * (alpha - gamma)
    columns = np.sin(half_beta) * np.cos(minus), np.sin(half_beta) * np.sin(minus)
    return np.stack(
        [*columns, np.cos(half_beta) * np.sin(plus), np.cos(half_beta) * np.cos(plus)], -1
    )


def random_grid(count: int, seed: int = 0) -> FormulaGrid:
    """Uniformly random rotations, stored; the same for the same seed."""
    rotations = random_rotations(count, seed)
    return FormulaGrid("random", count, lambda indices: rotations[indices])
