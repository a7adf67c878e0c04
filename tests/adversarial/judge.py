"""Gaps of ellipsoids and how far they stick out of arenas, in long double, with proofs.

Values come from points and directions that anyone can check: a direction u proves that a distance
is at least u·c − |A₁ᵀu| − |A₂ᵀu|, a point of each body that it is no more than theirs. Whether two
bodies meet is settled in decimals (`tests.exact`), which hold long doubles exactly.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests import exact, motion_oracle, oracles
from tests.oracles import Body

Wide = NDArray[np.longdouble]

# Long doubles have 64 bits: differences of numbers of size 1 are good to some 1e-18.
PRECISION = 1e-17


def wide(values: Any) -> Wide:
    """An array in long double."""
    return np.asarray(values, dtype=np.longdouble)


def _norm(vectors: Wide) -> Wide:
    return np.sqrt((vectors * vectors).sum(-1))


def supports(matrices: Wide, u: Wide) -> tuple[Wide, Wide]:
    """|Aᵀu| (m,) and the points (m, n) of centred bodies (m, n, n) that are farthest along u."""
    back = np.einsum("mij,mi->mj", matrices, u)
    length = _norm(back)
    return length, np.einsum("mij,mj->mi", matrices, back) / length[:, None]


def gaps(c: Wide, a1: Wide, a2: Wide, *, steps: int = 12) -> tuple[Wide, Wide]:
    """Largest u·c − |A₁ᵀu| − |A₂ᵀu| found, (m,), and its unit u (m, n).

    Offsets (m, n) and matrices (m, n, n); a lower bound of the distance where it is positive.
    """
    start = oracles.signed_gaps(*(np.asarray(x, dtype=np.float64) for x in (c, a1, a2)))[1]
    u = wide(start)
    u = u / _norm(u)[:, None]
    value = (u * c).sum(-1) - supports(a1, u)[0] - supports(a2, u)[0]
    for _ in range(steps):
        trial = _newton(c, a1, a2, u, value)
        found = (trial * c).sum(-1) - supports(a1, trial)[0] - supports(a2, trial)[0]
        better = found > value
        if not better.any():
            break
        u, value = np.where(better[:, None], trial, u), np.where(better, found, value)
    return value, u


def _newton(c: Wide, a1: Wide, a2: Wide, u: Wide, value: Wide) -> Wide:
    """One step on the sphere towards the direction of the largest gap."""
    n = c.shape[1]
    rest, bend = c - value[:, None] * u, np.zeros_like(a1)
    for a in (a1, a2):
        length, point = supports(a, u)
        rest = rest - point
        shape = np.einsum("mij,mkj->mik", a, a)
        bend = bend + (shape - point[:, :, None] * point[:, None, :]) / length[:, None, None]
    size = np.trace(bend, axis1=1, axis2=2)[:, None, None]
    bend = bend + np.maximum(value, 0)[:, None, None] * wide(np.eye(n))
    trial = u + _solved(bend + size * u[:, :, None] * u[:, None, :], rest)
    return trial / _norm(trial)[:, None]


def _solved(matrices: Wide, right: Wide) -> Wide:
    """Solutions (m, n) of positive definite systems, by elimination (numpy has none this wide)."""
    rows = np.concatenate([matrices, right[:, :, None]], axis=2)
    n = right.shape[1]
    for k in range(n):
        rows[:, k] = rows[:, k] / rows[:, k, k][:, None]
        for i in range(n):
            if i != k:
                rows[:, i] = rows[:, i] - rows[:, i, k][:, None] * rows[:, k]
    return np.where(np.isfinite(rows[:, :, n]), rows[:, :, n], 0)


def distance_above(c: Wide, a1: Wide, a2: Wide, u: Wide) -> Wide:
    """The distances (m,) of the bodies' points that face each other along u: none is less."""
    return _norm(c - supports(a1, u)[1] - supports(a2, u)[1])


def are_closer(c: Wide, a1: Wide, a2: Wide, u: Wide, clearance: float) -> bool:
    """Whether two bodies at c (n,) from each other are proved closer than this, or to meet."""
    if clearance > 0.0 and distance_above(c[None], a1[None], a2[None], u[None])[0] < clearance:
        return True
    zero = np.zeros(len(c), dtype=np.longdouble)
    return not exact.is_separated(Body(zero, a1), Body(c, a2))


def sticking_out(arena: Wide, c: Wide, matrices: Wide, steps: int = 60) -> Wide:
    """Largest |A_a⁻¹(c + A z)|, |z| = 1, found for centred arenas (n, n): above 1 is outside.

    Each value is that of a point of the part. z ← EᵀE z + Eᵀw climbs a convex function, from
    both ends of all axes and more.
    """
    n = c.shape[1]
    inverse = _solved(np.broadcast_to(arena.T @ arena, (n, n, n)), arena).T
    w, e = c @ inverse.T, np.einsum("ij,mjk->mik", inverse, matrices)
    return _norm(_farthest(w, e, steps)).max(axis=1)


def _farthest(w: Wide, e: Wide, steps: int) -> Wide:
    """Points (m, k, n) of the bodies w + E z that are locally farthest from the origin."""
    n = w.shape[1]
    corners = np.array([z for z in itertools.product((-1, 0, 1), repeat=n) if any(z)], dtype=float)
    flat, narrow = np.asarray(e, dtype=np.float64), np.asarray(w, dtype=np.float64)
    axes = np.linalg.svd(flat)[2]
    z = np.einsum("mji,kj->mki", axes, corners / np.linalg.norm(corners, axis=1)[:, None])
    for _ in range(steps):
        z = np.einsum("mji,mkj->mki", flat, narrow[:, None] + np.einsum("mij,mkj->mki", flat, z))
        z /= np.maximum(np.linalg.norm(z, axis=2), 1e-300)[:, :, None]
    last = wide(z)
    last = last / np.maximum(_norm(last), np.longdouble(1e-300))[:, :, None]
    return w[:, None] + np.einsum("mij,mkj->mki", e, last)


def room_along(arena: Wide, c: Wide, matrices: Wide, u: Wide) -> Wide:
    """h_a(u) − h(u) (m,): the part is nowhere farther from the wall than for any unit u (m, n)."""
    outer = supports(np.broadcast_to(arena, matrices.shape), u)[0]
    return outer - supports(matrices, u)[0] - (u * c).sum(-1)


def rooms(arena: Wide, c: Wide, matrices: Wide) -> tuple[Wide, Wide]:
    """Least room (m,) found between parts and the wall of a centred arena, and its normal."""
    own, offsets, parts = (np.asarray(x, dtype=np.float64) for x in (arena, c, matrices))
    grid = oracles.sphere_grid(300, c.shape[1])
    inner = np.linalg.norm(np.einsum("ku,mui->mki", grid, parts), axis=2)
    found = np.linalg.norm(grid @ own, axis=1) - inner - offsets @ grid.T
    starts = np.argsort(found, axis=1)[:, :3]
    u = wide(motion_oracle._polished_rooms(own, parts, offsets, grid[starts], 0.3)[1])
    u = u / _norm(u)[:, None]
    return room_along(arena, c, matrices, u), u
