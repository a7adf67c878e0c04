"""Distances of many pairs of ellipsoids, each with its evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.verify.ascent import ascend, difference, value

Array = NDArray[np.float64]

_BISECTIONS = 70
_WIDEST_LOGIT = 80.0
_ROUNDING = 32.0 * np.finfo(float).eps


@dataclass(frozen=True, eq=False)
class Distances:
    """Of k pairs of bodies.

    Attributes:
        lower: (k,), distance along a direction that separates them; minus a penetration depth
            where none does.
        upper: (k,), distance of two points of theirs; `lower` where they meet.
        meet: (k,), True only where a point was found that lies in both, rounding included.
    """

    lower: Array
    upper: Array
    meet: NDArray[np.bool_]


def distances(first: Array, second: Array, offset: Array) -> Distances:
    """Distances of ellipsoids with matrices A = R diag(a) (k, n, n) and centres `offset` apart.

    Where no direction shows a distance, the point at which both bodies, grown alike, would touch
    is looked at: if it lies in both bodies, they meet.
    """
    direction, meet = nearest_directions(first, second, offset)
    reach = np.linalg.norm(first, axis=(1, 2)) + np.linalg.norm(second, axis=(1, 2))
    margin = _ROUNDING * (np.linalg.norm(offset, axis=1) + reach)
    lower = value(direction, offset, first, second, 1.0) - margin
    apart = np.linalg.norm(difference(direction, offset, first, second, 1.0), axis=1) + margin
    return Distances(lower, np.where(lower > 0.0, apart, np.minimum(lower, 0.0)), meet)


def nearest_directions(
    first: Array, second: Array, offset: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Directions (k, n) along which bodies are farthest apart, and who certainly meets.

    A direction is proposed by the point at which both bodies, grown alike, would touch; then
    the distance along it is maximised.
    """
    direction, point = _touching(first, second, offset)
    meet = _in_both(point, first, second, offset)
    return ascend(direction, offset, first, second, 1.0), meet


def cheap_bounds(first: Array, second: Array, offset: Array) -> tuple[Array, Array]:
    """Lower and upper bounds (k,) of the distances, from the direction between the centres."""
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    along = np.zeros_like(offset)
    along[:, 0] = 1.0
    u = np.where(length > 0.0, offset / np.where(length > 0.0, length, 1.0), along)
    apart = np.linalg.norm(difference(u, offset, first, second, 1.0), axis=1)
    return value(u, offset, first, second, 1.0), apart


def bounded_distances(
    first: Array, second: Array, offset: Array, needed: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Lower and upper bounds of distances, exact below ``needed``, and who certainly meets."""
    low, high = cheap_bounds(first, second, offset)
    meet = np.zeros(len(low), dtype=bool)
    near = np.flatnonzero(low <= needed)
    if len(near):
        exact = distances(first[near], second[near], offset[near])
        low[near], high[near], meet[near] = exact.lower, exact.upper, exact.meet
    return low, high, meet


def _touching(first: Array, second: Array, offset: Array) -> tuple[Array, Array]:
    """Where both bodies, grown by one factor about their centres, touch first.

    Returns the common normal (k, n) and the point (k, n), seen from the first body's centre.
    In the frame where the first body is the unit ball and the second has axes s, the point
    maximises the concave function sum w^2 t (1 - t) / ((1 - t) + t s^2) of t in (0, 1).
    """
    inverse = np.linalg.inv(first)
    left, axes, _ = np.linalg.svd(inverse @ second)
    w = np.einsum("kji,kjl,kl->ki", left, inverse, offset)
    low = np.full(len(w), -_WIDEST_LOGIT)
    high = np.full(len(w), _WIDEST_LOGIT)
    squares = axes * axes
    for _ in range(_BISECTIONS):
        t, rest = _weights(0.5 * (low + high))
        slope = w * w * (rest**2 - squares * t**2) / (rest + squares * t) ** 2
        rising = np.sum(slope, axis=1) > 0.0
        low = np.where(rising, 0.5 * (low + high), low)
        high = np.where(rising, high, 0.5 * (low + high))
    t, rest = _weights(0.5 * (low + high))
    ball = rest / (rest + squares * t) * w
    normal = np.einsum("kji,kjl,kl->ki", inverse, left, ball)
    point = np.einsum("kij,kjl,kl->ki", first, left, ball)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    fallback = np.eye(offset.shape[1])[0]
    return np.where(length > 0.0, normal / np.where(length > 0.0, length, 1.0), fallback), point


def _weights(logit: Array) -> tuple[Array, Array]:
    """The weights t and 1 - t (k, 1) of a logit, both to full precision."""
    return 1.0 / (1.0 + np.exp(-logit))[:, None], 1.0 / (1.0 + np.exp(logit))[:, None]


def _in_both(point: Array, first: Array, second: Array, offset: Array) -> NDArray[np.bool_]:
    size = np.linalg.norm(offset, axis=1) + np.linalg.norm(point, axis=1)
    inside = np.ones(len(point), dtype=bool)
    for matrix, away in ((first, point), (second, point - offset)):
        inverse = np.linalg.inv(matrix)
        radius = np.linalg.norm(np.einsum("kij,kj->ki", inverse, away), axis=1)
        doubt = _ROUNDING * (1.0 + size * np.linalg.norm(inverse, axis=(1, 2)))
        inside &= radius + doubt < 1.0
    return inside
