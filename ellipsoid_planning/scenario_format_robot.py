"""The robots of the scenario format as pydantic models: rigid ones, and trees of links.

What depends on the dimension or on a joint's type is checked where robots are built, in
`scenario_robot` and `scenario_joints`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, StrictBool, StrictStr, Tag

from ellipsoid_planning.scenario_blocks import (
    Block,
    Body,
    Direction,
    Name,
    Number,
    Orientation,
    Vector,
)

# pydantic notes a union's branch in the place of an error; messages leave these steps out.
RIGID, ARTICULATED = "<rigid>", "<articulated>"
NUMBER, ORIENTATION = "<number>", "<orientation>"
TAGS = frozenset({RIGID, ARTICULATED, NUMBER, ORIENTATION})

EITHER = "a robot has either parts (rigid) or links (articulated)"


class RigidBlock(Block):
    """A rigid union of ellipsoids, in its base frame."""

    misplaced: ClassVar[Mapping[str, str]] = {
        "joints": f"{EITHER}, and only links have joints; put the parts into links",
        "base": f"{EITHER}; with parts, write rotates: true or false in place of base",
        "ignore_self_collision": f"{EITHER}; parts of a rigid robot never collide, remove this",
    }

    rotates: StrictBool = True
    parts: Annotated[list[Body], Field(min_length=1)]


class LinkBlock(Block):
    """A rigid piece of an articulated robot, in its own frame; it may have no parts."""

    name: Name
    parts: list[Body] = Field(default=[])


class JointOrigin(Block):
    """The pose of a joint's frame in its parent's frame."""

    position: Vector | None = Field(None, description="the parent's origin by default")
    orientation: Orientation | None = None


class JointLimit(Block):
    """The range of a joint's value: in degrees for a revolute joint, else lengths."""

    lower_deg: Number | None = Field(None, description="revolute: smallest angle in degrees")
    upper_deg: Number | None = Field(None, description="revolute: largest angle in degrees")
    lower: Number | None = Field(None, description="prismatic: smallest shift")
    upper: Number | None = Field(None, description="prismatic: largest shift")


class JointBlock(Block):
    """A joint between two links, in the words of URDF."""

    name: Name
    type: Literal["revolute", "continuous", "prismatic", "ball", "fixed"]
    parent: StrictStr
    child: StrictStr
    origin: JointOrigin | None = None
    axis: Direction | None = Field(
        None,
        description="in the joint's frame, of any length but zero, x by default; not for ball "
        "and fixed joints, nor for joints that turn in the plane",
    )
    limit: JointLimit | None = Field(None, description="required for revolute and prismatic")


Pair = Annotated[list[StrictStr], Field(min_length=2, max_length=2)]


class ArticulatedBlock(Block):
    """A tree of links on a base that flies freely, only translates, or is fixed."""

    misplaced: ClassVar[Mapping[str, str]] = {
        "parts": f"{EITHER}, got both; put the parts into links, or remove links and joints",
        "rotates": "a robot with links has a base in place of rotates; write base: free, "
        "translating or fixed",
    }

    base: Literal["free", "translating", "fixed"] = "free"
    links: Annotated[list[LinkBlock], Field(min_length=1)]
    joints: list[JointBlock] = Field(default=[], description="hang every link but one on another")
    ignore_self_collision: list[Pair] = Field(
        default=[],
        description="pairs of links that are never looked at for self-collision, besides those "
        "that share a joint",
    )


def _robot_tag(value: Any) -> str:
    if isinstance(value, ArticulatedBlock):
        return ARTICULATED
    if not isinstance(value, Mapping):
        return RIGID
    joined = "parts" not in value and ("joints" in value or "base" in value)
    return ARTICULATED if "links" in value or joined else RIGID


RobotBlock = Annotated[
    Annotated[RigidBlock, Tag(RIGID)] | Annotated[ArticulatedBlock, Tag(ARTICULATED)],
    Discriminator(_robot_tag),
]


def _value_tag(value: Any) -> str:
    return ORIENTATION if isinstance(value, (Mapping, Orientation)) else NUMBER


JointValue = Annotated[
    Annotated[Number, Tag(NUMBER)] | Annotated[Orientation, Tag(ORIENTATION)],
    Discriminator(_value_tag),
]


class Pose(Block):
    """Where the robot is: its base's pose in the world frame, and its joints' values."""

    position: Vector | None = Field(
        None,
        description="required, but with a fixed base: there start's is the origin by default, "
        "and goal's is start's",
    )
    orientation: Orientation | None = None
    joints: dict[StrictStr, JointValue] = Field(
        default={},
        description="NAME_deg: angle in degrees (revolute, continuous), NAME: shift (prismatic), "
        "NAME: orientation (ball); joints that are not named stand at zero",
    )
