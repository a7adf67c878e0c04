"""Where a query may have to squeeze through: poses to centre, and directions to follow."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.fitting import narrowest_directions
from ellipsoid_planning.cspace.poses import rotation_quaternion
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import centring, contact_model, layout, linear, validity
from ellipsoid_planning.roadmap.gates import Gate, GateFinder, probe
from ellipsoid_planning.robots.rigid import RigidRobot

Array = NDArray[np.float64]

_SAMPLES = 15
# Smaller turns between start and goal need no place of their own [rad].
_LEAST_TURN = 0.5
# Obstacles among which the gates of one query are looked for.
_BODIES = 24
# Gates wider than this are no narrow places for a robot that does not turn, in units of its reach.
_WIDEST = 0.25
# Directions along which the robot is narrow that are tried, and turns about a gate's normal.
_FITTING = 3
_SPINS = (0.0, 0.5 * math.pi, 0.25 * math.pi, 0.75 * math.pi)


@dataclass(frozen=True, eq=False)
class Seed:
    """A pose (7,) near a passage and a step (6,) along it (see kernels.contact_model).

    ``centred`` tells whether the pose is to be moved across the passage first, and the passage
    followed both ways.
    """

    pose: Array
    across: Array
    centred: bool = True


def seeds_of_query(
    cspace: CSpace, starts: Array, goals: Array, workspace: centring.Workspace
) -> Iterator[Seed | None]:
    """Seeds for queries from ``starts`` (S, 7) to ``goals`` (G, 7), the likeliest first.

    Now and then None, when looking for the next one took a while.
    """
    for first in starts:
        for last in goals:
            yield from _on_the_way(cspace, first, last)
    for first in starts:
        for last in goals:
            yield from _turning(cspace, first, last)
    for first in starts:
        for last in goals:
            yield from _at_gates(cspace, first, last, workspace)


def _on_the_way(cspace: CSpace, first: Array, last: Array) -> Iterator[Seed]:
    """The middles of the blocked stretches of the direct motion, then its ends."""
    reach = centring.robot_reach(cspace.scene)
    step = np.empty(6)
    contact_model.difference(first, last, reach, step)
    if not cspace.rotates:
        step[3:] = 0.0
    if not step.any():
        return
    poses = np.empty((_SAMPLES, 7))
    contact_model.samples_along(first, step, 1.0 / reach, poses)
    free = np.empty(_SAMPLES, dtype=np.bool_)
    validity.are_free(cspace.scene, poses, free)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], free, [True]]).astype(int)))
    for begin, end in edges.reshape(-1, 2):
        yield Seed(poses[(begin + end - 1) // 2], step)
    yield Seed(first, step, centred=False)
    yield Seed(last, -step, centred=False)


def _turning(cspace: CSpace, first: Array, last: Array) -> Iterator[Seed]:
    """Half-way of the turn from start to goal, either way round, in the middle of each arena.

    Where an arena is hardly larger than the robot, turning is what is narrow.
    """
    reach = centring.robot_reach(cspace.scene)
    step = np.empty(6)
    contact_model.difference(first, last, reach, step)
    turn = float(np.linalg.norm(step[3:])) / reach
    if not cspace.rotates or turn < _LEAST_TURN:
        return
    step[:3] = 0.0
    for arena in cspace.world.arenas:
        for way in (1.0, 1.0 - 2.0 * np.pi / turn):
            pose = np.empty(7)
            contact_model.moved(first, 0.5 * way * step, 1.0 / reach, pose)
            pose[:3] = 0.0
            pose[: cspace.dimension] = arena.centre
            yield Seed(pose, way * step)


def _at_gates(
    cspace: CSpace, first: Array, last: Array, workspace: centring.Workspace
) -> Iterator[Seed | None]:
    """Gates by the length of the way through them, each at one orientation after the other."""
    reach = centring.robot_reach(cspace.scene)
    widest = reach if cspace.rotates else _WIDEST * reach
    finder = GateFinder(cspace, *probe(cspace), widest, workspace)
    later: list[Iterator[Seed]] = []
    for gate in finder.gates(_bodies_near(cspace, first[:3], last[:3]), first[:3], last[:3]):
        yield None
        if gate is not None and _has_room(cspace, gate, first[3:]):
            seeds = _gate_seeds(cspace, gate, first, last)
            yield next(seeds, None)
            later.append(seeds)
    while later:
        seeds = later.pop(0)
        seed = next(seeds, None)
        if seed is not None:
            later.append(seeds)
            yield seed


def _bodies_near(cspace: CSpace, first: Array, last: Array) -> list[int]:
    """The obstacles nearest to the way from first to last, at most _BODIES of them."""
    rows = layout.obstacle_rows(cspace.scene)
    centres = rows[:, :3]
    step = last - first
    square = float(step @ step)
    s = (
        np.clip((centres - first) @ step / square, 0.0, 1.0)
        if square > 0.0
        else np.zeros(len(rows))
    )
    away = np.linalg.norm(centres - first - s[:, None] * step, axis=1) - rows[:, layout.BODY_RADIUS]
    return [int(j) for j in np.argsort(away, kind="stable")[:_BODIES]]


def _has_room(cspace: CSpace, gate: Gate, orientation: Array) -> bool:
    """Whether the point of a gate is free: for the robot, or if it turns, for a point."""
    n = cspace.dimension
    if not cspace.rotates:
        return bool(validity.configuration_is_free(cspace.scene, *gate.point, *orientation))
    point = gate.point[:n]
    inside = gate.gap <= 0.0 or all(arena.contains(point) for arena in cspace.world.arenas)
    return inside and not any(body.contains(point) for body in cspace.world.obstacles)


def _along(gate: Gate, first: Array, last: Array, dimension: int) -> Array:
    """Unit vector (3,) through a gate."""
    if len(gate.normals) == 3:
        products = [np.cross(gate.normals[a], gate.normals[b]) for a, b in ((0, 1), (1, 2), (2, 0))]
        along = max(products, key=np.linalg.norm)
    elif dimension == 2:
        along = np.array([-gate.normals[0, 1], gate.normals[0, 0], 0.0])
    else:
        u, step = gate.normals[0], last[:3] - first[:3]
        along = step - (step @ u) * u
    return along / max(float(np.linalg.norm(along)), 1e-300)


def _gate_seeds(cspace: CSpace, gate: Gate, first: Array, last: Array) -> Iterator[Seed]:
    across = np.zeros(6)
    across[:3] = _along(gate, first, last, cspace.dimension)
    if not across.any():
        return
    if not cspace.rotates:
        yield Seed(np.concatenate([gate.point, first[3:]]), across)
        return
    for quaternion in (first[3:], last[3:], *_fitting_quaternions(cspace, gate.normals[0], across)):
        rotation = np.array(linear.rotation_matrix(*quaternion)).reshape(3, 3)
        base = gate.point - rotation @ _middle(cspace)
        yield Seed(np.concatenate([base, quaternion]), across)


def _fitting_quaternions(cspace: CSpace, normal: Array, across: Array) -> Iterator[Array]:
    """Orientations at which the robot is narrowest along ``normal`` (3,), in space at some spins.

    Of the spins, those come first that point one of the robot's axes along ``across``.
    """
    n = cspace.dimension
    directions = narrowest_directions(cspace.robot)[:_FITTING]
    for spin in _SPINS if n == 3 else (0.0,):
        for v in directions:
            for sign in (1.0, -1.0):
                if n == 2:
                    yaw = math.atan2(normal[1], normal[0]) - math.atan2(sign * v[1], sign * v[0])
                    yield np.array([0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw)])
                else:
                    yield _frame_quaternion(cspace.robot, sign * v, normal, across[:3], spin)


def _frame_quaternion(
    robot: RigidRobot, v: Array, normal: Array, along: Array, spin: float
) -> Array:
    """Quaternion of a rotation that takes v to ``normal`` and the longest axis across v along."""
    axes = np.vstack([part.rotation.T * part.semi_axes[:, None] for part in robot.parts])
    across = axes - np.outer(axes @ v, v)
    first = across[np.argmax(np.linalg.norm(across, axis=1))]
    first = first / np.linalg.norm(first)
    along = along - (along @ normal) * normal
    along = along / np.linalg.norm(along)
    own = np.column_stack([v, first, np.cross(v, first)])
    turned = np.cos(spin) * along + np.sin(spin) * np.cross(normal, along)
    target = np.column_stack([normal, turned, np.cross(normal, turned)])
    return rotation_quaternion(target @ own.T)


def _middle(cspace: CSpace) -> Array:
    """The middle of the robot's box in its base frame (3,)."""
    parts = layout.part_rows(cspace.scene)
    extent = np.linalg.norm(parts[:, 3:12].reshape(-1, 3, 3), axis=2)
    low, high = (parts[:, :3] - extent).min(axis=0), (parts[:, :3] + extent).max(axis=0)
    return np.asarray(0.5 * (low + high))
