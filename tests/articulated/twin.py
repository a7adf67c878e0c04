"""Small, obvious and slow twins of the kernels for articulated robots, on plain numpy and scipy.

They read the robot's links and joints, and nothing of the package beyond these data classes. All
of them take many configurations (m, d) at once. Interpolation is OMPL's compound one, written
anew: base as in `tests.motion_oracle`, bounded joints linear, continuous joints the shorter way,
ball joints by spherical interpolation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests import motion_oracle, oracles

Array = NDArray[np.float64]
Frames = tuple[Array, Array]

SIZES = {"revolute": 1, "continuous": 1, "prismatic": 1, "ball": 4, "fixed": 0}


# --------------------------------------------------------------------------- kinematics


def base_size(robot: Any) -> int:
    """How many numbers place the base."""
    n = len(robot.parts[0].centre)
    return {"fixed": 0, "translating": n, "free": 3 if n == 2 else 7}[robot.base]


def joint_values(robot: Any, configurations: Array) -> dict[str, Array]:
    """The values (m, k) of every joint, by name."""
    values, at = {}, base_size(robot)
    for joint in robot.joints:
        size = SIZES[joint.type]
        values[joint.name] = configurations[:, at : at + size]
        at += size
    assert at == configurations.shape[1]
    return values


def planar_turn(angles: Array) -> Array:
    """Rotation matrices (m, 2, 2) of angles (m,)."""
    c, s = np.cos(angles), np.sin(angles)
    return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)


def base_frames(robot: Any, configurations: Array) -> Frames:
    """Rotations (m, n, n) and positions (m, n) of the base."""
    m, n = len(configurations), len(robot.parts[0].centre)
    if robot.base == "fixed":
        still = np.broadcast_to(robot.orientation, (m, n, n))
        return still, np.broadcast_to(robot.position, (m, n))
    at = configurations[:, :n]
    if robot.base == "translating":
        return np.broadcast_to(robot.orientation, (m, n, n)), at
    if n == 2:
        return planar_turn(configurations[:, 2]), at
    return Rotation.from_quat(configurations[:, 3:7]).as_matrix(), at


def joint_motion(joint: Any, values: Array) -> Frames:
    """Rotations (m, n, n) and shifts (m, n) of a joint at its values (m, k)."""
    m, n = len(values), len(joint.position)
    turn, shift = np.broadcast_to(np.eye(n), (m, n, n)), np.zeros((m, n))
    if joint.type == "prismatic":
        shift = values * joint.axis
    elif joint.type == "ball":
        turn = Rotation.from_quat(values).as_matrix()
    elif joint.type != "fixed" and n == 2:
        turn = planar_turn(values[:, 0])
    elif joint.type != "fixed":
        turn = Rotation.from_rotvec(values * joint.axis).as_matrix()
    return turn, shift


def link_frames(robot: Any, configurations: Array) -> dict[str, Frames]:
    """Rotations (m, n, n) and positions (m, n) of every link, each by walking up to the base."""
    above = {joint.child: joint for joint in robot.joints}
    values = joint_values(robot, configurations)
    known: dict[str, Frames] = {}

    def frames(link: str) -> Frames:
        if link in known:
            return known[link]
        if link not in above:
            return base_frames(robot, configurations)
        joint = above[link]
        rotation, position = frames(joint.parent)
        turn, shift = joint_motion(joint, values[joint.name])
        position = position + rotation @ joint.position
        rotation = rotation @ joint.rotation
        position = position + (rotation @ shift[:, :, None])[:, :, 0]
        known[link] = rotation @ turn, position
        return known[link]

    return {link.name: frames(link.name) for link in robot.links}


def placed(robot: Any, configurations: Array) -> list[tuple[Array, Array]]:
    """For each part its centres (m, n) and matrices (m, n, n) in the world."""
    frames = link_frames(robot, configurations)
    rows = []
    for link in robot.links:
        rotation, position = frames[link.name]
        rows += [(position + rotation @ p.centre, rotation @ p.matrix) for p in link.parts]
    return rows


# --------------------------------------------------------------------------- what may meet


def part_links(robot: Any) -> list[str]:
    """The link of each part."""
    return [link.name for link in robot.links for _ in link.parts]


def rigid_groups(robot: Any) -> dict[str, str]:
    """A representative of each link's rigid group: links that fixed joints join."""
    group = {link.name: link.name for link in robot.links}
    for joint in robot.joints:
        if joint.type == "fixed":
            old, new = group[joint.child], group[joint.parent]
            group = {name: new if at == old else at for name, at in group.items()}
    return group


def self_pairs(robot: Any) -> list[tuple[int, int]]:
    """Pairs of parts that count as self-collision if they meet."""
    links, group = part_links(robot), rigid_groups(robot)
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    joined |= {frozenset(pair) for pair in robot.ignored}
    return [
        (i, j)
        for j in range(len(links))
        for i in range(j)
        if group[links[i]] != group[links[j]] and frozenset((links[i], links[j])) not in joined
    ]


# --------------------------------------------------------------------------- gaps


def body_gaps(first: Frames, second: Frames, far: float = np.inf) -> tuple[Array, Array]:
    """Signed gaps (m,) of bodies (centres (m, n), matrices (m, n, n)), and directions (m, n).

    Bodies whose bounding balls are more than `far` apart get that lower bound instead.
    """
    c = second[0] - first[0]
    length = np.linalg.norm(c, axis=1)
    gaps = length - np.linalg.norm(first[1][0], 2) - np.linalg.norm(second[1][0], 2)
    directions = c / np.maximum(length, 1e-300)[:, None]
    near = gaps <= far
    if near.any():
        gaps[near], directions[near] = oracles.signed_gaps(c[near], first[1][near], second[1][near])
    return gaps, directions


def still(ellipsoid: Any, count: int) -> Frames:
    """A body that does not move, `count` times."""
    n = len(ellipsoid.centre)
    centres = np.broadcast_to(ellipsoid.centre, (count, n))
    return centres, np.broadcast_to(ellipsoid.matrix, (count, n, n))


def obstacle_gaps(world: Any, robot: Any, configurations: Array, far: float = np.inf) -> Array:
    """Least signed gap (m,) to any obstacle; gaps above `far` may be lower bounds."""
    best = np.full(len(configurations), np.inf)
    for body in placed(robot, configurations):
        for obstacle in world.obstacles:
            gaps, _ = body_gaps(still(obstacle, len(best)), body, far)
            best = np.minimum(best, gaps)
    return best


def arena_reaches(world: Any, robot: Any, configurations: Array, steps: int = 60) -> Array:
    """Largest |x| (m,) of the robot's points in the norm of any arena: at most 1 inside all.

    Ascent from several points of each part: z <- Eᵀ(p + Ez), brought to unit length.
    """
    worst = np.zeros(len(configurations))
    n = len(robot.parts[0].centre)
    starts = oracles.sphere_grid(4 * (n - 1), n)
    for centres, matrices in placed(robot, configurations):
        for arena in world.arenas:
            inverse = np.linalg.inv(arena.matrix)
            p = ((centres - arena.centre) @ inverse.T)[:, None]
            e = inverse @ matrices
            z = np.broadcast_to(starts, (len(p), *starts.shape))
            for _ in range(steps):
                z = (p + z @ np.swapaxes(e, 1, 2)) @ e
                z = z / np.linalg.norm(z, axis=2, keepdims=True)
            reached = np.linalg.norm(p + z @ np.swapaxes(e, 1, 2), axis=2)
            worst = np.maximum(worst, reached.max(axis=1))
    return worst


def self_gaps(robot: Any, configurations: Array, far: float = np.inf) -> Array:
    """Least signed gap (m,) of any two parts that may not meet."""
    best = np.full(len(configurations), np.inf)
    bodies = placed(robot, configurations)
    for i, j in self_pairs(robot):
        best = np.minimum(best, body_gaps(bodies[i], bodies[j], far)[0])
    return best


def within_limits(robot: Any, configurations: Array) -> NDArray[np.bool_]:
    """Whether all joints (m,) are within their limits."""
    good = np.ones(len(configurations), dtype=bool)
    for joint in robot.joints:
        if joint.type in ("revolute", "prismatic"):
            values = joint_values(robot, configurations)[joint.name][:, 0]
            good &= (values >= joint.lower) & (values <= joint.upper)
    return good


# --------------------------------------------------------------------------- interpolation


def slices(robot: Any) -> Iterator[tuple[str, slice]]:
    """What stands where in a configuration: (kind, place) with kind linear, angle, quaternion."""
    n, at = len(robot.parts[0].centre), base_size(robot)
    if at:
        yield "linear", slice(0, n)
    if robot.base == "free":
        yield ("angle" if n == 2 else "quaternion"), slice(n, at)
    kinds = {"continuous": "angle", "ball": "quaternion"}
    for joint in robot.joints:
        size = SIZES[joint.type]
        if size:
            yield kinds.get(joint.type, "linear"), slice(at, at + size)
        at += size


def interpolate(robot: Any, first: Array, second: Array, s: Array) -> Array:
    """OMPL's interpolation at parameters s (m,): configurations (m, d)."""
    out = np.empty((len(s), len(first)))
    for kind, place in slices(robot):
        a, b = first[place], second[place]
        if kind == "linear":
            out[:, place] = a + np.outer(s, b - a)
        elif kind == "angle":
            out[:, place] = motion_oracle.angles(a[0], b[0], s)[:, None]
        else:
            out[:, place] = motion_oracle.slerp(a, b, s)
    return out


class Least(NamedTuple):
    """Where along a motion something is least, and how little."""

    value: float
    s: float


def least_along(
    robot: Any,
    first: Array,
    second: Array,
    measure: Callable[[Array], Array],
    count: int = 201,
    basins: int = 3,
) -> Least:
    """Least `measure` of the configurations of a motion: dense samples, then zooming in."""
    s = np.linspace(0, 1, count)
    configurations = np.vstack([interpolate(robot, first, second, s), second])
    values = measure(configurations)
    best = Least(float(values.min()), float(np.append(s, 1.0)[values.argmin()]))
    for k in motion_oracle.local_minima(values[:-1])[:basins]:
        low, high = s[max(k - 1, 0)], s[min(k + 1, count - 1)]
        for _ in range(8):
            near = np.linspace(low, high, 13)
            found = measure(interpolate(robot, first, second, near))
            j = int(found.argmin())
            best = min(best, Least(float(found[j]), float(near[j])))
            low, high = near[max(j - 1, 0)], near[min(j + 1, 12)]
    return best


def solved(function: Callable[[float], float], start: float, step: float, target: float) -> float:
    """A root of function = target by the secant method, to 3e-14 of the value.

    Raises ArithmeticError when it does not settle.
    """
    x0, x1 = start, start + step
    f0, f1 = function(x0) - target, function(x1) - target
    limit = max(4 * abs(step), 1e-3 * abs(start))
    for _ in range(40):
        if abs(f1) < 3e-14:
            return x1
        if f1 == f0:
            break
        change = (x1 - x0) / (f1 - f0) * f1
        x0, x1 = x1, x1 - min(max(change, -limit), limit)
        f0, f1 = f1, function(x1) - target
    raise ArithmeticError("the least gap did not settle")
