"""Gates: saddle points of clearance between two or three bodies, as places to squeeze through.

For a robot that turns, gates are looked for with a ball instead of the robot, the largest that
any part must contain: a passage for the robot is one for the ball. For a robot that only
translates they are those of its own layer, part against body in every combination.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.kernels import centring, layout, placement, saddles

Array = NDArray[np.float64]

# Directions in which walls are looked for, in the plane and in space.
_HEADINGS = 64
_SPREAD = 128
# Looking along all of them takes as long as looking at so many pairs of bodies.
_WALL_PAIRS = 200


@dataclass(frozen=True, eq=False)
class Gate:
    """A narrowest place of a layer.

    Attributes:
        point: base position (3,).
        gap: distance of the robot there from each of the bodies that bound it; about, at a wall.
        normals: unit vectors (2 or 3, 3) from those bodies to the robot.
    """

    point: Array
    gap: float
    normals: Array


def only_translates(cspace: CSpace) -> bool:
    """Whether the robot has but one shape and orientation."""
    return not (cspace.rotates or isinstance(cspace, ArticulatedCSpace))


def probe(cspace: CSpace) -> tuple[Array, Array]:
    """Part rows and placed rows of what gates are looked for with."""
    scene = cspace.scene
    if only_translates(cspace):
        placed = layout.new_placed(scene)
        pose = cspace.poses(np.zeros(cspace.dimension))[0]
        placement.place(scene, *pose, placed)
        return layout.part_rows(scene), placed
    radius = max(float(part.semi_axes.min()) for part in cspace.robot.parts)
    parts, placed = np.zeros((1, layout.PART)), np.zeros((1, layout.PLACED))
    flat = [radius, radius, 0.0 if cspace.dimension == 2 else radius]
    parts[0, layout.PART_MATRIX : layout.PART_MATRIX + 9] = np.diag(flat).ravel()
    placed[0, layout.PLACED_MATRIX : layout.PLACED_MATRIX + 9] = np.diag(flat).ravel()
    parts[0, [layout.PART_RADIUS, layout.PART_REACH]] = radius
    placed[0, layout.PLACED_EXTENT : layout.PLACED_EXTENT + 3] = flat
    return parts, placed


class GateFinder:
    """Finds the gates of one layer among some of a scene's obstacles.

    Attributes:
        widest: gates that leave more room than this on each side are no narrow places.
    """

    def __init__(
        self,
        cspace: CSpace,
        parts: Array,
        placed: Array,
        widest: float,
        workspace: centring.Workspace,
    ) -> None:
        """Look with the placed robot ``placed``, whose base is at the origin."""
        self.widest = widest
        self._dimension = cspace.dimension
        self._obstacles = layout.obstacle_rows(cspace.scene)
        self._arenas = layout.arena_rows(cspace.scene)
        self._directions, self._around = _directions(cspace.dimension)
        self._parts, self._placed = parts, placed
        self._workspace = workspace

    def gates(self, bodies: list[int], first: Array, last: Array) -> Iterator[Gate | None]:
        """Gates between the obstacles with these indices; None where a combination has none.

        Those on the way from the point ``first`` (3,) to ``last`` (3,) come first, as far as
        bounding boxes tell.
        """
        pairs = [(i, j) for j in bodies for i in range(len(self._parts))]
        if not pairs:
            return
        for pair in pairs:
            yield from self._at_walls(*pair)
        low, high = self._boxes(pairs)
        inner, outer = np.maximum(low[:, None], low[None]), np.minimum(high[:, None], high[None])
        apart = np.linalg.norm(np.maximum(inner - outer, 0.0), axis=2)
        near = np.triu(apart < 2.0 * self.widest, 1)
        between = 0.5 * (inner + outer)
        index = np.argwhere(near)
        yield from self._combinations(pairs, index, between[index[:, 0], index[:, 1]], first, last)
        if self._dimension == 2:
            return
        triples = np.array(
            [(a, b, c) for a, b in index for c in np.flatnonzero(near[a] & near[b])],
            dtype=np.int64,
        ).reshape(-1, 3)
        a, b, c = triples.T
        points = (between[a, b] + between[b, c] + between[a, c]) / 3.0
        yield from self._combinations(pairs, triples, points, first, last)

    def compile_kernels(self) -> None:
        """Call the kernel that gates are found with, at worst on a body that is not there."""
        if len(self._obstacles):
            self._gate([(0, 0)])

    def _boxes(self, pairs: list[tuple[int, int]]) -> tuple[Array, Array]:
        """Corners (m, 3), (m, 3) of the boxes of C-obstacles."""
        part, body = np.array(pairs).T
        centre = self._obstacles[body, :3] - self._placed[part, :3]
        extent = self._obstacles[body, layout.BODY_EXTENT : layout.BODY_EXTENT + 3]
        extent = extent + self._placed[part, layout.PLACED_EXTENT : layout.PLACED_EXTENT + 3]
        return centre - extent, centre + extent

    def _combinations(
        self,
        pairs: list[tuple[int, int]],
        index: NDArray[np.int64],
        points: Array,
        first: Array,
        last: Array,
    ) -> Iterator[Gate | None]:
        way = np.linalg.norm(points - first, axis=1) + np.linalg.norm(points - last, axis=1)
        for k in np.argsort(way, kind="stable"):
            yield self._gate([pairs[m] for m in index[k]])

    def _at_walls(self, part: int, body: int) -> Iterator[Gate | None]:
        """Gates between an obstacle and the arenas, about where their normals are parallel.

        Along a direction the obstacle, the part and the wall behind them leave the difference of
        the arena's support function and those of the other two; its local minima, and in space
        its saddles, are gates.
        """
        part_matrix = self._placed[part, layout.PLACED_MATRIX : layout.PLACED_MATRIX + 9]
        part_matrix = part_matrix.reshape(3, 3)
        obstacle = self._obstacles[body]
        for arena in self._arenas:
            u = self._directions
            room = _support(arena, u) - _support(obstacle, u)
            room -= 2.0 * np.linalg.norm(u @ part_matrix, axis=1)
            higher = room[self._around] > room[:, None]
            changes = np.sum(higher != np.roll(higher, 1, axis=1), axis=1)
            # All round higher: a local minimum. Higher, lower, higher, lower: a saddle.
            for k in np.flatnonzero((changes >= 4) | higher.all(axis=1)):
                # Directions are few: at the gate itself there may be more room.
                if -self.widest < room[k] < 2.0 * self.widest:
                    # Half-way between the obstacle and the wall.
                    point = _farthest(obstacle, u[k]) + 0.5 * room[k] * u[k]
                    image = part_matrix.T @ u[k]
                    point += part_matrix @ image / np.linalg.norm(image)
                    point -= self._placed[part, :3]
                    yield Gate(point, 0.5 * float(room[k]), np.array([u[k], -u[k]]))
            self._workspace.pairs[0] += _WALL_PAIRS
            yield None

    def _gate(self, pairs: list[tuple[int, int]]) -> Gate | None:
        rows = np.array(pairs, dtype=np.int64)
        centres = self._obstacles[rows[:, 1], :3] - self._placed[rows[:, 0], :3]
        point, normals = centres.mean(axis=0), np.empty((len(pairs), 3))
        size = float(self._obstacles[rows[:, 1], layout.BODY_RADIUS].mean())
        gap, found = saddles.saddle(
            self._obstacles,
            self._parts,
            self._placed,
            rows,
            len(rows),
            size,
            point,
            normals,
            self._workspace,
        )
        return Gate(point, float(gap), normals) if found and gap < self.widest else None


def _support(body: Array, directions: Array) -> Array:
    """Support function of a body row in ``directions`` (m, 3)."""
    matrix = body[layout.BODY_MATRIX : layout.BODY_MATRIX + 9].reshape(3, 3)
    return np.asarray(directions @ body[:3] + np.linalg.norm(directions @ matrix, axis=1))


def _farthest(body: Array, direction: Array) -> Array:
    """The point of a body row that lies farthest along ``direction`` (3,)."""
    matrix = body[layout.BODY_MATRIX : layout.BODY_MATRIX + 9].reshape(3, 3)
    image = matrix.T @ direction
    return np.asarray(body[:3] + matrix @ image / np.linalg.norm(image))


@cache
def _directions(dimension: int) -> tuple[Array, NDArray[np.int64]]:
    """Directions (m, 3) all round, and those next to each (m, k), in order round it."""
    if dimension == 2:
        index = np.arange(_HEADINGS)
        around = np.column_stack([index - 1, (index + 1) % _HEADINGS])
        return np.pad(unit_directions(2, _HEADINGS), ((0, 0), (0, 1))), around
    u = unit_directions(3, _SPREAD)
    around = np.argsort(-(u @ u.T), axis=1)[:, 1:7]
    first = np.cross(u, np.eye(3)[np.argmin(np.abs(u), axis=1)])
    second = np.cross(u, first)
    angles = np.arctan2(
        np.einsum("mkc,mc->mk", u[around], second), np.einsum("mkc,mc->mk", u[around], first)
    )
    return u, np.take_along_axis(around, np.argsort(angles, axis=1), axis=1)
