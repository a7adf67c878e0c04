"""Robots close to what is around them, with gaps and steps of their own (nothing of the kernels).

A step (6,) moves the base by its first three numbers and turns the robot about it by the rotation
vector of the other three over a length, which may be any for gradients.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests import motion_oracle, oracles
from tests.motion_oracle import Scene
from tests.oracles import Body
from tests.random_scenes import Rng, boundary_point, matrix, rotation, unit_vector

Array = NDArray[np.float64]


def reach(scene: Scene) -> float:
    """How far from its base points of the robot are at most: the unit of turns."""
    return max(
        float(np.linalg.norm(part.centre) + np.linalg.norm(part.matrix, 2)) for part in scene.parts
    )


def pose_of(scene: Scene, configuration: Array) -> Array:
    """The pose (7,) of a configuration (d,)."""
    n, pose = scene.dimension, np.array([0.0, 0, 0, 0, 0, 0, 1])
    pose[:n] = configuration[:n]
    if scene.rotates:
        yaw = configuration[-1]
        pose[3:] = configuration[3:] if n == 3 else [0, 0, np.sin(yaw / 2), np.cos(yaw / 2)]
    return pose


def stepped(pose: Array, steps: Array, length: float) -> Array:
    """Poses (m, 7): `pose` (7,) moved by steps (m, 6) of a robot of this reach."""
    turned = Rotation.from_rotvec(steps[:, 3:] / length) * Rotation.from_quat(pose[3:])
    return np.column_stack([pose[:3] + steps[:, :3], turned.as_quat()])


def placed(scene: Scene, poses: Array) -> list[tuple[Array, Array]]:
    """Centres (m, n) and matrices (m, n, n) of the parts at poses (m, 7)."""
    n = scene.dimension
    turns = Rotation.from_quat(poses[:, 3:]).as_matrix()[:, :n, :n]
    return [(poses[:, :n] + turns @ p.centre, turns @ p.matrix) for p in scene.parts]


def obstacle_gaps(scene: Scene, poses: Array) -> Array:
    """Signed gaps (m, parts, obstacles): the distance, or minus a local depth."""
    found = np.empty((len(poses), len(scene.parts), len(scene.obstacles)))
    for i, (centres, matrices) in enumerate(placed(scene, poses)):
        for j, body in enumerate(scene.obstacles):
            other = np.broadcast_to(body.matrix, matrices.shape)
            found[:, i, j] = oracles.signed_gaps(centres - body.centre, other, matrices)[0]
    return found


def wall_rooms(scene: Scene, poses: Array) -> Array:
    """Rooms (m, parts, arenas) between parts and walls: least difference of supports."""
    found = np.empty((len(poses), len(scene.parts), len(scene.arenas)))
    grid = oracles.sphere_grid(400, scene.dimension)
    for i, (centres, matrices) in enumerate(placed(scene, poses)):
        for j, arena in enumerate(scene.arenas):
            outer = np.linalg.norm(grid @ arena.matrix, axis=1)
            inner = np.linalg.norm(np.einsum("ku,mui->mki", grid, matrices), axis=2)
            offsets = centres - arena.centre
            starts = np.argsort(outer - inner - offsets @ grid.T, axis=1)[:, :4]
            found[:, i, j] = motion_oracle._polished_rooms(
                arena.matrix, matrices, offsets, grid[starts], 0.3
            )[0]
    return found


def smallest_gaps(scene: Scene, poses: Array) -> Array:
    """The smallest gap (m,) of the robot at poses (m, 7)."""
    least = np.full(len(poses), np.inf)
    if scene.obstacles:
        least = np.minimum(least, obstacle_gaps(scene, poses).min(axis=(1, 2)))
    if scene.arenas:
        least = np.minimum(least, wall_rooms(scene, poses).min(axis=(1, 2)))
    return least


def steps_of(dimension: int, *, turns: bool = True) -> Array:
    """Unit steps (k, 6) that a robot can make."""
    free = [0, 1, 5] if dimension == 2 else [0, 1, 2, 3, 4, 5]
    return np.eye(6)[[k for k in free if turns or k < 3]]


def cornered(
    rng: Rng, n: int, gaps: list[float], kind: str = "mild", ratio: float = 3.0, parts: int = 2
) -> tuple[Scene, Array]:
    """A robot and obstacles that are these gaps away from a part each, and its pose (7,).

    Gaps are those of the pair that an obstacle is put at; another part may be nearer to it.
    """
    robot = tuple(
        Body(rng.uniform(-0.7, 0.7, n) * (i > 0), matrix(rng, n, kind, ratio, rng.uniform(0.4, 1)))
        for i in range(parts)
    )
    turn = rotation(rng, n)
    base = rng.uniform(-2, 2, n)
    bodies = []
    for k, gap in enumerate(gaps):
        part = robot[k % parts]
        a1, a2 = turn @ part.matrix, matrix(rng, n, "mild", 3.0, rng.uniform(0.5, 2))
        u = unit_vector(rng, n)
        offset = boundary_point(a1, u) + boundary_point(a2, u) + gap * u
        centre = base + turn @ part.centre + np.asarray(offset, dtype=float)
        bodies.append(Body(centre, a2))
    scene = Scene(np.full(n, -9.0), np.full(n, 9.0), tuple(bodies), (), robot)
    frame = np.eye(3)
    frame[:n, :n] = turn
    pose = np.concatenate([base, np.zeros(3 - n), Rotation.from_matrix(frame).as_quat()])
    return scene, pose
