"""The configuration space of an articulated robot: what is free, proved."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated_contacts import limit_contacts, self_contacts
from ellipsoid_planning.cspace.articulated_packing import (
    bodies_of,
    pack_articulated_scene,
    pack_kinematics,
)
from ellipsoid_planning.cspace.articulated_rows import (
    configurations_of_rows,
    interpolated,
    rows_of,
)
from ellipsoid_planning.cspace.contacts import Contact, bound_contacts, placed_contacts
from ellipsoid_planning.cspace.joint_ranges import never_meeting
from ellipsoid_planning.cspace.layer import Layer
from ellipsoid_planning.cspace.space import CSpace, check_clearance
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.kernels import (
    articulated_motion,
    articulated_validity,
    kinematics,
    layout,
)
from ellipsoid_planning.kernels.robot_model import new_articulated_model
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot, check_articulated
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

_CLEARANCE_SAMPLES = 33
_CLEARANCE_PROOFS = 40


class ArticulatedCSpace(CSpace, robots=ArticulatedRobot):
    """An articulated robot's configurations in a world, with proofs of what is free.

    Valid means: the base in its bounds, every joint in its limits, every part clear of obstacles
    and inside the arenas (at the clearance), and no part meets another (whatever the clearance)
    but those of neighbouring links and of ignored pairs. Pairs of links that are quickly proved
    never to meet within the joint limits are not tested (cspace.joint_ranges). What is called
    valid is proved so; see CSpace for what may be refused. The rounding of forward kinematics adds
    a third of that for each joint. Motions are also refused

    - that keep a gap of less than about 1e-9 of the size all along while they turn: they would
      take more than 1e5 pieces (a gap that small in passing takes some tens),
    - with half turns of more than one joint or base, or with several rotations in space of less
      than 2e-4 rad unless OMPL surely holds each of them (below 6e-5 rad).

    A motion that is proved is so backwards, too.

    Attributes:
        kinematics: the packed array that kernels read beside ``scene`` (kernels.kinematics).
    """

    def __init__(self, world: World, robot: ArticulatedRobot, clearance: float = 0.0) -> None:
        """Characterise the C-space.

        Raises:
            GeometryError: if the robot is rigid, the dimensions differ, or the clearance is
                negative, not finite, or leaves nothing of an arena.
        """
        check_articulated(robot)
        check_clearance(world, robot, clearance)
        self.world, self.articulated = world, robot
        self.robot: Any = robot  # the base class knows rigid ones
        self.clearance_required = float(clearance)
        bodies = bodies_of(robot)
        self.scene = pack_articulated_scene(world, robot, bodies, self.clearance_required)
        self.kinematics = pack_kinematics(robot, bodies, never_meeting(robot))

    @property
    def model(self) -> Any:
        """What kernels know of robot and world, workspaces included (kernels.robot_model)."""
        return new_articulated_model(self.scene, self.kinematics)

    @property
    def pose_size(self) -> int:
        """How many numbers a row of :meth:`poses` has: 7 + V."""
        return int(self.kinematics[kinematics.WIDTH])

    @property
    def reach(self) -> float:
        """Largest distance of a point of the robot from its base, whatever its joints do."""
        return self.articulated.reach

    def poses(self, configurations: ArrayLike) -> Array:
        """Rows (m, 7 + V) of configurations (m, d) or (d,); see cspace.articulated_rows."""
        return rows_of(self.articulated, configurations)

    def configurations(self, rows: Array) -> Array:
        """Configurations (m, d) of rows (m, 7 + V)."""
        return configurations_of_rows(self.articulated, rows)

    def is_valid(self, configuration: ArrayLike) -> bool:
        """Whether a configuration (d,) is provably free, in bounds, limits and at the clearance."""
        return bool(self.are_valid(self._one(configuration))[0])

    def are_valid(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """:meth:`is_valid` of every row of ``configurations`` (m, d), shape (m,)."""
        rows = self.poses(configurations)
        out = np.empty(len(rows), dtype=np.bool_)
        articulated_validity.are_articulated_free(self.scene, self.kinematics, rows, out)
        return out

    def clearance(self, configuration: ArrayLike) -> float:
        """Signed distance to obstacles and arena boundaries, as `CSpace.clearance`.

        The robot's parts against each other do not count.
        """
        row = self.pose(configuration)
        value = articulated_validity.articulated_clearance(self.scene, self.kinematics, row)
        return float(value)

    def placed(self, configuration: ArrayLike) -> Array:
        """The parts placed at a configuration (d,), rows (P, PLACED) of kernels.layout."""
        return self._placed(self.pose(configuration))[1]

    def _placed(self, row: Array) -> tuple[Array, Array]:
        frames = kinematics.new_frames(self.kinematics)
        placed = np.empty((len(self.robot.parts), layout.PLACED))
        kinematics.place_robot(layout.part_rows(self.scene), self.kinematics, row, frames, placed)
        return frames, placed

    def explain(self, configuration: ArrayLike) -> tuple[Contact, ...]:
        """Everything that makes a configuration (d,) invalid; empty if it is valid."""
        if self.is_valid(configuration):
            return ()
        values = np.asarray(configuration, dtype=float)
        frames, placed = self._placed(self.pose(values))
        contacts = []
        if self.articulated.base != FIXED_BASE:
            contacts += bound_contacts(self.world, values[: self.dimension])
        contacts += limit_contacts(self.articulated, values)
        contacts += placed_contacts(self.world, self.robot, self.scene, placed)
        contacts += self_contacts(self.articulated, self.scene, self.kinematics, frames, placed)
        return tuple(contacts)

    def motion_proofs(self, first: ArrayLike, second: ArrayLike) -> NDArray[np.int64]:
        """Number of proofs that each motion took, shape (m,); negative if it was refused."""
        begin, end = self._pairs(first, second)
        counts = np.empty(len(begin), dtype=np.int64)
        articulated_motion.articulated_motions_are_free(
            self.scene, self.kinematics, begin, end, counts
        )
        return counts

    def motion_clearance(self, first: ArrayLike, second: ArrayLike) -> float:
        """Proved lower bound of the clearance along a motion; −inf if it is not proved free.

        Infinite in an empty world; else within about 1e-3 of the smallest sampled clearance where
        proofs reach that far.
        """
        if not self.is_motion_valid(first, second):
            return -math.inf
        if not (self.world.obstacles or self.world.arenas):
            return math.inf
        samples = np.linspace(0.0, 1.0, _CLEARANCE_SAMPLES)
        high = min(self.clearance(self.interpolate(first, second, float(s))) for s in samples)
        low = self.clearance_required
        trial = low + 0.999 * (high - low)
        work = articulated_motion.new_motion_workspace(self.scene, self.kinematics)
        begin, end = self.pose(first), self.pose(second)
        for _ in range(_CLEARANCE_PROOFS):
            if high - low <= 1e-3 * high:
                break
            proofs = articulated_motion.prove_articulated_motion(
                self.scene, self.kinematics, begin, end, trial, work
            )
            low, high = (trial, high) if proofs > 0 else (low, trial)
            trial = 0.5 * (low + high)
        return low

    def interpolate(self, first: ArrayLike, second: ArrayLike, s: float) -> Array:
        """The configuration (d,) at ``s`` in [0, 1] of OMPL's motion from first to second."""
        return interpolated(self.articulated, first, second, s)

    def layer(self, orientation: ArrayLike | None = None) -> Layer:
        """The layer of a configuration (d,): everything but the base's position is fixed.

        Raises:
            GeometryError: if it is no configuration, or the base is fixed.
        """
        robot = self.articulated
        if robot.base == FIXED_BASE:
            raise GeometryError("a robot on a fixed base does not translate: it has no layers")
        if orientation is None:
            size = robot.configuration_size
            raise GeometryError(f"expected a configuration of {size} numbers, got none")
        values = self._one(orientation)
        values[: self.dimension] = 0.0
        rotation = robot.pose(values)[1]
        return Layer(self.world, self.scene, rotation, self.placed(values), robot.bodies_at(values))
