"""How much room an articulated planar robot has in a gate, at any heading: plain numpy.

The separation of two convex bodies is the largest gap between their support functions. Any unit
direction bounds it from below, and it changes by no more than the bodies move.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.robots import ArticulatedRobot

Array = NDArray[np.float64]

DIRECTIONS = unit_directions(2, 360)


def shape(robot: ArticulatedRobot, joints_deg: ArrayLike) -> tuple[Ellipsoid, ...]:
    """The robot's bodies with its base at the origin and its joints at the angles given."""
    return robot.bodies_at(np.concatenate([np.zeros(3), np.radians(joints_deg)]))


def separations(
    bodies: Sequence[Ellipsoid],
    walls: Sequence[Ellipsoid],
    headings: Array,
    places: Array,
) -> Array:
    """Separations (m, k), negative in penetration, of bodies at m headings (rad) and k places."""
    reach = np.array([wall.support(DIRECTIONS) for wall in walls])
    at = places @ DIRECTIONS.T
    found = np.empty((len(headings), len(places)))
    for row, heading in enumerate(headings):
        c, s = np.cos(heading), np.sin(heading)
        own = DIRECTIONS @ np.array([[c, -s], [s, c]])
        parts = np.array([body.support(-own) for body in bodies])
        gaps = at[None, None] - (parts[:, None] + reach[None])[:, :, None]
        found[row] = np.min(np.max(gaps, axis=-1), axis=(0, 1))
    return found


def extent(bodies: Sequence[Ellipsoid]) -> float:
    """Radius about the base of a disc that holds all bodies."""
    return float(max(np.linalg.norm(b.centre) + np.max(b.semi_axes) for b in bodies))
