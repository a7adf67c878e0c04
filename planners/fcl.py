"""The conventional checker: python-fcl with its own broad phase, for comparison and cross-checks.

FCL knows collisions of convex bodies and nothing else, so arenas and bounds are decided by our own
kernels here as well. It misses contacts shallower than about 1e-6 of the bodies' size. Motions
are checked the way OMPL does by default, state by state at a resolution.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import fcl
import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.world import World

from .spaces import check_space, state_access
from .validity import state_check

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace

RESOLUTION = 0.01
"""OMPL's default distance of checked states along a motion, as a fraction of the space's extent."""


_LARGEST_AXIS = 30.0
"""Scaled to this largest semi-axis, FCL's distances are right to about four digits."""


class FclBodies:
    """The robot's parts and the obstacles as FCL objects, and queries between them.

    Planar bodies get a third axis and lie in z = 0, which changes no contact between them.
    Everything is scaled to one size, because FCL's tolerances are absolute.
    """

    def __init__(self, cspace: CSpace) -> None:
        """Build the objects and the dynamic AABB tree over the obstacles."""
        bodies = (*cspace.robot.parts, *cspace.world.obstacles)
        self._scale = _LARGEST_AXIS / max(float(body.semi_axes.max()) for body in bodies)
        parts = [_scaled(part, self._scale) for part in cspace.robot.parts]
        obstacles = [_scaled(body, self._scale) for body in cspace.world.obstacles]
        self._parts = [fcl.CollisionObject(_shape(part)) for part in parts]
        placements = [_placement(part) for part in parts]
        self._part_rotations = np.array([rotation for rotation, _ in placements])
        self._part_centres = np.array([centre for _, centre in placements])
        self._obstacles = fcl.DynamicAABBTreeCollisionManager()
        self._obstacles.registerObjects([_placed(body) for body in obstacles])
        self._obstacles.setup()
        self._any = bool(cspace.world.obstacles)

    def place(self, rotation: NDArray[np.float64], position: NDArray[np.float64]) -> None:
        """Move the robot's base to ``position`` (3,) with ``rotation`` (3, 3), world frame."""
        rotations = rotation @ self._part_rotations
        centres = self._part_centres @ rotation.T + self._scale * position
        for part, turned, centre in zip(self._parts, rotations, centres, strict=True):
            part.setRotation(turned)
            part.setTranslation(centre)

    def collide(self) -> bool:
        """Whether any part meets any obstacle."""
        for part in self._parts if self._any else ():
            data = fcl.CollisionData()  # a used result object would keep its old contacts
            self._obstacles.collide(part, data, fcl.defaultCollisionCallback)
            if data.result.is_collision:
                return True
        return False

    def distance(self) -> float:
        """Smallest distance of a part from an obstacle; not positive where they meet."""
        best = math.inf
        for part in self._parts if self._any else ():
            data = fcl.DistanceData()
            self._obstacles.distance(part, data, fcl.defaultDistanceCallback)
            best = min(best, data.result.min_distance)
        return best / self._scale


class FclValidityChecker(ob.StateValidityChecker):
    """Valid: FCL finds no contact, and our kernels find the state inside arenas and bounds.

    A clearance that the scenario requires is measured with FCL's distance query.

    Attributes:
        cspace: the C-space, with obstacles, as for `EllipsoidValidityChecker`.
    """

    def __init__(self, si: ob.SpaceInformation, cspace: CSpace) -> None:
        """Create a checker for the states of ``si``, which is not kept.

        Raises:
            PlannerError: the space of ``si`` does not fit ``cspace``.
        """
        super().__init__(si)
        check_space(si.getStateSpace(), cspace)
        self.cspace = cspace
        self._access = state_access(cspace)
        self._enclosure = _without_obstacles(cspace)
        self._is_enclosed = state_check(self._enclosure)
        self._bodies = FclBodies(cspace)
        self._fixed = _embedded_rotation(cspace.robot.orientation)

    def isValid(self, state: ob.State) -> bool:  # noqa: N802
        """Whether ``state`` is valid."""
        if not self._is_enclosed(state):
            return False
        self._place(np.array(self._access.read(state)))
        required = self.cspace.clearance_required
        if required > 0.0:
            return self._bodies.distance() >= required
        return not self._bodies.collide()

    def clearance(self, state: ob.State) -> float:
        """Distance to obstacles by FCL and to arenas by our kernels; not positive in collision."""
        configuration = np.array(self._access.read(state))
        self._place(configuration)
        return min(self._bodies.distance(), float(self._enclosure.clearance(configuration)))

    def _place(self, configuration: NDArray[np.float64]) -> None:
        dimension = self.cspace.dimension
        position = np.zeros(3)
        position[:dimension] = configuration[:dimension]
        if not self.cspace.rotates:
            rotation = self._fixed
        elif dimension == 2:
            rotation = _about_z(configuration[2])
        else:
            rotation = _from_quaternion(configuration[3:])
        self._bodies.place(rotation, position)


def check_motions_discretely(si: ob.SpaceInformation, resolution: float = RESOLUTION) -> None:
    """Let ``si`` check motions state by state, ``resolution`` times the space's extent apart.

    Call it before `si.setup()`; it leaves OMPL's default motion validator in place.

    Raises:
        PlannerError: ``resolution`` is not in (0, 1].
    """
    if not 0.0 < resolution <= 1.0:
        raise PlannerError(f"resolution: expected a fraction in (0, 1], got {resolution!r}")
    si.setStateValidityCheckingResolution(resolution)


def _without_obstacles(cspace: CSpace) -> CSpace:
    world = cspace.world
    empty = World(low=world.low, high=world.high, arenas=world.arenas)
    return type(cspace)(empty, cspace.robot, cspace.clearance_required)


def _scaled(body: Ellipsoid, scale: float) -> Ellipsoid:
    return Ellipsoid(scale * body.centre, body.rotation, scale * body.semi_axes)


def _shape(body: Ellipsoid) -> fcl.Ellipsoid:
    axes = [float(axis) for axis in body.semi_axes]
    return fcl.Ellipsoid(*axes, *[min(axes)] * (3 - len(axes)))


def _placement(body: Ellipsoid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    centre = np.zeros(3)
    centre[: body.dimension] = body.centre
    return _embedded_rotation(body.rotation), centre


def _placed(body: Ellipsoid) -> fcl.CollisionObject:
    rotation, centre = _placement(body)
    return fcl.CollisionObject(_shape(body), fcl.Transform(rotation, centre))


def _embedded_rotation(rotation: NDArray[np.float64] | None) -> NDArray[np.float64]:
    embedded = np.eye(3)
    if rotation is not None:
        n = rotation.shape[0]
        embedded[:n, :n] = rotation
    return embedded


def _about_z(yaw: float) -> NDArray[np.float64]:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _from_quaternion(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z, w = quaternion.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
