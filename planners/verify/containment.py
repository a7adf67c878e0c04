"""How much room parts have inside arenas: dense surface points, then refined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.directions import unit_directions
from planners.verify.ascent import ascend, value

Array = NDArray[np.float64]

_POINTS = {2: 48, 3: 160}
_SLIDES = 25
_LARGEST_BATCH = 4096


def room(arenas: Array, parts: Array, offset: Array) -> Array:
    """Distances (k,) from parts to the boundaries of the arenas around them.

    Negative where a part leaves its arena. Every value is that of an actual direction, so the
    true room is never larger, but by rounding.

    Args:
        arenas: matrices A = R diag(a) (k, n, n).
        parts: the same of the parts.
        offset: (k, n), centres of the parts seen from those of the arenas.
    """
    rows = range(0, len(offset), _LARGEST_BATCH)
    found = [_room(*(x[i : i + _LARGEST_BATCH] for x in (arenas, parts, offset))) for i in rows]
    return np.concatenate(found) if found else np.zeros(0)


def room_at_least(arenas: Array, parts: Array, offset: Array) -> Array:
    """Cheap lower bounds (k,) of the room: -inf where they say nothing."""
    inverse = np.linalg.inv(arenas)
    centre = np.linalg.norm(np.einsum("kij,kj->ki", inverse, offset), axis=1)
    radius = np.linalg.norm(inverse @ parts, axis=(1, 2))
    thinnest = 1.0 / np.linalg.norm(inverse, axis=(1, 2))
    inside = 1.0 - centre - radius
    return np.where(inside > 0.0, inside * thinnest, -np.inf)


def _room(arenas: Array, parts: Array, offset: Array) -> Array:
    u = narrowest_directions(arenas, parts, offset)
    return -value(u, offset, arenas, parts, -1.0)


def narrowest_directions(arenas: Array, parts: Array, offset: Array) -> Array:
    """Directions (k, n) along which parts have the least room, as far as a search finds them."""
    candidates = _outermost_normal(arenas, parts, offset), _tightest(arenas, parts, offset)
    one, two = (ascend(u, offset, arenas, parts, -1.0) for u in candidates)
    better = value(one, offset, arenas, parts, -1.0) >= value(two, offset, arenas, parts, -1.0)
    return np.where(better[:, None], one, two)


def _outermost_normal(arenas: Array, parts: Array, offset: Array) -> Array:
    """The arena's normal (k, n) at the surface point that lies furthest out in its own norm.

    The furthest of many points is slid along the part's surface: the norm is convex, so
    stepping to the support point of its gradient never leads further in.
    """
    inverse = np.linalg.inv(arenas)
    turned = inverse @ parts
    centre = np.einsum("kij,kj->ki", inverse, offset)
    sphere = unit_directions(offset.shape[1], _POINTS[offset.shape[1]])
    outness = np.linalg.norm(np.einsum("kij,pj->kpi", turned, sphere) + centre[:, None], axis=2)
    ball = sphere[np.argmax(outness, axis=1)]
    for _ in range(_SLIDES):
        ball = _unit(
            np.einsum("kji,kj->ki", turned, np.einsum("kij,kj->ki", turned, ball) + centre)
        )
    outermost = np.einsum("kij,kj->ki", turned, ball) + centre
    return _unit(np.einsum("kji,kj->ki", inverse, outermost))


def _tightest(arenas: Array, parts: Array, offset: Array) -> Array:
    """The direction (k, n), of many, in which a part has the least room."""
    directions = unit_directions(offset.shape[1], _POINTS[offset.shape[1]])
    wide = np.linalg.norm(np.einsum("kij,pi->kpj", arenas, directions), axis=2)
    long = np.linalg.norm(np.einsum("kij,pi->kpj", parts, directions), axis=2)
    least = np.argmin(wide - long - offset @ directions.T, axis=1)
    return directions[least]


def _unit(rows: Array) -> Array:
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    axis = np.eye(rows.shape[1])[0]
    return np.where(length > 0.0, rows / np.where(length > 0.0, length, 1.0), axis)
