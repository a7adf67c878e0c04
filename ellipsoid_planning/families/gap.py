"""``gap`` and ``turned-gap``: one wall with one narrow opening.

In the plane the wall is two bodies. Between two convex bodies in space a gap only widens away from
its narrowest place, so there a third one closes it: two big bodies lean towards each other, the
third lies on top, and the best way is between all three.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.openings import Opening, Wall, pair, wall_bodies, wedge
from ellipsoid_planning.families.rooms import Rooms, clutter, ends, far_rotation
from ellipsoid_planning.families.scene import Gate, Layout, Request
from ellipsoid_planning.families.shapes import Shape, long_shape
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

ARENA = (12.0, 8.0, 8.0)


def gap(request: Request) -> Layout:
    """A wall with an opening; start and goal have the orientation that fits."""
    shape, opening = shape_and_opening(request)
    return one_wall(request, shape, opening, fits=True)


def turned_gap(request: Request) -> Layout:
    """The same, with start and goal far from the orientation that fits."""
    shape, opening = shape_and_opening(request)
    canonical = turn(request.dimension, 37.3, 21.9, 11.7)
    return dataclasses.replace(one_wall(request, shape, opening, fits=False), turned=canonical)


def shape_and_opening(request: Request) -> tuple[Shape, Opening]:
    """The robot, and the opening that a gap of this dimension is."""
    shape = long_shape(request.draws, request.dimension)
    if request.dimension == 2:
        return shape, pair(2)
    return shape, wedge(shape.main, request.draws)


def one_wall(request: Request, shape: Shape, opening: Opening, *, fits: bool) -> Layout:
    """A wall across the arena with rooms on both sides."""
    draws, n = request.draws, request.dimension
    wall = Wall(draws.number(3.2, 3.0, 3.6), draws.number(16.0, 15.0, 18.0), 7.0)
    start, goal = ends(draws, Rooms(), opening.normals[0])
    return Layout(
        shape=shape,
        arena=Ellipsoid.from_semi_axes(ARENA[:n], name="arena"),
        passage=wall_bodies(shape.main, opening, wall, request.signed_clearance, "wall"),
        clutter=clutter(draws, Rooms(), shape, start, goal),
        start=(start, _rotation(request, opening, 65.0, fits=fits)),
        goal=(goal, _rotation(request, opening, -50.0, fits=fits)),
        gates=(opening_gate(request, shape, opening),),
    )


def _rotation(request: Request, opening: Opening, usual_deg: float, *, fits: bool) -> Array:
    if fits:
        return opening.rotation
    usual = turn(request.dimension, usual_deg, 40.0, usual_deg) @ opening.rotation
    return far_rotation(request.draws, usual, (opening.rotation,))


def opening_gate(request: Request, shape: Shape, opening: Opening) -> Gate:
    """The gate of an opening at the origin."""
    n, width = request.dimension, 2.0 * shape.least
    play = request.signed_clearance * width
    return Gate(np.zeros(n), opening.rotation, np.eye(n)[0], width, play)
