"""Which pairs of links can meet within the joint limits, proved either way (thesis 6.3.1)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated_packing import (
    Bodies,
    bodies_of,
    pack_kinematics,
    rounding_share,
)
from ellipsoid_planning.cspace.joint_routes import Route, packed_joints, route_between
from ellipsoid_planning.kernels import joint_boxes, layout
from ellipsoid_planning.kernels.kinematics import JOINT_PARENT, joint_rows
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL

Array = NDArray[np.float64]

NEVER = "never"
MEET = "meet"
UNDECIDED = "undecided"
_VERDICTS = {
    joint_boxes.NEVER: NEVER,
    joint_boxes.MEET: MEET,
    joint_boxes.UNDECIDED: UNDECIDED,
}

# Limits are enforced to 1e-9, and motions interpolate to a few roundings.
_TOLERANCE = 2e-9
_EPSILON = float(np.finfo(float).eps)
# Tests of two parts in a box; one takes one or two microseconds.
_REPORT_TESTS = 50_000
_QUICK_TESTS = 400
_QUICK_WORK = 40_000
_QUICK_PAIRS = 100


@dataclass(frozen=True, eq=False)
class PairVerdict:
    """What was found about two links.

    Attributes:
        first, second: their names, in the order of the robot's links.
        verdict: ``NEVER`` (proved: they do not meet while all joints are in their limits),
            ``MEET`` (they do at ``example``), or ``UNDECIDED``.
        joints: names of the joints between them, which alone decide.
        example: values of these joints at which the two meet: numbers [rad or lengths] or, for
            ball joints, quaternions (x, y, z, w). None unless the verdict is ``MEET``.
        tests: how many pairs of parts were tested.
    """

    first: str
    second: str
    verdict: str
    joints: tuple[str, ...]
    example: dict[str, float | tuple[float, ...]] | None
    tests: int


class JointBoxes:
    """Proofs over boxes of joint values of one robot.

    Two parts count as meeting if they are not proved apart by more than rounding, as in
    ArticulatedCSpace; with limits, values up to 2e-9 beyond are covered.
    """

    def __init__(self, robot: ArticulatedRobot, bodies: Bodies | None = None) -> None:
        self.robot = robot
        self._bodies = bodies_of(robot) if bodies is None else bodies
        self._kinematics = pack_kinematics(robot, self._bodies)
        self._joints = packed_joints(robot)
        self._parts = {
            link.name: np.flatnonzero([name == link.name for name in robot.part_links])
            for link in robot.links
        }
        # Frames are relative to a body of the robot: coordinates stay within twice its reach.
        scale = 2.0 * robot.reach * rounding_share(robot)
        self._required = 2.0 * layout.ROUNDING * scale
        far = max([np.pi, *(abs(v) for j in self._joints for v in (j.lower, j.upper))])
        self._tolerance = _TOLERANCE + 8.0 * _EPSILON * far

    def route(self, first: str, second: str) -> Route:
        """The joints between two links that have parts and do not belong to one body."""
        owners = self._bodies.owners
        bodies = (int(owners[self._parts[name][0]]) for name in (first, second))
        return route_between(self._kinematics, self._joints, *bodies)

    def search(
        self, first: str, second: str, route: Route, coordinates: Array, tests: int
    ) -> tuple[str, Array, int]:
        """Whether two links meet: the verdict, an example (D,) for ``MEET``, tests done.

        ``coordinates`` (D, COORDINATE) are those of the route, perhaps with narrower limits.
        """
        point = np.zeros(len(coordinates))
        verdict, done = joint_boxes.search_boxes(
            self._kinematics,
            self._bodies.parts,
            route.rows,
            route.top,
            coordinates,
            self._parts[first],
            self._parts[second],
            self._tolerance,
            self._required,
            tests,
            point,
        )
        return _VERDICTS[verdict], point, int(done)

    def decide(self, first: str, second: str, tests: int = _REPORT_TESTS) -> PairVerdict:
        """Whether two links, in any order, can meet within the joint limits."""
        route = self.route(first, second)
        verdict, point, done = self.search(first, second, route, route.coordinates, tests)
        example = route.values(point) if verdict == MEET else None
        names = tuple(joint.name for joint in route.joints)
        return PairVerdict(first, second, verdict, names, example, done)

    def pairs(self) -> Iterator[tuple[str, str]]:
        """The pairs of links that self-collision is about, in the order of the robot's links."""
        robot, owners = self.robot, self._bodies.owners
        joined = {frozenset((j.parent, j.child)) for j in robot.joints} | robot.ignored
        names = [name for name, parts in self._parts.items() if len(parts)]
        for first, second in combinations(names, 2):
            bodies = {owners[self._parts[name][0]] for name in (first, second)}
            if len(bodies) == 2 and frozenset((first, second)) not in joined:
                yield first, second

    def nearest_pairs(self) -> list[tuple[str, str]]:
        """:meth:`pairs`, those with the fewest coordinates between them first."""
        pairs = list(self.pairs())
        above = np.zeros((len(self._joints) + 1, len(self._joints)))
        parents = joint_rows(self._kinematics)[:, JOINT_PARENT].astype(int)
        for j, parent in enumerate(parents):
            above[j + 1] = above[parent]
            above[j + 1, j] = 1.0
        weights = np.array([3.0 if joint.type == BALL else 1.0 for joint in self._joints])
        owners = self._bodies.owners.astype(int)
        first, second = (
            above[[owners[self._parts[pair[side]][0]] for pair in pairs]] for side in (0, 1)
        )
        lengths = np.abs(first - second) @ weights
        return [pairs[k] for k in np.argsort(lengths, kind="stable")]


def pair_verdicts(robot: ArticulatedRobot, tests: int = _REPORT_TESTS) -> tuple[PairVerdict, ...]:
    """Verdicts on all pairs of links that self-collision is about, each with at most ``tests``."""
    search = JointBoxes(robot)
    return tuple(search.decide(*pair, tests) for pair in search.pairs())


_never: WeakKeyDictionary[ArticulatedRobot, frozenset[frozenset[str]]] = WeakKeyDictionary()


def never_meeting(robot: ArticulatedRobot) -> frozenset[frozenset[str]]:
    """Pairs of links that are quickly proved never to meet within the joint limits.

    Counts, not time, bound the work, so that the same pairs are found every time: some 20 ms at
    most for 20 links, 40 ms for 80. Pairs with the fewest joints between them come first.
    """
    found = _never.get(robot)
    if found is None:
        found = _never[robot] = frozenset(_quickly_proved(robot))
    return found


def _quickly_proved(robot: ArticulatedRobot) -> Iterator[frozenset[str]]:
    search = JointBoxes(robot)
    left = _QUICK_WORK
    for pair in search.nearest_pairs()[:_QUICK_PAIRS]:
        route = search.route(*pair)
        # A test takes a time that has a fixed part and one for each coordinate.
        weight = 3 + len(route.coordinates)
        verdict, _, done = search.search(
            *pair, route, route.coordinates, min(_QUICK_TESTS, left // weight)
        )
        if verdict == NEVER:
            yield frozenset(pair)
        left -= done * weight
        if left < weight:
            break
