"""Dense checks of whole robots and of their motions, in plain numpy.

The interpolation is OMPL's, written anew from its description: linear position; shortest
angle in SO(2); spherical interpolation in SO(3) that leaves the orientation at the first
state's when the quaternions' product exceeds 1 - 1e-9.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests import oracles
from tests.oracles import Body

Array = NDArray[np.float64]

SAME_ORIENTATION = 1 - 1e-9


class Scene(NamedTuple):
    """A world and a rigid robot as plain arrays; parts are in the robot's base frame."""

    low: Array
    high: Array
    obstacles: tuple[Body, ...]
    arenas: tuple[Body, ...]
    parts: tuple[Body, ...]
    rotates: bool = True

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.low)


class Closest(NamedTuple):
    """Where along a motion a robot comes closest to something, and how close."""

    gap: float
    s: float
    direction: Array
    body: int


def rotations(configurations: Array, scene: Scene) -> Array:
    """Rotation matrices (m, n, n) of configurations (m, d); any quaternion is normalised."""
    m, n = len(configurations), scene.dimension
    if not scene.rotates:
        return np.broadcast_to(np.eye(n), (m, n, n))
    if n == 2:
        c, s = np.cos(configurations[:, 2]), np.sin(configurations[:, 2])
        return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    q = configurations[:, 3:] / np.linalg.norm(configurations[:, 3:], axis=1, keepdims=True)
    v, w = q[:, :3], q[:, 3]
    cross = np.zeros((m, 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    cross = cross - np.swapaxes(cross, 1, 2)
    return np.asarray(np.eye(3) + 2 * w[:, None, None] * cross + 2 * cross @ cross)


def placed(scene: Scene, configurations: Array) -> list[tuple[Array, Array]]:
    """For each part the centres (m, n) and matrices (m, n, n) in the world frame."""
    turns = rotations(configurations, scene)
    position = configurations[:, : scene.dimension]
    return [(position + turns @ part.centre, turns @ part.matrix) for part in scene.parts]


def obstacle_gaps(scene: Scene, configurations: Array, far: float = np.inf) -> tuple[Array, Array]:
    """Signed gaps (m, parts, obstacles) and their directions (m, parts, obstacles, n).

    Pairs whose bounding balls are more than `far` apart get that lower bound instead.
    """
    m, n = len(configurations), scene.dimension
    gaps = np.empty((m, len(scene.parts), len(scene.obstacles)))
    directions = np.empty((*gaps.shape, n))
    for i, (centres, matrices) in enumerate(placed(scene, configurations)):
        for j, obstacle in enumerate(scene.obstacles):
            c = centres - obstacle.centre
            length = np.linalg.norm(c, axis=1)
            reach = np.linalg.norm(obstacle.matrix, 2) + np.linalg.norm(scene.parts[i].matrix, 2)
            gaps[:, i, j] = length - reach
            directions[:, i, j] = c / np.maximum(length, 1e-300)[:, None]
            near = gaps[:, i, j] <= far
            a1 = np.broadcast_to(obstacle.matrix, (int(near.sum()), n, n))
            if near.any():
                found = oracles.signed_gaps(c[near], a1, matrices[near])
                gaps[near, i, j], directions[near, i, j] = found
    return gaps, directions


def arena_rooms(scene: Scene, configurations: Array, count: int = 600) -> tuple[Array, Array]:
    """Rooms (m, parts, arenas) between parts and arena boundaries, with inward normals.

    Least difference of supports over a grid of normals, the best few polished by a local search
    that uses values alone.  Negative: sticks out.
    """
    m, n = len(configurations), scene.dimension
    rooms = np.empty((m, len(scene.parts), len(scene.arenas)))
    normals = np.empty((*rooms.shape, n))
    grid = oracles.sphere_grid(count, n)
    for i, (centres, matrices) in enumerate(placed(scene, configurations)):
        for j, arena in enumerate(scene.arenas):
            offsets = centres - arena.centre
            inner = np.linalg.norm(np.einsum("ku,mui->mki", grid, matrices), axis=2)
            outer = np.linalg.norm(grid @ arena.matrix, axis=1)
            values = outer - inner - offsets @ grid.T
            starts = np.argsort(values, axis=1)[:, :4]
            rooms[:, i, j], normals[:, i, j] = _polished_rooms(
                arena.matrix, matrices, offsets, grid[starts], 4.0 / count ** (1 / (n - 1))
            )
    return rooms, -normals


def _polished_rooms(
    arena: Array, matrices: Array, offsets: Array, starts: Array, radius: float
) -> tuple[Array, Array]:
    """Shrinking pattern search on the sphere from `starts` (m, k, n): values and normals."""

    def value(u: Array) -> Array:
        inner = np.linalg.norm(np.einsum("mku,mui->mki", u, matrices), axis=2)
        outer = np.linalg.norm(u @ arena, axis=2)
        return np.asarray(outer - inner - np.einsum("mku,mu->mk", u, offsets))

    u, best = starts, value(starts)
    n = starts.shape[2]
    steps = np.concatenate([np.eye(n), -np.eye(n)])
    while radius > 1e-9:
        improved = np.zeros(best.shape, dtype=bool)
        for step in steps:
            trial = u + radius * step
            trial = trial / np.linalg.norm(trial, axis=2, keepdims=True)
            found = value(trial)
            better = found < best
            u, best = np.where(better[:, :, None], trial, u), np.where(better, found, best)
            improved |= better
        if not improved.any() or improved.mean() < 0.05:
            radius *= 0.4
    k = best.argmin(axis=1)
    rows = np.arange(len(best))
    return best[rows, k], u[rows, k]


def are_free(scene: Scene, configurations: Array) -> NDArray[np.bool_]:
    """Whether the robot meets no obstacle, by the Minkowski sums' gauges alone (quick)."""
    m, n = len(configurations), scene.dimension
    free = np.ones(m, dtype=bool)
    for centres, matrices in placed(scene, configurations):
        for obstacle in scene.obstacles:
            c = centres - obstacle.centre
            reach = np.linalg.norm(obstacle.matrix, 2) + np.linalg.norm(matrices[0], 2)
            near = free & (np.linalg.norm(c, axis=1) <= reach)
            a1 = np.broadcast_to(obstacle.matrix, (int(near.sum()), n, n))
            free[near] = oracles.combinations(c[near], a1, matrices[near], 30)[0] > 1
    return free


def clearances(scene: Scene, configurations: Array, far: float = np.inf) -> Array:
    """Distance of the robot from everything at configurations (m, d); bounds do not count.

    Distances of obstacles above `far` may come out as a lower bound.
    """
    values = np.full(len(configurations), np.inf)
    if scene.obstacles:
        values = np.minimum(values, obstacle_gaps(scene, configurations, far)[0].min(axis=(1, 2)))
    if scene.arenas:
        values = np.minimum(values, arena_rooms(scene, configurations)[0].min(axis=(1, 2)))
    return values


def in_bounds(scene: Scene, configurations: Array) -> Array:
    """Whether the base positions lie in the box."""
    position = configurations[:, : scene.dimension]
    return np.asarray(((position >= scene.low) & (position <= scene.high)).all(axis=1))


# --------------------------------------------------------------------------- interpolation


def interpolate(scene: Scene, first: Array, second: Array, s: Array) -> Array:
    """OMPL's interpolation at parameters s (m,) in [0, 1]: configurations (m, d)."""
    s = np.asarray(s, dtype=float)
    n = scene.dimension
    position = first[:n] + (second[:n] - first[:n]) * s[:, None]
    if not scene.rotates:
        return np.asarray(position)
    if n == 2:
        return np.column_stack([position, angles(first[2], second[2], s)])
    return np.column_stack([position, slerp(first[3:], second[3:], s)])


def angles(first: float, second: float, s: Array) -> Array:
    """OMPL's interpolation of an angle at parameters s (m,)."""
    difference = second - first
    if abs(difference) <= np.pi:
        return np.asarray(first + difference * s)
    turn = 2 * np.pi - difference if difference > 0 else -2 * np.pi - difference
    value = first - turn * s
    value = np.where(value > np.pi, value - 2 * np.pi, value)
    return np.where(value < -np.pi, value + 2 * np.pi, value)


def slerp(first: Array, second: Array, s: Array) -> Array:
    """OMPL's interpolation of a quaternion at parameters s (m,): (m, 4)."""
    product = float(first @ second)
    if abs(product) > SAME_ORIENTATION:
        return np.tile(first, (len(s), 1))
    angle = np.arccos(abs(product))
    end = -second if product < 0 else second
    weights = np.sin((1 - s) * angle), np.sin(s * angle)
    return np.asarray((weights[0][:, None] * first + weights[1][:, None] * end) / np.sin(angle))


# --------------------------------------------------------------------------- along a motion


def motion_samples(scene: Scene, first: Array, second: Array, count: int) -> tuple[Array, Array]:
    """Parameters and configurations along a motion; the last is the second state itself."""
    s = np.linspace(0, 1, count)
    configurations = interpolate(scene, first, second, s)
    return np.append(s, 1.0), np.vstack([configurations, second])


def closest_obstacle(scene: Scene, first: Array, second: Array, count: int = 201) -> Closest:
    """The least signed gap to obstacles along a motion: dense samples, then refined about each.

    Gaps above 0.2 may come out as a lower bound.
    """

    def evaluate(configurations: Array) -> tuple[Array, Array, Array]:
        gaps, directions = obstacle_gaps(scene, configurations, far=0.2)
        return _least(gaps, directions)

    return _closest(scene, first, second, count, evaluate)


def closest_arena(scene: Scene, first: Array, second: Array, count: int = 101) -> Closest:
    """The least room to an arena's boundary along a motion, with the inward normal."""

    def evaluate(configurations: Array) -> tuple[Array, Array, Array]:
        rooms, normals = arena_rooms(scene, configurations, 200)
        return _least(rooms, normals)

    return _closest(scene, first, second, count, evaluate)


def _least(values: Array, directions: Array) -> tuple[Array, Array, Array]:
    """Least of (m, parts, bodies) for each row, its direction and its body's index."""
    m, bodies = len(values), values.shape[2]
    flat = values.reshape(m, -1)
    k = flat.argmin(axis=1)
    rows = np.arange(m)
    return flat[rows, k], directions.reshape(m, flat.shape[1], -1)[rows, k], k % bodies


def _closest(
    scene: Scene,
    first: Array,
    second: Array,
    count: int,
    evaluate: Callable[[Array], tuple[Array, Array, Array]],
) -> Closest:
    """Least value along a motion, by zooming in ten times about the three lowest samples."""
    s, configurations = motion_samples(scene, first, second, count)
    values, directions, bodies = evaluate(configurations)
    k = int(values.argmin())
    best = Closest(float(values[k]), float(s[k]), directions[k], int(bodies[k]))
    lowest = local_minima(values)[:3]
    for k in lowest:
        low, high = s[max(k - 1, 0)], s[min(k + 1, count - 1)]
        for _ in range(8):
            near = np.linspace(low, high, 21)
            values, directions, bodies = evaluate(interpolate(scene, first, second, near))
            j = int(values.argmin())
            if values[j] < best.gap:
                best = Closest(float(values[j]), float(near[j]), directions[j], int(bodies[j]))
            low, high = near[max(j - 1, 0)], near[min(j + 1, 20)]
    return best


def local_minima(values: Array) -> list[int]:
    """Indices of samples not above their neighbours, lowest first."""
    padded = np.concatenate([[np.inf], values, [np.inf]])
    lowest = (padded[1:-1] <= padded[:-2]) & (padded[1:-1] <= padded[2:])
    where = np.flatnonzero(lowest)
    return [int(k) for k in where[np.argsort(values[where])]]


def pushed(scene: Scene, first: Array, second: Array, target: float, rounds: int = 15) -> Scene:
    """The scene with bodies moved so that the least gap along the motion is `target`.

    Each round moves the closest body along its normal by what is missing: obstacles, or the
    arenas of a scene without obstacles.  Raises ArithmeticError when it does not settle to
    within 2e-14.
    """
    closest = closest_obstacle if scene.obstacles else closest_arena
    for _ in range(rounds):
        found = closest(scene, first, second)
        if abs(found.gap - target) < 2e-14:
            return scene
        bodies = list(scene.obstacles or scene.arenas)
        moved = bodies[found.body]
        # the direction points from the body to the part: moving against it widens the gap
        centre = moved.centre - (target - found.gap) * found.direction
        bodies[found.body] = Body(centre, moved.matrix)
        scene = (
            scene._replace(obstacles=tuple(bodies))
            if scene.obstacles
            else scene._replace(arenas=tuple(bodies))
        )
    raise ArithmeticError("the body did not settle")
