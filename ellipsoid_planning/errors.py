"""The exceptions of this package, all under one base class.

Catch `EllipsoidPlanningError` to catch everything that a user's input can cause.
"""

from __future__ import annotations


class EllipsoidPlanningError(Exception):
    """Base class of every error that this package raises on purpose."""


class GeometryError(EllipsoidPlanningError, ValueError):
    """Numbers that describe no ellipsoid, robot or world, or an empty construction."""


class GridError(EllipsoidPlanningError, ValueError):
    """A grid or group of rotations or motions that does not exist, or has no such size."""


class RobotError(GeometryError):
    """Links and joints that make no robot.

    Attributes:
        path: where in the robot the fault is, such as ("joints", 1, "parent"); empty for the
            robot as a whole.
    """

    def __init__(self, problem: str, path: tuple[str | int, ...] = ()) -> None:
        super().__init__(problem)
        self.path = path


class ScenarioError(EllipsoidPlanningError):
    """A scenario that cannot be read, or that asks for something impossible.

    Attributes:
        problem: what was expected, what came and the remedy, without the place.
        file: path of the scenario file, None for a scenario built in Python.
        field: dotted path such as ``robot.parts[1].semi_axes``, None for the whole file.
        line: line in the file, counted from 1, None where it is not known.
        column: column in that line, counted from 1, None where it is not known.
    """

    def __init__(
        self,
        problem: str,
        *,
        file: str | None = None,
        field: str | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        self.problem = problem
        self.file = file
        self.field = field
        self.line = line
        self.column = column
        super().__init__(self._message())

    def _message(self) -> str:
        place = self.file or ""
        if self.line is not None:
            place += f":{self.line}" if place else f"line {self.line}"
            place += f":{self.column}" if self.column is not None else ""
        return ": ".join(part for part in (place, self.field, self.problem) if part)

    def __reduce__(self) -> tuple[object, ...]:
        place = (self.file, self.field, self.line, self.column)
        return _rebuild_scenario_error, (self.problem, *place)


def _rebuild_scenario_error(
    problem: str, file: str | None, field: str | None, line: int | None, column: int | None
) -> ScenarioError:
    return ScenarioError(problem, file=file, field=field, line=line, column=column)


class FamilyError(EllipsoidPlanningError):
    """An unknown family of scenarios, or a clearance, dimension or seed that it does not have."""


class UrdfError(EllipsoidPlanningError):
    """A URDF, or a mesh of it, that cannot be read, or that robots of ellipsoids cannot follow."""


class CrystalError(EllipsoidPlanningError):
    """A space group, cell, packing model or diffraction data that contradicts itself or another."""


class PlannerError(EllipsoidPlanningError):
    """An unknown planner, an unknown parameter, or a parameter out of its range."""


class RoadmapError(EllipsoidPlanningError):
    """A roadmap's file that cannot be read or written, or that does not belong to the scene."""


class TableError(EllipsoidPlanningError):
    """A safety function's table that cannot be made, read or written, or is another link's."""


class ResultError(EllipsoidPlanningError):
    """A result file that cannot be read, or that contradicts itself."""


class ContradictionError(ResultError):
    """A well-formed result whose numbers contradict its own path: someone changed the file."""
