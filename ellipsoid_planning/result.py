"""What a planner found: the path and its proof's numbers, as a value and as a JSON file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning import __version__, atomic, input_files
from ellipsoid_planning.errors import ResultError
from ellipsoid_planning.metric import base_travel, path_length
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.whole_characters import PROBLEM, halved_text

FORMAT = 1
TIMES = ("planning", "simplification", "total", "build", "search")
STATUSES = ("solved", "timeout", "exhausted", "invalid_start", "invalid_goal")


@dataclass(frozen=True, eq=False)
class PathResult:
    """A path through the configuration space.

    Attributes:
        configurations: (m, d), read-only, m >= 1; between two of them the motion is OMPL's
            own interpolation.
        length: OMPL's path length.
        base_travel: how far the robot's base travels, in the scenario's unit of length.
        min_clearance: a proved lower bound of the distance to obstacles and arena boundary
            along the path; infinite when there are neither. Not certified: 0, or less where
            the path was seen to meet them.
        certified: True if every motion is proved collision-free in continuous time.
    """

    configurations: NDArray[np.float64]
    length: float
    base_travel: float
    min_clearance: float
    certified: bool

    def __post_init__(self) -> None:
        configurations = np.array(self.configurations, dtype=float)
        if configurations.ndim != 2 or len(configurations) == 0:
            raise ResultError(
                f"expected a path of one or more configurations, got shape {configurations.shape}"
            )
        configurations.setflags(write=False)
        object.__setattr__(self, "configurations", configurations)

    @classmethod
    def from_configurations(
        cls,
        robot: Robot,
        configurations: ArrayLike,
        *,
        min_clearance: float,
        certified: bool,
    ) -> PathResult:
        """Build from the configurations (m, d), measuring length and base travel."""
        path = np.array(configurations, dtype=float)
        length, travel = path_length(robot, path), base_travel(robot, path)
        return cls(path, length, travel, min_clearance, certified)

    def to_dict(self) -> dict[str, Any]:
        """Return the ``path`` entry of a result file; an infinite clearance becomes null."""
        clearance = self.min_clearance if math.isfinite(self.min_clearance) else None
        return {
            "configurations": self.configurations.tolist(),
            "length": self.length,
            "base_travel": self.base_travel,
            "min_clearance": clearance,
            "certified": self.certified,
        }


@dataclass(frozen=True, eq=False)
class PlanResult:
    """The outcome of one planning run.

    Attributes:
        scenario: the problem that was planned.
        planner: the planner's name.
        status: one of `STATUSES`; "solved" exactly when there is a path.
        seed: the seed of the run, None when none was set.
        time: seconds: "planning", of the planner alone; "simplification", of shortening the path
            afterwards, None if that was not done; "total", their sum; "build" and "search", parts
            of the planning, None when the planner cannot tell them apart.
        path: the path, None when none was found.
        statistics: the planner's own counts, data that JSON can hold.
        version: the version of this package that planned.
    """

    scenario: Scenario
    planner: str
    status: str
    seed: int | None = None
    time: Mapping[str, float | None] = field(default_factory=dict)
    path: PathResult | None = None
    statistics: Mapping[str, Any] = field(default_factory=dict)
    version: str = __version__

    def __post_init__(self) -> None:
        if self.status not in STATUSES:
            raise ResultError(f"expected a status among {STATUSES}, got {self.status!r}")
        if (self.status == "solved") != (self.path is not None):
            raise ResultError(f"expected a path exactly when solved, got status {self.status!r}")
        size = self.scenario.robot.configuration_size
        if self.path is not None and self.path.configurations.shape[1] != size:
            got = self.path.configurations.shape[1]
            raise ResultError(f"expected configurations of {size} numbers, got {got}")
        time = {key: self.time.get(key) for key in TIMES}
        object.__setattr__(self, "time", time)

    @property
    def solved(self) -> bool:
        """True if a path was found."""
        return self.path is not None

    def to_dict(self) -> dict[str, Any]:
        """Return the result in its file format, as data for JSON.

        A configuration is the base, then the values of the joints in the order of the path's
        ``joints``, which only the path of a robot with joints has.
        """
        path = None if self.path is None else self.path.to_dict()
        names = joint_names(self.scenario.robot)
        if path is not None and names:
            path = {"joints": names, **path}
        return {
            "format": FORMAT,
            "scenario": self.scenario.to_dict(),
            "planner": self.planner,
            "seed": self.seed,
            "status": self.status,
            "time": dict(self.time),
            "path": path,
            "statistics": dict(self.statistics),
            "version": self.version,
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], file: str | None = None) -> PlanResult:
        """Return the result of a document in the file format; `file` is for messages.

        Raises:
            ResultError: if an entry is missing, wrong, or contradicts the path.
        """
        from ellipsoid_planning.result_format import result_fields

        return cls(**result_fields(data, file))

    def to_json(self) -> str:
        """Return the result as JSON text."""
        return json.dumps(self.to_dict(), indent=1, allow_nan=False, default=_plain) + "\n"

    def save(self, path: str | Path) -> None:
        """Write the result to a JSON file, completely or not at all.

        Raises:
            ResultError: if the file cannot be written; the message names it.
        """
        text = self.to_json()
        folder = Path(path).parent
        if not folder.is_dir():
            raise ResultError(f"{path}: the folder {str(folder)!r} does not exist; create it first")
        try:
            atomic.write_text(path, text)
        except OSError as error:
            raise ResultError(f"{path}: cannot write the file: {error.strerror}") from None


def load_result(path: str | Path) -> PlanResult:
    """Return the result of a JSON file, its lengths recomputed from the path and compared.

    Raises:
        ResultError: if the file cannot be read, is no result, or contradicts itself.
    """
    try:
        text = input_files.read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise ResultError(f"{path}: cannot read the result: {reason}") from None
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:  # also an integer of thousands of digits
        place = f":{error.lineno}:{error.colno}" if isinstance(error, json.JSONDecodeError) else ""
        raise ResultError(f"{path}{place}: broken JSON; plan again to get a whole file") from None
    if halved_text(text, data) is not None:
        raise ResultError(f"{path}: {PROBLEM}")
    return PlanResult.from_dict(data, str(path))


def joint_names(robot: Robot) -> list[str]:
    """Names of the joints in the order of configurations; none of a rigid robot."""
    return list(robot.joint_slices)


def _plain(value: Any) -> Any:
    """Return numpy's numbers and arrays, which statistics may hold, as Python's."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"expected data that JSON can hold, got {type(value).__name__}")
