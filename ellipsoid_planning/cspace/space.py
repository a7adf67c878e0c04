"""The configuration space of a robot in a world: what is free, proved."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.contacts import Contact, body_contacts, bound_contacts
from ellipsoid_planning.cspace.layer import Layer
from ellipsoid_planning.cspace.packing import pack_scene
from ellipsoid_planning.cspace.poses import (
    configurations_from_poses,
    interpolate,
    poses,
    rotation_quaternion,
)
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.orientation import check_rotation
from ellipsoid_planning.kernels import layout, motion, motion_clearance, placement, validity
from ellipsoid_planning.metric import path_length
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.configurations import as_numbers, checked_configuration
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

_CLEARANCE_SAMPLES = 33
_CLEARANCE_PROOFS = 60


def check_clearance(world: World, robot: Robot, clearance: float) -> None:
    """Check that a robot fits a world's dimension, and a clearance for its range.

    Raises:
        GeometryError: if not.
    """
    given: Any = world
    if not isinstance(given, World):
        raise GeometryError(f"expected a World first, then a robot; got {type(world).__name__}")
    if world.dimension != robot.dimension:
        raise GeometryError(
            f"expected a robot of the world's dimension {world.dimension}, "
            f"got dimension {robot.dimension}"
        )
    number: Any = clearance
    if not (isinstance(number, Real) and 0.0 <= float(number) < np.inf):
        raise GeometryError(f"expected a clearance of at least 0, got {clearance!r}")


class CSpace:
    """A robot's configurations in a world, with proofs of what is free.

    ``CSpace(world, robot)`` is the C-space of any robot: for an articulated one it makes the
    subclass that knows its joints, as ``pathlib.Path`` makes a path of the system's kind.

    Whatever is called valid is proved so, rounding included. What is free may be refused

    - when its clearance is within about 1e-12 of the scene's size (1e-10 at axis ratios of 1e6),
    - with a ``clearance`` asked for, when a part all but fills an arena: no single ellipsoid then
      encloses part and ball tightly, and up to a sixth of the true room may be given up.

    Attributes:
        world, robot: what the space is made from.
        clearance_required: distance that every valid configuration and motion keeps.
        scene: the packed array that kernels read, read-only (kernels.layout).
    """

    _kinds: ClassVar[list[tuple[type, type[CSpace]]]] = []

    def __init_subclass__(cls, robots: type | None = None, **rest: Any) -> None:
        """Let ``CSpace(world, robot)`` make this subclass for robots of the class ``robots``."""
        super().__init_subclass__(**rest)
        if robots is not None:
            CSpace._kinds.append((robots, cls))

    def __new__(cls, *given: Any, **named: Any) -> CSpace:  # noqa: PYI034 (or a subclass)
        """Make the C-space of the kind that the robot needs."""
        robot = named.get("robot", given[1] if len(given) > 1 else None)
        kinds = CSpace._kinds if cls is CSpace else []
        kind = next((kind for robots, kind in kinds if isinstance(robot, robots)), cls)
        return super().__new__(kind)

    def __init__(
        self, world: World, robot: RigidRobot | ArticulatedRobot, clearance: float = 0.0
    ) -> None:
        """Characterise the C-space.

        Args:
            world: obstacles, arenas and bounds.
            robot: rigid or articulated, of the world's dimension.
            clearance: the distance that every valid configuration and motion keeps.

        Raises:
            GeometryError: if it is no robot, the dimensions differ, or the clearance is negative,
                not finite, or leaves nothing of an arena.
        """
        if not isinstance(robot, RigidRobot):
            expected = "a RigidRobot or an ArticulatedRobot"
            raise GeometryError(f"expected {expected}, got {type(robot).__name__}")
        check_clearance(world, robot, clearance)
        self.world, self.robot = world, robot
        self.clearance_required = float(clearance)
        self.scene = pack_scene(world, robot, self.clearance_required)

    @property
    def model(self) -> Any:
        """What kernels know of robot and world (kernels.robot_model)."""
        return self.scene

    @property
    def reach(self) -> float:
        """Largest distance of a point of the robot from its base."""
        return self.size

    @property
    def pose_size(self) -> int:
        """How many numbers a row of :meth:`poses` has: 7, and the values of joints."""
        return 7

    @property
    def size(self) -> float:
        """What gaps are compared with: how far points of a rigid piece get from its own frame."""
        return float(layout.part_rows(self.scene)[:, layout.PART_REACH].max())

    @property
    def dimension(self) -> int:
        """Dimension n of the workspace, 2 or 3."""
        return self.world.dimension

    @property
    def rotates(self) -> bool:
        """Whether configurations have an orientation."""
        return self.robot.rotates

    @property
    def tolerance(self) -> float:
        """Clearance below which a free configuration or motion may be refused."""
        return layout.TOLERANCE * float(self.scene[layout.SCALE])

    def poses(self, configurations: ArrayLike) -> Array:
        """Spatial poses (m, 7) of configurations (m, d) or (d,); see :mod:`cspace.poses`."""
        return poses(self.robot, configurations)

    def pose(self, configuration: ArrayLike) -> Array:
        """The row of :meth:`poses` of a single configuration (d,).

        Raises:
            GeometryError: if it is no single configuration of finite numbers.
        """
        return self.poses(self._one(configuration))[0]

    def _one(self, configuration: ArrayLike) -> Array:
        return checked_configuration(configuration, self.robot.configuration_size)

    def _pairs(self, first: ArrayLike, second: ArrayLike) -> tuple[Array, Array]:
        """The rows of :meth:`poses` of as many first as second configurations."""
        begin, end = self.poses(first), self.poses(second)
        if len(begin) != len(end):
            raise GeometryError(
                f"expected as many last configurations as first ones, got {len(begin)} and "
                f"{len(end)}"
            )
        return begin, end

    def configurations(self, rows: Array) -> Array:
        """Configurations (m, d) of spatial poses (m, 7)."""
        return configurations_from_poses(self.robot, rows)

    def is_valid(self, configuration: ArrayLike) -> bool:
        """Whether a configuration (d,) is provably free, in bounds and at the clearance."""
        return bool(validity.configuration_is_free(self.scene, *self.pose(configuration)))

    def are_valid(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """:meth:`is_valid` of every row of ``configurations`` (m, d), shape (m,)."""
        rows = self.poses(configurations)
        out = np.empty(len(rows), dtype=np.bool_)
        validity.are_free(self.scene, rows, out)
        return out

    def clearance(self, configuration: ArrayLike) -> float:
        """Signed distance to obstacles and arena boundaries: the least of all pairs.

        - Apart from an obstacle: a proved lower bound of the distance, right to 1e-6 of itself.
        - Meeting one: minus the penetration depth, the shortest move that takes the part out of
          it; a search all over the sphere, so that the true depth is at most that.
        - Inside an arena: a proved lower bound of the distance to its boundary, at most a sixth
          low where the part all but fills the arena.
        - Not inside: minus how far the part sticks out; a search, the true excess is at least that.

        All are right to the rounding of the scene, 1e-14 of its size, beside. `explain` names the
        pairs by the same numbers. Infinite in an empty world.
        """
        return float(validity.clearance_of(self.scene, *self.pose(configuration)))

    def explain(self, configuration: ArrayLike) -> tuple[Contact, ...]:
        """Everything that makes a configuration (d,) invalid; empty if it is valid."""
        if self.is_valid(configuration):
            return ()
        values = np.asarray(configuration, dtype=float)
        pose = self.pose(values)
        contacts = bound_contacts(self.world, values[: self.dimension])
        contacts += body_contacts(self.world, self.robot, self.scene, pose)
        return tuple(contacts)

    def is_motion_valid(self, first: ArrayLike, second: ArrayLike) -> bool:
        """Whether the motion between two configurations (d,) is proved free throughout.

        The motion is OMPL's interpolation in continuous time; see kernels.motion.
        """
        return bool(self.are_motions_valid(self._one(first), self._one(second))[0])

    def are_motions_valid(self, first: ArrayLike, second: ArrayLike) -> NDArray[np.bool_]:
        """:meth:`is_motion_valid` of every pair of rows (m, d), shape (m,)."""
        return self.motion_proofs(first, second) > 0

    def motion_proofs(self, first: ArrayLike, second: ArrayLike) -> NDArray[np.int64]:
        """Number of proofs that each motion took, shape (m,); negative if it was refused."""
        begin, end = self._pairs(first, second)
        counts = np.empty(len(begin), dtype=np.int64)
        motion.motions_are_free(self.scene, begin, end, counts)
        return counts

    def motion_clearance(self, first: ArrayLike, second: ArrayLike) -> float:
        """Proved lower bound of the clearance along a motion; −inf if it is not proved free.

        Infinite in an empty world; else within about 1e-3 of the smallest sampled clearance where
        proofs reach that far.
        """
        begin, end = self.pose(first), self.pose(second)
        if not (self.world.obstacles or self.world.arenas) and self.is_motion_valid(first, second):
            return math.inf
        return float(
            motion_clearance.motion_clearance(
                self.scene, begin, end, _CLEARANCE_SAMPLES, _CLEARANCE_PROOFS
            )
        )

    def interpolate(self, first: ArrayLike, second: ArrayLike, s: float) -> Array:
        """The configuration (d,) at ``s`` in [0, 1] of OMPL's motion from first to second."""
        return interpolate(self.robot, first, second, s)

    def distance(self, first: ArrayLike, second: ArrayLike) -> float:
        """OMPL's default distance of two configurations (d,)."""
        return path_length(self.robot, np.array([self._one(first), self._one(second)]))

    def layer(self, orientation: ArrayLike | None = None) -> Layer:
        """The layer of a rotation (n, n), or of the orientation of a configuration (d,).

        A robot that only translates needs neither.

        Raises:
            GeometryError: if ``orientation`` is neither.
        """
        n, robot = self.dimension, self.robot
        expected = f"a rotation ({n}, {n}) or a configuration of {robot.configuration_size} numbers"
        if orientation is None and robot.orientation is not None:
            return self._layer(robot.orientation)
        given = as_numbers([] if orientation is None else orientation, expected)
        if given.shape == (n, n):
            return self._layer(check_rotation(given, n))
        if given.shape != (robot.configuration_size,):
            raise GeometryError(f"expected {expected}, got shape {given.shape}")
        return self._layer(robot.pose(given)[1])

    def _layer(self, rotation: Array) -> Layer:
        n, robot = self.dimension, self.robot
        placed = np.empty((len(robot.parts), layout.PLACED))
        placement.place(self.scene, 0.0, 0.0, 0.0, *rotation_quaternion(rotation), placed)
        bodies = tuple(part.transform(rotation, np.zeros(n)) for part in robot.parts)
        return Layer(self.world, self.scene, rotation, placed, bodies)
