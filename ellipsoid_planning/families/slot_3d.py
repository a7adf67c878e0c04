"""``slot-3d``: a passage at least three robot lengths long between long ellipsoids.

Three openings of the same normals stand in a row, half a slot's length apart, all touching the
same planes: the play is the stated one at each and, the bodies being so long that they are nearly
flat, at most a tenth of the width larger in between.
"""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.families.chain_of_gaps import moved_gate
from ellipsoid_planning.families.gap import opening_gate
from ellipsoid_planning.families.openings import Wall, frame, wall_bodies
from ellipsoid_planning.families.rooms import Rooms, clutter, ends, far_rotation
from ellipsoid_planning.families.scene import Layout, Request
from ellipsoid_planning.families.shapes import long_shape
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

ROBOT_LENGTHS = 3.02
ARENA = (34.0, 5.0, 5.0)
WALL = Wall(thick=16.0, wide=9.0, deep=3.2)
ROOMS = Rooms(
    ends=(25.5, 26.5),
    beside=(0.9, 1.1),
    blockers=22.0,
    stray=(21.0, 24.0),
    aside=(1.9, 2.4),
    size=(0.25, 0.4),
)


def slot_3d(request: Request) -> Layout:
    """A long slot among three rows of three bodies, with start and goal turned otherwise."""
    draws = request.draws
    shape = long_shape(draws, 3)
    opening = frame(shape.main, draws, 3)
    half = ROBOT_LENGTHS * shape.reach
    bodies, gates = [], []
    for number, x in enumerate((-half, 0.0, half), 1):
        shift = np.array([x, 0.0, 0.0])
        row = wall_bodies(shape.main, opening, WALL, request.signed_clearance, f"row {number}")
        bodies += [body.transform(np.eye(3), shift) for body in row]
        gates.append(moved_gate(opening_gate(request, shape, opening), np.eye(3), shift))
    start, goal = ends(draws, ROOMS, opening.normals[0])
    usual = turn(3, 65.0, 40.0, 65.0), turn(3, -50.0, 40.0, -50.0)
    fitting = (opening.rotation,)
    return Layout(
        shape=shape,
        arena=Ellipsoid.from_semi_axes(ARENA, name="arena"),
        passage=tuple(bodies),
        clutter=clutter(draws, ROOMS, shape, start, goal)[:3],
        start=(start, far_rotation(draws, usual[0] @ opening.rotation, fitting)),
        goal=(goal, far_rotation(draws, usual[1] @ opening.rotation, fitting)),
        gates=tuple(gates),
    )
