"""From worlds and robots to the one flat array that kernels read (see kernels.layout)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.bounding_tree import bounding_tree
from ellipsoid_planning.geometry.rows import (
    body_row,
    farthest,
    grown_axes,
    part_row,
    shrunk_axes,
)
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World

Array = NDArray[np.float64]


def _scale(world: World, robot: RigidRobot) -> float:
    corner = np.linalg.norm(np.maximum(np.abs(world.low), np.abs(world.high)))
    sizes = [float(corner) + max(farthest(part) for part in robot.parts)]
    sizes += [farthest(body) for body in (*world.obstacles, *world.arenas)]
    return max(sizes)


def _bounds(world: World) -> tuple[Array, Array]:
    low, high = np.zeros(3), np.zeros(3)
    low[: world.dimension], high[: world.dimension] = world.low, world.high
    return low, high


def pack_scene(world: World, robot: RigidRobot, clearance: float) -> Array:
    """The scene as one flat array, read-only (kernels.layout tells what stands where).

    Raises:
        GeometryError: if the clearance leaves nothing of an arena.
    """
    header = np.zeros(layout.HEADER)
    header[layout.OBSTACLE_COUNT] = len(world.obstacles)
    header[layout.ARENA_COUNT] = len(world.arenas)
    header[layout.PART_COUNT] = len(robot.parts)
    header[layout.DIMENSION] = world.dimension
    header[layout.CLEARANCE] = clearance
    low, high = _bounds(world)
    header[layout.LOW : layout.LOW + 3] = low
    header[layout.HIGH : layout.HIGH + 3] = high
    header[layout.SCALE] = _scale(world, robot)
    obstacles = [body_row(b, grown_axes(b.semi_axes, clearance)) for b in world.obstacles]
    arenas = [body_row(b, shrunk_axes(b.semi_axes, clearance)) for b in world.arenas]
    tree = bounding_tree(np.array(obstacles).reshape(-1, layout.BODY))
    parts = [part_row(part) for part in robot.parts]
    scene = np.concatenate([header, *obstacles, *arenas, *parts, tree.ravel()])
    scene.setflags(write=False)
    return scene
