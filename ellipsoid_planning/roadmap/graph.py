"""A roadmap as a plain graph, for drawing and export."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import roadmap_tables
from ellipsoid_planning.kernels.containers import EMPTY
from ellipsoid_planning.roadmap.level import Level

if TYPE_CHECKING:
    from ellipsoid_planning.roadmap.highway import HighwayRoadmap

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RoadmapGraph:
    """Configurations joined by proved motions.

    Attributes:
        configurations: vertices (m, d).
        edges: pairs of vertices (k, 2); the motion along each is proved free.
        layers: the layer of each vertex (m,), counted over all levels.
    """

    configurations: Array
    edges: Indices
    layers: Indices

    def __post_init__(self) -> None:
        for array in (self.configurations, self.edges, self.layers):
            array.setflags(write=False)


def _crossings(level: Level) -> tuple[Indices, Array]:
    """Proved edges: nodes (k, 2) and the swept coordinate at either (k, 2)."""
    table = level.tables.edges
    used = table[0] != EMPTY
    keys, rows = table[0, used], level.tables.edge_reals[table[1, used]]
    proved = rows[:, roadmap_tables.EDGE_PROVED] > 0.0
    nodes = np.column_stack(
        [keys >> roadmap_tables.NODE_BITS, keys & ((1 << roadmap_tables.NODE_BITS) - 1)]
    )
    return nodes[proved], rows[proved, roadmap_tables.EDGE_LOWER : roadmap_tables.EDGE_UPPER + 1]


def _level_graph(level: Level, cspace: CSpace) -> RoadmapGraph:
    """Vertices where edges leave and enter intervals; a node's own are joined along it."""
    nodes, swept = _crossings(level)
    places = np.column_stack([nodes.ravel(), swept.ravel()])
    unique, index = np.unique(places, axis=0, return_inverse=True)
    across = index.reshape(-1, 2)
    same = np.flatnonzero(unique[:-1, 0] == unique[1:, 0]) if len(unique) else np.empty(0, int)
    along = np.column_stack([same, same + 1])
    integers = level.tables.node_integers[unique[:, 0].astype(np.int64)]
    poses = np.empty((len(unique), len(level.tables.pose)))
    poses[:, :3] = level.tables.columns[integers[:, roadmap_tables.NODE_COLUMN]]
    poses[:, level.axis] = unique[:, 1]
    layers = integers[:, roadmap_tables.NODE_LAYER]
    poses[:, 3:] = level.tables.orientations[layers]
    return RoadmapGraph(
        cspace.configurations(poses).reshape(len(poses), cspace.robot.configuration_size),
        np.vstack([across, along]).astype(np.int64),
        layers.astype(np.int64),
    )


def explored_graph(planner: HighwayRoadmap) -> RoadmapGraph:
    """Everything that the planner's queries have proved so far, over all levels."""
    robot = planner.cspace.robot
    parts = [_level_graph(level, planner.cspace) for level in planner.levels]
    configurations = [np.empty((0, robot.configuration_size))]
    edges, layers = [np.empty((0, 2), np.int64)], [np.empty(0, np.int64)]
    count, first_layer = 0, 0
    for part, level in zip(parts, planner.levels, strict=True):
        configurations.append(part.configurations)
        edges.append(part.edges + count)
        layers.append(part.layers + first_layer)
        count += len(part.configurations)
        first_layer += len(level.grid.orientations)
    vertices, pairs = np.vstack(configurations), np.vstack(edges)
    if planner.loaded:
        # Files may be wrong about what is proved.
        first, last = vertices[pairs.T]
        pairs = pairs[planner.cspace.are_motions_valid(first, last)]
    return RoadmapGraph(vertices, pairs, np.concatenate(layers))
