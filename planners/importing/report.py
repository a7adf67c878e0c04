"""What became of a robot when it was imported."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.scenario_write import robot_document

CARRIED_OVER = "carried over"


@dataclass(frozen=True)
class LinkReport:
    """How closely a link is enclosed.

    Attributes:
        name: the link's.
        solids: how many collision shapes it has.
        vertices: how many vertices of meshes and boxes were checked to be inside.
        parts: how many ellipsoids enclose it.
        volume: of their union: exact for one, to about one per cent for several.
        hull_volume: of the convex hull of the link's geometry; 0 for flat or no geometry.
    """

    name: str
    solids: int
    vertices: int
    parts: int
    volume: float
    hull_volume: float

    @property
    def excess(self) -> float | None:
        """The volume divided by that of the convex hull; None for flat or no geometry."""
        return self.volume / self.hull_volume if self.hull_volume > 0.0 else None


@dataclass(frozen=True)
class JointReport:
    """What became of a joint.

    Attributes:
        name: the joint's.
        type: its type in the URDF.
        fate: "carried over", or what was changed and why.
        dropped: what else is said of it, which plans do not heed: "velocity", "effort" and such.
    """

    name: str
    type: str
    fate: str
    dropped: tuple[str, ...] = ()

    @property
    def changed(self) -> bool:
        """Whether the joint is another one now."""
        return self.fate != CARRIED_OVER


@dataclass(frozen=True, eq=False)
class ImportedRobot:
    """A robot and how it compares with its description.

    Attributes:
        name: the robot's.
        robot: made of ellipsoids.
        links, joints: in the description's order.
        ignored: pairs of links whose ellipsoids always touch; the robot ignores them.
        touching: further pairs whose ellipsoids touch at the zero pose.
    """

    name: str
    robot: ArticulatedRobot
    links: tuple[LinkReport, ...]
    joints: tuple[JointReport, ...]
    ignored: tuple[tuple[str, str], ...]
    touching: tuple[tuple[str, str], ...]

    @property
    def excess(self) -> float | None:
        """The volume of all ellipsoids divided by that of all convex hulls."""
        hulls = sum(link.hull_volume for link in self.links)
        return sum(link.volume for link in self.links) / hulls if hulls > 0.0 else None

    def document(self) -> dict[str, Any]:
        """The robot as the entry ``robot`` of a scenario."""
        return {"robot": robot_document(self.robot)}

    def to_dict(self) -> dict[str, Any]:
        """The report as plain data that JSON can hold."""
        return {
            "name": self.name,
            "base": self.robot.base,
            "volume_excess": self.excess,
            "links": [{**asdict(link), "volume_excess": link.excess} for link in self.links],
            "joints": [{**asdict(joint), "dropped": list(joint.dropped)} for joint in self.joints],
            "ignored_self_collision": [list(pair) for pair in self.ignored],
            "touching_at_zero": [list(pair) for pair in self.touching],
        }
