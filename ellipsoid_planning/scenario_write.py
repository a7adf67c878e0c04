"""From a scenario back to the scenario format, complete and without loss."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import form_of_heading, form_of_rotation

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario


def scenario_document(scenario: Scenario) -> dict[str, Any]:
    """Return the scenario in its file format, as plain data that JSON and YAML can hold.

    Orientations come out as they were written where the body is still the one that was read;
    otherwise as yaw_deg or as a quaternion, equal to rounding.
    """
    world, robot = scenario.world, scenario.robot
    document: dict[str, Any] = {
        "format": 1,
        "name": scenario.name,
        "description": scenario.description,
        "dimension": scenario.dimension,
        "bounds": {"low": world.low.tolist(), "high": world.high.tolist()},
        "arena": [_body(scenario, body) for body in world.arenas],
        "obstacles": [_body(scenario, body) for body in world.obstacles],
        "robot": {
            "rotates": robot.rotates,
            "parts": [_body(scenario, part) for part in robot.parts],
        },
        "clearance": scenario.clearance,
        "start": _pose(scenario, scenario.start),
        "goal": _pose(scenario, scenario.goal),
    }
    if scenario.planner:
        document["planner"] = copy.deepcopy(dict(scenario.planner))
    return document


def _body(scenario: Scenario, body: Ellipsoid) -> dict[str, Any]:
    return {
        "name": body.name,
        "semi_axes": body.semi_axes.tolist(),
        "position": body.centre.tolist(),
        "orientation": _orientation(scenario, body, body.rotation),
    }


def _pose(scenario: Scenario, configuration: NDArray[np.float64]) -> dict[str, Any]:
    n = scenario.dimension
    return {
        "position": configuration[:n].tolist(),
        "orientation": _pose_orientation(scenario, configuration[n:]),
    }


def _pose_orientation(scenario: Scenario, turn: NDArray[np.float64]) -> dict[str, Any]:
    fixed = scenario.robot.orientation
    if fixed is not None:
        return _orientation(scenario, fixed, fixed)
    if scenario.dimension == 2:
        return form_of_heading(float(turn[0]))
    return {"quaternion": turn.tolist()}


def _orientation(
    scenario: Scenario, owner: object, rotation: NDArray[np.float64]
) -> dict[str, Any]:
    for built, written in scenario.origin.orientations:
        if built is owner:
            return copy.deepcopy(dict(written))
    return form_of_rotation(rotation)
