"""Where a query may have to squeeze through: poses to centre, and directions to follow."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.fitting import narrowest_directions
from ellipsoid_planning.cspace.poses import rotation_quaternion
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.rows import placed_row
from ellipsoid_planning.kernels import centring, contact_model, layout, linear, validity
from ellipsoid_planning.kernels.robot_model import poses_are_free, step_count
from ellipsoid_planning.roadmap.gates import Gate, GateFinder, only_translates, probe
from ellipsoid_planning.roadmap.joint_layers import has_fixed_base, middle_of_joints
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
    """A pose (7 + V,) near a passage and a step along it (see kernels.contact_model).

    ``centred`` tells whether the pose is to be moved across the passage first, and the passage
    followed both ways.
    """

    pose: Array
    across: Array
    centred: bool = True


def seeds_of_query(
    cspace: CSpace, starts: Array, goals: Array, pairs: NDArray[np.int64]
) -> Iterator[Seed | None]:
    """Seeds for queries from ``starts`` (S, 7 + V) to ``goals`` (G, 7 + V), the likeliest first.

    Now and then None, when looking for the next one took a while. ``pairs`` (1,) counts the pairs
    of bodies that were looked at.
    """
    workspace = centring.new_workspace(cspace.scene)._replace(pairs=pairs)
    for first in starts:
        for last in goals:
            yield from _on_the_way(cspace, first, last)
    for first in starts:
        for last in goals:
            yield from _turning(cspace, first, last)
    for first in starts:
        for last in goals:
            yield from _at_gates(cspace, first, last, workspace)


def _step(cspace: CSpace, first: Array, last: Array) -> Array:
    """The step from one pose to another (see kernels.contact_model)."""
    model = cspace.model
    step = np.zeros(step_count(model))
    contact_model.difference(model, first, last, cspace.reach, step)
    if not cspace.rotates:
        step[3:6] = 0.0
    return step


def _on_the_way(cspace: CSpace, first: Array, last: Array) -> Iterator[Seed]:
    """The middles of the blocked stretches of the direct motion, then its ends."""
    model, step = cspace.model, _step(cspace, first, last)
    if not step.any():
        return
    poses = np.repeat(first[None], _SAMPLES, axis=0)
    contact_model.samples_along(model, first, step, 1.0 / cspace.reach, poses)
    free = np.empty(_SAMPLES, dtype=np.bool_)
    poses_are_free(model, poses, free)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], free, [True]]).astype(int)))
    for begin, end in edges.reshape(-1, 2):
        yield Seed(poses[(begin + end - 1) // 2], step)
    yield Seed(first, step, centred=False)
    yield Seed(last, -step, centred=False)


def _turning(cspace: CSpace, first: Array, last: Array) -> Iterator[Seed]:
    """Half-way of the turn from start to goal, either way round, in the middle of each arena.

    Where an arena is hardly larger than the robot, turning is what is narrow.
    """
    step = _step(cspace, first, last)
    turn = float(np.linalg.norm(step[3:6])) / cspace.reach
    if not cspace.rotates or turn < _LEAST_TURN:
        return
    step[:3] = 0.0
    for arena in cspace.world.arenas:
        for way in (1.0, 1.0 - 2.0 * np.pi / turn):
            pose, course = first.copy(), step.copy()
            course[3:6] *= way
            contact_model.moved(cspace.model, first, 0.5 * course, 1.0 / cspace.reach, pose)
            pose[:3] = 0.0
            pose[: cspace.dimension] = arena.centre
            yield Seed(pose, course)


def _at_gates(
    cspace: CSpace, first: Array, last: Array, workspace: centring.Workspace
) -> Iterator[Seed | None]:
    """Gates by the length of the way through them, each at one orientation after the other."""
    if has_fixed_base(cspace):
        return
    widest = _WIDEST * cspace.reach if only_translates(cspace) else cspace.reach
    finder = GateFinder(cspace, *probe(cspace), widest, workspace)
    shapes = [(joints, _frozen(cspace, joints)) for joints in _shapes(cspace, first, last)]
    later: list[Iterator[Seed]] = []
    for gate in finder.gates(_bodies_near(cspace, first[:3], last[:3]), first[:3], last[:3]):
        yield None
        if gate is not None and _has_room(cspace, gate, first[3:]):
            seeds = _gate_seeds(cspace, gate, first, last, shapes)
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
    if only_translates(cspace):
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


def _gate_seeds(
    cspace: CSpace, gate: Gate, first: Array, last: Array, shapes: list[tuple[Array, RigidRobot]]
) -> Iterator[Seed]:
    across = np.zeros(step_count(cspace.model))
    across[:3] = _along(gate, first, last, cspace.dimension)
    if not across.any():
        return
    if only_translates(cspace):
        yield Seed(np.concatenate([gate.point, first[3:]]), across)
        return
    for joints, robot in shapes:
        quaternions = [first[3:7], last[3:7]]
        if cspace.rotates:
            quaternions += _fitting_quaternions(robot, gate.normals[0], across)
        for quaternion in quaternions:
            rotation = np.array(linear.rotation_matrix(*quaternion)).reshape(3, 3)
            base = gate.point - rotation @ _middle(robot)
            yield Seed(np.concatenate([base, quaternion, joints]), across)


def _shapes(cspace: CSpace, first: Array, last: Array) -> list[Array]:
    """Joint values (V,) that the robot is tried at in a gate: those of the ends, and the middle."""
    if not isinstance(cspace, ArticulatedCSpace):
        return [first[7:]]
    shapes = [middle_of_joints(cspace.articulated), first[7:], last[7:]]
    return [row for k, row in enumerate(shapes) if not any((row == o).all() for o in shapes[:k])]


def _frozen(cspace: CSpace, joints: Array) -> RigidRobot:
    """The robot with its joints held at values (V,), as a rigid one in the base's frame."""
    if not isinstance(cspace, ArticulatedCSpace):
        return cspace.robot
    row = np.concatenate([np.zeros(6), [1.0], joints])
    robot = cspace.articulated
    at_home = cspace.configurations(row[None])[0]
    position, rotation = robot.pose(at_home)
    home = (part.transform(rotation.T, -rotation.T @ position) for part in robot.bodies_at(at_home))
    return RigidRobot(tuple(home))


def _fitting_quaternions(robot: RigidRobot, normal: Array, across: Array) -> Iterator[Array]:
    """Orientations at which the robot is narrowest along ``normal`` (3,), in space at some spins.

    Of the spins, those come first that point one of the robot's axes along ``across``.
    """
    n = robot.dimension
    directions = narrowest_directions(robot)[:_FITTING]
    for spin in _SPINS if n == 3 else (0.0,):
        for v in directions:
            for sign in (1.0, -1.0):
                if n == 2:
                    yaw = math.atan2(normal[1], normal[0]) - math.atan2(sign * v[1], sign * v[0])
                    yield np.array([0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw)])
                else:
                    yield _frame_quaternion(robot, sign * v, normal, across[:3], spin)


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


def _middle(robot: RigidRobot) -> Array:
    """The middle of the robot's box in its base frame (3,)."""
    rows = np.array([placed_row(part) for part in robot.parts])
    low, high = (rows[:, :3] - rows[:, 12:]).min(axis=0), (rows[:, :3] + rows[:, 12:]).max(axis=0)
    return np.asarray(0.5 * (low + high))
