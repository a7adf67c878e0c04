"""Joints: how one link of an articulated robot moves against another."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.orientation import check_rotation, rotation_from_yaw
from ellipsoid_planning.robots import joint_limits
from ellipsoid_planning.sizes import check_coordinates

REVOLUTE = "revolute"
CONTINUOUS = "continuous"
PRISMATIC = "prismatic"
BALL = "ball"
FIXED = "fixed"
JOINT_TYPES = (REVOLUTE, CONTINUOUS, PRISMATIC, BALL, FIXED)
LIMITED = (REVOLUTE, PRISMATIC)

# How many numbers of a configuration a joint of each type takes.
VALUE_COUNTS = {REVOLUTE: 1, CONTINUOUS: 1, PRISMATIC: 1, BALL: 4, FIXED: 0}

TINY = 1e-100
UNIT_ROUNDING = 4.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two links, in the words of URDF.

    The joint's frame stands at ``position`` with ``rotation`` in the parent's frame. The child's
    frame is the joint's frame after the joint's motion: a turn by the joint's value [rad] about
    ``axis`` (revolute, continuous), a shift by it along ``axis`` (prismatic), the rotation of a
    quaternion (x, y, z, w) (ball), nothing (fixed).

    Attributes:
        name, parent, child: names of the joint and of the two links.
        type: one of ``JOINT_TYPES``.
        position: (n,), by default 0.
        rotation: (n, n), by default the identity.
        axis: unit vector in the joint's frame, (n,); by default x, as in URDF. In the plane,
            revolute and continuous joints turn anticlockwise and have none (None).
        lower, upper: the limits of a revolute [rad] or prismatic joint; a continuous joint has
            [-pi, pi], the others none (0, 0).
        notice: what was made of the limits, for whoever wrote them; "" if nothing.

    Limits of a revolute joint that both lie a thousand turns or more from 0 mean none: the joint
    becomes continuous. A joint whose range is at most 1e-12 becomes a fixed one.

    Raises:
        GeometryError: if a value does not fit the type or the dimension.
    """

    name: str
    parent: str
    child: str
    type: str
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    axis: NDArray[np.float64] | None = None
    lower: float = 0.0
    upper: float = 0.0
    notice: str = field(default="", init=False)

    @classmethod
    def of(
        cls,
        name: str,
        parent: str,
        child: str,
        type: str,  # noqa: A002 (URDF's word)
        position: ArrayLike,
        rotation: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        lower: float = 0.0,
        upper: float = 0.0,
    ) -> Joint:
        """A joint from plain numbers; ``axis`` has any length but zero."""
        at = np.array(position, dtype=float)
        turned = np.eye(len(at)) if rotation is None else np.array(rotation, dtype=float)
        direction = None if axis is None else np.array(axis, dtype=float)
        return cls(name, parent, child, type, at, turned, direction, lower, upper)

    def __post_init__(self) -> None:
        if self.type not in JOINT_TYPES:
            raise self._error(f"expected one of {', '.join(JOINT_TYPES)}, got {self.type!r}")
        position = np.array(self.position, dtype=float)
        if position.shape not in ((2,), (3,)) or not np.all(np.isfinite(position)):
            raise self._error(f"expected a position of 2 or 3 finite numbers, got {position}")
        check_coordinates(position, f"joint {self.name!r}: position")
        n = len(position)
        if self.type == BALL and n == 2:
            raise self._error("there are no ball joints in the plane; use a continuous joint")
        self._keep("position", position)
        self._keep("rotation", check_rotation(self.rotation, n))
        self._keep("axis", self._unit_axis(n))
        self._check_limits()

    def _keep(self, name: str, value: NDArray[np.float64] | None) -> None:
        if value is not None:
            value.setflags(write=False)
        object.__setattr__(self, name, value)

    def _unit_axis(self, n: int) -> NDArray[np.float64] | None:
        if self.type in (BALL, FIXED) or (n == 2 and self.type != PRISMATIC):
            return None
        axis = np.eye(n)[0] if self.axis is None else np.array(self.axis, dtype=float)
        largest = float(np.max(np.abs(axis))) if axis.shape == (n,) else 0.0
        if 0.0 < largest < math.inf and not TINY < largest < 1.0 / TINY:
            axis = axis / largest  # squares of its numbers would vanish, or overflow
        length = float(np.linalg.norm(axis)) if axis.shape == (n,) else 0.0
        if not 0.0 < length < math.inf:
            raise self._error(f"expected an axis of {n} numbers other than zero, got {axis}")
        # An axis of unit length keeps its bits, so that a written one reads back as it was.
        return axis if abs(length - 1.0) <= UNIT_ROUNDING else axis / length

    def _check_limits(self) -> None:
        if self.type in LIMITED and not self.lower < self.upper:
            raise self._error(f"expected lower < upper, got {self.lower:g} and {self.upper:g}")
        if self.type == REVOLUTE and joint_limits.is_unlimited(self.lower, self.upper):
            self._become(CONTINUOUS, joint_limits.unlimited_notice(self.lower, self.upper))
        elif self.type in LIMITED:
            revolute = self.type == REVOLUTE
            find = joint_limits.revolute_problem if revolute else joint_limits.shift_problem
            problem = find(self.lower, self.upper)
            if problem is not None:
                raise self._error(problem)
        if self.type in LIMITED and self.upper - self.lower <= joint_limits.NEGLIGIBLE:
            self._fix(self.lower)
        if self.type == CONTINUOUS:
            object.__setattr__(self, "lower", -math.pi)
            object.__setattr__(self, "upper", math.pi)

    def _become(self, kind: str, notice: str) -> None:
        object.__setattr__(self, "type", kind)
        object.__setattr__(self, "notice", f"joint {self.name!r}: {notice}")

    def _fix(self, value: float) -> None:
        """Make this a fixed joint where its value was."""
        notice = joint_limits.fixed_notice(self.lower, self.upper)
        if self.type == PRISMATIC:
            shift = value * np.asarray(self.axis)
            self._keep("position", self.position + self.rotation @ shift)
        elif len(self.position) == 2:
            self._keep("rotation", self.rotation @ rotation_from_yaw(value))
        else:
            turn = np.array(joint_limits.about(tuple(np.asarray(self.axis).tolist()), value))
            self._keep("rotation", self.rotation @ turn)
        self._become(FIXED, notice)
        object.__setattr__(self, "axis", None)
        object.__setattr__(self, "lower", 0.0)
        object.__setattr__(self, "upper", 0.0)

    def _error(self, problem: str) -> GeometryError:
        return GeometryError(f"joint {self.name!r}: {problem}")

    @property
    def value_count(self) -> int:
        """How many numbers of a configuration the joint takes: 0, 1 or 4."""
        return VALUE_COUNTS[self.type]
