"""The least gap along a motion of an articulated robot, to 1e-17 of the size.

Forward kinematics and OMPL's interpolation are written anew in extended precision, from the robot's
links and joints. Gaps are stationary in the direction u and in s, so that both are found in double
precision; only the gap itself is evaluated in extended precision.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tests import oracles
from tests.articulated import twin

Long = np.longdouble
PI = Long("3.14159265358979323846264338327950288")
HELD = Long(1) - Long(1e-9)
ONES = 24  # directions that the farthest point from an arena's centre is looked for from

Array = Any  # of extended precision, which numpy's types do not tell apart
Frames = tuple[Array, Array]


class Aim(NamedTuple):
    """What may touch: a part, and an obstacle, an arena or another part; with a clearance."""

    kind: str
    part: int
    other: Any
    clearance: float = 0.0


# --------------------------------------------------------------------------- the motion


def _slerp(first: Array, second: Array, s: Array) -> Array:
    """OMPL's, for quaternions of about unit length: held where their product is nearly 1."""
    product = (first * second).sum()
    if abs(product) > HELD:
        return np.broadcast_to(first, (len(s), 4))
    angle = np.arccos(abs(product))
    # Near a half turn OMPL decides in double precision.
    sign = -1 if float(first.astype(float) @ second.astype(float)) < 0 else 1
    a, b = np.sin((1 - s) * angle), np.sin(s * angle)
    return (a[:, None] * first + sign * b[:, None] * second) / np.sin(angle)


def configurations(robot: Any, first: Array, second: Array, s: Array) -> Array:
    """OMPL's interpolation (m, d) at parameters s (m,)."""
    a, b, s = (Long(1) * np.asarray(x) for x in (first, second, s))
    out = np.empty((len(s), len(a)), dtype=Long)
    for kind, place in twin.slices(robot):
        if kind == "quaternion":
            out[:, place] = _slerp(a[place], b[place], s)
            continue
        step = b[place] - a[place]
        if kind == "angle" and abs(step[0]) > PI:
            step = step - np.copysign(2 * PI, step)
        out[:, place] = a[place] + s[:, None] * step
    return out


# --------------------------------------------------------------------------- the robot


def turns(angles: Array) -> Array:
    c, s = np.cos(angles), np.sin(angles)
    return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)


def about(axis: Array, angles: Array) -> Array:
    """Rotations (m, 3, 3) about an axis."""
    x, y, z = Long(1) * axis / np.sqrt((Long(1) * axis) @ (Long(1) * axis))
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=Long)
    half = np.sin(angles / 2)[:, None, None]
    return np.eye(3) + np.sin(angles)[:, None, None] * cross + 2 * half**2 * (cross @ cross)


def rotations(q: Array) -> Array:
    """Rotations (m, 3, 3) of quaternions (m, 4) of any length."""
    x, y, z, w = (q / np.sqrt((q * q).sum(1, keepdims=True))).T
    cross = np.zeros((len(q), 3, 3), dtype=Long)
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -z, y, -x
    cross[:, 1, 0], cross[:, 2, 0], cross[:, 2, 1] = z, -y, x
    return np.eye(3) + 2 * w[:, None, None] * cross + 2 * cross @ cross


def _base(robot: Any, q: Array) -> Frames:
    n = len(robot.parts[0].centre)
    turn, at = np.eye(n, dtype=Long)[None], q[:, :n]
    if robot.base != "free":
        turn = Long(1) * robot.orientation[None]
    elif n == 2:
        turn = turns(q[:, 2])
    else:
        turn = rotations(q[:, 3:7])
    if robot.base == "fixed":
        at = Long(1) * robot.position[None]
    return np.broadcast_to(turn, (len(q), n, n)), np.broadcast_to(at, (len(q), n))


def frames(robot: Any, q: Array) -> dict[str, Frames]:
    """Rotations (m, n, n) and positions (m, n) of all links."""
    above = {joint.child: joint for joint in robot.joints}
    values = twin.joint_values(robot, q)
    known: dict[str, Frames] = {}

    def place(link: str) -> Frames:
        if link not in known:
            known[link] = _base(robot, q) if link not in above else below(above[link])
        return known[link]

    def below(joint: Any) -> Frames:
        turn, at = place(joint.parent)
        at = at + turn @ (Long(1) * joint.position)
        turn, value = turn @ (Long(1) * joint.rotation), values[joint.name]
        if joint.type == "prismatic":
            return turn, at + value * (turn @ (Long(1) * joint.axis))
        if joint.type == "ball":
            return turn @ rotations(value), at
        if joint.type == "fixed":
            return turn, at
        planar = len(joint.position) == 2
        return turn @ (turns(value[:, 0]) if planar else about(joint.axis, value[:, 0])), at

    return {link.name: place(link.name) for link in robot.links}


def bodies(robot: Any, q: Array, chosen: list[int]) -> list[Frames]:
    """Centres (m, n) and matrices (m, n, n) of the chosen parts."""
    known, links = frames(robot, q), twin.part_links(robot)
    found = []
    for k in chosen:
        (turn, at), part = known[links[k]], robot.parts[k]
        found.append((at + turn @ (Long(1) * part.centre), turn @ (Long(1) * part.matrix)))
    return found


# --------------------------------------------------------------------------- gaps


def _norms(vectors: Array) -> Array:
    return np.sqrt((vectors * vectors).sum(-1))


def separations(c: Array, first: Array, second: Array, exact: bool = True) -> Array:
    """Signed gaps (m,) of bodies whose centres differ by c (m, n), matrices (m, n, n).

    Unless ``exact`` they are lower bounds, good enough to see where a motion comes close.
    """
    bodies = c.astype(float), first.astype(float), second.astype(float)
    _, u = oracles.combinations(*bodies, 24 if exact else 20)
    u = u / np.maximum(np.linalg.norm(u, axis=1), 1e-300)[:, None]
    value = (u * bodies[0]).sum(1)
    for a in bodies[1:]:
        value = value - np.linalg.norm((np.swapaxes(a, 1, 2) @ u[:, :, None])[:, :, 0], axis=1)
    for _ in range(20 if exact else 0):
        before = value
        u, value = oracles.ascended(*bodies, u, value)
        if not (value > before).any():
            break
    u = Long(1) * u / _norms(Long(1) * u)[:, None]
    reach = [_norms((np.swapaxes(a, 1, 2) @ u[:, :, None])[:, :, 0]) for a in (first, second)]
    return (u * c).sum(1) - reach[0] - reach[1]


def inverse_of(matrix: Array) -> Array:
    """By Newton's steps from the one in double precision."""
    found = Long(1) * np.linalg.inv(np.asarray(matrix, dtype=float))
    for _ in range(3):
        found = found @ (2 * np.eye(len(found)) - Long(1) * matrix @ found)
    return found


def rooms(c: Array, part: Array, arena: Array, clearance: float = 0.0) -> Array:
    """1 less the farthest point (m,) of a part grown by ``clearance``, in the arena's norm.

    Ascent from several points p = c + Mz + rw of the part: z and w go along the gradient.
    """
    inverse = inverse_of(arena)
    at = c @ inverse.T
    blocks = [inverse @ part]
    if clearance > 0.0:
        blocks.append(np.broadcast_to(inverse * Long(clearance), part.shape))

    def step(points: Array, place: Array, parts: list[Array]) -> Array:
        out = place[:, None]
        for e in parts:
            z = points @ e
            length = np.sqrt((z * z).sum(2, keepdims=True))
            out = out + (z / np.maximum(length, 1e-300)) @ np.swapaxes(e, 1, 2)
        return out

    rough, parts = at.astype(float), [e.astype(float) for e in blocks]
    grid = oracles.sphere_grid(ONES, c.shape[1])
    points = np.broadcast_to(grid, (len(c), *grid.shape))
    for _ in range(30):
        points = step(points, rough, parts)
    best = np.argmax((points * points).sum(2), axis=1)
    found = Long(1) * points[np.arange(len(c)), best][:, None]
    for _ in range(2):
        found = step(found, at, blocks)
    return 1 - np.sqrt((found[:, 0] ** 2).sum(1))


def gaps(robot: Any, aim: Aim, q: Array, exact: bool = True) -> Array:
    """What is left (m,) at configurations (m, d): lengths, or 1 - |x| of an arena's norm."""
    if aim.kind == "self":
        (c1, m1), (c2, m2) = bodies(robot, q, [aim.other, aim.part])
        return separations(c2 - c1, m1, m2, exact)
    ((c, m),) = bodies(robot, q, [aim.part])
    c, matrix = c - Long(1) * aim.other.centre, Long(1) * aim.other.matrix
    if aim.kind == "arena":
        return rooms(c, m, matrix, aim.clearance)
    still = np.broadcast_to(matrix, m.shape)
    return separations(c, still, m, exact) - Long(aim.clearance)


class Least(NamedTuple):
    """Where along a motion the gap is least, and how little."""

    value: Array
    s: Array


def _parabola(gap: Callable[[Array], Array], s: Array, h: float) -> Array:
    """The lowest point of the parabola through three points, within [0, 1]."""
    middle = min(max(s, Long(h)), 1 - Long(h))
    low, at, high = gap(middle + Long(h) * np.array([-1, 0, 1], dtype=Long))
    bend, slope = low + high - 2 * at, (high - low) / 2
    if not bend > 0:
        return Long(0) if high > low else Long(1)
    return min(max(middle - Long(h) * slope / bend, Long(0)), Long(1))


def lowest(robot: Any, aim: Aim, ends: tuple[Array, Array], s: Array) -> Least:
    """The least gap close to ``s``, where it is within 1e-4 of that already."""

    def gap(s: Array) -> Array:
        return gaps(robot, aim, configurations(robot, *ends, s))

    for h in (1e-4, 1e-6):
        s = _parabola(gap, s, h)
    return Least(gap(np.array([s]))[0], s)


def least(robot: Any, aim: Aim, first: Array, second: Array, count: int = 97) -> Least:
    """The least gap along a motion, its ends included."""
    ends = first, second

    def gap(s: Array, exact: bool) -> Array:
        return gaps(robot, aim, configurations(robot, *ends, s), exact)

    s = np.linspace(0, 1, count, dtype=Long)
    rough = gap(s, exact=False)
    last = gaps(robot, aim, Long(1) * np.asarray(second)[None])[0]  # OMPL may jump there
    values = gap(s[[0, -1]], exact=True)
    best = min(Least(last, Long(1)), Least(values[0], s[0]), Least(values[1], s[-1]))
    inner = np.flatnonzero(
        np.r_[True, rough[1:] <= rough[:-1]] & np.r_[rough[:-1] <= rough[1:], True]
    )
    for k in inner[np.argsort(rough[inner])][:2]:
        low, high = s[max(k - 1, 0)], s[min(k + 1, count - 1)]
        for _ in range(2):
            near = np.linspace(low, high, 17, dtype=Long)
            found = gap(near, exact=True)
            j = int(found.argmin())
            best = min(best, Least(found[j], near[j]))
            low, high = near[max(j - 1, 0)], near[min(j + 1, 16)]
        best = min(best, lowest(robot, aim, ends, (low + high) / 2))
    return best
