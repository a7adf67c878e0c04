"""One plane through one layer of the configuration space, ready to be drawn.

A layer fixes the robot's orientation; in 3-D a vertical plane is cut out of it. All polygons
are in the plane's coordinates (across, up): up is the last axis, along which lines are swept.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.minkowski import minkowski_sum_boundary
from planners.view.convex import Support, intersect_half_planes, section_support

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ellipsoid_planning.cspace.layer import Layer
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.geometry import Ellipsoid

DIRECTIONS = 240


@dataclass(frozen=True, eq=False)
class LayerSlice:
    """A plane of a layer.

    Attributes:
        cspace: whose layer it is.
        configuration: (d,), gives the layer's orientation and a point of the plane.
        across: the index of the horizontal axis, 0 or 1 (always 0 in 2-D).
    """

    cspace: CSpace
    configuration: NDArray[np.float64]
    across: int = 0

    @cached_property
    def layer(self) -> Layer:
        """The layer."""
        return self.cspace.layer(self.configuration)

    @property
    def bounds(self) -> NDArray[np.float64]:
        """The box of base positions, (2, 2): low and high corner."""
        world = self.cspace.world
        return np.array([world.low, world.high])[:, self._shown]

    @property
    def point(self) -> NDArray[np.float64]:
        """The base position of the configuration, (2,)."""
        return self.configuration[self._shown]

    @property
    def fixed(self) -> tuple[int, float] | None:
        """The axis that the plane is normal to and its place on it; None in 2-D."""
        if self.cspace.dimension == 2:
            return None
        return 1 - self.across, float(self.configuration[1 - self.across])

    def configuration_at(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the layer's configuration (d,) with the base at a point (2,) of the plane."""
        moved = self.configuration.copy()
        moved[self._shown] = point
        return moved

    def c_obstacles(self) -> list[NDArray[np.float64]]:
        """Return the C-obstacle of each part and obstacle that meets the plane, (m, 2) each."""
        polygons = [self._c_obstacle(*pair) for pair in self.layer.obstacle_pairs()]
        return [polygon for polygon in polygons if len(polygon) > 2]

    def allowed(self) -> NDArray[np.float64]:
        """Return the base positions (m, 2) within the bounds that keep the robot in the arena."""
        polygon = _rectangle(*self.bounds)
        for arena, part in self.layer.arena_pairs():
            polygon = self._cut(polygon, self._difference(arena, part))
        return polygon

    def sweep_lines(self, count: int) -> NDArray[np.float64]:
        """Return where `count` evenly spaced sweep lines stand on the horizontal axis, (count,)."""
        low, high = self.bounds[:, 0]
        return np.asarray(low + (np.arange(count) + 0.5) * (high - low) / count)

    def free_intervals(self, lines: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Return the free intervals on each sweep line, (k, 2) each."""
        n = self.cspace.dimension
        found = []
        for line in lines:
            position = self.configuration_at(np.array([line, 0.0]))[:n]
            found.append(self.layer.free_intervals(position))
        return found

    def roadmap(
        self, lines: NDArray[np.float64], intervals: list[NDArray[np.float64]]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the midpoints of intervals (m, 2) and the certified edges (k, 2, 2).

        Edges join the midpoints of overlapping intervals on neighbouring lines.
        """
        nodes = [
            np.column_stack([np.full(len(on_line), line), on_line.mean(axis=1)])
            for line, on_line in zip(lines, intervals, strict=True)
        ]
        edges = [
            (nodes[i][a], nodes[i + 1][b])
            for i in range(len(lines) - 1)
            for a, b in _overlapping(intervals[i], intervals[i + 1])
            if self._is_edge(nodes[i][a], nodes[i + 1][b])
        ]
        return np.concatenate(nodes).reshape(-1, 2), np.array(edges).reshape(-1, 2, 2)

    @property
    def _shown(self) -> list[int]:
        return [self.across, self.cspace.dimension - 1]

    def _is_edge(self, first: NDArray[np.float64], second: NDArray[np.float64]) -> bool:
        return bool(
            self.cspace.is_motion_valid(self.configuration_at(first), self.configuration_at(second))
        )

    def _c_obstacle(self, obstacle: Ellipsoid, part: Ellipsoid) -> NDArray[np.float64]:
        gap = self.cspace.clearance_required
        if self.cspace.dimension == 2:
            normals = unit_directions(2, DIRECTIONS)
            boundary = minkowski_sum_boundary(obstacle, part, normals)
            return np.asarray(boundary + gap * normals)

        def support(u: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(
                obstacle.support(u) + part.support(u) + gap * np.linalg.norm(u, axis=-1)
            )

        reach = np.linalg.norm(obstacle.semi_axes) + np.linalg.norm(part.semi_axes) + gap
        middle = obstacle.centre[self._shown]
        return self._cut(_rectangle(middle - 2.0 * reach, middle + 2.0 * reach), support)

    def _difference(self, arena: Ellipsoid, part: Ellipsoid) -> Support:
        # x + part lies in the arena iff u.x + h_part(u) <= h_arena(u) for every u.
        gap = self.cspace.clearance_required
        return lambda u: arena.support(u) - part.support(u) - gap * np.linalg.norm(u, axis=-1)

    def _cut(self, polygon: NDArray[np.float64], support: Support) -> NDArray[np.float64]:
        """Cut a polygon (k, 2) down to {x : u.x <= support(u) for every u}."""
        normals = unit_directions(2, DIRECTIONS)
        if self.fixed is None:
            return intersect_half_planes(polygon, normals, support(normals))
        axis, place = self.fixed

        def from_plane(u: NDArray[np.float64]) -> NDArray[np.float64]:
            return support(u) - place * u[:, axis]

        unit = np.eye(3)
        offsets = section_support(from_plane, unit[self._shown], unit[axis], DIRECTIONS)
        return intersect_half_planes(polygon, normals, offsets)


def _rectangle(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([low, [high[0], low[1]], high, [low[0], high[1]]])


def _overlapping(first: NDArray[np.float64], second: NDArray[np.float64]) -> list[tuple[int, int]]:
    low = np.maximum(first[:, None, 0], second[None, :, 0])
    high = np.minimum(first[:, None, 1], second[None, :, 1])
    return [(int(a), int(b)) for a, b in np.argwhere(low < high)]
