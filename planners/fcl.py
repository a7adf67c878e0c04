"""The conventional checker: python-fcl with its own broad phase, for comparison and cross-checks.

FCL knows collisions of convex bodies and nothing else, so arenas and bounds are decided by our own
kernels here as well. It misses contacts shallower than about 1e-6 of the bodies' size. Motions
are checked the way OMPL does by default, state by state at a resolution.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import combinations

import fcl
import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels.kinematics import pair_matrix
from ellipsoid_planning.world import World

from .articulated_states import articulated_reader
from .placing import PartPlaces, homogeneous
from .spaces import check_space, is_articulated, state_access
from .validity import state_check

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
        self._places = PartPlaces(cspace.robot)
        self._request = fcl.CollisionRequest()
        self._pairs = [(self._parts[i], self._parts[j]) for i, j in self_pairs(cspace)]

    def place(self, rotation: NDArray[np.float64], position: NDArray[np.float64]) -> None:
        """Move a rigid robot's base to ``position`` (3,) with ``rotation`` (3, 3), world frame."""
        rotations = rotation @ self._part_rotations
        centres = self._part_centres @ rotation.T + self._scale * position
        self._move(rotations, centres)

    def place_at(self, configuration: NDArray[np.float64]) -> None:
        """Move the robot, rigid or articulated, to a configuration (d,)."""
        rotations, centres = self._places(configuration)
        self._move(rotations, self._scale * centres)

    def _move(self, rotations: NDArray[np.float64], centres: NDArray[np.float64]) -> None:
        for part, turned, centre in zip(self._parts, rotations, centres, strict=True):
            part.setRotation(turned)
            part.setTranslation(centre)

    def collide(self) -> bool:
        """Whether any part meets an obstacle, or another part that it may not meet."""
        return self.meets_obstacle() or self.meets_itself()

    def meets_itself(self) -> bool:
        """Whether any part meets another part that it may not meet."""
        for first, second in self._pairs:
            result = fcl.CollisionResult()
            if fcl.collide(first, second, self._request, result):
                return True
        return False

    def meets_obstacle(self) -> bool:
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

    The parts of an articulated robot are placed in numpy, and FCL looks at the same pairs of them
    as our kernels do, which decide the joints' limits.

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
        self._read = _reader(cspace)
        self._enclosure = _enclosure(cspace)
        self._is_enclosed = state_check(self._enclosure)
        self._bodies = FclBodies(cspace)

    def isValid(self, state: ob.State) -> bool:  # noqa: N802
        """Whether ``state`` is valid."""
        if not self._is_enclosed(state):
            return False
        self._bodies.place_at(self._read(state))
        required = self.cspace.clearance_required
        if required > 0.0:  # the parts keep it from obstacles, not from each other
            return self._bodies.distance() >= required and not self._bodies.meets_itself()
        return not self._bodies.collide()

    def clearance(self, state: ob.State) -> float:
        """Distance to obstacles by FCL and to arenas by our kernels; not positive in collision."""
        configuration = self._read(state)
        self._bodies.place_at(configuration)
        return min(self._bodies.distance(), float(self._enclosure.clearance(configuration)))


def check_motions_discretely(si: ob.SpaceInformation, resolution: float = RESOLUTION) -> None:
    """Let ``si`` check motions state by state, ``resolution`` times the space's extent apart.

    Call it before `si.setup()`; it leaves OMPL's default motion validator in place.

    Raises:
        PlannerError: ``resolution`` is not in (0, 1].
    """
    if not 0.0 < resolution <= 1.0:
        raise PlannerError(f"resolution: expected a fraction in (0, 1], got {resolution!r}")
    si.setStateValidityCheckingResolution(resolution)


def _reader(cspace: CSpace) -> Callable[[ob.State], NDArray[np.float64]]:
    if is_articulated(cspace):
        return articulated_reader(cspace)
    read = state_access(cspace).read
    return lambda state: np.array(read(state))


def self_pairs(cspace: CSpace) -> list[tuple[int, int]]:
    """Numbers of the parts that may not meet each other."""
    if not is_articulated(cspace):
        return []
    first, second = np.nonzero(np.triu(pair_matrix(cspace.kinematics)))
    return list(zip(first.tolist(), second.tolist(), strict=True))


def _enclosure(cspace: CSpace) -> CSpace:
    """``cspace`` with bounds, limits and arenas alone."""
    world, robot = cspace.world, cspace.robot
    empty = World(low=world.low, high=world.high, arenas=world.arenas)
    if is_articulated(cspace):
        links = [link.name for link in cspace.robot.links]
        robot = replace(cspace.robot, ignored=frozenset(map(frozenset, combinations(links, 2))))
    return CSpace(empty, robot, cspace.clearance_required)


def _scaled(body: Ellipsoid, scale: float) -> Ellipsoid:
    return Ellipsoid(scale * body.centre, body.rotation, scale * body.semi_axes)


def _shape(body: Ellipsoid) -> fcl.Ellipsoid:
    axes = [float(axis) for axis in body.semi_axes]
    return fcl.Ellipsoid(*axes, *[min(axes)] * (3 - len(axes)))


def _placement(body: Ellipsoid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    transform = homogeneous(body.centre, body.rotation)
    return transform[:3, :3], transform[:3, 3]


def _placed(body: Ellipsoid) -> fcl.CollisionObject:
    rotation, centre = _placement(body)
    return fcl.CollisionObject(_shape(body), fcl.Transform(rotation, centre))
