"""Gates: saddle points of clearance between two or three bodies, as places to squeeze through.

For a robot that turns, gates are looked for with a ball instead of the robot, the largest that
any part must contain: a passage for the robot is one for the ball. For a robot that only
translates they are those of its own layer, part against body in every combination.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import centring, layout, placement, saddles

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Gate:
    """A narrowest place of a layer.

    Attributes:
        point: base position (3,).
        gap: distance of the robot there from each of the bodies that bound it.
        normals: unit vectors (2 or 3, 3) from those bodies to the robot.
    """

    point: Array
    gap: float
    normals: Array


def probe(cspace: CSpace) -> tuple[Array, Array]:
    """Part rows and placed rows of what gates are looked for with."""
    scene = cspace.scene
    if not cspace.rotates:
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
        self._parts, self._placed = parts, placed
        self._workspace = workspace

    def gates(self, bodies: list[int]) -> Iterator[Gate | None]:
        """Gates between the obstacles with these indices; None where a combination has none."""
        pairs = [(i, j) for j in bodies for i in range(len(self._parts))]
        near = [
            (a, b) for a, b in combinations(range(len(pairs)), 2) if self._near(pairs[a], pairs[b])
        ]
        for a, b in near:
            yield self._gate([pairs[a], pairs[b]])
        if self._dimension == 2:
            return
        joined = set(near)
        for a, b in near:
            for c in range(b + 1, len(pairs)):
                if (a, c) in joined and (b, c) in joined:
                    yield self._gate([pairs[a], pairs[b], pairs[c]])

    def _near(self, first: tuple[int, int], second: tuple[int, int]) -> bool:
        apart = saddles.boxes_apart(self._obstacles, self._placed, *first, *second)
        return bool(apart < 2.0 * self.widest)

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
