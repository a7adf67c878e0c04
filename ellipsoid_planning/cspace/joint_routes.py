"""The joints between two links of an articulated robot, as coordinates of boxes of joint values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import joint_boxes as boxes
from ellipsoid_planning.kernels import kinematics as tables
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC, Joint
from ellipsoid_planning.robots.tree import joints_in_order

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Route:
    """The way from one body of a robot to another.

    Attributes:
        joints: the moving joints on it, from the first body to the second.
        rows: (k,), their numbers in the kinematics, parents before children.
        top: the body that all of them hang on.
        coordinates: (D, COORDINATE), see kernels.joint_boxes, from the first body to the second.
    """

    joints: tuple[Joint, ...]
    rows: Indices
    top: int
    coordinates: Array

    def values(self, point: Array) -> dict[str, float | tuple[float, ...]]:
        """Values of the joints by name at a point (D,): a number, or a quaternion (x, y, z, w)."""
        values: dict[str, float | tuple[float, ...]] = {}
        at = 0
        for joint in self.joints:
            if joint.type == BALL:
                down = self.coordinates[at, boxes.COORDINATE_ROLE] == boxes.ALPHA
                angles = point[at : at + 3] if down else point[at : at + 3][::-1]
                values[joint.name] = _quaternion(*map(float, angles))
                at += 3
            else:
                values[joint.name] = float(point[at])
                at += 1
        return values


def _quaternion(alpha: float, beta: float, gamma: float) -> tuple[float, ...]:
    """The quaternion (x, y, z, w) of Rz(α) Rx(β) Rz(γ)."""
    c, s = math.cos(0.5 * beta), math.sin(0.5 * beta)
    less, more = 0.5 * (alpha - gamma), 0.5 * (alpha + gamma)
    return s * math.cos(less), s * math.sin(less), c * math.sin(more), c * math.cos(more)


def packed_joints(robot: ArticulatedRobot) -> list[Joint]:
    """The moving joints in the order of the kinematics: joint j moves body j + 1."""
    return [j for j in joints_in_order(robot.joints, robot.root) if j.type != FIXED]


def route_between(kinematics: Array, joints: list[Joint], first: int, second: int) -> Route:
    """The route from body ``first`` to body ``second``; ``joints`` are :func:`packed_joints`."""
    parents = tables.joint_rows(kinematics)[:, tables.JOINT_PARENT].astype(int)
    up, down = _ancestors(parents, first), _ancestors(parents, second)
    top = next(body for body in up if body in down)
    rising = [body - 1 for body in up[: up.index(top)]]
    falling = [body - 1 for body in reversed(down[: down.index(top)])]
    rows = [row for j in rising for row in reversed(_coordinates(joints[j], j))]
    rows += [row for j in falling for row in _coordinates(joints[j], j)]
    order = [*rising, *falling]
    return Route(
        tuple(joints[j] for j in order),
        np.array(sorted(order), dtype=np.int64),
        top,
        np.array(rows, dtype=float).reshape(-1, boxes.COORDINATE),
    )


def _ancestors(parents: NDArray[np.int64], body: int) -> list[int]:
    chain = [body]
    while chain[-1] > 0:
        chain.append(int(parents[chain[-1] - 1]))
    return chain


def _coordinates(joint: Joint, row: int) -> list[tuple[float, ...]]:
    if joint.type == BALL:
        return [
            (row, boxes.ALPHA, -math.pi, math.pi),
            (row, boxes.BETA, 0.0, math.pi),
            (row, boxes.GAMMA, -math.pi, math.pi),
        ]
    role = boxes.SLIDE if joint.type == PRISMATIC else boxes.TURN
    return [(row, role, joint.lower, joint.upper)]


def restricted(route: Route, ranges: Mapping[str, tuple[float, float]]) -> Array:
    """The coordinates of ``route`` with other limits of some single-valued joints, by name."""
    coordinates = route.coordinates.copy()
    at = 0
    for joint in route.joints:
        if joint.name in ranges:
            coordinates[at, boxes.COORDINATE_LOW : boxes.COORDINATE_HIGH + 1] = ranges[joint.name]
        at += 3 if joint.type == BALL else 1
    return coordinates
