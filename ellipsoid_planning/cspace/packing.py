"""From worlds and robots to the one flat array that kernels read (see kernels.layout)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.bounding_tree import bounding_tree
from ellipsoid_planning.geometry.rows import (
    body_rows,
    farthest,
    farthest_of,
    grown_axes,
    part_row,
    shrunk_axes,
)
from ellipsoid_planning.kernels import broad_phase, layout
from ellipsoid_planning.robots.rigid import RigidRobot, check_rigid
from ellipsoid_planning.world import World

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def _scale(world: World, reach: float, *bodies: Array) -> float:
    corner = np.linalg.norm(np.maximum(np.abs(world.low), np.abs(world.high)))
    return max(float(corner) + reach, *map(farthest_of, bodies))


def _bounds(world: World) -> tuple[Array, Array]:
    low, high = np.zeros(3), np.zeros(3)
    low[: world.dimension], high[: world.dimension] = world.low, world.high
    return low, high


def pack_scene(world: World, robot: RigidRobot, clearance: float) -> Array:
    """The scene as one flat array, read-only (kernels.layout tells what stands where).

    Raises:
        GeometryError: if the clearance leaves nothing of an arena, or the robot is not rigid.
    """
    check_rigid(robot)
    parts = np.array([part_row(part) for part in robot.parts])
    return pack_parts(world, parts, max(farthest(part) for part in robot.parts), clearance)


def pack_parts(world: World, parts: Array, reach: float, clearance: float) -> Array:
    """:func:`pack_scene` of rows of parts (k, PART), none farther than ``reach`` from the base.

    Raises:
        GeometryError: if the clearance leaves nothing of an arena.
    """
    header = np.zeros(layout.HEADER)
    header[layout.OBSTACLE_COUNT] = len(world.obstacles)
    header[layout.ARENA_COUNT] = len(world.arenas)
    header[layout.PART_COUNT] = len(parts)
    header[layout.DIMENSION] = world.dimension
    header[layout.CLEARANCE] = clearance
    low, high = _bounds(world)
    header[layout.LOW : layout.LOW + 3] = low
    header[layout.HIGH : layout.HIGH + 3] = high
    axes = np.array([body.semi_axes for body in world.obstacles]).reshape(-1, world.dimension)
    obstacles = body_rows(world.obstacles, grown_axes(axes, clearance))
    shrunk = [shrunk_axes(body.semi_axes, clearance) for body in world.arenas]
    arenas = body_rows(world.arenas, np.array(shrunk))
    header[layout.SCALE] = _scale(world, reach, obstacles, arenas)
    tables = (obstacles, arenas, parts, bounding_tree(obstacles))
    scene = np.concatenate([header, *(table.ravel() for table in tables)])
    scene.setflags(write=False)
    return scene


def scene_within(scene: Array, low: Array, high: Array, margin: float) -> tuple[Array, Indices]:
    """The scene with bounds (3,), (3,), and the obstacles left in it, (m,) of the whole scene's.

    An obstacle stays unless it is farther than ``margin`` from wherever a robot within the new
    bounds can reach. It takes as long as there are obstacles to keep, not more.
    """
    parts = layout.part_rows(scene)
    room = float(parts[:, layout.PART_REACH].max()) + margin
    room += 4.0 * layout.TOLERANCE * float(scene[layout.SCALE])
    tree = layout.tree_rows(scene)
    kept = np.empty(len(tree), dtype=np.int64)
    kept = kept[: broad_phase.overlapping_nodes(tree, *(low - room), *(high + room), kept)]
    nodes = tree[kept]
    # Whoever misses a box goes on from the first node that is left after it.
    nodes[:, layout.NODE_SKIP] = np.searchsorted(kept, nodes[:, layout.NODE_SKIP])
    leaf = nodes[:, layout.NODE_OBSTACLE] >= 0.0
    members = nodes[leaf, layout.NODE_OBSTACLE].astype(np.int64)
    nodes[leaf, layout.NODE_OBSTACLE] = np.arange(len(members))
    header = scene[: layout.HEADER].copy()
    header[layout.OBSTACLE_COUNT] = len(members)
    header[layout.LOW : layout.LOW + 3], header[layout.HIGH : layout.HIGH + 3] = low, high
    obstacles = layout.obstacle_rows(scene)[members]
    tables = (obstacles, layout.arena_rows(scene), parts, nodes)
    found = np.concatenate([header, *(table.ravel() for table in tables)])
    found.setflags(write=False)
    return found, members
