"""``bend``: a corridor round a corner that is so tight that the robot must turn inside.

The arena's wall, a circle (an ellipsoid of revolution in space), is the outer side. The inner side
are three pegs that touch one circle about the arena's centre from within, so that they and the
wall leave three gates of the same width, and from each to the next the robot turns by the angle
between them. Each gate is narrowest on the peg's own radius, which a ball within the robot must
cross: no way has more play than the ball. And the motion that turns the robot about the arena's
centre has this play all the way.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.scene import Gate, Layout, Request
from ellipsoid_planning.families.shapes import Shape, long_shape
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

OUTER = 7.0
ARENA_HEIGHT = 3.8
PEG_HEIGHT = 11.0
# At the robot's ends the wall is nearer, by a third of its half width.
OUTLINE = 0.5


def bend(request: Request) -> Layout:
    """Three gates round a bend between two rooms, which a wall keeps apart elsewhere."""
    draws, n = request.draws, request.dimension
    shape = long_shape(draws, n, flatness=1.5, outline=OUTLINE)
    step_deg = draws.number(46.0, 40.0, 50.0)
    angles = [step_deg, 0.0, -step_deg]
    start, goal = _end(draws, n, 1.0), _end(draws, n, -1.0)
    divider = np.array([5.5, 0.5, PEG_HEIGHT])[:n]
    bodies = [
        Ellipsoid.from_semi_axes(divider, _planar(-4.0, 0.0, n), name="divider"),
        *_pebbles(draws, n),
    ]
    return Layout(
        shape=shape,
        arena=Ellipsoid.from_semi_axes([OUTER, OUTER, ARENA_HEIGHT][:n], name="arena"),
        passage=_pegs(request, shape, angles),
        clutter=tuple(bodies),
        start=(start, _parallel(draws, n, 170.0)),
        goal=(goal, _parallel(draws, n, 10.0)),
        gates=tuple(_gate(request, shape, angle) for angle in angles),
    )


def _pegs(request: Request, shape: Shape, angles: list[float]) -> tuple[Ellipsoid, ...]:
    """Pegs at polar angles [deg], touching the inner circle from within."""
    n = request.dimension
    radius = request.draws.number(2.8, 2.6, 3.0)
    inner = OUTER - 2.0 * shape.least * (1.0 + request.signed_clearance)
    semi_axes = np.array([radius, radius, PEG_HEIGHT])[:n]
    return tuple(
        Ellipsoid.from_semi_axes(
            semi_axes, turn(n, angle) @ _planar(inner - radius, 0.0, n), name=f"peg {number}"
        )
        for number, angle in enumerate(angles, 1)
    )


def _gate(request: Request, shape: Shape, angle_deg: float) -> Gate:
    """The gate at a polar angle: the robot along the circle, its centre midway."""
    n, width = request.dimension, 2.0 * shape.least
    play = request.signed_clearance * width
    middle = OUTER - (width + play) / 2.0
    outwards = turn(n, angle_deg)
    along = turn(n, angle_deg - 90.0)
    return Gate(outwards @ _planar(middle, 0.0, n), along, along[:, 0], width, play)


def _end(draws: Draws, dimension: int, side: float) -> Array:
    """A place in the room above or below the divider."""
    x, y = draws.number(-2.8, -3.1, -2.5), draws.number(2.9, 2.7, 3.1)
    return _planar(x, side * y, dimension)


def _parallel(draws: Draws, dimension: int, yaw_deg: float) -> Array:
    """An orientation along the divider, to about 15 degrees."""
    yaw = draws.number(yaw_deg, yaw_deg - 15.0, yaw_deg + 15.0)
    return turn(dimension, yaw, draws.number(0.0, -15.0, 15.0), draws.number(0.0, -90.0, 90.0))


def _pebbles(draws: Draws, dimension: int) -> list[Ellipsoid]:
    """A small body in either room, at the wall."""
    pebbles = []
    for number, side in enumerate((1.0, -1.0), 1):
        angle = math.radians(side * draws.number(150.0, 145.0, 160.0))
        centre = (OUTER - 0.6) * np.array([math.cos(angle), math.sin(angle)])
        axes = [draws.number(0.4, 0.3, 0.5) for _ in range(dimension)]
        rotation = draws.rotation(np.eye(dimension))
        position = _planar(centre[0], centre[1], dimension)
        pebbles.append(Ellipsoid(position, rotation, np.array(axes), f"pebble {number}"))
    return pebbles


def _planar(x: float, y: float, dimension: int) -> Array:
    return np.array([x, y, 0.0])[:dimension]
