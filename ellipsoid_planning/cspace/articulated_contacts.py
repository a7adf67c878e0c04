"""What is wrong with an articulated robot's configuration: joints out of limits, self-collision."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated_packing import may_meet
from ellipsoid_planning.cspace.contacts import Contact
from ellipsoid_planning.kernels import depths, layout, self_collision, separation
from ellipsoid_planning.kernels import kinematics as tables
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import PRISMATIC

Array = NDArray[np.float64]

LIMIT_TOLERANCE = 1e-9


def limit_contacts(robot: ArticulatedRobot, configuration: Array) -> list[Contact]:
    """Joints whose values in a configuration (d,) are out of their limits."""
    contacts = []
    for joint in robot.moving_joints:
        if joint.value_count != 1:
            continue
        value = float(configuration[robot.joint_slices[joint.name]][0])
        excess = max(joint.lower - value, value - joint.upper)
        if not excess <= LIMIT_TOLERANCE:
            scale, unit = (1.0, "") if joint.type == PRISMATIC else (math.degrees(1.0), " deg")
            text = (
                f"joint {joint.name!r} = {value * scale:g}{unit} is out of its limits "
                f"[{joint.lower * scale:g}, {joint.upper * scale:g}]"
            )
            contacts.append(Contact("limits", "", joint.name, excess, text))
    return contacts


def self_contacts(
    robot: ArticulatedRobot, scene: Array, kinematics: Array, frames: Array, placed: Array
) -> list[Contact]:
    """Pairs of placed parts that may not meet and are not proved apart."""
    shapes, owners = tables.shape_rows(kinematics), tables.owners_of(kinematics)
    # All of them: joints out of their limits may bring links together that else never meet.
    pairs = may_meet(robot, owners)
    required = 2.0 * layout.ROUNDING * float(scene[layout.SCALE])
    body = self_collision.new_body()
    contacts = []
    for i, first in enumerate(robot.parts):
        self_collision.as_body(shapes, i, frames[int(owners[i])], placed, body)
        for j in range(i + 1, len(robot.parts)):
            if not pairs[i, j]:
                continue
            second = robot.parts[j]
            gap, *u, _ = separation.separation(
                body, 0, placed, j, 0.5, math.inf, separation.CONVERGE
            )
            if not gap > required:
                found = depths.least_depth(body, 0, placed, j, *u, robot.dimension == 2)
                gap = float(min(max(gap, found), 0.0))
                text = f"part {first.name!r} hits part {second.name!r} of the robot itself"
                text += f" by {-gap:.6g}"
                contacts.append(Contact("self", first.name, second.name, -gap, text, gap))
    return contacts
