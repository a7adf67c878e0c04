"""From the validated format to worlds, robots and configurations.

Checks what depends on the dimension: vector lengths and orientation forms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import (
    PLANAR_FORMS,
    SPATIAL_FORMS,
    heading_from_degrees,
    quaternion_from_form,
    rotation_from_form,
)
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_format import (
    Body,
    Bounds,
    Orientation,
    Pose,
    Robot,
    ScenarioModel,
)
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.scenario_problems import scenario_error, shown
from ellipsoid_planning.world import World

SAME_ORIENTATION = 1e-12


def scenario_parts(data: Any, origin: Origin) -> dict[str, Any]:
    """Return the fields of a `Scenario` from a document in the scenario format.

    Raises:
        ScenarioError: at the first thing that is wrong with the document.
    """
    if not isinstance(data, Mapping):
        problem = f"expected a mapping with the keys of a scenario, got {shown(data)}"
        raise origin.error((), problem)
    try:
        model = ScenarioModel.model_validate(dict(data))
    except ValidationError as error:
        raise scenario_error(error, origin) from None
    return _Builder(model.dimension, origin).build(model)


class _Builder:
    """Builds the objects of one document and remembers orientations as they were written."""

    def __init__(self, dimension: int, origin: Origin) -> None:
        self._dimension = dimension
        self._origin = origin
        self._orientations: list[tuple[object, Mapping[str, Any]]] = []

    def build(self, model: ScenarioModel) -> dict[str, Any]:
        low, high = self._box(model.bounds)
        obstacles = self._bodies(model.obstacles, ("obstacles",), "obstacle")
        arenas = self._bodies(model.arena, ("arena",), "arena")
        robot = self._robot(model.robot, model.start)
        start = self._configuration(model.start, robot, ("start",))
        goal = self._configuration(model.goal, robot, ("goal",))
        if not robot.rotates:
            self._check_same_orientation(model.start, model.goal)
        return {
            "name": model.name,
            "description": model.description,
            "world": World(np.array(low), np.array(high), obstacles, arenas),
            "robot": robot,
            "clearance": float(model.clearance),
            "start": start,
            "goal": goal,
            "planner": model.planner.model_dump() if model.planner else {},
            "origin": Origin(
                self._origin.file,
                self._origin.values,
                self._origin.keys,
                tuple(self._orientations),
            ),
        }

    def _box(self, bounds: Bounds) -> tuple[list[float], list[float]]:
        low = self._vector(bounds.low, ("bounds", "low"))
        high = self._vector(bounds.high, ("bounds", "high"))
        for index, (below, above) in enumerate(zip(low, high, strict=True)):
            if not below < above:
                raise self._origin.error(
                    ("bounds", "low", index),
                    f"expected low < high, got low {below:g} and high {above:g}; "
                    "exchange or correct them",
                )
        return low, high

    def _vector(self, values: Sequence[float], path: Path) -> list[float]:
        if len(values) != self._dimension:
            raise self._origin.error(
                path,
                f"expected {self._dimension} numbers because the dimension is {self._dimension}, "
                f"got {len(values)}; correct this or the dimension",
            )
        return [float(value) for value in values]

    def _bodies(self, bodies: Sequence[Body], path: Path, kind: str) -> tuple[Ellipsoid, ...]:
        return tuple(
            self._body(body, (*path, index), body.name or f"{kind} {index + 1}")
            for index, body in enumerate(bodies)
        )

    def _body(self, body: Body, path: Path, name: str) -> Ellipsoid:
        semi_axes = self._vector(body.semi_axes, (*path, "semi_axes"))
        position = [0.0] * self._dimension
        if body.position is not None:
            position = self._vector(body.position, (*path, "position"))
        rotation, written = self._rotation(body.orientation, path)
        ellipsoid = Ellipsoid.from_semi_axes(semi_axes, position, rotation, name)
        self._orientations += [(ellipsoid, written)] if written else []
        return ellipsoid

    def _robot(self, robot: Robot, start: Pose) -> RigidRobot:
        parts = self._bodies(robot.parts, ("robot", "parts"), "part")
        if robot.rotates:
            return RigidRobot(parts)
        rotation, written = self._rotation(start.orientation, ("start",))
        built = RigidRobot(parts, rotates=False, orientation=rotation)
        self._orientations += [(built.orientation, written)] if written else []
        return built

    def _configuration(self, pose: Pose, robot: RigidRobot, path: Path) -> NDArray[np.float64]:
        position = self._vector(pose.position, (*path, "position"))
        form, value = self._form(pose.orientation, path)
        if not robot.rotates:
            return np.array(position)
        if self._dimension == 2:
            return np.array([*position, heading_from_degrees(value) if form else 0.0])
        quaternion = [0.0, 0.0, 0.0, 1.0]
        if form:
            quaternion = self._checked(quaternion_from_form, form, value, path).tolist()
        return np.array([*position, *quaternion])

    def _check_same_orientation(self, start: Pose, goal: Pose) -> None:
        first, _ = self._rotation(start.orientation, ("start",))
        second, _ = self._rotation(goal.orientation, ("goal",))
        if not np.max(np.abs(first - second)) <= SAME_ORIENTATION:
            raise self._origin.error(
                ("goal", "orientation"),
                "expected the start's orientation because robot.rotates is false, got another "
                "one; repeat the start's, or let the robot rotate",
            )

    def _rotation(
        self, orientation: Orientation | None, path: Path
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Return the rotation (n, n) and the orientation as written, empty for none."""
        form, value = self._form(orientation, path)
        if not form:
            return np.eye(self._dimension), {}
        return self._checked(rotation_from_form, form, value, path), {form: value}

    def _form(self, orientation: Orientation | None, path: Path) -> tuple[str, Any]:
        if orientation is None:
            return "", None
        ((form, value),) = orientation.model_dump(exclude_unset=True).items()
        allowed = PLANAR_FORMS if self._dimension == 2 else SPATIAL_FORMS
        if form not in allowed:
            raise self._origin.error(
                (*path, "orientation", form),
                f"expected {' or '.join(allowed)} because the dimension is {self._dimension}, "
                f"got {form}; write the orientation in one of these forms",
                at_key=True,
            )
        return form, value

    def _checked(self, convert: Any, form: str, value: Any, path: Path) -> NDArray[np.float64]:
        try:
            return np.asarray(convert(form, value))
        except GeometryError as error:
            raise self._origin.error((*path, "orientation", form), str(error)) from None
