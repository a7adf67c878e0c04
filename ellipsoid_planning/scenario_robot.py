"""From the validated format to robots: rigid ones, and trees of links and joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ellipsoid_planning.errors import GeometryError, RobotError
from ellipsoid_planning.robots.articulated import (
    FIXED_BASE,
    FREE_BASE,
    ArticulatedRobot,
    Link,
)
from ellipsoid_planning.robots.joint import BALL, LIMITED, PRISMATIC, REVOLUTE, Joint
from ellipsoid_planning.robots.joint_limits import is_unlimited, revolute_problem, shift_problem
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.tree import check_ignored_pair
from ellipsoid_planning.scenario_entries import Entries
from ellipsoid_planning.scenario_format_robot import (
    ArticulatedBlock,
    JointBlock,
    JointLimit,
    Pose,
    RigidBlock,
)
from ellipsoid_planning.scenario_joints import keyed_joints
from ellipsoid_planning.scenario_origin import Path

ROBOT: Path = ("robot",)


def robot_of(
    entries: Entries, block: RigidBlock | ArticulatedBlock, start: Pose
) -> RigidRobot | ArticulatedRobot:
    """The robot of a document; what does not move of its base comes from `start`."""
    if isinstance(block, ArticulatedBlock):
        return _articulated_robot(entries, block, start)
    parts = entries.bodies(block.parts, ("robot", "parts"), "part")
    if block.rotates:
        return RigidRobot(parts)
    rotation, written = entries.rotation(start.orientation, ("start", "orientation"))
    robot = RigidRobot(parts, rotates=False, orientation=rotation)
    entries.remember(robot.orientation, written)
    return robot


def _articulated_robot(entries: Entries, block: ArticulatedBlock, start: Pose) -> ArticulatedRobot:
    links = tuple(
        Link(link.name, entries.bodies(link.parts, (*ROBOT, "links", index, "parts"), link.name))
        for index, link in enumerate(block.links)
    )
    joints = tuple(_joint(entries, joint, index) for index, joint in enumerate(block.joints))
    _check_ignored(entries, block.ignore_self_collision, [link.name for link in links])
    position = orientation = None
    written: dict[str, Any] = {}
    if block.base != FREE_BASE:
        place = ("start", "orientation")
        orientation, written = entries.rotation(start.orientation, place)
    if block.base == FIXED_BASE:
        position = np.array(entries.vector(start.position, ("start", "position")))
    ignored = frozenset(frozenset(pair) for pair in block.ignore_self_collision)
    try:
        robot = ArticulatedRobot(links, joints, block.base, position, orientation, ignored)
        keyed_joints(robot)
    except RobotError as error:
        raise entries.error((*ROBOT, *error.path), str(error)) from None
    except GeometryError as error:
        raise entries.error(ROBOT, str(error)) from None
    entries.remember(robot.orientation, written)
    return robot


def _check_ignored(entries: Entries, pairs: Sequence[Sequence[str]], links: list[str]) -> None:
    index = 0
    try:
        for index, pair in enumerate(pairs):  # noqa: B007 (the error needs it)
            check_ignored_pair(pair, links)
    except RobotError as error:
        raise entries.error((*ROBOT, *error.path, index), str(error)) from None


def _joint(entries: Entries, block: JointBlock, index: int) -> Joint:
    path: Path = (*ROBOT, "joints", index)
    if block.type == BALL and entries.dimension == 2:
        raise entries.error(
            (*path, "type"),
            f"joint {block.name!r}: there are no ball joints in the plane; make it revolute or "
            "continuous",
        )
    place = (*path, "origin")
    at = None if block.origin is None else block.origin.position
    turned = None if block.origin is None else block.origin.orientation
    position = entries.vector(at, (*place, "position"))
    rotation, written = entries.rotation(turned, (*place, "orientation"))
    axis = _axis(entries, block, path)
    lower, upper = _limits(entries, block, path)
    try:
        joint = Joint.of(
            block.name,
            block.parent,
            block.child,
            block.type,
            position,
            rotation,
            axis,
            lower,
            upper,
        )
    except GeometryError as error:
        raise entries.error(path, str(error)) from None
    entries.remember(joint, written)
    return joint


def _axis(entries: Entries, block: JointBlock, path: Path) -> list[float] | None:
    if block.axis is None:
        return None
    if block.type != PRISMATIC:
        why = {BALL: "a ball joint turns about every axis", "fixed": "a fixed joint does not move"}
        problem = why.get(block.type)
        if entries.dimension == 2 and problem is None:
            problem = "in the plane a joint turns anticlockwise"
        if problem is not None:
            raise entries.error(
                (*path, "axis"), f"joint {block.name!r}: {problem}, so it has no axis; remove it"
            )
    axis = entries.vector(block.axis, (*path, "axis"))
    length = math.hypot(*axis)
    if not 0.0 < length < math.inf:
        raise entries.error(
            (*path, "axis"),
            f"joint {block.name!r}: expected an axis other than zero, got {block.axis}; give the "
            "direction that the joint turns about or moves along",
        )
    return axis


def _limits(entries: Entries, block: JointBlock, path: Path) -> tuple[float, float]:
    """Lower and upper limit, in radians for a revolute joint; 0 where there are none."""
    place = (*path, "limit")
    if block.type not in LIMITED:
        if block.limit is not None:
            remedy = " or make it revolute" if block.type == "continuous" else ""
            raise entries.error(
                place,
                f"joint {block.name!r} is {block.type} and has no limits; remove them{remedy}",
            )
        return 0.0, 0.0
    keys = ("lower_deg", "upper_deg") if block.type == REVOLUTE else ("lower", "upper")
    if block.limit is None:
        problem = f"joint {block.name!r} is {block.type} and needs limits; add {_example(keys)}"
        raise entries.error(place, problem)
    lower, upper = _limit_values(entries, block, block.limit, keys, place)
    if not lower < upper:
        raise entries.error(
            (*place, keys[0]),
            f"joint {block.name!r}: expected {keys[0]} < {keys[1]}, got {lower:g} and {upper:g}; "
            "exchange or correct them",
        )
    if block.type == REVOLUTE:
        lower, upper = math.radians(lower), math.radians(upper)
        wrong = None if is_unlimited(lower, upper) else revolute_problem(lower, upper)
    else:
        wrong = shift_problem(lower, upper)
    if wrong is not None:
        raise entries.error((*place, keys[0]), f"joint {block.name!r}: {wrong}")
    return lower, upper


def _limit_values(
    entries: Entries, block: JointBlock, limit: JointLimit, keys: tuple[str, str], place: Path
) -> tuple[float, float]:
    """The two numbers in the file's unit, with an error for the keys of the other unit."""
    given = limit.model_dump(exclude_unset=True)
    for key in given:
        if key not in keys:
            raise entries.error(
                (*place, key),
                f"joint {block.name!r} is {block.type}, so its limits are {keys[0]} and "
                f"{keys[1]}; write {_example(keys)}",
                at_key=True,
            )
    for key in keys:
        if key not in given:
            raise entries.error((*place, key), "this key is missing; add it")
    return given[keys[0]], given[keys[1]]


def _example(keys: tuple[str, str]) -> str:
    return f"limit: {{{keys[0]}: ..., {keys[1]}: ...}}"
