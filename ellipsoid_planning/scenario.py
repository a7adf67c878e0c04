"""Scenarios: a world, a robot, and where it should go from where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_origin import Origin
from ellipsoid_planning.sizes import MOST_LENGTH
from ellipsoid_planning.world import World

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace


@dataclass(frozen=True, eq=False)
class Scenario:
    """One planning problem, read from a file or built in Python.

    Attributes:
        name: a short name.
        world: obstacles, arenas and bounds, in the world frame.
        robot: the robot, in its base frame, or in the frames of its links.
        start, goal: configurations (d,), see `RigidRobot` and `ArticulatedRobot`; headings
            and values of continuous joints [rad] are brought into [-pi, pi), quaternions
            (x, y, z, w) to unit length, and joints must keep their limits.
        clearance: the distance that every state and motion keeps, at least 0.
        planner: empty, or a planner's ``name`` and its parameters.
        description: what the scenario is about.
        origin: the file it was read from, for messages and for writing it back.

    Raises:
        ScenarioError: if the pieces do not fit together. Whether start and goal are free is
            another question, for `scenario_checks.check_endpoints`.
    """

    name: str
    world: World
    robot: RigidRobot | ArticulatedRobot
    start: NDArray[np.float64]
    goal: NDArray[np.float64]
    clearance: float = 0.0
    planner: Mapping[str, Any] = field(default_factory=dict)
    description: str = ""
    origin: Origin = field(default_factory=Origin, repr=False)

    def __post_init__(self) -> None:
        from ellipsoid_planning.scenario_configuration import normalised_configuration
        from ellipsoid_planning.scenario_scale import check_scale

        if self.world.dimension != self.robot.dimension:
            raise self.origin.error(
                ("robot",),
                f"expected a robot of dimension {self.world.dimension} as the world, "
                f"got {self.robot.dimension}",
            )
        if not 0.0 <= self.clearance <= MOST_LENGTH:
            problem = f"expected a clearance from 0 to {MOST_LENGTH:g}, got {self.clearance}"
            raise self.origin.error(("clearance",), problem)
        check_scale(self.world, self.robot, self.origin)
        for which in ("start", "goal"):
            given = getattr(self, which)
            configuration = normalised_configuration(self.robot, given, which, self.origin)
            configuration.setflags(write=False)
            object.__setattr__(self, which, configuration)
        object.__setattr__(self, "clearance", float(self.clearance))
        object.__setattr__(self, "planner", MappingProxyType(dict(self.planner)))

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "planner": dict(self.planner)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, planner=MappingProxyType(state["planner"]))

    @property
    def dimension(self) -> int:
        """The dimension n of the world, 2 or 3."""
        return self.world.dimension

    @property
    def notices(self) -> tuple[str, ...]:
        """What was taken for something else than it says, for whoever wrote the scenario."""
        return tuple(joint.notice for joint in self.robot.joints if joint.notice)

    @property
    def file(self) -> str | None:
        """The file that the scenario was read from, None when it was built in Python."""
        return self.origin.file

    def cspace(self) -> CSpace:
        """Return the configuration space of the robot in the world, with the clearance."""
        from ellipsoid_planning.cspace.space import CSpace

        return CSpace(self.world, self.robot, self.clearance)

    def to_dict(self) -> dict[str, Any]:
        """Return the scenario in the file format, complete, as data for JSON or YAML.

        `from_dict` gives it back; bodies and configurations that were read from a file come
        back to the last bit, orientations that were computed in Python to rounding.
        """
        from ellipsoid_planning.scenario_write import scenario_document

        return scenario_document(self)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], file: str | None = None) -> Scenario:
        """Return the scenario of a document in the file format; `file` is for messages.

        Raises:
            ScenarioError: at the first thing that is wrong with the document.
        """
        return cls._from_document(data, Origin(file))

    @classmethod
    def _from_document(cls, data: Any, origin: Origin) -> Scenario:
        from ellipsoid_planning.scenario_build import scenario_parts

        return cls(**scenario_parts(data, origin))


def load_scenario(path_or_name: str | Path) -> Scenario:
    """Return the scenario of a YAML file, or of a bundled scenario's name.

    Raises:
        ScenarioError: with file, field, line and column at the first thing that is wrong.
    """
    from ellipsoid_planning.scenario_files import locate, read_document

    data, origin = read_document(locate(path_or_name))
    return Scenario._from_document(data, origin)  # noqa: SLF001 (same module)


def bundled_scenarios() -> dict[str, Path]:
    """Return the files of the bundled scenarios by name, in alphabetical order."""
    from ellipsoid_planning import scenario_files

    return scenario_files.bundled_scenarios()


def scenario_schema() -> dict[str, Any]:
    """Return the JSON schema of the scenario format."""
    from ellipsoid_planning import scenario_format

    return scenario_format.scenario_schema()


__all__ = ["Scenario", "ScenarioError", "bundled_scenarios", "load_scenario", "scenario_schema"]
