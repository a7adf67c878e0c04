"""The format of packing models and of targets as pydantic models: keys, types and ranges."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, StrictStr, WithJsonSchema
from pydantic_core import PydanticCustomError

from ellipsoid_planning.scenario_blocks import Block, Name, NotNegative, Number
from ellipsoid_planning.scenario_format import whole
from ellipsoid_planning.scenario_format_robot import RobotBlock

# Cells and steps have ranges of their own (see model_build).
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0.0)]
Lengths = Annotated[list[Positive], Field(min_length=2, max_length=3)]


GROUP = {"anyOf": [{"type": "string"}, {"type": "integer"}]}


def group_name(value: Any) -> str:
    """A group's symbol or number as text; numbers such as 19.0 and true are none."""
    if isinstance(value, str) or (isinstance(value, int) and not isinstance(value, bool)):
        return str(value)
    raise PydanticCustomError("group", "a group's symbol such as P212121, or its number")


class CellBlock(Block):
    """The unit cell's parameters; right angles by default."""

    lengths: Lengths
    angles_deg: Annotated[list[Positive], Field(min_length=1, max_length=3)] | None = None


class RangeBlock(Block):
    """The values of one coordinate that are searched, in its unit (degrees for an angle).

    ``nodes`` says where in the steps the values stand: in the middle of each (``centres``), or at
    their ends (``ends``), both limits included.
    """

    lower: Number | None = None
    upper: Number | None = None
    step: Positive
    nodes: Literal["centres", "ends"] = "centres"


class OrientationBlock(Block):
    """Which orientations of the molecule are searched: ranges of angles, or a grid by name."""

    yaw_deg: RangeBlock | None = Field(None, description="2-D: the heading")
    euler: StrictStr = Field("ZXZ", description="3-D: axes of the three turns, intrinsic")
    alpha_deg: RangeBlock | None = Field(None, description="3-D: the first turn")
    beta_deg: RangeBlock | None = Field(None, description="3-D: the second turn")
    gamma_deg: RangeBlock | None = Field(None, description="3-D: the third turn")
    grid: StrictStr | None = Field(None, description="3-D: all rotations, by a grid of this name")
    resolution_deg: Positive | None = Field(None, description="3-D: how fine that grid is")


class PositionBlock(Block):
    """Along which of the cell's axes the molecule's base is shifted, and by how much."""

    x: RangeBlock | None = None
    y: RangeBlock | None = None
    z: RangeBlock | None = None


class PackingBlock(Block):
    """What counts as a packing."""

    overlap: NotNegative = Field(
        default=0.0, description="how deep parts may reach into each other in a free arrangement"
    )


class SearchBlock(Block):
    """The grid of arrangements; what is not named does not move (joints: stand at zero)."""

    slack: NotNegative = Field(
        default=0.0,
        description="how much deeper at the grid's nodes, which only lie near free ones",
    )
    position: PositionBlock = PositionBlock()
    orientation: OrientationBlock | None = None
    joints: dict[StrictStr, RangeBlock] = Field(
        default={}, description="NAME_deg (an angle) or NAME (a shift); limits are the joint's"
    )


class DiffractionBlock(Block):
    """What is compared with the data."""

    resolution: Positive = Field(description="smallest spacing of the lattice planes, d_min")
    densities: dict[StrictStr, Positive] = Field(
        default={}, description="electrons per volume of a link by name, 1 by default"
    )


class PackingModelBlock(Block):
    """A packing model: a molecule, its cell and group, and the arrangements to search."""

    misplaced: ClassVar[Mapping[str, str]] = {
        "robot": "a packing model has a molecule; rename this key to molecule"
    }

    format: Annotated[Literal[1], BeforeValidator(whole)]
    name: Name
    description: StrictStr = ""
    dimension: Annotated[Literal[2, 3], BeforeValidator(whole)]
    group: Annotated[str, BeforeValidator(group_name), WithJsonSchema(GROUP)]
    cell: CellBlock
    molecule: RobotBlock
    packing: PackingBlock = PackingBlock(overlap=0.0)
    search: SearchBlock
    diffraction: DiffractionBlock


class TargetBlock(Block):
    """A target: the arrangement whose magnitudes are to be found again."""

    format: Annotated[Literal[1], BeforeValidator(whole)]
    name: Name
    description: StrictStr = ""
    configuration: dict[StrictStr, Number] = Field(
        description="every coordinate of the model by its key: x, alpha_deg, left_ear_deg, ..."
    )


def packing_model_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of packing models."""
    return _schema(PackingModelBlock, "packing model")


def target_schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of targets."""
    return _schema(TargetBlock, "target")


def _schema(block: type[Block], what: str) -> dict[str, Any]:
    dialect = "https://json-schema.org/draft/2020-12/schema"
    title = f"ellipsoid-planning {what}, format 1"
    return {"$schema": dialect, **block.model_json_schema(), "title": title}
