"""Small markers where the joints of a robot are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.robots.joint import BALL, FIXED, PRISMATIC

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.robots import Joint, Robot

SIZE = 0.4  # radius as a part of the robot's median thickness
RAIL = 0.5  # radius of a prismatic joint's rail, in radii


@dataclass(frozen=True, eq=False)
class JointMarker:
    """A ball, or a rod between two points, that stands out of the links that it joins.

    Attributes:
        joint: the joint's name.
        link: its parent, in whose frame the marker is fixed.
        points: (1, n) a ball's centre, or (2, n) a rod's ends.
        radius: of the ball or the rod, in the scenario's unit of length.
    """

    joint: str
    link: str
    points: NDArray[np.float64]
    radius: float

    def placed(
        self, poses: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]
    ) -> NDArray[np.float64]:
        """Return the points in the world, with the link poses of a configuration."""
        position, rotation = poses[self.link]
        return np.asarray(position + self.points @ rotation.T)


def joint_markers(robot: Robot) -> tuple[JointMarker, ...]:
    """Return a marker for each joint that moves.

    A ball joint gets a ball, a revolute one a dot in the plane and a pin along its axis in
    space, a prismatic one a rail between its limits.
    """
    radius = SIZE * float(np.median([part.semi_axes.min() for part in robot.parts]))
    return tuple(_marker(robot, joint, radius) for joint in robot.joints if joint.type != FIXED)


def _marker(robot: Robot, joint: Joint, radius: float) -> JointMarker:
    axis = np.zeros(len(joint.position)) if joint.axis is None else joint.axis
    along = [0.0]
    if joint.type == PRISMATIC:
        along, radius = [joint.lower, joint.upper], RAIL * radius
    elif joint.type == BALL:
        radius = max(radius, 1.1 * _depth(_joined(robot, joint)))
    elif joint.axis is not None:
        along = _extent(_joined(robot, joint), axis, radius)
    points = joint.position + np.outer(along, axis) @ joint.rotation.T
    return JointMarker(joint.name, joint.parent, points, radius)


def _joined(robot: Robot, joint: Joint) -> list[Ellipsoid]:
    """The parts of both links in the joint's frame, the joint at zero."""
    back = joint.rotation.T
    parts = list(zip(robot.parts, robot.part_links, strict=True))
    above = [
        part.transform(back, -back @ joint.position) for part, at in parts if at == joint.parent
    ]
    return above + [part for part, at in parts if at == joint.child]


def _extent(bodies: list[Ellipsoid], axis: NDArray[np.float64], margin: float) -> list[float]:
    """Where the line along the axis leaves the bodies that hold the origin, and a bit more."""
    low, high = -margin, margin
    for body in bodies:
        centre, way = np.linalg.solve(body.matrix, np.column_stack([-body.centre, axis])).T
        inside = 1.0 - centre @ centre
        if inside <= 0.0:
            continue
        middle, square = -(centre @ way), way @ way
        reach = np.sqrt(middle**2 + square * inside)
        low = min(low, (middle - reach) / square - margin)
        high = max(high, (middle + reach) / square + margin)
    return [float(low), float(high)]


def _depth(bodies: list[Ellipsoid]) -> float:
    """How deep the origin lies in the bodies, at most; 0 outside them."""
    origin = np.zeros(3)
    return max(
        (
            float(np.min(np.linalg.norm(body.surface_points(300), axis=1)))
            for body in bodies
            if body.contains(origin)
        ),
        default=0.0,
    )
