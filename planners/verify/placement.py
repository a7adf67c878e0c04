"""Where many configurations put a robot's base, links and parts, in numpy of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC, Joint
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.robots.tree import joints_in_order

Array = NDArray[np.float64]


def placements(robot: Robot, configurations: Array) -> tuple[Array, Array]:
    """Base positions (k, n) and rotations (k, n, n) of configurations (k, d)."""
    n, k = robot.dimension, len(configurations)
    if robot.base_size:
        positions = configurations[:, :n]
    else:
        fixed = getattr(robot, "position", None)
        positions = np.broadcast_to(np.asarray(fixed, dtype=float), (k, n))
    if robot.orientation is not None:
        return positions, np.broadcast_to(robot.orientation, (k, n, n))
    if n == 2:
        return positions, _planar(configurations[:, 2])
    return positions, _spatial(configurations[:, 3:7])


def part_placements(robot: Robot, configurations: Array) -> tuple[Array, Array]:
    """Centres (k, P, n) and matrices A = R diag(a) (k, P, n, n) of all parts in the world."""
    links = {robot.root: placements(robot, configurations)}
    for joint in joints_in_order(robot.joints, robot.root):
        position, rotation = links[joint.parent]
        at = rotation @ joint.rotation
        values = configurations[:, robot.joint_slices.get(joint.name, slice(0, 0))]
        shift, turn = _motion(joint, values)
        links[joint.child] = (
            position + rotation @ joint.position + np.einsum("kij,kj->ki", at, shift),
            at @ turn,
        )
    centres, matrices = [], []
    for part, link in zip(robot.parts, robot.part_links, strict=True):
        position, rotation = links[link]
        centres.append(position + rotation @ part.centre)
        matrices.append(rotation @ part.matrix)
    return np.stack(centres, axis=1), np.stack(matrices, axis=1)


def _motion(joint: Joint, values: Array) -> tuple[Array, Array]:
    """Shifts (k, n) and turns (k, n, n) of a joint's child at the joint's values (k, 0 | 1 | 4)."""
    k, n = len(values), len(joint.position)
    shift, still = np.zeros((k, n)), np.broadcast_to(np.eye(n), (k, n, n))
    if joint.type == FIXED:
        return shift, still
    if joint.type == PRISMATIC:
        return values * np.asarray(joint.axis), still
    if joint.type == BALL:
        return shift, _spatial(values)
    if n == 2:
        return shift, _planar(values[:, 0])
    half = 0.5 * values
    return shift, _spatial(np.hstack([np.sin(half) * np.asarray(joint.axis), np.cos(half)]))


def _planar(angles: Array) -> Array:
    cosine, sine = np.cos(angles), np.sin(angles)
    return np.moveaxis(np.array([[cosine, -sine], [sine, cosine]]), -1, 0)


def _spatial(quaternions: Array) -> Array:
    unit = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
    x, y, z, w = unit.T
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
