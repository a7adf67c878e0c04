"""Covering radii that are exact: the holes of a grid are the faces of a convex hull.

Rotations are pairs of antipodes on the unit sphere in four dimensions. The largest empty balls
touch the vertices of a face of their convex hull; their centres are the faces' normals. So the
covering radius is that of the face nearest to the origin. Large grids are treated in patches: the
hull of the nodes near a patch has all faces whose normals lie in the patch, if no ball reaches
beyond those nodes, which is checked.
"""

from __future__ import annotations

import math

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
    cell = grid.cell
    margin = 3.0 * grid.spacing
    while cell.circumradius + margin < math.pi:
        nodes, _ = grid.shifted(cell.circumradius + margin)
        largest = _largest_hole(nodes, cell)
        if largest <= margin:
            return largest
        margin = 1.5 * max(largest, margin) if largest < math.pi else 2.0 * margin
    return _of_everything(grid)


def _of_patches(grid: RotationGrid) -> float:
    """The largest hole in any of the icosahedral group's cells, one by one."""
    group = icosahedral()
    cell = VoronoiCell.of_group(group)
    nodes = grid.quaternions()
    largest = 0.0
    for element in group.quaternions:
        margin = 3.0 * grid.spacing
        while True:
            near = _turned_near(nodes, element, cell.circumradius + margin)
            hole = _largest_hole(near, cell) if len(near) > 5 else math.inf
            if hole <= margin:
                break
            if cell.circumradius + margin >= math.pi:
                return _of_everything(grid)
            margin *= 2.0
        largest = max(largest, hole)
    return largest


def _turned_near(nodes: Array, element: Array, reach: float) -> Array:
    """The nodes within ``reach`` [rad] of an element, seen from it."""
    overlap = nodes @ element
    near = np.abs(overlap) >= math.cos(0.5 * min(reach, math.pi))
    signed = nodes[near] * np.sign(overlap[near])[:, None]
    return signed @ left_matrix(inverse(element)).T


def _largest_hole(nodes: Array, cell: VoronoiCell) -> float:
    centres, radii = _holes(nodes)
    # Slightly wider than the cell, so that rounding drops no centre on its border.
    inside = cell.contains(centres, 1e-9) & (centres @ IDENTITY > 0.0)
    return float(radii[inside].max(initial=0.0))


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
