"""Triangles around solids, and cutting triangles by planes."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

SECTORS = 32
ARC = 12
# The solid angle of a closed surface about a point, divided by the whole: 1 inside, 0 outside.
INSIDE = 0.25


def box_triangles(half_sizes: ArrayLike) -> Array:
    """The surface (12, 3, 3) of the box |x_i| <= h_i."""
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * np.asarray(half_sizes)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads]
    return corners[np.array(faces)]


def cylinder_triangles(radius: float, half_length: float) -> Array:
    """A prism (k, 3, 3) around the cylinder about z."""
    return _revolved(np.array([radius, radius]), np.array([-half_length, half_length]))


def capsule_triangles(radius: float, half_length: float) -> Array:
    """A polyhedron (k, 3, 3) around the convex hull of the balls about (0, 0, +-h)."""
    # Vertices of a polygon whose sides touch the half circle.
    angles = math.pi * ((np.arange(ARC) + 0.5) / ARC - 0.5)
    reach = radius / math.cos(0.5 * math.pi / ARC)
    shift = np.where(np.arange(ARC) < ARC // 2, -half_length, half_length)
    return _revolved(reach * np.cos(angles), reach * np.sin(angles) + shift)


def _revolved(radii: Array, heights: Array) -> Array:
    """The closed surface of rings about z, from the lowest to the highest, around the circles."""
    angles = 2.0 * math.pi * np.arange(SECTORS) / SECTORS
    circle = np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles])
    circle /= math.cos(math.pi / SECTORS)
    rings = radii[:, None, None] * circle + heights[:, None, None] * np.array([0.0, 0.0, 1.0])
    following = np.roll(rings, -1, axis=1)
    below, above = rings[:-1].reshape(-1, 3), rings[1:].reshape(-1, 3)
    below_next, above_next = following[:-1].reshape(-1, 3), following[1:].reshape(-1, 3)
    poles = np.zeros((2, SECTORS, 3))
    poles[0, :, 2], poles[1, :, 2] = heights[0], heights[-1]
    return np.concatenate(
        [
            np.stack([below, below_next, above_next], axis=1),
            np.stack([below, above_next, above], axis=1),
            np.stack([poles[0], following[0], rings[0]], axis=1),
            np.stack([poles[1], rings[-1], following[-1]], axis=1),
        ]
    )


def cut_triangles(triangles: Array, normal: Array, offset: float) -> Array:
    """The parts (k, 3, 3) of triangles (m, 3, 3) where normal . x <= offset, as triangles."""
    height = triangles @ normal - offset
    inside = height <= 0.0
    count = inside.sum(axis=1)
    one, two = count == 1, count == 2
    a, b, c, ab, ac = _crossings(triangles[one], height[one], inside[one])
    tips = np.stack([a, ab, ac], axis=1)
    a, b, c, ab, ac = _crossings(triangles[two], height[two], ~inside[two])
    bases = [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate([triangles[count == 3], tips, *bases])


def _crossings(triangles: Array, height: Array, alone: NDArray[np.bool_]) -> tuple[Array, ...]:
    """Corners a, b, c, turned so that a is on its own side, and where ab and ac cross."""
    first = np.argmax(alone, axis=1)
    order = (first[:, None] + np.arange(3)) % 3
    row = np.arange(len(triangles))[:, None]
    corner, at = triangles[row, order], height[row, order]
    a, b, c = corner[:, 0], corner[:, 1], corner[:, 2]
    to_b = (at[:, 0] / (at[:, 0] - at[:, 1]))[:, None]
    to_c = (at[:, 0] / (at[:, 0] - at[:, 2]))[:, None]
    return a, b, c, a + to_b * (b - a), a + to_c * (c - a)


def are_inside(points: Array, triangles: Array) -> NDArray[np.bool_]:
    """Whether points (m, 3) are inside a closed surface of triangles (k, 3, 3).

    By the solid angle (A. van Oosterom and J. Strackee, "The solid angle of a plane triangle",
    IEEE Transactions on Biomedical Engineering 30, 1983), whichever way round the triangles are.
    It bears holes and overlaps: a point is inside from a quarter of the whole solid angle on.
    """
    turns = np.empty(len(points))
    for index, point in enumerate(points):
        a, b, c = np.moveaxis(triangles - point, 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = np.sum(a * np.cross(b, c), axis=1)
        cosines = la * lb * lc + np.sum(a * b, axis=1) * lc + np.sum(b * c, axis=1) * la
        cosines += np.sum(c * a, axis=1) * lb
        turns[index] = np.sum(np.arctan2(volume, cosines)) / (2.0 * math.pi)
    return np.abs(turns) > INSIDE
