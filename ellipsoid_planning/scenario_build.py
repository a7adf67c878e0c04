"""From the validated format to worlds, robots and configurations.

Checks what depends on the dimension and on the robot; see also `scenario_entries`,
`scenario_robot` and `scenario_joints`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import heading_from_degrees
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_blocks import Body
from ellipsoid_planning.scenario_bodies import QuickBodies, quick_bodies
from ellipsoid_planning.scenario_entries import Entries
from ellipsoid_planning.scenario_format import Bounds, ScenarioModel
from ellipsoid_planning.scenario_format_robot import Pose
from ellipsoid_planning.scenario_joints import joint_values
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.scenario_problems import scenario_error, shown
from ellipsoid_planning.scenario_robot import robot_of
from ellipsoid_planning.sizes import LEAST_LENGTH, REMEDY
from ellipsoid_planning.world import World

SAME_ORIENTATION = 1e-12
KINDS = {"obstacles": "obstacle", "arena": "arena"}


def scenario_parts(data: Any, origin: Origin) -> dict[str, Any]:
    """Return the fields of a `Scenario` from a document in the scenario format.

    Raises:
        ScenarioError: at the first thing that is wrong with the document.
    """
    if not isinstance(data, Mapping):
        problem = f"expected a mapping with the keys of a scenario, got {shown(data)}"
        raise origin.error((), problem)
    quick = {}
    for key, kind in KINDS.items():
        found = quick_bodies(data.get(key), data.get("dimension"), kind)
        if found is not None:
            quick[key] = found
    try:
        model = ScenarioModel.model_validate(
            {key: value for key, value in data.items() if key not in quick}
        )
    except ValidationError as error:
        raise scenario_error(error, origin) from None
    return _Builder(Entries(model.dimension, origin), quick).build(model)


class _Builder:
    """Builds the objects of one document."""

    def __init__(self, entries: Entries, quick: Mapping[str, QuickBodies]) -> None:
        self._entries = entries
        self._quick = quick

    def build(self, model: ScenarioModel) -> dict[str, Any]:
        entries = self._entries
        low, high = self._box(model.bounds)
        obstacles = self._bodies(model.obstacles, "obstacles")
        arenas = self._bodies(model.arena, "arena")
        robot = robot_of(entries, model.robot, model.start)
        start = self._configuration(model.start, robot, "start")
        goal = self._configuration(model.goal, robot, "goal")
        self._check_same_base(model.start, model.goal, robot)
        return {
            "name": model.name,
            "description": model.description,
            "world": World(np.array(low), np.array(high), obstacles, arenas),
            "robot": robot,
            "clearance": float(model.clearance),
            "start": start,
            "goal": goal,
            "planner": model.planner.model_dump() if model.planner else {},
            "origin": entries.origin(),
        }

    def _bodies(self, bodies: Sequence[Body], key: str) -> tuple[Ellipsoid, ...]:
        if key not in self._quick:
            return self._entries.bodies(bodies, (key,), KINDS[key])
        made, written = self._quick[key]
        for body, orientation in written:
            self._entries.remember(body, orientation)
        return made

    def _box(self, bounds: Bounds) -> tuple[list[float], list[float]]:
        low = self._entries.vector(bounds.low, ("bounds", "low"))
        high = self._entries.vector(bounds.high, ("bounds", "high"))
        for index, (below, above) in enumerate(zip(low, high, strict=True)):
            if not below < above:
                raise self._entries.error(
                    ("bounds", "low", index),
                    f"expected low < high, got low {below:g} and high {above:g}; "
                    "exchange or correct them",
                )
            if above - below < LEAST_LENGTH:
                raise self._entries.error(
                    ("bounds", "low", index),
                    f"expected low and high at least {LEAST_LENGTH:g} apart, got low {below:g} and "
                    f"high {above:g}; {REMEDY}",
                )
        return low, high

    def _configuration(
        self, pose: Pose, robot: RigidRobot | ArticulatedRobot, which: str
    ) -> NDArray[np.float64]:
        base = [] if _stands(robot) else self._base(pose, robot, (which,))
        return np.array([*base, *joint_values(self._entries, robot, pose.joints, which)])

    def _base(self, pose: Pose, robot: RigidRobot | ArticulatedRobot, path: Path) -> list[float]:
        if pose.position is None:
            raise self._entries.error((*path, "position"), "this key is missing; add it")
        position = self._entries.vector(pose.position, (*path, "position"))
        place = (*path, "orientation")
        form, value = self._entries.form(pose.orientation, place)
        if not robot.rotates:
            return position
        if robot.dimension == 2:
            return [*position, heading_from_degrees(value) if form else 0.0]
        return [*position, *self._entries.quaternion(pose.orientation, place)]

    def _check_same_base(
        self, start: Pose, goal: Pose, robot: RigidRobot | ArticulatedRobot
    ) -> None:
        if robot.rotates:
            return
        fixed = _stands(robot)
        if fixed and goal.position is not None:
            self._check_same_position(start, goal)
        if fixed and goal.orientation is None:
            return
        first, _ = self._entries.rotation(start.orientation, ("start", "orientation"))
        second, _ = self._entries.rotation(goal.orientation, ("goal", "orientation"))
        if not np.max(np.abs(first - second)) <= SAME_ORIENTATION:
            why, remedy = "robot.rotates is false", "let the robot rotate"
            if isinstance(robot, ArticulatedRobot):
                why, remedy = f"robot.base is {robot.base}", "make the base free"
            raise self._entries.error(
                ("goal", "orientation"),
                f"expected the start's orientation because {why}, got another one; repeat the "
                f"start's, or {remedy}",
            )

    def _check_same_position(self, start: Pose, goal: Pose) -> None:
        first = self._entries.vector(start.position, ("start", "position"))
        second = self._entries.vector(goal.position, ("goal", "position"))
        if first != second:
            raise self._entries.error(
                ("goal", "position"),
                f"expected the start's position {first} because robot.base is fixed, got "
                f"{second}; repeat the start's, or leave the goal's out",
            )


def _stands(robot: RigidRobot | ArticulatedRobot) -> bool:
    """Whether the base is fixed."""
    return isinstance(robot, ArticulatedRobot) and robot.base == FIXED_BASE
