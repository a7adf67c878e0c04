"""From a scenario back to the scenario format, complete and without loss."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import (
    degrees_from_radians,
    form_of_heading,
    form_of_rotation,
)
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import PRISMATIC, REVOLUTE, Joint
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_joints import written_values
from ellipsoid_planning.scenario_origin import Origin

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario


def scenario_document(scenario: Scenario) -> dict[str, Any]:
    """Return the scenario in its file format, as plain data that JSON and YAML can hold.

    Orientations come out as they were written where the body is still the one that was read;
    otherwise as yaw_deg or as a quaternion, equal to rounding.
    """
    world = scenario.world
    document: dict[str, Any] = {
        "format": 1,
        "name": scenario.name,
        "description": scenario.description,
        "dimension": scenario.dimension,
        "bounds": {"low": world.low.tolist(), "high": world.high.tolist()},
        "arena": [_body(scenario.origin, body) for body in world.arenas],
        "obstacles": [_body(scenario.origin, body) for body in world.obstacles],
        "robot": robot_document(scenario.robot, scenario.origin),
        "clearance": scenario.clearance,
        "start": _pose(scenario, scenario.start),
        "goal": _pose(scenario, scenario.goal),
    }
    if scenario.planner:
        document["planner"] = copy.deepcopy(dict(scenario.planner))
    return document


def _body(origin: Origin, body: Ellipsoid) -> dict[str, Any]:
    return {
        "name": body.name,
        "semi_axes": body.semi_axes.tolist(),
        "position": body.centre.tolist(),
        "orientation": _orientation(origin, body, body.rotation),
    }


def robot_document(
    robot: RigidRobot | ArticulatedRobot, origin: Origin | None = None
) -> dict[str, Any]:
    """Return the entry ``robot`` of a scenario's file; ``origin`` knows orientations as written."""
    origin = origin or Origin()
    if isinstance(robot, RigidRobot):
        parts = [_body(origin, part) for part in robot.parts]
        return {"rotates": robot.rotates, "parts": parts}
    return {
        "base": robot.base,
        "links": [
            {"name": link.name, "parts": [_body(origin, part) for part in link.parts]}
            for link in robot.links
        ],
        "joints": [_joint(origin, joint) for joint in robot.joints],
        "ignore_self_collision": sorted(sorted(pair) for pair in robot.ignored),
    }


def _joint(origin: Origin, joint: Joint) -> dict[str, Any]:
    written: dict[str, Any] = {
        "name": joint.name,
        "type": joint.type,
        "parent": joint.parent,
        "child": joint.child,
        "origin": {
            "position": joint.position.tolist(),
            "orientation": _orientation(origin, joint, joint.rotation),
        },
    }
    if joint.axis is not None:
        written["axis"] = joint.axis.tolist()
    if joint.type == REVOLUTE:
        lower, upper = map(degrees_from_radians, (joint.lower, joint.upper))
        written["limit"] = {"lower_deg": lower, "upper_deg": upper}
    elif joint.type == PRISMATIC:
        written["limit"] = {"lower": joint.lower, "upper": joint.upper}
    return written


def _pose(scenario: Scenario, configuration: NDArray[np.float64]) -> dict[str, Any]:
    robot, n = scenario.robot, scenario.dimension
    position, turn = configuration[:n], configuration[n:]
    if isinstance(robot, ArticulatedRobot) and robot.position is not None:
        position = robot.position
    pose = {"position": position.tolist(), "orientation": _pose_orientation(scenario, turn)}
    if isinstance(robot, ArticulatedRobot):
        pose["joints"] = written_values(robot, configuration)
    return pose


def _pose_orientation(scenario: Scenario, turn: NDArray[np.float64]) -> dict[str, Any]:
    fixed = scenario.robot.orientation
    if fixed is not None:
        return _orientation(scenario.origin, fixed, fixed)
    if scenario.dimension == 2:
        return form_of_heading(float(turn[0]))
    return {"quaternion": turn[:4].tolist()}


def _orientation(origin: Origin, owner: object, rotation: NDArray[np.float64]) -> dict[str, Any]:
    written = origin.written_orientation(owner)
    return form_of_rotation(rotation) if written is None else copy.deepcopy(dict(written))
