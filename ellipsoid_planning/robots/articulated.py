"""Articulated robots: trees of links, each a union of ellipsoids, joined by joints."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError, RobotError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.naming import numbered
from ellipsoid_planning.geometry.orientation import (
    check_rotation,
    rotation_from_quaternion,
    rotation_from_yaw,
)
from ellipsoid_planning.robots.configurations import checked_configuration
from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC, Joint
from ellipsoid_planning.robots.reach import joint_weights, robot_reach
from ellipsoid_planning.robots.tree import check_tree, joints_in_order
from ellipsoid_planning.sizes import check_bodies, check_coordinates

Array = NDArray[np.float64]

FREE_BASE = "free"
TRANSLATING_BASE = "translating"
FIXED_BASE = "fixed"
BASES = (FREE_BASE, TRANSLATING_BASE, FIXED_BASE)


@dataclass(frozen=True, eq=False)
class Link:
    """A rigid part of an articulated robot: ellipsoids in the link's frame, possibly none."""

    name: str
    parts: tuple[Ellipsoid, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", numbered(self.parts, self.name))


@dataclass(frozen=True, eq=False)
class ArticulatedRobot:
    """A tree of links on a base that flies freely, only translates, or is fixed.

    A configuration is a flat array: the base as for `RigidRobot` ([x, y, yaw] or [x, y, z, qx,
    qy, qz, qw]; the position alone for a translating base; nothing for a fixed one), then the
    values of the moving joints in the order of ``joint_names``: one number for a revolute,
    continuous [rad] or prismatic joint, a quaternion (x, y, z, w) for a ball joint. The base is
    the frame of the root link.

    Attributes:
        links: at least one, with at least one part between them.
        joints: a tree over the links.
        base: one of ``BASES``.
        position: (n,), where a fixed base stands; the origin by default.
        orientation: (n, n), base frame to world frame, of a base that does not rotate; the
            identity by default. A free base has none.
        ignored: pairs of link names that are never looked at for self-collision. Links joined
            directly, or that cannot move against each other, need not be listed.

    Raises:
        GeometryError: if the joints make no tree, a name is there twice or unknown, the
            dimensions differ, or there is no part.
    """

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    base: str = FREE_BASE
    position: Array | None = None
    orientation: Array | None = None
    ignored: frozenset[frozenset[str]] = field(default_factory=frozenset)

    def __post_init__(self) -> None:
        object.__setattr__(self, "links", tuple(self.links))
        object.__setattr__(self, "joints", tuple(self.joints))
        object.__setattr__(self, "ignored", _pairs(self.ignored))
        check_tree([link.name for link in self.links], self.joints, self.ignored)
        if not self.parts:
            raise RobotError(
                "expected a robot of at least one part, got none in any of its links; "
                "give a link a body",
                ("links",),
            )
        dimensions = {part.dimension for part in self.parts}
        dimensions |= {len(joint.position) for joint in self.joints}
        if len(dimensions) > 1:
            raise GeometryError(
                f"expected links and joints of one dimension, got {sorted(dimensions)}"
            )
        check_bodies(self.parts, "part")
        if self.base not in BASES:
            raise GeometryError(f"expected a base of {', '.join(BASES)}, got {self.base!r}")
        self._fix_base()

    def _fix_base(self) -> None:
        if self.base == FREE_BASE and self.orientation is not None:
            raise GeometryError("a free base has no fixed orientation; make it translating")
        if self.base != FIXED_BASE and self.position is not None:
            raise GeometryError("only a fixed base has a position of its own")
        if self.base == FIXED_BASE and not self.moving_joints:
            held = [joint.notice for joint in self.joints if joint.notice]
            got = f"got none ({'; '.join(held)})" if held else "got none"
            raise RobotError(
                f"a robot on a fixed base needs a joint that moves, {got}; add one, or let "
                "the base move",
                ("base",),
            )
        if self.base != FREE_BASE:
            given = np.eye(self.dimension) if self.orientation is None else self.orientation
            self._keep("orientation", check_rotation(given, self.dimension))
        if self.base == FIXED_BASE:
            at = np.zeros(self.dimension) if self.position is None else np.array(self.position)
            if at.shape != (self.dimension,) or not np.all(np.isfinite(at)):
                raise GeometryError(f"expected a position of {self.dimension} numbers, got {at}")
            check_coordinates(at, "position")
            self._keep("position", at.astype(float))

    def _keep(self, name: str, value: Array) -> None:
        value.setflags(write=False)
        object.__setattr__(self, name, value)

    @property
    def dimension(self) -> int:
        """The dimension n of the robot's world, 2 or 3."""
        return self.parts[0].dimension

    @property
    def rotates(self) -> bool:
        """Whether the base turns."""
        return self.base == FREE_BASE

    @cached_property
    def parts(self) -> tuple[Ellipsoid, ...]:
        """The parts of all links, in the order of the links, each in its own link's frame."""
        return tuple(part for link in self.links for part in link.parts)

    @cached_property
    def part_links(self) -> tuple[str, ...]:
        """The name of each part's link, in the order of ``parts``."""
        return tuple(link.name for link in self.links for _ in link.parts)

    @cached_property
    def moving_joints(self) -> tuple[Joint, ...]:
        """The joints that are not fixed, in the order given, which is that of configurations."""
        return tuple(joint for joint in self.joints if joint.type != FIXED)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the moving joints, in the order of configurations."""
        return tuple(joint.name for joint in self.moving_joints)

    @cached_property
    def root(self) -> str:
        """Name of the link that no joint moves: the base."""
        children = {joint.child for joint in self.joints}
        return next(link.name for link in self.links if link.name not in children)

    @property
    def base_size(self) -> int:
        """How many numbers of a configuration place the base."""
        if self.base == FIXED_BASE:
            return 0
        if self.base == TRANSLATING_BASE:
            return self.dimension
        return 3 if self.dimension == 2 else 7

    @property
    def configuration_size(self) -> int:
        """The length d of a configuration."""
        return self.base_size + sum(joint.value_count for joint in self.moving_joints)

    @cached_property
    def joint_slices(self) -> dict[str, slice]:
        """Where the values of each moving joint stand in a configuration, by name."""
        slices, first = {}, self.base_size
        for joint in self.moving_joints:
            slices[joint.name] = slice(first, first + joint.value_count)
            first += joint.value_count
        return slices

    @cached_property
    def joint_weights(self) -> Array:
        """(J,), what each moving joint counts in the metric, see robots.reach; read-only."""
        weights = joint_weights(self)
        weights.setflags(write=False)
        return weights

    @cached_property
    def reach(self) -> float:
        """How far points of the robot can get from its base, at most."""
        return robot_reach(self)

    def pose(self, configuration: ArrayLike) -> tuple[Array, Array]:
        """Return the base position (n,) and rotation (n, n), base to world, of a configuration.

        A quaternion of any positive length is taken for the rotation it points at.

        Raises:
            GeometryError: if the configuration has another size or is not finite.
        """
        values = self._checked(configuration)
        n = self.dimension
        if self.base == FIXED_BASE:
            return np.asarray(self.position), np.asarray(self.orientation)
        if self.base == TRANSLATING_BASE:
            return values[:n], np.asarray(self.orientation)
        if n == 2:
            return values[:2], rotation_from_yaw(float(values[2]))
        return values[:3], rotation_from_quaternion(values[3:7])

    def _checked(self, configuration: ArrayLike) -> Array:
        return checked_configuration(configuration, self.configuration_size)

    def link_poses(self, configuration: ArrayLike) -> dict[str, tuple[Array, Array]]:
        """Position (n,) and rotation (n, n) of every link's frame in the world, by name.

        Raises:
            GeometryError: if the configuration has another size or is not finite.
        """
        values = self._checked(configuration)
        poses = {self.root: self.pose(values)}
        for joint in joints_in_order(self.joints, self.root):
            position, rotation = poses[joint.parent]
            own = values[self.joint_slices[joint.name]] if joint.type != FIXED else values[:0]
            shift, turn = _motion(joint, own)
            at = rotation @ joint.rotation
            poses[joint.child] = (position + rotation @ joint.position + at @ shift, at @ turn)
        return poses

    def bodies_at(self, configuration: ArrayLike) -> tuple[Ellipsoid, ...]:
        """Return the parts in the world frame at a configuration (d,), in order of ``parts``."""
        poses = self.link_poses(configuration)
        bodies = []
        for part, link in zip(self.parts, self.part_links, strict=True):
            position, rotation = poses[link]
            bodies.append(part.transform(rotation, position))
        return tuple(bodies)


def check_articulated(robot: Any) -> None:
    """Refuse what is not an articulated robot, a rigid one above all.

    Raises:
        GeometryError: if it is none.
    """
    if not isinstance(robot, ArticulatedRobot):
        raise GeometryError(
            f"expected an ArticulatedRobot, got {type(robot).__name__}; CSpace(world, robot) is "
            "the C-space of every robot"
        )


def _motion(joint: Joint, values: Array) -> tuple[Array, Array]:
    """Shift (n,) and turn (n, n) of the child's frame against the joint's frame."""
    n = len(joint.position)
    if joint.type == FIXED:
        return np.zeros(n), np.eye(n)
    if joint.type == PRISMATIC:
        return values[0] * np.asarray(joint.axis), np.eye(n)
    if joint.type == BALL:
        return np.zeros(n), rotation_from_quaternion(values)
    if n == 2:
        return np.zeros(n), rotation_from_yaw(float(values[0]))
    half = 0.5 * float(values[0])
    quaternion = np.append(np.sin(half) * np.asarray(joint.axis), np.cos(half))
    return np.zeros(n), rotation_from_quaternion(quaternion)


def _pairs(pairs: Iterable[Iterable[str]]) -> frozenset[frozenset[str]]:
    return frozenset(frozenset(pair) for pair in pairs)
