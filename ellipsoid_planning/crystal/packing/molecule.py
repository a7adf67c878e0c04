"""Molecules: articulated unions of ellipsoids whose every degree of freedom is a coordinate.

Order of coordinates: the base's shifts along the cell's axes (those that are free), its turns
(Euler angles, or one heading in the plane), then the joints.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import molecule as kernels
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC, Joint

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

WORLD = -1
AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
EULER_NAMES = ("alpha", "beta", "gamma")


@dataclass(frozen=True)
class Coordinate:
    """One degree of freedom: a turn [rad] or a shift [the cell's unit of length].

    Attributes:
        name: of the joint, or x, y, z, alpha, beta, gamma, yaw for the base.
        turns: whether it is an angle.
    """

    name: str
    turns: bool

    @property
    def key(self) -> str:
        """Its key in files: the name, with ``_deg`` for an angle, which files give in degrees."""
        return f"{self.name}_deg" if self.turns else self.name


@dataclass(frozen=True, eq=False)
class Molecule:
    """A molecule and how its coordinates move it (see kernels.molecule for the arrays).

    Attributes:
        robot: its links, joints and pairs of links that may meet.
        coordinates: K of them, the base's first.
        base_count: how many of them place the base.
        densities: (P,), electrons (or any weight) per volume of each part, in the links' order.
        kinds, parents: (K,) int64, and the poses ``origins`` (K, 12) and ``axes`` (K, 3).
        part_frames: (P,) int64, the coordinate that carries each part, -1 for none.
        parts: (P, 12), centre and A of each part in that coordinate's frame.
    """

    robot: ArticulatedRobot
    coordinates: tuple[Coordinate, ...]
    base_count: int
    densities: Array
    kinds: Integers
    parents: Integers
    origins: Array
    axes: Array
    part_frames: Integers
    parts: Array = field(repr=False)

    @property
    def dimension(self) -> int:
        """The dimension n, 2 or 3."""
        return self.robot.dimension

    @cached_property
    def part_volumes(self) -> Array:
        """(P,), the parts' volumes, areas in the plane; read-only."""
        ball = math.pi if self.dimension == 2 else 4.0 * math.pi / 3.0
        return _frozen(ball * np.array([np.prod(part.semi_axes) for part in self.robot.parts]))

    @property
    def volume(self) -> float:
        """The sum of the parts' volumes (areas in the plane); overlaps count twice."""
        return float(self.part_volumes.sum())

    def placed(self, configuration: ArrayLike) -> tuple[Array, Array]:
        """Centres (P, 3) and matrices A (P, 3, 3) of all parts in the world.

        Args:
            configuration: (K,), angles [rad].

        Raises:
            CrystalError: if the size is another, or a value is not finite.
        """
        frames = self.frames(configuration)
        posed = np.empty((len(self.parts), kernels.POSED))
        kernels.pose_parts(frames, self.part_frames, self.parts, posed)
        return posed[:, :3].copy(), posed[:, 3:].reshape(-1, 3, 3).copy()

    def frames(self, configuration: ArrayLike) -> Array:
        """Frames (K, 12) of the coordinates in the world: rotation row-major, position."""
        values = np.array(configuration, dtype=float)
        if values.shape != (len(self.coordinates),) or not np.all(np.isfinite(values)):
            raise CrystalError(
                f"expected a configuration of {len(self.coordinates)} finite numbers "
                f"({', '.join(c.name for c in self.coordinates)}), got {values.tolist()}"
            )
        frames = np.empty((len(self.coordinates), kernels.FRAME))
        arrays = (self.kinds, self.parents, self.origins, self.axes)
        kernels.place_frames(*arrays, values, frames)
        return frames

    def bodies(self, configuration: ArrayLike) -> tuple[Ellipsoid, ...]:
        """All parts in the world, as ellipsoids of the molecule's dimension."""
        frames, n = self.frames(configuration), self.dimension
        placed = []
        for part, local, frame in zip(self.robot.parts, self._poses, self.part_frames, strict=True):
            rotation, position = local
            if frame != WORLD:
                outer = frames[frame, :9].reshape(3, 3)
                position = outer @ position + frames[frame, 9:]
                rotation = outer @ rotation
            placed.append(part.transform(rotation[:n, :n], position[:n]))
        return tuple(placed)

    @cached_property
    def _poses(self) -> list[tuple[Array, Array]]:
        """Each part's link in the frame of its coordinate."""
        links = _link_poses(self.robot, self.base_count)
        return [links[name][1:] for name in self.robot.part_links]


def molecule_of(
    robot: ArticulatedRobot,
    basis: Array,
    shifts: Sequence[int] = (),
    euler: str = "ZXZ",
    densities: Mapping[str, float] | None = None,
) -> Molecule:
    """The molecule of a robot in a cell.

    Args:
        robot: with a free base; its joints revolute, continuous, prismatic or fixed.
        basis: (n, n), the cell's axes as columns.
        shifts: along which of the cell's axes (0, 1, 2) the molecule may move.
        euler: three letters of XYZ, turns about the molecule's own moving axes, first to last;
            empty for a molecule that does not turn. In the plane there is one heading.
        densities: weight per volume of each link by name, 1 by default.

    Raises:
        CrystalError: if a joint is a ball joint, or the turns are no such letters.
    """
    n = robot.dimension
    base = _base_coordinates(n, basis, shifts, euler)
    joints = [joint for joint in robot.joints if joint.type == BALL]
    if joints:
        raise CrystalError(
            f"joint {joints[0].name!r}: ball joints have no grid of values here; make it three "
            "revolute joints, one after another"
        )
    links = _link_poses(robot, len(base))
    coordinates = [coordinate for coordinate, _ in base]
    axes = [axis for _, axis in base]
    parents = list(range(-1, len(base) - 1))
    origins = [_row(np.eye(3), np.zeros(3))] * len(base)
    for joint in _moving(robot):
        coordinates.append(Coordinate(joint.name, joint.type != PRISMATIC))
        frame, rotation, position = links[joint.parent]
        origins.append(_row(rotation @ _deep(joint.rotation), position + rotation @ _flat(joint)))
        parents.append(frame)
        axes.append(_axis(joint))
    given = densities or {}
    return Molecule(
        robot,
        tuple(coordinates),
        len(base),
        _frozen(np.array([given.get(name, 1.0) for name in robot.part_links])),
        _frozen(np.array([0 if c.turns else 1 for c in coordinates], dtype=np.int64)),
        _frozen(np.array(parents, dtype=np.int64)),
        _frozen(np.array(origins).reshape(-1, kernels.FRAME)),
        _frozen(np.array(axes, dtype=float).reshape(-1, 3)),
        _frozen(np.array([links[name][0] for name in robot.part_links], dtype=np.int64)),
        _frozen(_part_rows(robot, links)),
    )


def _base_coordinates(
    n: int, basis: Array, shifts: Sequence[int], euler: str
) -> list[tuple[Coordinate, Array]]:
    columns = np.eye(3)
    columns[:n, :n] = basis / np.linalg.norm(basis, axis=0)
    found = [(Coordinate("xyz"[k], False), columns[:, k]) for k in sorted(shifts)]
    if not euler:
        return found
    if n == 2:
        return [*found, (Coordinate("yaw", True), np.array(AXES["Z"]))]
    if len(euler) != 3 or set(euler) - set(AXES) or euler[0] == euler[1] or euler[1] == euler[2]:
        raise CrystalError(
            f"expected three Euler axes of X, Y, Z, no two alike in a row, got {euler!r}; write "
            "ZXZ, say"
        )
    turns = zip(EULER_NAMES, euler, strict=True)
    return [*found, *((Coordinate(name, True), np.array(AXES[axis])) for name, axis in turns)]


def _moving(robot: ArticulatedRobot) -> list[Joint]:
    return [joint for joint in _chain_by_chain(robot, robot.root) if joint.type != FIXED]


def _chain_by_chain(robot: ArticulatedRobot, link: str) -> Iterator[Joint]:
    """The joints below a link, each followed by all that it carries: searches prune early."""
    for joint in robot.joints:
        if joint.parent == link:
            yield joint
            yield from _chain_by_chain(robot, joint.child)


def _link_poses(robot: ArticulatedRobot, base: int) -> dict[str, tuple[int, Array, Array]]:
    """Each link's coordinate, and its rotation and position in that coordinate's frame."""
    found = {robot.root: (base - 1, np.eye(3), np.zeros(3))}
    moving = iter(range(base, base + len(_moving(robot))))
    for joint in _chain_by_chain(robot, robot.root):
        frame, rotation, position = found[joint.parent]
        if joint.type == FIXED:
            turned = rotation @ _deep(joint.rotation)
            found[joint.child] = frame, turned, position + rotation @ _flat(joint)
        else:
            found[joint.child] = next(moving), np.eye(3), np.zeros(3)
    return found


def _part_rows(
    robot: ArticulatedRobot, links: Mapping[str, tuple[int, Array, Array]]
) -> NDArray[np.float64]:
    rows = np.empty((len(robot.parts), kernels.POSED))
    for row, part, name in zip(rows, robot.parts, robot.part_links, strict=True):
        _, rotation, position = links[name]
        centre, matrix = np.zeros(3), np.eye(3)
        centre[: part.dimension] = part.centre
        matrix[: part.dimension, : part.dimension] = part.matrix
        if part.dimension == 2:
            matrix[2, 2] = float(part.semi_axes.min())
        row[:3], row[3:] = rotation @ centre + position, (rotation @ matrix).ravel()
    return rows


def _row(rotation: Array, position: Array) -> Array:
    return np.concatenate([rotation.ravel(), position])


def _deep(rotation: Array) -> Array:
    """A rotation (n, n) as one of space, about z in the plane."""
    spatial = np.eye(3)
    spatial[: len(rotation), : len(rotation)] = rotation
    return spatial


def _flat(joint: Joint) -> Array:
    position = np.zeros(3)
    position[: len(joint.position)] = joint.position
    return position


def _axis(joint: Joint) -> Array:
    axis = np.zeros(3)
    if joint.axis is None:
        axis[2] = 1.0
    else:
        axis[: len(joint.axis)] = joint.axis
    return axis


def _frozen(array: NDArray) -> NDArray:  # type: ignore[type-arg]
    array.setflags(write=False)
    return array
