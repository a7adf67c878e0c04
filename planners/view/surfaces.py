"""Surfaces as four-cornered patches, for drawing."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.geometry import Ellipsoid

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray


def ellipsoid_patches(
    body: Ellipsoid, longitudes: int = 32, latitudes: int = 16
) -> NDArray[np.float64]:
    """Return the patches of a 3-D ellipsoid, (m, 4, 3), corners anticlockwise from outside."""
    azimuth = np.linspace(0.0, 2.0 * np.pi, longitudes + 1)
    polar = np.linspace(0.0, np.pi, latitudes + 1)
    ball = np.stack(
        [
            np.outer(np.sin(polar), np.cos(azimuth)),
            np.outer(np.sin(polar), np.sin(azimuth)),
            np.outer(np.cos(polar), np.ones_like(azimuth)),
        ],
        axis=-1,
    )
    return grid_patches(body.centre + ball @ body.matrix.T)


def fan_patches(outline: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the flat patches (k, 4, 3) of a convex outline (k, 3), as anticlockwise as it is."""
    middle = np.broadcast_to(outline.mean(axis=0), outline.shape)
    return np.stack([middle, middle, outline, np.roll(outline, -1, axis=0)], axis=1)


def tube_patches(
    points: NDArray[np.float64], radius: float, sides: int = 10
) -> NDArray[np.float64]:
    """Return the patches of a tube around a polyline (k, 3), (m, 4, 3), with rounded corners.

    Each segment is a cylinder and each point a small ball, so that corners have no gaps.
    """
    pieces = [
        ellipsoid_patches(Ellipsoid.from_semi_axes([radius] * 3, point), sides, sides // 2)
        for point in points
    ]
    for first, second in pairwise(points):
        if np.linalg.norm(second - first) > 1e-9 * radius:
            pieces.append(_cylinder_patches(first, second, radius, sides))
    return np.concatenate(pieces)


def path_radius(parts: Iterable[Ellipsoid], size: float) -> float:
    """Return how thick to draw the path of a robot: thinner than it, visible in the scene.

    Args:
        parts: of the robot.
        size: of the scene, in the same unit of length.
    """
    longest = max(float(part.semi_axes.max()) for part in parts)
    return float(np.clip(0.15 * longest, 0.0015 * size, 0.004 * size))


def triangles(patches: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return vertices (4m, 3) and triangles (2m, 3) of patches (m, 4, 3)."""
    first = 4 * np.arange(len(patches))[:, None]
    corners = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])])
    return patches.reshape(-1, 3), corners


def _cylinder_patches(
    first: NDArray[np.float64], second: NDArray[np.float64], radius: float, sides: int
) -> NDArray[np.float64]:
    along = (second - first) / np.linalg.norm(second - first)
    across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    across /= np.linalg.norm(across)
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = radius * (
        np.outer(np.cos(angle), across) + np.outer(np.sin(angle), np.cross(along, across))
    )
    return grid_patches(np.stack([second + ring, first + ring]))


def grid_patches(grid: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the cells (r*c, 4, 3) of a grid (r+1, c+1, 3) of points."""
    corners = (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])
    return np.stack(corners, axis=2).reshape(-1, 4, 3)
