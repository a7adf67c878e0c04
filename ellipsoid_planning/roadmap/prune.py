"""Removal of redundant nodes from a roadmap (thesis 6.3.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.roadmap.graph import RoadmapGraph

Indices = NDArray[np.int64]


def without_redundant_nodes(
    graph: RoadmapGraph, cspace: CSpace, axis: int | None = None
) -> RoadmapGraph:
    """``graph`` with fewer vertices and the same connectivity.

    In each plane of sweep lines of each layer the roadmap falls into routes; vertices where
    routes split, converge or end stay. Along a route a vertex is dropped if a proved motion
    joins its neighbours on the route, and if everything else that it was joined to is, or can
    be, joined to one of them. So two vertices that remain are connected afterwards exactly if
    they were before, and every component keeps at least one.

    Args:
        graph: whose edges are proved motions of ``cspace``.
        cspace: proves the new edges.
        axis: the swept axis, the last by default; in space, planes hold it and the last of the
            other two.
    """
    plane = _planes(graph, cspace.dimension, cspace.dimension - 1 if axis is None else axis)
    pruning = _Pruning(graph, cspace, plane)
    for vertex in np.flatnonzero(pruning.on_route()):
        pruning.drop_if_redundant(int(vertex))
    return pruning.graph()


def _planes(graph: RoadmapGraph, dimension: int, axis: int) -> Indices:
    """A number (m,) for the plane of each vertex: its layer, and in space a coordinate."""
    across = [k for k in range(dimension) if k != axis][:-1]
    keys = np.column_stack([graph.layers, graph.configurations[:, across]])
    return np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1).astype(np.int64)


class _Pruning:
    """A graph from which vertices are taken one by one."""

    def __init__(self, graph: RoadmapGraph, cspace: CSpace, plane: Indices) -> None:
        self._old, self._cspace, self._plane = graph, cspace, plane
        self._joined: list[set[int]] = [set() for _ in graph.configurations]
        for a, b in graph.edges.tolist():
            if a != b:
                self._join(a, b)
        self._kept = np.ones(len(plane), dtype=np.bool_)

    def on_route(self) -> NDArray[np.bool_]:
        """Which vertices (m,) lie inside a route: they have two neighbours in their plane."""
        return np.array([len(self._beside(v)) == 2 for v in range(len(self._plane))], dtype=bool)

    def drop_if_redundant(self, vertex: int) -> None:
        """Drop ``vertex`` if its neighbours can do without it."""
        beside = self._beside(vertex)
        if len(beside) != 2:
            return
        ends = tuple(beside)
        new = [ends]
        for other in self._joined[vertex] - beside:
            end = next((e for e in ends if self._is_joined(other, e)), None)
            if end is None:
                return
            new.append((other, end))
        if not self._is_joined(*ends):
            return
        for other in self._joined[vertex]:
            self._joined[other].discard(vertex)
        self._joined[vertex] = set()
        self._kept[vertex] = False
        for a, b in new:
            self._join(a, b)

    def graph(self) -> RoadmapGraph:
        """What is left."""
        index = np.cumsum(self._kept) - 1
        edges = [(a, b) for a, others in enumerate(self._joined) for b in sorted(others) if a < b]
        return RoadmapGraph(
            self._old.configurations[self._kept],
            index[np.array(edges, dtype=np.int64).reshape(-1, 2)].astype(np.int64),
            self._old.layers[self._kept],
        )

    def _join(self, a: int, b: int) -> None:
        self._joined[a].add(b)
        self._joined[b].add(a)

    def _beside(self, vertex: int) -> set[int]:
        plane = self._plane[vertex]
        return {other for other in self._joined[vertex] if self._plane[other] == plane}

    def _is_joined(self, a: int, b: int) -> bool:
        if b in self._joined[a]:
            return True
        first, last = self._old.configurations[[min(a, b), max(a, b)]]
        return self._cspace.is_motion_valid(first, last)
