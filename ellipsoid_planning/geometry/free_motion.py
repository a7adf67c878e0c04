"""The volume of free motion of an ellipsoid among ellipsoids in an ellipsoid (thesis 5.5.2).

The motions that keep the robot in the arena, less those that meet each obstacle. Every term is
a kinematic formula, so that the result is a closed form where the robot rolls freely in the
arena. It is the volume of free motion when the robot can never meet two obstacles at once, nor
an obstacle and the arena's boundary.

Where it can, some motions are subtracted twice, or although they leave the arena: then the
result is a lower bound. (The thesis says upper; the subtracted sets overlap, so that their union
is smaller than their sum.) Subtracting only obstacles that are apart gives an upper bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.affine import ellipsoid_from_factor
from ellipsoid_planning.geometry.clearance import inner_clearance
from ellipsoid_planning.geometry.dual import gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_same_dimension
from ellipsoid_planning.geometry.motion_volume import (
    MotionVolume,
    contained_motions,
    meeting_motions,
)
from ellipsoid_planning.geometry.rotation_ranges import RotationRange, single_rotation

Array = NDArray[np.float64]
CLEARANCE_TOLERANCE = 1e-9
ARENA = "the arena's boundary"


@dataclass(frozen=True)
class Separation:
    """Whether the robot is too short to reach two things at once.

    Attributes:
        first: an obstacle's name, or "obstacle 0" by its place.
        second: another's, or "the arena's boundary".
        distance: between them, in lengths; if the robot only translates, in units of the robot
            (where it is the unit ball).
        needed: the robot's length, which the distance must reach.
    """

    first: str
    second: str
    distance: float
    needed: float

    @property
    def holds(self) -> bool:
        """Whether the robot never reaches both."""
        return self.distance >= self.needed


@dataclass(frozen=True, eq=False)
class FreeMotionVolume:
    """The volume of the motions that keep a robot in the arena and off all obstacles.

    Attributes:
        value: contained less all blocked, at least 0.
        kind: "exact" if the conditions hold, up to the error of `contained` where that is no
            closed form; else "lower".
        upper: an upper bound; equal to `value` if that is exact.
        contained: the motions that keep the robot in the arena.
        blocked: the motions that meet each obstacle, in order; 0 for obstacles outside the arena.
        failing: the conditions for equality that do not hold.
    """

    value: float
    kind: Literal["exact", "lower"]
    upper: float
    contained: MotionVolume
    blocked: tuple[float, ...]
    failing: tuple[Separation, ...]

    @property
    def fraction(self) -> float:
        """`value` as a fraction of the motions that keep the robot in the arena."""
        return self.value / self.contained.value if self.contained.value > 0.0 else 0.0


def free_motion_volume(
    arena: Ellipsoid,
    obstacles: Sequence[Ellipsoid],
    robot: Ellipsoid,
    *,
    rotates: bool = True,
    rotations: RotationRange | None = None,
) -> FreeMotionVolume:
    """Return the volume of free motion, or bounds of it.

    Args:
        arena: what the robot must stay in.
        obstacles: what it must not meet; those outside the arena do not count.
        robot: at its orientation before it is rotated; where it is does not matter.
        rotates: whether it rotates; if not, the volume is that of its positions (n,).
        rotations: a restricted range of rotations; None for all.

    Raises:
        GeometryError: if the dimensions differ.
    """
    for body in (*obstacles, robot):
        check_same_dimension(arena, body)
    if not rotates:
        rotations = single_rotation(np.eye(arena.dimension))
    contained = contained_motions(arena, robot, rotations)
    inside = [gap(arena, obstacle).value <= 0.0 for obstacle in obstacles]
    blocked = tuple(
        meeting_motions(obstacle, robot, rotations).value if counts else 0.0
        for obstacle, counts in zip(obstacles, inside, strict=True)
    )
    conditions = _conditions(arena, obstacles, robot, inside, rotates)
    failing = {pair: c for pair, c in conditions.items() if not c.holds}
    value = max(contained.value - sum(blocked), 0.0)
    upper = contained.value - _apart(blocked, failing)
    return FreeMotionVolume(
        value,
        "lower" if failing else "exact",
        max(upper, value) if failing else value,
        contained,
        blocked,
        tuple(failing.values()),
    )


def _conditions(
    arena: Ellipsoid,
    obstacles: Sequence[Ellipsoid],
    robot: Ellipsoid,
    inside: Sequence[bool],
    rotates: bool,
) -> dict[tuple[int, int], Separation]:
    """The conditions of pairs (i, j), j = -1 for the arena, of obstacles that count.

    A robot that rotates reaches both iff they are nearer than its longest axis is long; one that
    only translates iff they are nearer than 2 where it is the unit ball.
    """
    names = [body.name or f"obstacle {i}" for i, body in enumerate(obstacles)]
    if rotates:
        bodies, bounds, needed = list(obstacles), arena, 2.0 * float(np.max(robot.semi_axes))
    else:
        bodies = [_seen_by(robot, obstacle) for obstacle in obstacles]
        bounds, needed = _seen_by(robot, arena), 2.0
    counted = [i for i, counts in enumerate(inside) if counts]
    conditions = {}
    for i in counted:
        distance = inner_clearance(bounds, bodies[i])
        distance -= CLEARANCE_TOLERANCE * float(np.max(bounds.semi_axes))
        conditions[i, -1] = Separation(names[i], ARENA, distance, needed)
    for i, j in combinations(counted, 2):
        distance = gap(bodies[i], bodies[j]).value
        conditions[i, j] = Separation(names[i], names[j], distance, needed)
    return conditions


def _seen_by(robot: Ellipsoid, body: Ellipsoid) -> Ellipsoid:
    """The body where the robot, at its orientation, is a unit ball."""
    to_ball = robot.rotation.T / robot.semi_axes[:, None]
    return ellipsoid_from_factor(to_ball @ body.centre, to_ball @ body.matrix)


def _apart(blocked: Sequence[float], failing: dict[tuple[int, int], Separation]) -> float:
    """The sum over obstacles that are apart from each other and the boundary, largest first."""
    chosen: list[int] = []
    for i in sorted(range(len(blocked)), key=lambda i: -blocked[i]):
        pairs = [(min(i, j), max(i, j)) for j in chosen]
        if (i, -1) not in failing and not any(pair in failing for pair in pairs):
            chosen.append(i)
    return sum(blocked[i] for i in chosen)
