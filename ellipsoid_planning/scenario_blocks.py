"""The pieces that the blocks of the scenario format are made of, as pydantic models."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, Field, StrictStr, model_validator
from pydantic_core import PydanticCustomError

from ellipsoid_planning.sizes import LEAST_LENGTH, MOST_LENGTH

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Coordinate = Annotated[
    float, Field(strict=True, allow_inf_nan=False, ge=-MOST_LENGTH, le=MOST_LENGTH)
]
Positive = Annotated[
    float, Field(strict=True, allow_inf_nan=False, gt=0.0, ge=LEAST_LENGTH, le=MOST_LENGTH)
]
NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0, le=MOST_LENGTH)]
Vector = Annotated[list[Coordinate], Field(min_length=2, max_length=3)]
Direction = Annotated[list[Number], Field(min_length=2, max_length=3)]
Name = Annotated[StrictStr, Field(min_length=1)]
Triple = Annotated[list[Number], Field(min_length=3, max_length=3)]


class Block(BaseModel):
    """A mapping of the file whose keys are all known.

    Attributes:
        misplaced: keys that belong elsewhere, and what to do with them.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    misplaced: ClassVar[Mapping[str, str]] = {}

    @model_validator(mode="before")
    @classmethod
    def _check_keys(cls, data: Any) -> Any:
        """Refuse unknown, missing and empty keys with a suggestion, before anything else."""
        if isinstance(data, Mapping):
            for key, value in data.items():
                cls._check_key(key, value)
            for key, field in cls.model_fields.items():
                if field.is_required() and key not in data:
                    raise PydanticCustomError("missing_key", "missing", {"key": key})
        return data

    @classmethod
    def _check_key(cls, key: Any, value: Any) -> None:
        if key in cls.misplaced:
            context = {"key": key, "remedy": cls.misplaced[key]}
            raise PydanticCustomError("misplaced_key", "misplaced", context)
        if key not in cls.model_fields:
            known = sorted(cls.model_fields)
            close = difflib.get_close_matches(str(key), known, n=1)
            context = {"key": key, "known": known, "close": close}
            raise PydanticCustomError("unknown_key", "unknown", context)
        if value is None:
            raise PydanticCustomError("empty_key", "empty", {"key": key})


class AxisAngle(Block):
    """A turn about an axis, of any length but zero, by an angle in degrees."""

    axis: Triple
    angle_deg: Number


class Orientation(Block):
    """Exactly one of the forms: yaw_deg in 2-D, the others in 3-D."""

    yaw_deg: Number | None = Field(None, description="2-D: heading in degrees, anticlockwise")
    quaternion: Annotated[list[Number], Field(min_length=4, max_length=4)] | None = Field(
        None, description="3-D: unit quaternion [x, y, z, w]"
    )
    rpy_deg: Triple | None = Field(None, description="3-D: R = Rz(yaw) Ry(pitch) Rx(roll)")
    axis_angle: AxisAngle | None = Field(None, description="3-D: axis and angle")
    euler_zxz_deg: Triple | None = Field(
        None, description="3-D: R = Rz(first) Rx(second) Rz(third)"
    )

    @model_validator(mode="after")
    def _check_one_form(self) -> Orientation:
        forms = sorted(self.model_fields_set)
        if len(forms) != 1:
            raise PydanticCustomError("forms", "forms", {"forms": forms})
        return self


class Body(Block):
    """One ellipsoid: an obstacle, an arena or a part of the robot."""

    name: StrictStr = ""
    semi_axes: Annotated[list[Positive], Field(min_length=2, max_length=3)]
    position: Vector | None = Field(None, description="centre; the origin by default")
    orientation: Orientation | None = None
