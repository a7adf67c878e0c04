"""What stands in the rooms on both sides of a passage: start, goal and clutter.

The clutter leaves the lane of the passage and room around start and goal free. One body on
either side stands on the direct way from start to goal, so that it is blocked even without the
passage.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.shapes import Shape
from ellipsoid_planning.families.turns import axis_angle_between, turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

FARTHEST = math.radians(30.0)
ATTEMPTS = 1000


@dataclass(frozen=True)
class Rooms:
    """Where things stand along the passage (x) and how far from its axis.

    Attributes:
        ends: |x| of start and goal, from and to.
        beside: distance of start and goal from the axis, from and to.
        blockers: |x| of the bodies on the direct way.
        stray: |x| of other clutter, from and to.
        aside: distance of other clutter from the axis, from and to.
        size: semi-axes of clutter, from and to.
    """

    ends: tuple[float, float] = (6.8, 7.8)
    beside: tuple[float, float] = (1.9, 2.4)
    blockers: float = 4.4
    stray: tuple[float, float] = (4.5, 9.0)
    aside: tuple[float, float] = (3.2, 5.0)
    size: tuple[float, float] = (0.45, 0.75)


def ends(draws: Draws, rooms: Rooms, normal: Array) -> tuple[Array, Array]:
    """Positions (n,) of start and goal, both off the axis towards the body of a normal (n,)."""
    return _end(draws, rooms, normal, -1.0), _end(draws, rooms, normal, 1.0)


def _end(draws: Draws, rooms: Rooms, normal: Array, side: float) -> Array:
    beside = draws.number(sum(rooms.beside) / 2.0, *rooms.beside) * normal
    sway = turn(len(normal), 0.0, 0.0, draws.number(0.0, -12.0, 12.0))
    beside = sway @ beside if len(normal) == 3 else beside
    beside[0] = side * draws.number(sum(rooms.ends) / 2.0, *rooms.ends)
    return np.asarray(beside)


def far_rotation(draws: Draws, usual: Array, fitting: tuple[Array, ...]) -> Array:
    """A rotation (n, n) whose long and thin axes are at least 30 degrees from fitting ones.

    An ellipsoid fits as well after half turns about its axes; these leave its axes in place.
    """
    for _ in range(ATTEMPTS):
        rotation = draws.rotation(usual)
        angles = [
            axis_angle_between(rotation[:, k], fits[:, k]) for fits in fitting for k in (0, 1)
        ]
        if min(angles) >= FARTHEST:
            return rotation
    raise RuntimeError("no orientation far from the fitting ones was found")  # pragma: no cover


def clutter(
    draws: Draws, rooms: Rooms, shape: Shape, start: Array, goal: Array
) -> tuple[Ellipsoid, ...]:
    """Two bodies on the direct way from start to goal and two elsewhere."""
    blockers = [
        _pebble(draws, rooms, start + (x - start[0]) / (goal[0] - start[0]) * (goal - start), name)
        for x, name in ((-rooms.blockers, "pebble 1"), (rooms.blockers, "pebble 2"))
    ]
    strays = [
        _stray(draws, rooms, shape, side, (start, goal), name)
        for side, name in ((-1.0, "pebble 3"), (1.0, "pebble 4"))
    ]
    return (*blockers, *strays)


def _pebble(draws: Draws, rooms: Rooms, centre: Array, name: str) -> Ellipsoid:
    n, (low, high) = len(centre), rooms.size
    axes = [draws.number((low + high) / 2.0, low, high) for _ in range(n)]
    return Ellipsoid(centre, draws.rotation(np.eye(n)), np.array(axes), name)


def _stray(
    draws: Draws,
    rooms: Rooms,
    shape: Shape,
    side: float,
    ends: tuple[Array, Array],
    name: str,
) -> Ellipsoid:
    """A body off the lane, with room for the robot to turn between it and start and goal."""
    needed = 1.3 * shape.reach + rooms.size[1]
    for _ in range(ATTEMPTS):
        centre = _off_the_lane(draws, rooms, side, len(ends[0]))
        if min(float(np.linalg.norm(centre - end)) for end in ends) >= needed:
            return _pebble(draws, rooms, centre, name)
    raise RuntimeError("no place for clutter was found")  # pragma: no cover


def _off_the_lane(draws: Draws, rooms: Rooms, side: float, dimension: int) -> Array:
    x = side * draws.number(rooms.stray[0] + 0.8, *rooms.stray)
    aside = draws.number(sum(rooms.aside) / 2.0, *rooms.aside)
    if dimension == 2:
        return np.array([x, aside * draws.sign(-1.0)])
    angle = math.radians(draws.number(-110.0, -180.0, 180.0))
    return np.array([x, aside * math.cos(angle), aside * math.sin(angle)])
