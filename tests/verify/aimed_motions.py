"""Motions that miss or touch an obstacle by a hair, at a place that no even sampling looks at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from planners.verify.intervals import Places
from planners.verify.placement import part_placements
from planners.verify.questions import Bodies, FromObstacles
from planners.verify.resolution import Resolution, resolve
from planners.verify.unrolled import Motions, unrolled
from tests.planners.articulated_scenes import ROBOTS, random_configurations, robot_of
from tests.random_scenes import rotation, semi_axes, unit_vector

Array = NDArray[np.float64]

KINDS = ("planar", "spatial", "planar ball", *ROBOTS)
SHAPES = ("sphere", "mild", "needle", "disc", "blade")


@dataclass(frozen=True, eq=False)
class Aimed:
    """A motion, an obstacle, and the s at which a point of it is ``gap`` away from the robot."""

    motions: Motions
    obstacle: Ellipsoid
    s: float
    gap: float

    def resolved(self, needed: float = 0.0) -> Resolution:
        """What can be proved of it."""
        bodies = Bodies.of((self.obstacle,), self.motions.robot.dimension)
        return resolve(
            self.motions, Places(self.motions), FromObstacles(self.motions, bodies, needed)
        )


def ends_of(kind: str, rng: np.random.Generator) -> tuple[object, Array]:
    """A robot and the two ends (2, d) of a random motion."""
    if kind in ROBOTS:
        robot = robot_of(kind)
        return robot, random_configurations(robot, 2, seed=int(rng.integers(1 << 30)))
    n = 3 if kind == "spatial" else 2
    axes = [[1.0, 0.4, 0.3][:n], [0.3, 0.3, 0.3][:n]]
    parts = [Ellipsoid.from_semi_axes(a, rng.normal(size=n)) for a in axes]
    robot = RigidRobot(tuple(parts[1:] if kind == "planar ball" else parts))
    turns = rng.normal(size=(2, 4)) if n == 3 else rng.uniform(-3, 3, (2, 1))
    if n == 3:
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    return robot, np.hstack([rng.uniform(-3, 3, (2, n)), turns])


def aimed(kind: str, shape: str, gap: float, rng: np.random.Generator, graze: bool) -> Aimed:
    """A motion past an obstacle that is ``gap`` away at some s; if ``graze``, moving along it."""
    robot, path = ends_of(kind, rng)
    motions = unrolled(robot, path)
    n, s = robot.dimension, rng.uniform(0.05, 0.95)
    part = int(rng.integers(len(robot.parts)))
    u = unit_vector(rng, n)
    for _ in range(3 if graze else 0):
        u = _across(_velocity(motions, s, part, u), u)
    point = _support_point(motions, s, part, u)
    axes = semi_axes(rng, n, shape)
    turned = rotation(rng, n)
    matrix = turned * axes
    ball = matrix.T @ u
    centre = point + gap * u + matrix @ ball / np.linalg.norm(ball)
    return Aimed(motions, Ellipsoid(centre, turned, axes), s, gap)


def _across(along: Array, u: Array) -> Array:
    """The unit vector next to u that is normal to a direction, if there is one."""
    if not np.linalg.norm(along) > 1e-9:
        return u
    along = along / np.linalg.norm(along)
    if len(u) == 2:
        normal = np.array([-along[1], along[0]])
        return normal if normal @ u >= 0.0 else -normal
    normal = u - (u @ along) * along
    return normal / np.linalg.norm(normal)


def _place(motions: Motions, s: float, part: int) -> tuple[Array, Array]:
    rows = motions.at(np.zeros(1, dtype=np.intp), np.array([s]))
    centres, matrices = part_placements(motions.robot, rows)
    return centres[0, part], matrices[0, part]


def _support_point(motions: Motions, s: float, part: int, u: Array) -> Array:
    centre, matrix = _place(motions, s, part)
    ball = matrix.T @ u
    return centre + matrix @ ball / np.linalg.norm(ball)


def _velocity(motions: Motions, s: float, part: int, u: Array) -> Array:
    """Of the material point that is the support point, by differences."""
    _, matrix = _place(motions, s, part)
    label = matrix.T @ u / np.linalg.norm(matrix.T @ u)
    (c1, m1), (c2, m2) = (_place(motions, s + h, part) for h in (-1e-6, 1e-6))
    return (c2 + m2 @ label - c1 - m1 @ label) / 2e-6
