"""Saying what is wrong with a configuration: which part meets what, and how deep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import layout, placement, validity
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.world import World

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Contact:
    """One reason why a configuration is not valid.

    Attributes:
        kind: 'obstacle', 'arena', 'bounds', or of articulated robots 'self' or 'limits'.
        part: name of the robot's part; empty for 'bounds' and 'limits'.
        body: name of the obstacle, arena, other part or joint; the coordinate for 'bounds'.
        depth: how much is missing, in the scenario's unit: the part would have to move at most
            that far (obstacle), or sticks out that far (arena, bounds), the clearance included.
        message: the whole in one sentence.
    """

    kind: str
    part: str
    body: str
    depth: float
    message: str


def bound_contacts(world: World, position: Array) -> list[Contact]:
    """Coordinates of a base position (n,) that leave the bounds."""
    contacts = []
    for k, name in zip(range(world.dimension), "xyz", strict=False):
        depth = max(world.low[k] - position[k], position[k] - world.high[k])
        if depth > 0.0:
            text = (
                f"the base's {name} = {position[k]:g} is out of bounds "
                f"[{world.low[k]:g}, {world.high[k]:g}] by {depth:g}"
            )
            contacts.append(Contact("bounds", "", name, float(depth), text))
    return contacts


def body_contacts(world: World, robot: RigidRobot, scene: Array, pose: Array) -> list[Contact]:
    """Parts that meet an obstacle, leave an arena, or come closer than the clearance."""
    placed = np.empty((len(robot.parts), layout.PLACED))
    placement.place(scene, *pose, placed)
    return placed_contacts(world, robot, scene, placed)


def placed_contacts(world: World, robot: Robot, scene: Array, placed: Array) -> list[Contact]:
    """:func:`body_contacts` of parts that are placed already, rows (k, PLACED)."""
    gaps = np.empty((len(robot.parts), len(world.obstacles)))
    validity.obstacle_gaps(scene, placed, gaps)
    inside = np.empty((len(robot.parts), len(world.arenas)), dtype=np.bool_)
    validity.in_arenas(scene, placed, inside)
    rooms = np.empty(inside.shape)
    validity.arena_gaps(scene, placed, rooms)
    clearance = float(scene[layout.CLEARANCE])
    required = clearance + layout.ROUNDING * float(scene[layout.SCALE])
    contacts = []
    for i, part in enumerate(robot.parts):
        for j in np.flatnonzero(~(gaps[i] > required)):
            body, missing = world.obstacles[j], required - gaps[i, j]
            verb = "meets" if gaps[i, j] <= 0.0 else f"is closer than {clearance:g} to"
            text = f"part {part.name!r} {verb} obstacle {body.name!r} (depth {missing:.6g})"
            contacts.append(Contact("obstacle", part.name, body.name, float(missing), text))
        for a in np.flatnonzero(~inside[i]):
            arena = world.arenas[a]
            missing = max(required - rooms[i, a], 0.0)
            verb = "leaves" if rooms[i, a] < 0.0 else f"is closer than {clearance:g} to the wall of"
            text = f"part {part.name!r} {verb} arena {arena.name!r} (by {missing:.6g})"
            contacts.append(Contact("arena", part.name, arena.name, float(missing), text))
    return contacts
