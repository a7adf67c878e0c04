"""``chain-of-gaps``: three walls in a row, each with a gap that needs another orientation."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.gap import opening_gate, shape_and_opening
from ellipsoid_planning.families.openings import Wall, wall_bodies
from ellipsoid_planning.families.rooms import Rooms, clutter, ends, far_rotation
from ellipsoid_planning.families.scene import Gate, Layout, Request
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

ARENA = (28.0, 8.0, 8.0)
SPACING = 12.0
YAWS_DEG = (-25.0, 20.0, -15.0)
ROLLS_DEG = (0.0, 70.0, -40.0)
ROOMS = Rooms(ends=(20.6, 21.4), blockers=17.6, stray=(17.0, 21.0))


def chain_of_gaps(request: Request) -> Layout:
    """Three gaps whose directions differ by 25 to 50 degrees from one to the next."""
    draws, n = request.draws, request.dimension
    shape, opening = shape_and_opening(request)
    wall = Wall(draws.number(3.2, 3.0, 3.4), draws.number(16.0, 15.0, 18.0), 7.0)
    bodies, gates = [], []
    for number in range(3):
        position, rotation = _wall_pose(request, number)
        upright = wall_bodies(
            shape.main, opening, wall, request.signed_clearance, f"wall {number + 1}"
        )
        bodies += [body.transform(rotation, position) for body in upright]
        gates.append(moved_gate(opening_gate(request, shape, opening), rotation, position))
    start, goal = ends(draws, ROOMS, opening.normals[0])
    fitting = tuple(gate.rotation for gate in gates)
    return Layout(
        shape=shape,
        arena=Ellipsoid.from_semi_axes(ARENA[:n], name="arena"),
        passage=tuple(bodies),
        clutter=clutter(draws, ROOMS, shape, start, goal)[:3],
        start=(start, far_rotation(draws, turn(n, 80.0, 60.0, 60.0), fitting[:1])),
        goal=(goal, far_rotation(draws, turn(n, 100.0, 50.0, 50.0), fitting[-1:])),
        gates=tuple(gates),
    )


def _wall_pose(request: Request, number: int) -> tuple[Array, Array]:
    """Position (n,) and rotation (n, n) of a wall, the signs of the turns alternating."""
    draws, n = request.draws, request.dimension
    yaw, roll = YAWS_DEG[number], ROLLS_DEG[number]
    sway = draws.number(0.5 * (-1) ** number, -1.0, 1.0)
    position = np.zeros(n)
    position[:2] = (number - 1) * SPACING, sway
    smaller, larger = sorted((0.8 * yaw, 1.2 * yaw))
    tilt = 0.0 if n == 2 else draws.number(0.0, -10.0, 10.0)
    roll = 0.0 if n == 2 else draws.number(roll, roll - 30.0, roll + 30.0)
    return position, turn(n, draws.number(yaw, smaller, larger), tilt, roll)


def moved_gate(gate: Gate, rotation: Array, position: Array) -> Gate:
    """A gate under x -> rotation @ x + position."""
    return dataclasses.replace(
        gate,
        position=rotation @ gate.position + position,
        rotation=rotation @ gate.rotation,
        travel=rotation @ gate.travel,
    )
