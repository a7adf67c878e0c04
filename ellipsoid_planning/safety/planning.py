"""From a C-space to the tables that its robot's bodies need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.articulated_packing import bodies_of, pack_kinematics
from ellipsoid_planning.geometry.rows import body_rows
from ellipsoid_planning.kernels import kinematics as joints
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.articulated import (
    FREE_BASE,
    TRANSLATING_BASE,
    ArticulatedRobot,
    Link,
)
from ellipsoid_planning.robots.reach import robot_reach
from ellipsoid_planning.safety.resolution import TableParameters, resolution_of
from ellipsoid_planning.safety.shapes import PlacedShape, Shape, shape_of
from ellipsoid_planning.safety.table import TablePlan

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RobotPlan:
    """The tables of a robot.

    Attributes:
        kinematics: the robot as kernels.kinematics has it; a rigid one is a single body.
        members: for each body the numbers of its parts.
        shapes: for each body its shape and where that stands; None for one without parts.
        tables: the distinct ones.
        table_of: for each body the index of its table, or −1.
    """

    kinematics: Array
    members: tuple[NDArray[np.int64], ...]
    shapes: tuple[PlacedShape | None, ...]
    tables: tuple[TablePlan, ...]
    table_of: tuple[int, ...]


def as_articulated(cspace: CSpace) -> ArticulatedRobot:
    """The robot of a C-space; a rigid one as a robot of a single link."""
    if isinstance(cspace, ArticulatedCSpace):
        return cspace.articulated
    robot = cspace.robot
    base = FREE_BASE if robot.rotates else TRANSLATING_BASE
    return ArticulatedRobot((Link("robot", robot.parts),), (), base, None, robot.orientation)


def plan_tables(cspace: CSpace, parameters: TableParameters) -> RobotPlan:
    """Which tables the robot of ``cspace`` needs.

    Raises:
        TableError: see resolution_of.
    """
    robot = as_articulated(cspace)
    bodies = bodies_of(robot)
    kinematics = pack_kinematics(robot, bodies)
    owners = bodies.owners.astype(np.int64)
    members = tuple(np.flatnonzero(owners == b) for b in range(len(bodies.joints) + 1))
    neutral = _neutral_rotations(robot, kinematics)
    turns = _turning(robot, bodies.joints)
    shapes = [
        _placed_shape(bodies.parts[own], robot.dimension, *frame) if len(own) else None
        for own, frame in zip(members, zip(neutral, turns, strict=True), strict=True)
    ]
    distinct: list[Shape] = []
    table_of = [_table_index(distinct, placed) for placed in shapes]
    tables = tuple(_table_plan(cspace, robot, shape, parameters) for shape in distinct)
    return RobotPlan(kinematics, members, tuple(shapes), tables, tuple(table_of))


def _neutral_rotations(robot: ArticulatedRobot, kinematics: Array) -> Array:
    """Rotations (bodies, 3, 3) of the bodies' frames with all joints at 0."""
    row = np.zeros(int(kinematics[joints.WIDTH]))
    row[6] = 1.0
    for joint in joints.joint_rows(kinematics):
        if joint[joints.JOINT_KIND] == joints.BALL:
            row[int(joint[joints.JOINT_VALUE]) + 3] = 1.0
    frames = joints.new_frames(kinematics)
    joints.body_frames(kinematics, row, frames)
    rotations = frames[:, : joints.FRAME_TRANSLATION].reshape(-1, 3, 3).copy()
    if robot.orientation is not None:
        fixed = np.eye(3)
        fixed[: robot.dimension, : robot.dimension] = robot.orientation
        rotations = fixed @ rotations
    return rotations


def _turning(robot: ArticulatedRobot, rows: Array) -> list[bool]:
    """Whether the orientation of each body can change."""
    turns = [robot.rotates]
    for joint in rows:
        slides = int(joint[joints.JOINT_KIND]) == joints.PRISMATIC
        turns.append(turns[int(joint[joints.JOINT_PARENT])] or not slides)
    return turns


def _placed_shape(parts: Array, dimension: int, neutral: Array, turns: bool) -> PlacedShape:
    rows = parts.copy()
    centre, matrix = layout.PART_CENTRE, layout.PART_MATRIX
    rows[:, centre : centre + 3] = parts[:, centre : centre + 3] @ neutral.T
    turned = neutral @ parts[:, matrix : matrix + 9].reshape(-1, 3, 3)
    if dimension == 2:
        turned[:, 2], turned[:, :, 2] = 0.0, 0.0  # what rounding has left there
    rows[:, matrix : matrix + 9] = turned.reshape(-1, 9)
    found = shape_of(rows, dimension == 2, turns)
    return PlacedShape(found.shape, neutral.T @ found.middle, neutral.T @ found.turn)


def _table_index(distinct: list[Shape], placed: PlacedShape | None) -> int:
    if placed is None:
        return -1
    for index, shape in enumerate(distinct):
        if shape.is_same(placed.shape):
            return index
    distinct.append(placed.shape)
    return len(distinct) - 1


def _table_plan(
    cspace: CSpace, robot: ArticulatedRobot, shape: Shape, parameters: TableParameters
) -> TablePlan:
    safe_low, safe_high = _safe_box(cspace, shape)
    low, high = _places(cspace, robot, shape)
    low, high = np.maximum(low, safe_low), np.minimum(high, safe_high)
    n, resolution = cspace.dimension, None
    if np.all(low[:n] < high[:n]):
        low[n:], high[n:] = -1.0, 1.0
        resolution = resolution_of(shape, low, high, n, parameters)
    required, scale = cspace.clearance_required, float(cspace.scene[layout.SCALE])
    return TablePlan(cspace.world, shape, required, scale, safe_low, safe_high, resolution)


def _room(cspace: CSpace, shape: Shape) -> float:
    """How far obstacles and a link's middle must be apart, box from point, to be safe."""
    rounding = 4.0 * layout.TOLERANCE * float(cspace.scene[layout.SCALE])
    return shape.radius + shape.slack + cspace.clearance_required + rounding


def _safe_box(cspace: CSpace, shape: Shape) -> tuple[Array, Array]:
    """A box (3,), (3,) such that the link is safe if its middle is outside of it."""
    if cspace.world.arenas:
        return np.full(3, -np.inf), np.full(3, np.inf)
    if not cspace.world.obstacles:
        return np.full(3, np.inf), np.full(3, -np.inf)
    low, high = _box(cspace, body_rows(cspace.world.obstacles))
    room = _room(cspace, shape)
    return low - room, high + room


def _box(cspace: CSpace, rows: Array) -> tuple[Array, Array]:
    """The box (3,), (3,) around obstacles or arenas; planar ones are endless along z."""
    centres = rows[:, layout.BODY_CENTRE : layout.BODY_CENTRE + 3]
    extents = rows[:, layout.BODY_EXTENT : layout.BODY_EXTENT + 3]
    low, high = (centres - extents).min(axis=0), (centres + extents).max(axis=0)
    low[cspace.dimension :], high[cspace.dimension :] = -np.inf, np.inf
    return low, high


def _places(cspace: CSpace, robot: ArticulatedRobot, shape: Shape) -> tuple[Array, Array]:
    """A box (3,), (3,) where the middle of a link mostly is.

    What is outside goes to the exact test, so that nothing rests on this box.
    """
    n, world = cspace.dimension, cspace.world
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    reach = robot_reach(robot)
    if robot.position is not None:
        low[:n], high[:n] = robot.position - reach, robot.position + reach
    else:
        # Links that are far from a base that moves are mostly where nothing is, or within a wall.
        room = min(shape.radius, reach)
        low[:n], high[:n] = world.low - room, world.high + room
    for arena in body_rows(world.arenas):
        inner = _box(cspace, arena[None])
        low, high = np.maximum(low, inner[0]), np.minimum(high, inner[1])
    return low, high
