"""Saying what is wrong with a configuration: which part meets what, and how deep."""

from __future__ import annotations

import math
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
        depth: how much is missing, in the scenario's unit (of joints: rad or that unit): for
            obstacles and arenas the clearance asked for less ``gap``; else how far it is out.
        message: the whole in one sentence.
        gap: signed distance of the two as of `CSpace.clearance`; not a number for 'bounds' and
            'limits'.
    """

    kind: str
    part: str
    body: str
    depth: float
    message: str
    gap: float = math.nan


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
    if not inside.all():
        validity.arena_gaps(scene, placed, rooms)
    clearance = float(scene[layout.CLEARANCE])
    contacts = []
    for i, part in enumerate(robot.parts):
        # Gaps have the margin for rounding off already.
        for j in np.flatnonzero(~(gaps[i] > clearance)):
            name = world.obstacles[j].name
            contacts.append(_obstacle_contact(part.name, name, float(gaps[i, j]), clearance))
        for a in np.flatnonzero(~inside[i]):
            room = float(rooms[i, a])
            contacts.append(_arena_contact(part.name, world.arenas[a].name, room, clearance))
    return contacts


def _obstacle_contact(part: str, body: str, gap: float, clearance: float) -> Contact:
    if gap > 0.0:
        verb, amount = "is closer to", f", {gap:.6g}, than the clearance {clearance:g}"
    else:
        verb, amount = "hits", f" by {-gap:.6g}"
    text = f"part {part!r} {verb} obstacle {body!r}{amount}"
    return Contact("obstacle", part, body, clearance - gap, text, gap)


def _arena_contact(part: str, body: str, gap: float, clearance: float) -> Contact:
    if gap > 0.0:
        verb = "is closer to the boundary of"
        amount = f", {gap:.6g}, than the clearance {clearance:g}"
    else:
        verb, amount = "leaves", f" by {-gap:.6g}"
    text = f"part {part!r} {verb} arena {body!r}{amount}"
    return Contact("arena", part, body, clearance - gap, text, gap)
