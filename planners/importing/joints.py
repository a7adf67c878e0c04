"""Joints of a URDF as joints of a robot of ellipsoids."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError, UrdfError
from ellipsoid_planning.robots.joint import CONTINUOUS, FIXED, LIMITED, PRISMATIC, REVOLUTE, Joint
from planners.importing.report import CARRIED_OVER, JointReport
from planners.importing.urdf_text import Description

Array = NDArray[np.float64]

KNOWN = (REVOLUTE, CONTINUOUS, PRISMATIC, FIXED)
INDEPENDENT = "independent"
HELD = "fixed"
MIMICS = (INDEPENDENT, HELD)


@dataclass(frozen=True, eq=False)
class ConvertedJoint:
    """A joint and what became of it."""

    joint: Joint
    report: JointReport


def converted_joints(
    description: Description, joints: list[Any], mimic: str
) -> list[ConvertedJoint]:
    """Convert yourdfpy's joints.

    A joint whose limits are equal is fixed there. The coupling of a mimic joint is dropped, which
    loses no configuration of the robot but adds others ("independent"), or the joint is fixed
    where its leader's value is 0 ("fixed").

    Raises:
        UrdfError: naming the joint: its type is not supported, or its numbers make no joint.
    """
    unknown = [joint for joint in joints if joint.type not in KNOWN]
    if unknown:
        names = ", ".join(f"{joint.name!r} ({joint.type})" for joint in unknown)
        raise UrdfError(
            f"{description.file}: expected joints of the types {', '.join(KNOWN)}, got {names}; "
            "replace them in the URDF; a base that moves freely is had with --base free"
        )
    try:
        return [
            _converted(joint, mimic, description.dropped.get(joint.name, ())) for joint in joints
        ]
    except GeometryError as error:
        raise UrdfError(f"{description.file}: {error}") from None


def _converted(source: Any, mimic: str, dropped: tuple[str, ...]) -> ConvertedJoint:
    pose = np.eye(4) if source.origin is None else source.origin
    lower, upper = _limits(source)
    coupled = source.mimic is not None and source.type != FIXED
    held = None
    if coupled and mimic == HELD:
        held = float(source.mimic.offset)
    elif source.type in LIMITED and lower == upper:
        held = lower
    axis = None if source.type == FIXED else source.axis
    free_lower, free_upper = (lower, upper) if held is None else (-1.0, 1.0)
    limits = (free_lower, free_upper) if source.type in LIMITED else (0.0, 0.0)
    ends = source.name, source.parent, source.child
    joint = Joint.of(*ends, source.type, pose[:3, 3], pose[:3, :3], axis, *limits)
    if held is not None:
        joint = _held(joint, held)
    fate = _fate(source, held, coupled=coupled)
    if joint.notice:  # limits that mean none, or leave one value
        said = joint.notice.partition(": ")[2]
        fate = said if fate == CARRIED_OVER else f"{fate}; {said}"
    report = JointReport(source.name, source.type, fate, dropped)
    return ConvertedJoint(joint, report)


def _limits(source: Any) -> tuple[float, float]:
    """The limits [rad or length]; URDF's default of either is 0."""
    if source.type not in LIMITED:
        return 0.0, 0.0
    if source.limit is None:
        raise GeometryError(
            f"joint {source.name!r}: a {source.type} joint needs <limit lower upper>"
        )
    lower, upper = source.limit.lower or 0.0, source.limit.upper or 0.0
    if not lower <= upper or (lower == upper and math.isinf(lower)):
        raise GeometryError(
            f"joint {source.name!r}: expected limits with lower <= upper, "
            f"got {lower:g} and {upper:g}"
        )
    return lower, upper


def _held(joint: Joint, value: float) -> Joint:
    """The joint fixed at a value."""
    shift, turn = joint.position, joint.rotation
    if joint.type == PRISMATIC:
        shift = shift + turn @ (value * np.asarray(joint.axis))
    else:
        turn = turn @ _about(np.asarray(joint.axis), value)
    return Joint.of(joint.name, joint.parent, joint.child, FIXED, shift, turn)


def _about(axis: Array, angle: float) -> Array:
    """The rotation (3, 3) by an angle [rad] about a unit vector (Rodrigues' formula)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def _fate(source: Any, held: float | None, *, coupled: bool) -> str:
    if coupled:
        leader = f"mimics {source.mimic.joint!r}"
        return f"{leader}: coupling dropped" if held is None else f"{leader}: fixed at {held:g}"
    if held is None:
        return CARRIED_OVER
    if source.limit.lower is None and source.limit.upper is None:
        return "no lower and upper limit, which URDF takes for 0: fixed at 0"
    return f"limits are equal: fixed at {held:g}"
