"""Covering radii that are exact: the holes of a grid are the faces of a convex hull.

Rotations are pairs of antipodes on the unit sphere in four dimensions. The largest empty balls
touch the vertices of a face of their convex hull; their centres are the faces' normals. So the
covering radius is that of the face nearest to the origin. Large grids are treated in patches: the
hull of the nodes near a patch has all faces whose normals lie in the patch, if no ball reaches
beyond those nodes, which is checked.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.groups.finite_groups import icosahedral
from ellipsoid_planning.groups.group_grid import GroupGrid
from ellipsoid_planning.groups.nearby import both_signs, tree_of
from ellipsoid_planning.groups.quaternions import (
    IDENTITY,
    angle,
    angle_of_chord,
    inverse,
    left_matrix,
    random_rotations,
)
from ellipsoid_planning.groups.rotation_grid import RotationGrid
from ellipsoid_planning.groups.voronoi import VoronoiCell

Array = NDArray[np.float64]

_WHOLE = 3000  # up to here one hull of everything is cheapest
_EXACT = 100_000  # beyond, grids without a group are probed unless asked otherwise


def covering_radius(grid: RotationGrid, most: int = _EXACT) -> tuple[float, bool]:
    """The largest distance [rad] of a rotation from the grid, and whether it is exact.

    Exact (to rounding) for every grid that a group replicates, and for others up to ``most``
    nodes; beyond, the largest distance of 200,000 random rotations, which is a lower bound.
    """
    if grid.count <= _WHOLE:
        return _of_everything(grid), True
    if isinstance(grid, GroupGrid):
        return _of_cell(grid), True
    if grid.count <= most:
        return _of_patches(grid), True
    return probed_radius(grid), False


def probed_radius(grid: RotationGrid, probes: int = 200_000, seed: int = 0) -> float:
    """The largest distance [rad] of random rotations from the grid: a lower bound."""
    # A stream of its own, so that a random grid of the same seed is not probed at its nodes.
    rotations = random_rotations(probes, np.random.default_rng((seed, probes)))
    return float(angle(rotations, grid.at(grid.nearest(rotations))).max())


def _holes(points: Array) -> tuple[Array, Array]:
    """The centres (k, 4) of the empty balls between unit ``points`` and their radii [rad]."""
    from scipy.spatial import ConvexHull

    planes = ConvexHull(points).equations
    cosines = np.clip(-planes[:, 4], -1.0, 1.0)
    return planes[:, :4], 2.0 * np.arccos(cosines)


def _of_everything(grid: RotationGrid) -> float:
    points = both_signs(grid.quaternions())
    if np.linalg.matrix_rank(points) < 4 or len(points) < 6:
        return probed_radius(grid)
    return min(float(_holes(points)[1].max()), math.pi)


def _of_cell(grid: GroupGrid) -> float:
    """The largest hole whose centre is in the centre cell; the group maps all holes there."""
    largest = _of_patch(lambda reach: grid.shifted(reach)[0], grid.cell, grid.spacing)
    return _of_everything(grid) if largest is None else largest


def _of_patches(grid: RotationGrid) -> float:
    """The largest hole in any of the icosahedral group's cells, one by one."""
    cell, nodes, largest = VoronoiCell.of_group(icosahedral()), grid.quaternions(), 0.0
    for element in icosahedral().quaternions:
        hole = _of_patch(partial(_turned_near, nodes, element), cell, grid.spacing)
        if hole is None:
            return _of_everything(grid)
        largest = max(largest, hole)
    return largest


def _of_patch(near: Callable[[float], Array], cell: VoronoiCell, spacing: float) -> float | None:
    """The largest hole in a cell, or None when holes are so large that all nodes are needed.

    ``near`` gives the nodes within an angle [rad] of the identity.
    """
    margin = 3.0 * spacing
    while cell.circumradius + margin < math.pi:
        largest, widest = _holes_of_cell(near(cell.circumradius + margin), cell)
        # Balls that reach into the cell then end before the nodes do, and no hole was missed.
        if widest <= margin:
            return largest
        margin *= 1.5
    return None


def _turned_near(nodes: Array, element: Array, reach: float) -> Array:
    """The nodes within ``reach`` [rad] of an element, seen from it."""
    overlap = nodes @ element
    near = np.abs(overlap) >= math.cos(0.5 * min(reach, math.pi))
    signed = nodes[near] * np.sign(overlap[near])[:, None]
    return signed @ left_matrix(inverse(element)).T


def _holes_of_cell(nodes: Array, cell: VoronoiCell) -> tuple[float, float]:
    """The radii [rad] of the largest hole with its centre in the cell, and of any that meets it."""
    from scipy.spatial import QhullError

    try:
        centres, radii = _holes(nodes)
    except (QhullError, ValueError):  # too few nodes, or all in one plane
        return math.inf, math.inf
    away = 2.0 * np.arccos(np.clip(centres @ IDENTITY, -1.0, 1.0))
    meeting = away - radii <= cell.circumradius
    # Slightly wider than the cell, so that rounding drops no centre on its border.
    inside = cell.contains(centres, 1e-9) & (away < math.pi)
    return float(radii[inside].max(initial=0.0)), float(radii[meeting].max(initial=0.0))


def separation(grid: RotationGrid) -> float:
    """The smallest distance [rad] between two different nodes; pi for a single one."""
    return float(nearest_distances(grid).min())


def nearest_distances(grid: RotationGrid) -> Array:
    """The distance [rad] of nodes to their nearest neighbours: all, or those of the centre cell."""
    if grid.count == 1:
        return np.array([math.pi])
    if isinstance(grid, GroupGrid):
        margin = 3.0 * grid.spacing
        nodes, around = grid.cell_nodes, grid.shifted(grid.cell.circumradius + margin)[0]
        found = _nearest(nodes, around) if len(around) > 1 else np.array([math.inf])
        if found.max() <= margin:
            return found
        return _nearest(nodes, grid.quaternions())
    return _nearest(grid.quaternions(), grid.quaternions())


def _nearest(nodes: Array, among: Array) -> Array:
    chord, _ = tree_of(both_signs(among)).query(nodes, k=2)
    return angle_of_chord(chord[:, 1])
