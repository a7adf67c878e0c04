"""Which numbers of a configuration are lengths, angles and quaternions, and what they weigh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, PRISMATIC
from ellipsoid_planning.robots.reach import joint_reaches, robot_reach
from ellipsoid_planning.robots.robot import Robot


@dataclass(frozen=True)
class Turn:
    """A coordinate that moves a robot, or a part of it.

    Attributes:
        place: where it stands in a configuration.
        weight: what it weighs in OMPL's distance.
        reach: how far points that it turns can be from its axis; 1 for a prismatic joint.
        joint: its joint's name, empty for the base.
        lower, upper: its limits.
    """

    place: slice
    weight: float
    reach: float
    joint: str = ""
    lower: float = 0.0
    upper: float = 0.0


@dataclass(frozen=True)
class Coordinates:
    """Of a robot's configurations.

    Attributes:
        position: how many numbers place the base, 0 if it is fixed.
        numbers: revolute and prismatic joints, which move evenly.
        angles: headings and continuous joints, which turn the shortest way.
        quaternions: orientations in space and ball joints.
    """

    position: int
    numbers: tuple[Turn, ...]
    angles: tuple[Turn, ...]
    quaternions: tuple[Turn, ...]


def coordinates(robot: Robot) -> Coordinates:
    """The coordinates of ``robot``, rigid or articulated."""
    n = robot.dimension
    numbers: list[Turn] = []
    angles: list[Turn] = []
    quaternions: list[Turn] = []
    if robot.rotates and n == 2:
        angles.append(Turn(slice(2, 3), 0.5, _reach(robot)))
    elif robot.rotates:
        quaternions.append(Turn(slice(3, 7), 1.0, _reach(robot)))
    if isinstance(robot, ArticulatedRobot):
        reaches = joint_reaches(robot)
        for joint, weight in zip(robot.moving_joints, robot.joint_weights, strict=True):
            kind = {CONTINUOUS: angles, BALL: quaternions}.get(joint.type, numbers)
            reach = 1.0 if joint.type == PRISMATIC else reaches[joint.name]
            place = robot.joint_slices[joint.name]
            kind.append(Turn(place, float(weight), reach, joint.name, joint.lower, joint.upper))
    position = n if robot.base_size else 0
    return Coordinates(position, tuple(numbers), tuple(angles), tuple(quaternions))


def _reach(robot: Robot) -> float:
    """How far points of the robot can get from its base."""
    if isinstance(robot, ArticulatedRobot):
        return robot_reach(robot)
    return max(float(np.linalg.norm(p.centre) + np.max(p.semi_axes)) for p in robot.parts)
