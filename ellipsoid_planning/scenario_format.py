"""The scenario format 1 as pydantic models: keys, types and ranges.

What depends on the dimension (vector lengths, orientation forms) is checked where the objects
are built, in `scenario_build`. Later keys are added here as optional fields.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictStr
from pydantic_core import PydanticCustomError

from ellipsoid_planning.scenario_blocks import Block, Body, NotNegative, Vector
from ellipsoid_planning.scenario_format_robot import Pose, RobotBlock


def whole(value: Any) -> Any:
    """Refuse 2.0 and true, which Python holds equal to 2 and 1."""
    if isinstance(value, (bool, float)):
        raise PydanticCustomError("literal_error", "not a whole number")
    return value


class Bounds(Block):
    """The box of the robot's base position."""

    low: Vector
    high: Vector


class PlannerBlock(BaseModel):
    """A planner's name, and its parameters under the planner's own names."""

    model_config = ConfigDict(extra="allow", frozen=True)

    name: StrictStr


class ScenarioModel(Block):
    """A scenario: a world, a robot, and where it should go from where."""

    format: Annotated[Literal[1], BeforeValidator(whole)]
    name: StrictStr
    description: StrictStr = ""
    dimension: Annotated[Literal[2, 3], BeforeValidator(whole)]
    bounds: Bounds
    arena: list[Body] = Field(default=[], description="each must contain the whole robot")
    obstacles: list[Body] = Field(default=[])
    robot: RobotBlock
    clearance: NotNegative = Field(
        0.0, description="distance from obstacles and arenas that every state and motion keeps"
    )
    start: Pose
    goal: Pose
    planner: PlannerBlock | None = None


def scenario_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of the scenario format."""
    schema = ScenarioModel.model_json_schema()
    dialect = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": dialect, **schema, "title": "ellipsoid-planning scenario, format 1"}
