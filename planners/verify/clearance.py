"""The clearance of many configurations: bounding spheres first, then exact distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario import Scenario
from planners.verify import containment, separation
from planners.verify.meetings import Clearances, Meeting
from planners.verify.placement import part_placements

Array = NDArray[np.float64]

_LARGEST_BATCH = 20000


@dataclass(frozen=True, eq=False)
class _Bodies:
    centres: Array
    matrices: Array
    radii: Array
    names: tuple[str, ...]


def _bodies(ellipsoids: tuple[Ellipsoid, ...], dimension: int) -> _Bodies:
    return _Bodies(
        np.array([body.centre for body in ellipsoids]).reshape(-1, dimension),
        np.array([body.matrix for body in ellipsoids]).reshape(-1, dimension, dimension),
        np.array([np.max(body.semi_axes) for body in ellipsoids]),
        tuple(body.name for body in ellipsoids),
    )


class ClearanceTester:
    """Distances of a scenario's robot to everything around it."""

    def __init__(self, scenario: Scenario) -> None:
        """Take the bodies out of ``scenario``."""
        self._robot = scenario.robot
        n = scenario.dimension
        self._parts = _bodies(scenario.robot.parts, n)
        self._obstacles = _bodies(scenario.world.obstacles, n)
        self._arenas = _bodies(scenario.world.arenas, n)

    def test(self, configurations: Array, needed: Array) -> Clearances:
        """The clearances of configurations (k, d), exact where they are below ``needed`` (k,)."""
        lower = np.full(len(configurations), np.inf)
        upper = np.full(len(configurations), np.inf)
        meetings: list[Meeting] = []
        all_centres, all_matrices = part_placements(self._robot, configurations)
        if not np.all(np.isfinite(needed)) and self._obstacles.names:
            needed = np.minimum(needed, self._at_most(all_centres))
        for part, name in enumerate(self._parts.names):
            centres, matrices = all_centres[:, part], all_matrices[:, part]
            for rows, low, high, found in (
                self._obstacle_distances(part, centres, matrices, needed, lower),
                self._arena_rooms(centres, matrices, needed, lower),
            ):
                np.minimum.at(lower, rows, low)
                np.minimum.at(upper, rows, high)
                meetings += [Meeting(k, name, body, depth, row) for k, body, depth, row in found]
        return Clearances(lower, upper, tuple(meetings))

    def _at_most(self, all_centres: Array) -> Array:
        """Bounds (k,) of clearances from above: the distances of the bodies' centres."""
        nearest = np.full(len(all_centres), np.inf)
        for row, centres in enumerate(all_centres):
            for centre in centres:
                away = np.linalg.norm(self._obstacles.centres - centre, axis=1)
                nearest[row] = min(nearest[row], float(np.min(away)))
        return nearest

    def _obstacle_distances(
        self, part: int, centres: Array, matrices: Array, needed: Array, lower: Array
    ) -> tuple[NDArray[np.intp], Array, Array, list[tuple[str, str, float, int]]]:
        """Rows, lower and upper bounds of the close pairs; `lower` takes the others' bounds."""
        obstacles = self._obstacles
        if not obstacles.names:
            return np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0), []
        # Those far from all of the configurations first, so that large worlds cost no more.
        middle = np.mean(centres, axis=0)
        spread = float(np.max(np.linalg.norm(centres - middle, axis=1)))
        far = np.linalg.norm(obstacles.centres - middle, axis=1) - spread
        far -= obstacles.radii + self._parts.radii[part]
        kept = np.flatnonzero(far <= np.max(needed))
        np.minimum(lower, np.min(np.delete(far, kept), initial=np.inf), out=lower)
        away = np.linalg.norm(obstacles.centres[kept] - centres[:, None], axis=2)
        spheres = away - obstacles.radii[kept] - self._parts.radii[part]
        close = spheres <= needed[:, None]
        nearest = np.min(np.where(close, np.inf, spheres), axis=1, initial=np.inf)
        np.minimum(lower, nearest, out=lower)
        rows, others = np.nonzero(close)
        others = kept[others]
        low, high = np.zeros(len(rows)), np.zeros(len(rows))
        meet = np.zeros(len(rows), dtype=bool)
        for i in range(0, len(rows), _LARGEST_BATCH):
            batch = slice(i, i + _LARGEST_BATCH)
            row, other = rows[batch], others[batch]
            pair = matrices[row], obstacles.matrices[other], obstacles.centres[other] - centres[row]
            low[batch], high[batch], meet[batch] = separation.bounded_distances(*pair, needed[row])
        found = [
            ("obstacle", obstacles.names[others[i]], float(-low[i]), int(rows[i]))
            for i in np.flatnonzero(meet)
        ]
        return rows, low, high, found

    def _arena_rooms(
        self, centres: Array, matrices: Array, needed: Array, lower: Array
    ) -> tuple[NDArray[np.intp], Array, Array, list[tuple[str, str, float, int]]]:
        """As `_obstacle_distances`, for the arenas."""
        all_rows, rooms, found = [np.zeros(0, dtype=np.intp)], [np.zeros(0)], []
        arenas = self._arenas
        for name, centre, matrix in zip(arenas.names, arenas.centres, arenas.matrices, strict=True):
            around = np.broadcast_to(matrix, matrices.shape)
            least = containment.room_at_least(around, matrices, centres - centre)
            close = least <= needed
            np.minimum(lower, np.where(close, np.inf, least), out=lower)
            rows = np.flatnonzero(close)
            room = containment.room(around[rows], matrices[rows], centres[rows] - centre)
            doubt = 64.0 * np.finfo(float).eps * float(np.linalg.norm(matrix))
            found += [
                ("arena", name, float(-room[i]), int(rows[i]))
                for i in np.flatnonzero(room < -doubt)
            ]
            all_rows.append(rows)
            rooms.append(room)
        room = np.concatenate(rooms)
        return np.concatenate(all_rows), room, room, found
