"""How large a ball passes a wall: plain numpy, without the kernels.

A ball within the robot, centred at its base, goes wherever the robot goes, at any orientation. A
path whose base crosses a plane must cross it where the ball has room; the most room there bounds
the clearance of every path at that place. Room is a distance, so it varies by no more than one
moves: its values on a grid bound it in between.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

BISECTIONS = 48


def distance(body: Ellipsoid, points: Array) -> Array:
    """Distances (m,) of points (m, n) from a body, zero inside.

    In the body's frame the foot of q is a² q / (t + a²), at the root t of |a q / (t + a²)| = 1.
    """
    q, a = (points - body.centre) @ body.rotation, body.semi_axes
    low, high = np.zeros(len(q)), a.max() * np.linalg.norm(q, axis=1) + 1e-9
    for _ in range(BISECTIONS):
        t = 0.5 * (low + high)
        beyond = np.sum((a * q / (t[:, None] + a * a)) ** 2, axis=1) > 1.0
        low, high = np.where(beyond, t, low), np.where(beyond, high, t)
    return np.linalg.norm(q - a * a * q / (low[:, None] + a * a), axis=1)


def room(world: World, points: Array) -> Array:
    """Radii (m,) of the largest balls about points (m, n) that meet no obstacle.

    Negative at points where no base can be: out of bounds or of an arena.
    """
    inside = np.all((points >= world.low) & (points <= world.high), axis=1)
    for arena in world.arenas:
        inside &= arena.contains(points)
    found = np.full(len(points), -1.0)
    found[inside] = np.min([distance(body, points[inside]) for body in world.obstacles], axis=0)
    return found


def plane(normal: ArrayLike, through: ArrayLike, reach: float, step: float) -> Array:
    """Grid points (m, n) of a plane (a line if n = 2), within `reach` of a point (n,) along it.

    No point of that part of the plane is farther than 0.71 `step` from one of them.
    """
    normal = np.asarray(normal, dtype=float)
    along = np.linalg.svd(normal[None])[2][1:]
    ticks = np.arange(-reach, reach + step, step)
    grid = np.stack(np.meshgrid(*[ticks] * len(along), indexing="ij"), axis=-1)
    return np.asarray(through, dtype=float) + grid.reshape(-1, len(along)) @ along


def widths(robot: RigidRobot, directions: Array) -> Array:
    """Widths (m,) of the robot's convex hull along unit directions (m, n) of its base frame."""
    ahead = np.max([part.support(directions) for part in robot.parts], axis=0)
    behind = np.max([part.support(-directions) for part in robot.parts], axis=0)
    return ahead + behind
