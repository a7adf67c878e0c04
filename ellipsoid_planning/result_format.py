"""Reads the result format 1 and checks that a result agrees with its own path."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import ContradictionError, ResultError, ScenarioError
from ellipsoid_planning.metric import base_travel, path_length
from ellipsoid_planning.result import FORMAT, STATUSES, TIMES, PathResult, joint_names
from ellipsoid_planning.robots.coordinates import limits, quaternions
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.scenario import Scenario

AGREEMENT = 1e-6
UNIT_TOLERANCE = 1e-6
LIMIT_TOLERANCE = 1e-9


def result_fields(data: Any, file: str | None) -> dict[str, Any]:
    """Return the fields of a `PlanResult` from a document.

    Raises:
        ResultError: if an entry is missing, wrong, or contradicts the path.
    """
    return _Reader(file).fields(data)


class _Reader:
    """Takes entries out of one document, with errors that name the file and the entry."""

    def __init__(self, file: str | None) -> None:
        self._file = file

    def fields(self, data: Any) -> dict[str, Any]:
        document = self._typed(data, dict, "", "a result")
        if self._entry(document, "format", int) != FORMAT:
            raise self._error("format", f"expected {FORMAT}, got {document['format']!r}")
        scenario = self._scenario(document)
        status = self._entry(document, "status", str)
        if status not in STATUSES:
            raise self._error("status", f"expected one of {', '.join(STATUSES)}, got {status!r}")
        return {
            "scenario": scenario,
            "planner": self._entry(document, "planner", str),
            "status": status,
            "seed": self._optional(document, "seed", int),
            "time": self._time(self._entry(document, "time", dict)),
            "path": self._path(document, scenario.robot, status),
            "statistics": self._entry(document, "statistics", dict),
            "version": self._entry(document, "version", str),
        }

    def _scenario(self, document: Mapping[str, Any]) -> Scenario:
        try:
            return Scenario.from_dict(self._entry(document, "scenario", dict))
        except ScenarioError as error:
            field = f"scenario.{error.field}" if error.field else "scenario"
            raise self._error(field, error.problem) from None

    def _time(self, entry: Mapping[str, Any]) -> dict[str, float | None]:
        if "planning" not in entry and "simplification" not in entry:
            # Files of before these were told apart: their total is the planner's alone.
            entry = {**entry, "planning": entry.get("total"), "simplification": None}
        return {key: self._optional(entry, key, float, "time.") for key in TIMES}

    def _path(self, document: Mapping[str, Any], robot: Robot, status: str) -> PathResult | None:
        entry = self._optional(document, "path", dict)
        if (entry is not None) != (status == "solved"):
            raise self._error("path", f"expected a path exactly when solved, status is {status!r}")
        if entry is None:
            return None
        self._check_joints(entry, joint_names(robot))
        configurations = self._configurations(entry, robot)
        clearance = self._optional(entry, "min_clearance", float, "path.")
        path = PathResult.from_configurations(
            robot,
            configurations,
            min_clearance=math.inf if clearance is None else clearance,
            certified=self._entry(entry, "certified", bool, "path."),
        )
        self._check(entry, "length", path_length(robot, configurations))
        self._check(entry, "base_travel", base_travel(robot, configurations))
        return path

    def _check_joints(self, entry: Mapping[str, Any], expected: list[str]) -> None:
        given = self._entry(entry, "joints", list, "path.") if expected else entry.get("joints", [])
        if given != expected:
            raise self._error(
                "path.joints",
                f"expected the scenario's joints in their order, {expected}, got {given}",
            )

    def _configurations(self, entry: Mapping[str, Any], robot: Robot) -> NDArray[np.float64]:
        rows = self._entry(entry, "configurations", list, "path.")
        size, field = robot.configuration_size, "path.configurations"
        for index, row in enumerate(rows):
            numbers = isinstance(row, list) and all(_is_number(value) for value in row)
            if not numbers or len(row) != size:
                raise self._error(f"{field}[{index}]", f"expected {size} finite numbers")
        if not rows:
            raise self._error(field, "expected one configuration or more, got none")
        configurations = np.array(rows, dtype=float)
        for place in quaternions(robot):
            errors = np.abs(np.linalg.norm(configurations[:, place], axis=1) - 1.0)
            if np.max(errors) > UNIT_TOLERANCE:
                worst, owner = int(np.argmax(errors)), _owner(robot, place.start)
                raise self._error(f"{field}[{worst}]", f"expected a unit quaternion{owner}")
        self._check_limits(configurations, robot, field)
        return configurations

    def _check_limits(self, configurations: NDArray[np.float64], robot: Robot, field: str) -> None:
        low, high = limits(robot)
        beyond = np.maximum(low - configurations, configurations - high)
        row, place = divmod(int(np.argmax(beyond)), beyond.shape[1])
        if beyond[row, place] > LIMIT_TOLERANCE:
            value = configurations[row, place]
            raise self._error(
                f"{field}[{row}]",
                f"expected a value between {low[place]:.10g} and {high[place]:.10g}"
                f"{_owner(robot, place)}, got {value:.10g}",
            )

    def _check(self, entry: Mapping[str, Any], key: str, computed: float) -> None:
        stated = self._entry(entry, key, float, "path.")
        if not abs(stated - computed) <= AGREEMENT * (1.0 + computed):
            problem = f"says {stated:.9g}, but its configurations give {computed:.9g}"
            message = f"path.{key}: {problem}; the file was changed, plan again"
            raise ContradictionError(": ".join(part for part in (self._file, message) if part))

    def _optional(self, entry: Mapping[str, Any], key: str, kind: type, parent: str = "") -> Any:
        if key in entry and entry[key] is None:
            return None
        return self._entry(entry, key, kind, parent)

    def _entry(self, entry: Mapping[str, Any], key: str, kind: type, parent: str = "") -> Any:
        if key not in entry:
            raise self._error(parent + key, "this entry is missing")
        return self._typed(entry[key], kind, parent + key, f"{kind.__name__}")

    def _typed(self, value: Any, kind: type, field: str, expected: str) -> Any:
        if kind is float and _is_number(value):
            return float(value)
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise self._error(field, f"expected {expected}, got {type(value).__name__}")
        return value

    def _error(self, field: str, problem: str) -> ResultError:
        return ResultError(": ".join(part for part in (self._file, field, problem) if part))


def _owner(robot: Robot, place: int) -> str:
    """Whose the number at a place of a configuration is, for messages; "" for the base's."""
    for name, own in robot.joint_slices.items():
        if own.start <= place < own.stop:
            return f" for joint {name!r}"
    return ""


def _is_number(value: Any) -> bool:
    """Tell whether a value is a number that a double can hold; nan is not."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) <= sys.float_info.max
