"""How far the parts of an articulated robot keep from each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.joint import FIXED
from ellipsoid_planning.robots.robot import Robot
from planners.verify.meetings import Clearances, Meeting
from planners.verify.placement import part_placements
from planners.verify.separation import bounded_distances

Array = NDArray[np.float64]


def self_pairs(robot: Robot) -> list[tuple[int, int]]:
    """Pairs of parts that may not meet: not of one link, or of links joined, fixed or ignored."""
    links = robot.part_links
    count = len(links)
    return [
        (i, j)
        for i in range(count)
        for j in range(i + 1, count)
        if not _excused(robot, links[i], links[j])
    ]


def _excused(robot: Robot, first: str, second: str) -> bool:
    both = {first, second}
    joined = any({joint.parent, joint.child} == both for joint in robot.joints)
    ignored = frozenset(both) in getattr(robot, "ignored", ())
    return joined or ignored or _carrier(robot, first) == _carrier(robot, second)


def _carrier(robot: Robot, link: str) -> str:
    """The link at the end of the fixed joints that ``link`` hangs on."""
    fixed = {joint.child: joint.parent for joint in robot.joints if joint.type == FIXED}
    while link in fixed:
        link = fixed[link]
    return link


class SelfTester:
    """Distances of a robot's parts from each other.

    They are halved: two parts that each move by less than half their distance cannot meet.
    """

    def __init__(self, robot: Robot) -> None:
        """Find the pairs of ``robot`` that count."""
        self._robot = robot
        self.pairs = self_pairs(robot)
        self._radii = np.array([float(np.max(part.semi_axes)) for part in robot.parts])

    def test(self, configurations: Array, needed: Array) -> Clearances:
        """Half distances at configurations (k, d), exact where they are below ``needed`` (k,)."""
        lower = np.full(len(configurations), np.inf)
        upper = np.full(len(configurations), np.inf)
        meetings: list[Meeting] = []
        centres, matrices = part_placements(self._robot, configurations)
        for i, j in self.pairs:
            offset = centres[:, j] - centres[:, i]
            spheres = np.linalg.norm(offset, axis=1) - self._radii[i] - self._radii[j]
            rows = np.flatnonzero(spheres <= 2.0 * needed)
            np.minimum(lower, np.where(spheres <= 2.0 * needed, np.inf, 0.5 * spheres), out=lower)
            if not len(rows):
                continue
            low, high, meet = bounded_distances(
                matrices[rows, i], matrices[rows, j], offset[rows], 2.0 * needed[rows]
            )
            lower[rows] = np.minimum(lower[rows], 0.5 * low)
            upper[rows] = np.minimum(upper[rows], 0.5 * high)
            names = self._robot.parts[i].name, self._robot.parts[j].name
            meetings += [
                Meeting("self", *names, float(-low[k]), int(rows[k])) for k in np.flatnonzero(meet)
            ]
        return Clearances(lower, upper, tuple(meetings))
