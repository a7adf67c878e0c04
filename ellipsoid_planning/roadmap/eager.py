"""The whole roadmap of chosen layers, for drawing and export (thesis 6.2 and 6.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels.grid import find_nearest
from ellipsoid_planning.kernels.robot_model import ways_are_free
from ellipsoid_planning.metric import turn_length
from ellipsoid_planning.roadmap.graph import RoadmapGraph
from ellipsoid_planning.roadmap.grid import grid_columns
from ellipsoid_planning.roadmap.joint_layers import layer_metric, spread_layers
from ellipsoid_planning.roadmap.orientations import spread_orientations
from ellipsoid_planning.roadmap.parameters import RoadmapParameters

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def layer_orientations(cspace: CSpace, count: int | None = None) -> Array:
    """Configurations (L, d) with the orientations of a planner's first layers, at the origin.

    ``count`` layers, or as many as the planner has by default; one if the robot does not rotate.
    """
    if isinstance(cspace, ArticulatedCSpace):
        count = RoadmapParameters(layers=count).layer_count(cspace.dimension, articulated=True)
        layers = spread_layers(cspace, count)
        return cspace.configurations(np.column_stack([np.zeros((len(layers), 3)), layers]))
    rows = np.zeros((1, 7))
    rows[0, 6] = 1.0
    if cspace.rotates:
        count = RoadmapParameters(layers=count).layer_count(cspace.dimension)
        quaternions = spread_orientations(cspace.dimension, count)
        rows = np.column_stack([np.zeros((len(quaternions), 3)), quaternions])
    return cspace.configurations(rows)


def eager_roadmap(
    cspace: CSpace,
    orientations: ArrayLike,
    parameters: RoadmapParameters | None = None,
) -> RoadmapGraph:
    """All nodes and edges of some layers: every line is swept, every edge tried.

    Vertices are the midpoints of free intervals. Edges join overlapping intervals of
    neighbouring lines in a layer, and of the same line in neighbouring layers, where the motion
    between the midpoints is proved free.

    Args:
        cspace: what the roadmap is of.
        orientations: configurations (d,) or (L, d); their orientations are the layers, their
            positions do not count. See :func:`layer_orientations` for a planner's own.
        parameters: for ``lines``, ``axis`` and ``neighbours``.

    Raises:
        GeometryError: if the configurations have another size.
        PlannerError: if a parameter does not fit the C-space.
    """
    given = parameters or RoadmapParameters()
    axis = given.checked_axis(cspace.dimension)
    layers = cspace.poses(orientations)[:, 3:]
    columns, beside = grid_columns(cspace.world, axis, given.line_count(cspace.dimension))
    joined = given.neighbour_count(cspace.dimension)
    intervals = _intervals(cspace, layers, columns, axis)
    lines = np.vstack(
        [
            _pairs_of_columns(len(layers), beside),
            _pairs_of_layers(cspace, layers, joined, len(columns)),
        ]
    )
    line_of, bounds = _nodes(intervals)
    poses = np.empty((len(line_of), 3 + layers.shape[1]))
    poses[:, :3] = columns[line_of % len(columns)]
    poses[:, axis] = bounds.mean(axis=1)
    poses[:, 3:] = layers[line_of // len(columns)]
    configurations = cspace.configurations(poses)
    return RoadmapGraph(
        configurations.reshape(len(poses), cspace.robot.configuration_size),
        _proved(cspace, poses, _overlapping(lines, line_of, bounds)),
        line_of // len(columns),
    )


def _intervals(cspace: CSpace, layers: Array, columns: Array, axis: int) -> list[Array]:
    """Free intervals (k, 2) of every line; layer after layer, in the columns' order."""
    n = cspace.dimension
    rows = np.zeros((len(layers), 3 + layers.shape[1]))
    rows[:, 3:] = layers
    found = []
    for configuration in cspace.configurations(rows):
        layer = cspace.layer(configuration)
        found += [layer.free_intervals(column[:n], axis) for column in columns]
    return found


def _nodes(intervals: list[Array]) -> tuple[Indices, Array]:
    """The line (m,) and the bounds (m, 2) of every interval."""
    counts = [len(on_line) for on_line in intervals]
    line_of = np.repeat(np.arange(len(intervals)), counts)
    return line_of, np.concatenate(intervals).reshape(-1, 2)


def _pairs_of_columns(layers: int, neighbours: Indices) -> Indices:
    """Neighbouring lines (k, 2) within each of the layers."""
    column, place = np.nonzero(neighbours > np.arange(len(neighbours))[:, None])
    pairs = np.column_stack([column, neighbours[column, place]])
    first = np.arange(layers)[:, None, None] * len(neighbours)
    return np.asarray(pairs + first, dtype=np.int64).reshape(-1, 2)


def _pairs_of_layers(cspace: CSpace, layers: Array, joined: int, columns: int) -> Indices:
    """The same line (k, 2) in neighbouring layers."""
    table = np.full((len(layers), joined), -1, dtype=np.int64)
    joints, weight = layer_metric(cspace), turn_length(cspace.robot)
    for k in range(len(layers)):
        find_nearest(layers, joints, table, k, len(layers), joined, weight)
    layer, place = np.nonzero(table >= 0)
    pairs = np.unique(np.sort(np.column_stack([layer, table[layer, place]]), axis=1), axis=0)
    lines = pairs[:, None, :] * columns + np.arange(columns)[None, :, None]
    return np.asarray(lines, dtype=np.int64).reshape(-1, 2)


def _overlapping(lines: Indices, line_of: Indices, bounds: Array) -> Indices:
    """Pairs of nodes (k, 2) whose intervals overlap, on the given pairs of lines."""
    first, last = np.searchsorted(line_of, lines), np.searchsorted(line_of, lines, side="right")
    pairs: list[Indices] = [np.empty((0, 2), dtype=np.int64)]
    # Few intervals share a line: pair their j-th and k-th over all lines at once.
    most = (last - first).max(axis=0, initial=0)
    for j in range(most[0]):
        for k in range(most[1]):
            there = (first[:, 0] + j < last[:, 0]) & (first[:, 1] + k < last[:, 1])
            pairs.append(first[there] + np.array([j, k]))
    a, b = np.concatenate(pairs).T
    low = np.maximum(bounds[a, 0], bounds[b, 0])
    high = np.minimum(bounds[a, 1], bounds[b, 1])
    return np.column_stack([a, b])[low < high]


def _proved(cspace: CSpace, poses: Array, pairs: Indices) -> Indices:
    """Those of the ``pairs`` (k, 2) of poses that a proved motion joins."""
    counts = np.empty(len(pairs), dtype=np.int64)
    ways_are_free(cspace.model, poses[pairs[:, 0]], poses[pairs[:, 1]], counts)
    return pairs[counts > 0]
