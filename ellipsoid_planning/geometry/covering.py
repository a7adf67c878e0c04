"""One or several ellipsoids that together cover a group of solids."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.enclosing import enclosing_ellipsoid, grown_around
from ellipsoid_planning.geometry.rounds import Rounds
from ellipsoid_planning.geometry.solids import Solid

Array = NDArray[np.float64]
Group = tuple[Solid, ...]

# Splits are compared by rough ellipsoids.
ROUGH = 1e-2
PLACES = (0.2, 0.35, 0.5, 0.65, 0.8)
SAMPLES = 500
UNION_SAMPLES = 4_000
# A split must take away at least this share of the union's volume.
WORTHWHILE = 0.01


def enclose(solids: Sequence[Solid], tolerance: float | None = None) -> Ellipsoid:
    """The minimum-volume ellipsoid around solids, which are inside in floating point too.

    Exact for a single sphere, box, cylinder or capsule; else see `enclosing_ellipsoid`.

    Raises:
        GeometryError: if the solids are one point.
    """
    points = np.concatenate([solid.points for solid in solids])
    rounds = Rounds.joined([solid.rounds for solid in solids])
    if len(solids) == 1 and solids[0].form is not None:
        return grown_around(solids[0].form, points, rounds)
    return enclosing_ellipsoid(points, rounds, tolerance=tolerance).ellipsoid


def cover(solids: Sequence[Solid], parts: int = 1) -> tuple[Ellipsoid, ...]:
    """At most so many ellipsoids whose union covers the solids.

    The group is split again and again, by a plane or between solids, where that takes most away
    from the volume, until there are enough parts or no split makes the union worthwhile smaller.
    Solids that a plane crosses are cut by it, so that the union covers surfaces and insides, not
    only vertices. The choice is greedy.

    Raises:
        GeometryError: if the solids are one point, or there is none.
    """
    cells = [_Cell(tuple(solids), enclose(solids))]
    splittable = list(cells) if parts > 1 else []
    while len(cells) < parts and splittable:
        best = max(splittable, key=lambda cell: cell.gain)
        splittable.remove(best)
        if best.gain <= 0.0:
            break
        new = [_Cell(group, enclose(group)) for group in best.split[1]]
        others = [cell for cell in cells if cell is not best]
        if _union([*others, *new]) < (1.0 - WORTHWHILE) * _union(cells):
            cells = [*others, *new]
            splittable += new
    return tuple(cell.ellipsoid for cell in cells)


def union_volume(bodies: Sequence[Ellipsoid]) -> float:
    """The volume (area) of the union: exact for one body, to about one per cent for several."""
    if len(bodies) == 1:
        return _volume(bodies[0])
    total = 0.0
    for body in bodies:
        points = body.centre + _ball_points(UNION_SAMPLES, body.dimension) @ body.matrix.T
        shared = np.sum([other.contains(points) for other in bodies if other is not body], axis=0)
        total += _volume(body) * float(np.mean(1.0 / (1.0 + shared)))
    return total


def _union(cells: Sequence[_Cell]) -> float:
    return union_volume([cell.ellipsoid for cell in cells])


@dataclass(frozen=True, eq=False)
class _Cell:
    """Solids and pieces that one ellipsoid encloses."""

    solids: Group
    ellipsoid: Ellipsoid

    @property
    def gain(self) -> float:
        """By how much the best split lowers the volume."""
        return self.split[0]

    @cached_property
    def split(self) -> tuple[float, tuple[Group, Group]]:
        """The best split's gain and its two groups."""
        best: tuple[float, tuple[Group, Group]] = -math.inf, ((), ())
        for first, second in self._splits():
            try:
                union = _rough_union(first, second)
            except GeometryError:  # a group that is one point
                continue
            gain = _volume(self.ellipsoid) - union
            if gain > best[0]:
                best = gain, (first, second)
        return best

    def _splits(self) -> Iterator[tuple[Group, Group]]:
        """Planes across the ellipsoid's axes at several places, and between whole solids."""
        for normal in self.ellipsoid.rotation.T:
            extents = [solid.extent(normal) for solid in self.solids]
            low, high = min(e[0] for e in extents), max(e[1] for e in extents)
            for place in PLACES:
                offset = low + place * (high - low)
                pieces = [solid.cut(normal, offset) for solid in self.solids]
                first = tuple(below for below, _ in pieces if below is not None)
                second = tuple(above for _, above in pieces if above is not None)
                if first and second:
                    yield first, second
            ordered = sorted(self.solids, key=lambda solid: float(solid.middle @ normal))
            for count in range(1, len(ordered)):
                yield tuple(ordered[:count]), tuple(ordered[count:])


def _rough_union(first: Sequence[Solid], second: Sequence[Solid]) -> float:
    """About the volume of the union of the ellipsoids around two groups."""
    one, other = _rough(first), _rough(second)
    inside = other.contains(one.centre + _ball_points(SAMPLES) @ one.matrix.T)
    return _volume(one) * (1.0 - float(np.mean(inside))) + _volume(other)


def _rough(solids: Sequence[Solid]) -> Ellipsoid:
    if len(solids) == 1 and solids[0].form is not None:
        return solids[0].form
    points = np.concatenate([*[s.points for s in solids], *[_round_points(s) for s in solids]])
    return enclosing_ellipsoid(points, tolerance=ROUGH).ellipsoid


def _round_points(solid: Solid) -> Array:
    """Points around a curved solid."""
    return solid.surface.reshape(-1, 3) if len(solid.rounds.centres) else np.zeros((0, 3))


def _ball_points(count: int, n: int = 3) -> Array:
    """Points (count, n) spread evenly in the unit ball."""
    # Radii in the order of a low-discrepancy sequence, or the points would lie on a spiral.
    radii = (((np.arange(count) + 1.0) * 0.5 * (math.sqrt(5.0) - 1.0)) % 1.0) ** (1.0 / n)
    return unit_directions(n, count) * radii[:, None]


def _volume(body: Ellipsoid) -> float:
    ball = math.pi if body.dimension == 2 else 4.0 / 3.0 * math.pi
    return float(ball * np.prod(body.semi_axes))
