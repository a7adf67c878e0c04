"""How far motions can depart from straight lines: bounds of accelerations, joint by joint.

A point that hangs on joints which turn at constant rates w_1, w_2, ... (from the base outwards)
has, by the product rule, the acceleration

    sum_i w_i^2 a_i x (a_i x r_i)  +  2 sum_{i<j} w_i w_j a_i x (a_j x r_j),

r_j being its offset from joint j, so at most sum_i w_i^2 |r_i| + 2 sum_{i<j} w_i w_j |r_j|. A
prismatic joint j of rate v_j counts in the second sum, with v_j in place of w_j |r_j|. A base's
translation adds nothing. A point of acceleration at most K stays within K w^2 / 8 of the
straight line between its places at the ends of an interval of width w.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.joint import PRISMATIC, Joint
from ellipsoid_planning.robots.robot import Robot
from planners.verify.coordinates import coordinates
from planners.verify.unrolled import Motions

Array = NDArray[np.float64]

_SLACK = 1.0 + 1e-6  # quaternions are of unit length within 1e-9, or reported


def bends(motions: Motions) -> tuple[Array, Array]:
    """Bounds (M, P) of the accelerations of parts' points, in the world and as the base sees them.

    The time of a motion runs from 0 to 1.
    """
    robot = motions.robot
    rates = _rates(motions)
    parents = {joint.child: joint for joint in robot.joints}
    world, inner = [], []
    for part, link in zip(robot.parts, robot.part_links, strict=True):
        reach, bend, speed = _chain(part, link, parents, motions, rates)
        turning = rates[""]
        inner.append(_SLACK * bend)
        world.append(_SLACK * (bend + turning * turning * reach + 2.0 * turning * speed))
    return np.stack(world, axis=1), np.stack(inner, axis=1)


def robot_extent(robot: Robot, motions: Motions) -> float:
    """How far any point gets from the base's origin in any of the motions."""
    parents = {joint.child: joint for joint in robot.joints}
    rates = _rates(motions)
    return max(
        float(np.max(_chain(part, link, parents, motions, rates)[0]))
        + float(np.max(part.semi_axes))  # which `_extent` leaves out of balls
        for part, link in zip(robot.parts, robot.part_links, strict=True)
    )


def _chain(
    part: Ellipsoid,
    link: str,
    parents: dict[str, Joint],
    motions: Motions,
    rates: dict[str, Array],
) -> tuple[Array, Array, Array]:
    """A part's reach from the base, and as the base sees it, its acceleration and its speed."""
    zero = np.zeros(len(motions.index))
    reach = zero + float(np.linalg.norm(part.centre)) + _extent(part)
    bend, speed = zero, zero
    while link in parents:
        joint = parents[link]
        rate = rates.get(joint.name, zero)
        if joint.type == PRISMATIC:
            at = motions.robot.joint_slices[joint.name].start
            first = motions.first[:, at]
            reach = reach + np.maximum(np.abs(first), np.abs(first + motions.change[:, at]))
            speed = speed + rate
        else:
            bend = bend + rate * rate * reach + 2.0 * rate * speed
            speed = speed + rate * reach
        reach = reach + float(np.linalg.norm(joint.position))
        link = joint.parent
    return reach, bend, speed


def _extent(part: Ellipsoid) -> float:
    """How far material points are from the centre; a ball may be taken not to turn with it."""
    axes = part.semi_axes
    return 0.0 if np.all(axes == axes[0]) else float(np.max(axes))


def _rates(motions: Motions) -> dict[str, Array]:
    """How fast (M,) joints turn or shift, by name, and the base turns, under no name."""
    known = coordinates(motions.robot)
    rates = {"": np.zeros(len(motions.index))}
    for turn in (*known.numbers, *known.angles):
        rates[turn.joint] = np.abs(motions.change[:, turn.place.start])
    for q, turn in enumerate(known.quaternions):
        rates[turn.joint] = 2.0 * motions.arcs[:, q]
    return rates
