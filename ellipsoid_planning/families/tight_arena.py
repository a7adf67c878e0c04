"""``tight-arena``: half a turn in a chamber that is as high as the robot is long, almost.

The arena is long and low, the robot must turn round, and so stand upright somewhere. Upright it
contains a segment as long as itself, and the arena's longest chord across is at its middle, twice
the middle semi-axis: there, and only there, the robot passes through the upright, with a free play
of this chord less its length.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.scene import Gate, Layout, Request
from ellipsoid_planning.families.shapes import Shape, base_frame
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

LENGTH_RATIO = 5.0
DEPTH_RATIO = 0.75
OPEN_RATIO = 1.6
PEBBLE_AT = 0.36


def tight_arena(request: Request) -> Layout:
    """A robot that must turn round in the middle of a low chamber."""
    draws, n = request.draws, request.dimension
    shape = _shape(request)
    long = float(shape.main.semi_axes[0])
    chamber = long * np.array([LENGTH_RATIO, 1.0, DEPTH_RATIO])[:n]
    tight, roomy = chamber.copy(), chamber * OPEN_RATIO
    tight[1] *= 1.0 + request.signed_clearance
    far = LENGTH_RATIO * long
    start = _beside(-draws.number(0.69, 0.67, 0.71) * far, draws.number(0.1, -0.15, 0.15), n)
    goal = _beside(draws.number(0.66, 0.65, 0.68) * far, draws.number(-0.1, -0.15, 0.15), n)
    return Layout(
        shape=shape,
        arena=Ellipsoid.from_semi_axes(tight, name="arena"),
        passage=(),
        clutter=_pebbles(request, far),
        start=(start, turn(n, draws.number(5.0, -10.0, 10.0))),
        goal=(goal, turn(n, draws.number(172.0, 165.0, 178.0))),
        gates=(_gate(request, long),),
        open_arena=Ellipsoid.from_semi_axes(roomy, name="arena"),
    )


def _shape(request: Request) -> Shape:
    """A long robot with a hump, which is in nobody's way when the robot stands upright."""
    draws, n = request.draws, request.dimension
    long, thin = draws.number(1.8, 1.6, 2.0), draws.number(0.4, 0.35, 0.45)
    medium = thin * draws.number(1.3, 1.2, 1.4)
    main = Ellipsoid.from_semi_axes([long, thin, medium][:n], name="hull")
    hump = Ellipsoid.from_semi_axes(
        np.array([0.3 * long, thin, 0.8 * medium])[:n],
        np.array([draws.number(0.3, 0.2, 0.4) * long, 0.4 * thin, 0.0])[:n],
        name="hump",
    )
    return Shape((main, hump), *base_frame(draws, main))


def _gate(request: Request, long: float) -> Gate:
    """Upright in the middle, where the whole passage is a turn on the spot."""
    n, width = request.dimension, 2.0 * long
    play = request.signed_clearance * width
    return Gate(np.zeros(n), turn(n, 90.0), np.eye(n)[0], width, play)


def _pebbles(request: Request, far: float) -> tuple[Ellipsoid, ...]:
    """A small body on either side of the middle, in the direct way."""
    draws, n = request.draws, request.dimension
    pebbles = []
    for number, side in enumerate((-1.0, 1.0), 1):
        axes = [draws.number(0.2, 0.15, 0.25) for _ in range(n)]
        centre = _beside(side * PEBBLE_AT * far, 0.0, n)
        rotation = draws.rotation(np.eye(n))
        pebbles.append(Ellipsoid(centre, rotation, np.array(axes), f"pebble {number}"))
    return tuple(pebbles)


def _beside(x: float, y: float, dimension: int) -> Array:
    return np.array([x, y, 0.0])[:dimension]
