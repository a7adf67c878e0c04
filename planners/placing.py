"""Where configurations put a robot's parts, in plain numpy: what a conventional checker would do.

One configuration at a time, in space: planar robots lie in z = 0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC, Joint
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.robots.tree import joints_in_order

Array = NDArray[np.float64]


def homogeneous(position: Array, rotation: Array) -> Array:
    """The transform (4, 4) of a position (n,) and a rotation (n, n)."""
    transform = np.eye(4)
    n = len(position)
    transform[:n, :n], transform[:n, 3] = rotation, position
    return transform


def about_z(yaw: float) -> Array:
    """The rotation (3, 3) by ``yaw`` about the z axis."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def from_quaternion(quaternion: Array) -> Array:
    """The rotation (3, 3) of a unit quaternion (x, y, z, w)."""
    x, y, z, w = quaternion.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


class BasePose:
    """The base of a robot in space."""

    def __init__(self, robot: Robot) -> None:
        """Keep what does not vary."""
        self._dimension, self._rotates = robot.dimension, robot.rotates
        fixed = isinstance(robot, ArticulatedRobot) and robot.base == FIXED_BASE
        self._moves = not fixed
        n = robot.dimension
        position = np.zeros(n) if robot.base_size else np.asarray(robot.pose(_zero(robot))[0])
        rotation = np.eye(n) if robot.orientation is None else robot.orientation
        self._still = homogeneous(position, rotation)

    def write(self, configuration: Array, out: Array) -> None:
        """Write the base's transform to ``out`` (4, 4)."""
        out[:] = self._still
        n = self._dimension
        if self._moves:
            out[:n, 3] = configuration[:n]
        if self._rotates:
            turned = about_z(configuration[2]) if n == 2 else from_quaternion(configuration[3:7])
            out[:3, :3] = turned


def _zero(robot: Robot) -> Array:
    values = np.zeros(robot.configuration_size)
    values[[place.stop - 1 for place in robot.joint_slices.values()]] = 1.0
    return values


class LinkFrames:
    """Forward kinematics: the frames of the base and of what each moving joint carries.

    All joints' own transforms are computed together, each a fixed combination of 1, sin and
    1 - cos of its value (Rodrigues), of 1 and the value (prismatic), or of products of the
    quaternion's entries (ball). Then they are multiplied along the tree, into arrays made once.

    Attributes:
        world: (1 + J, 4, 4), the frames after `place`; the base's is the first.
        carriers: by link, the number of its frame and its transform (4, 4) in it.
    """

    def __init__(self, robot: ArticulatedRobot) -> None:
        """Lay out the joints of ``robot``."""
        self._base = BasePose(robot)
        self.carriers: dict[str, tuple[int, Array]] = {robot.root: (0, np.eye(4))}
        moving: list[Joint] = []
        parents, origins = [], []
        for joint in joints_in_order(robot.joints, robot.root):
            frame, inside = self.carriers[joint.parent]
            origin = inside @ homogeneous(joint.position, joint.rotation)
            if joint.type == FIXED:
                self.carriers[joint.child] = frame, origin
                continue
            moving.append(joint)
            parents.append(frame)
            origins.append(origin)
            self.carriers[joint.child] = len(moving), np.eye(4)
        self._lay_out(robot, moving, origins)
        self.world = np.empty((1 + len(moving), 4, 4))
        # Views made once: a product then costs one call.
        self._products = [
            (self.world[parent], self._locals[k], self.world[k + 1])
            for k, parent in enumerate(parents)
        ]

    def _lay_out(self, robot: ArticulatedRobot, moving: list[Joint], origins: list[Array]) -> None:
        slices = [robot.joint_slices[joint.name] for joint in moving]
        self._places = np.array([place.start for place in slices], dtype=np.intp)
        self._sliding = np.array([joint.type == PRISMATIC for joint in moving], dtype=bool)
        self._any_sliding = bool(self._sliding.any())
        self._features = np.ones((len(moving), 1, 3))
        tables = [_table(joint, origin) for joint, origin in zip(moving, origins, strict=True)]
        self._tables = np.array(tables).reshape(len(moving), 3, 16)
        self._flat = np.empty((len(moving), 1, 16))
        self._locals = self._flat.reshape(len(moving), 4, 4)
        balls = [k for k, joint in enumerate(moving) if joint.type == BALL]
        self._balls = np.array(balls, dtype=np.intp)
        self._quaternions = self._places[self._balls, None] + np.arange(4)
        self._products_of = np.array([_ball_table(origins[k]) for k in balls])

    def place(self, configuration: Array) -> None:
        """Compute ``world`` at a configuration (d,)."""
        self._base.write(configuration, self.world[0])
        values = configuration.take(self._places)
        features = self._features[:, 0]
        np.sin(values, out=features[:, 1])
        np.subtract(1.0, np.cos(values), out=features[:, 2])
        if self._any_sliding:
            features[self._sliding, 1] = values[self._sliding]
        np.matmul(self._features, self._tables, self._flat)
        if len(self._balls):
            q = configuration.take(self._quaternions)
            pairs = (q[:, :, None] * q[:, None, :]).reshape(-1, 1, 16)
            self._flat[self._balls] = pairs @ self._products_of
        for parent, own, frame in self._products:
            np.dot(parent, own, frame)


def _table(joint: Joint, origin: Array) -> Array:
    """The transforms (3, 4, 4) that 1, sin and 1 - cos (or 1 and the value) multiply."""
    table = np.zeros((3, 4, 4))
    table[0] = origin
    if joint.type == PRISMATIC:
        axis = np.asarray(joint.axis)
        table[1, :3, 3] = origin[:3, : len(axis)] @ axis
    elif joint.type != BALL:
        x, y, z = (0.0, 0.0, 1.0) if joint.axis is None else joint.axis
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        table[1, :3, :3] = origin[:3, :3] @ cross
        table[2, :3, :3] = origin[:3, :3] @ cross @ cross
    return table


def _ball_table(origin: Array) -> Array:
    """What makes of the products (16,) of a unit quaternion's entries the transform (16,)."""
    table = np.zeros((4, 4, 4, 4))  # row, column, and the two entries (x, y, z, w)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        table[i, i, [i, j, k, 3], [i, j, k, 3]] = 1.0, -1.0, -1.0, 1.0
        table[i, j, [i, k], [j, 3]] = 2.0, -2.0
        table[j, i, [i, k], [j, 3]] = 2.0, 2.0
    table[3, 3, range(4), range(4)] = 1.0
    return np.einsum("am,mnij->ijan", origin, table).reshape(16, 16)


class PartPlaces:
    """The parts of a robot, rigid or articulated, wherever a configuration puts them."""

    def __init__(self, robot: Robot) -> None:
        """Take the parts of ``robot``."""
        self._frames = LinkFrames(robot) if isinstance(robot, ArticulatedRobot) else None
        self._base = BasePose(robot)
        self._world = np.empty((1, 4, 4))
        own = [homogeneous(part.centre, part.rotation) for part in robot.parts]
        if self._frames is None:
            self._owners = np.zeros(len(own), dtype=np.intp)
        else:
            carriers = [self._frames.carriers[link] for link in robot.part_links]
            self._owners = np.array([number for number, _ in carriers], dtype=np.intp)
            own = [inside @ place for (_, inside), place in zip(carriers, own, strict=True)]
        self._own = np.array(own)

    def __call__(self, configuration: Array) -> tuple[Array, Array]:
        """Rotations (P, 3, 3) and centres (P, 3) of all parts at a configuration (d,)."""
        if self._frames is None:
            self._base.write(configuration, self._world[0])
            placed = self._world @ self._own
        else:
            self._frames.place(configuration)
            placed = self._frames.world.take(self._owners, axis=0) @ self._own
        return placed[:, :3, :3], placed[:, :3, 3]
