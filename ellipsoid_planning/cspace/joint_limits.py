"""Joint limits that keep two links from meeting, proved (thesis 6.3.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.joint_ranges import NEVER, JointBoxes
from ellipsoid_planning.cspace.joint_routes import Route, restricted
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.configurations import checked_configuration
from ellipsoid_planning.robots.joint import BALL, Joint

Array = NDArray[np.float64]

# The limits found are this close to the largest ones, as a share of the joint's range, unless the
# proofs of the last steps ask for more than _TESTS each.
RESOLUTION = 1e-4
_TESTS = 20_000
MOST_JOINTS = 2


@dataclass(frozen=True)
class ExcludingLimits:
    """Limits of one joint under which two links never meet, all others being as they are.

    Attributes:
        joint: its name.
        lower, upper: the limits [rad or lengths], within the joint's own.
        around: the value that they were grown from, both ways.
    """

    joint: str
    lower: float
    upper: float
    around: float


def excluding_limits(
    search: JointBoxes, first: str, second: str, configuration: ArrayLike | None = None
) -> tuple[ExcludingLimits, ...]:
    """For each joint between two links, the largest limits that alone keep the links apart.

    They contain the joint's value in ``configuration`` (d,), or 0 without one, or what of its
    limits is closest to that. The other joint keeps its whole range. Nothing is found for more
    than two joints or a ball joint between the links, nor for joints that cannot keep the links
    apart even at that one value.
    """
    route = search.route(first, second)
    if len(route.joints) > MOST_JOINTS or any(joint.type == BALL for joint in route.joints):
        return ()
    found = []
    for joint in route.joints:
        value = _value(search.robot, joint, configuration)
        growth = _Growth(search, (first, second), route, joint, value)
        if not growth.apart(value, value):
            continue
        lower, upper = growth.lower(), growth.upper()
        if lower < upper:
            found.append(ExcludingLimits(joint.name, lower, upper, value))
    return tuple(found)


def _value(robot: ArticulatedRobot, joint: Joint, configuration: ArrayLike | None) -> float:
    at = robot.joint_slices[joint.name].start
    value = 0.0
    if configuration is not None:
        value = float(checked_configuration(configuration, robot.configuration_size)[at])
    return min(max(value, joint.lower), joint.upper)


@dataclass(frozen=True, eq=False)
class _Growth:
    """Grows the limits of one joint from one of its values."""

    search: JointBoxes
    links: tuple[str, str]
    route: Route
    joint: Joint
    value: float

    def apart(self, lower: float, upper: float) -> bool:
        """Whether the links never meet with these limits."""
        coordinates = restricted(self.route, {self.joint.name: (lower, upper)})
        return self.search.search(*self.links, self.route, coordinates, _TESTS)[0] == NEVER

    def upper(self) -> float:
        """The largest upper limit that is proved."""
        return self._grown(self.joint.upper)

    def lower(self) -> float:
        """The smallest lower limit that is proved."""
        return self._grown(self.joint.lower)

    def _grown(self, limit: float) -> float:
        """Bisection between the value and ``limit``; only what is new is proved each time."""
        if self.apart(*sorted((self.value, limit))):
            return limit
        proved, failed = self.value, limit
        while abs(failed - proved) > RESOLUTION * (self.joint.upper - self.joint.lower):
            middle = 0.5 * (proved + failed)
            if self.apart(*sorted((proved, middle))):
                proved = middle
            else:
                failed = middle
        return proved
