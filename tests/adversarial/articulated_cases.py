"""Motions of articulated robots that are aimed at where a proof could go wrong.

Random motions never come within rounding of contact. Here a part touches something by a chosen hair
at a chosen place of the motion: at an end with whatever slope (and perhaps comes back later), or
in the middle, grazing. All but the aimed pair is left out, so that the judge is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.world import World
from tests import random_scenes
from tests.adversarial import articulated_judge as judge
from tests.adversarial.articulated_judge import Aim, Least
from tests.articulated import random_robots, twin

Array = NDArray[np.float64]
Rng = np.random.Generator

KINDS = ("obstacle", "arena", "self")
TWISTS = ("plain", "tiny", "half", "far", "lever", "bolted", "uneven", "offset", "small")
"""What is special: tiny turns, half turns, joints far from 0, long levers, chains of fixed joints,
quaternions a little longer than 1, bodies far from the origin, everything small."""
_FAR = (1e3, 1e5, 1e6)
_SHAPES = ("sphere", "mild", "needle", "disc")


@dataclass(frozen=True, eq=False)
class Case:
    """A scene with one motion, and the least gap along it.

    Attributes:
        truth: the least gap less the clearance, in lengths or in the arena's norm.
        scale: what rounding is measured by: the scene's size, or 1 over the arena's least
            semi-axis times that.
    """

    label: str
    space: ArticulatedCSpace
    aim: Aim
    first: Array
    second: Array
    truth: Least
    scale: float

    def is_certified(self) -> bool:
        """Whether the motion is proved, either way round."""
        a, b = self.first, self.second
        return self.space.is_motion_valid(a, b) or self.space.is_motion_valid(b, a)


@dataclass(frozen=True, eq=False)
class _Scene:
    """A robot with the part that is aimed, its motion, and where it is to touch."""

    robot: ArticulatedRobot
    first: Array
    second: Array
    s: float
    normal: Array
    size: float
    offset: Array

    def at(self) -> Array:
        """The configuration (1, d) where it is to touch."""
        return np.asarray(judge.configurations(self.robot, self.first, self.second, [self.s]))


# --------------------------------------------------------------------------- robots and motions


def _body(rng: Rng, n: int, size: float, centre: Array) -> Ellipsoid:
    kind, ratio = str(rng.choice(_SHAPES)), 10.0 ** rng.uniform(0.2, 2.0)
    if kind == "mild":
        ratio = 3.0
    axes = np.asarray(random_scenes.semi_axes(rng, n, kind, ratio))
    axes = size * axes / axes.max()
    return Ellipsoid(centre, random_scenes.rotation(rng, n), axes)


def _joint(rng: Rng, n: int, k: int, kind: str, arm: float, far: float) -> Joint:
    low, high = (-far, far) if kind == "revolute" else (-2.0 * arm, 2.0 * arm)
    return Joint.of(
        f"joint{k}",
        f"link{k}",
        f"link{k + 1}",
        kind,
        arm * random_scenes.unit_vector(rng, n),
        random_scenes.rotation(rng, n),
        rng.normal(size=n),
        low,
        high,
    )


def _robot(rng: Rng, n: int, twist: str, base: str, size: float, offset: Array) -> ArticulatedRobot:
    types = ["revolute", "continuous", "prismatic"] + ["ball"] * (n == 3)
    if twist == "far":
        kinds = ["revolute", *rng.choice(types, int(rng.integers(1, 3)))]
    elif twist in ("tiny", "uneven") and n == 3:
        kinds = ["ball", *rng.choice(types, int(rng.integers(1, 3)))]
    elif twist == "half":
        kinds = ["continuous", *rng.choice(types, int(rng.integers(1, 3)))]
    else:
        kinds = list(rng.choice(types, int(rng.integers(2, 5))))
    if twist == "bolted":
        kinds = [kinds[0]] + ["fixed"] * 25 + kinds[1:2]
    far = float(rng.choice(_FAR)) if twist == "far" else 6.0
    arm = size * (10.0 ** rng.uniform(1.0, 4.0) if twist == "lever" else rng.uniform(0.2, 1.5))
    joints = tuple(_joint(rng, n, k, str(kind), arm, far) for k, kind in enumerate(kinds))
    bodies = [_body(rng, n, size * 10.0 ** rng.uniform(-2, -0.3), np.zeros(n)) for _ in range(2)]
    links = [Link(f"link{k}") for k in range(len(kinds) + 1)]
    links[0], links[-1] = Link("link0", (bodies[0],)), Link(links[-1].name, (bodies[1],))
    names = [link.name for link in links]
    pairs = frozenset(frozenset((a, b)) for a in names for b in names if a != b)
    return ArticulatedRobot(
        tuple(links),
        joints,
        base,
        offset if base == "fixed" else None,
        None if base == "free" else random_scenes.rotation(rng, n),
        pairs,
    )


def _tiny(rng: Rng) -> float:
    return float(rng.choice([10.0 ** rng.uniform(-9, -3), 5.9e-5, 6.1e-5, 1.2e-4, 1.999e-4]))


def _motion(rng: Rng, robot: ArticulatedRobot, twist: str, size: float, offset: Array) -> Any:
    first = random_robots.random_configurations(rng, robot, 1, size)[0]
    n = robot.dimension
    if robot.base != "fixed":
        first[:n] += offset
    if twist == "far":
        joint = robot.joints[0]
        first[robot.joint_slices[joint.name]] = joint.upper - rng.uniform(10.0, 20.0)
    turn = float(rng.choice([0.1, 1.0, 3.1]))
    step = size * float(rng.choice([0.1, 1.0, 10.0]))
    if twist == "tiny":
        turn = _tiny(rng)
        step *= float(rng.choice([turn, 1.0]))
    second = random_robots.nearby(rng, robot, first, step, turn)
    if twist == "tiny":
        _turn_all(rng, robot, first, second, turn)
    if twist == "half":
        place = robot.joint_slices["joint0"]
        off = float(rng.choice([0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-7])) * rng.choice([-1, 1])
        second[place] = np.remainder(first[place] + np.pi + off + np.pi, 2 * np.pi) - np.pi
    if twist == "uneven":
        for kind, place in twin.slices(robot):
            if kind == "quaternion":
                first[place] *= 1.0 + 4.9e-10 * rng.uniform(-1, 1)
                second[place] *= 1.0 + 4.9e-10 * rng.uniform(-1, 1)
    return first, second


def _turn_all(rng: Rng, robot: Any, first: Array, second: Array, turn: float) -> None:
    """Let every rotation in space turn by exactly this tiny angle or, some, not at all."""
    for kind, place in twin.slices(robot):
        if kind == "quaternion":
            angle = turn * float(rng.choice([0.0, 0.5, 1.0]))
            spin = np.append(
                np.sin(angle / 2) * random_scenes.unit_vector(rng, 3), np.cos(angle / 2)
            )
            found = random_scenes.quaternion_product(spin, first[place])
            second[place] = found / np.linalg.norm(found)


# --------------------------------------------------------------------------- where it touches


def _contact(scene: _Scene, u: Array, aim: Aim) -> tuple[Array, Array]:
    """The moving body's point (n,) farthest against u, and how it moves with s."""
    h = 1e-6 if 1e-6 <= scene.s <= 1 - 1e-6 else (1e-6 if scene.s < 0.5 else -1e-6)
    ends = [scene.s - h, scene.s + h] if 1e-6 <= scene.s <= 1 - 1e-6 else [scene.s, scene.s + h]
    q = judge.configurations(scene.robot, scene.first, scene.second, np.array([scene.s, *ends]))
    ((c, m),) = judge.bodies(scene.robot, q, [aim.part])
    way = -(m[0].T @ u) / np.sqrt(((m[0].T @ u) ** 2).sum())
    points = c + m @ way
    return points[0].astype(float), ((points[2] - points[1]) / (ends[1] - ends[0])).astype(float)


def _normal(rng: Rng, scene: _Scene, aim: Aim, graze: bool) -> Array:
    """A direction from what is touched to the part: across its motion if it grazes."""
    n = scene.robot.dimension
    u = random_scenes.unit_vector(rng, n)
    if not graze:
        _, v = _contact(scene, u, aim)
        if rng.uniform() < 0.5 and np.linalg.norm(v) > 0:
            u = u + rng.choice([-3.0, 3.0]) * v / np.linalg.norm(v)
        return np.asarray(u / np.linalg.norm(u))
    for _ in range(6):
        _, v = _contact(scene, u, aim)
        if not np.linalg.norm(v) > 0:
            break
        u = u - (u @ v) * v / (v @ v)
        u /= np.linalg.norm(u)
    return u


def _against_world(scene: _Scene, aim: Aim, build: Ellipsoid) -> Callable[[float], Any]:
    point, _ = _contact(scene, scene.normal, aim)
    u, matrix = scene.normal, build.matrix
    reach = matrix @ (matrix.T @ u) / np.linalg.norm(matrix.T @ u)
    n, arena = scene.robot.dimension, aim.kind == "arena"
    # An arena has its centre on the part's side; the part's farthest point is on the other one.
    centre = point + reach * (1.0 if arena else -1.0)
    box = 40.0 * scene.size * np.ones(n) + 10.0 * scene.robot.reach

    def world(t: float) -> Any:
        body = Ellipsoid(centre - t * u, build.rotation, build.semi_axes)
        bodies = ((), (body,)) if arena else ((body,), ())
        found = World(scene.offset - box, scene.offset + box, *bodies)
        return found, scene.robot, aim._replace(other=body)

    return world


def _against_itself(scene: _Scene, aim: Aim) -> Callable[[float], Any]:
    """The last link's body shifted so that it touches the first one's."""
    robot, u = scene.robot, scene.normal
    names = (robot.links[0].name, robot.links[-1].name)
    watched = replace(robot, ignored=robot.ignored - {frozenset(names)})
    q = scene.at()
    (c0, m0), (_, m1) = judge.bodies(robot, q, [0, 1])
    turn, at = (x[0].astype(float) for x in judge.frames(robot, q)[names[1]])
    m0, m1 = m0[0].astype(float), m1[0].astype(float)
    place = c0[0].astype(float)
    for m in (m0, m1):
        place = place + m @ (m.T @ u) / np.linalg.norm(m.T @ u)
    part, n = robot.parts[1], robot.dimension
    box = 40.0 * scene.size * np.ones(n)

    def build(t: float) -> Any:
        body = Ellipsoid(turn.T @ (place + t * u - at), part.rotation, part.semi_axes)
        links = (*watched.links[:-1], Link(names[1], (body,)))
        return World(scene.offset - box, scene.offset + box), replace(watched, links=links), aim

    return build


def _shrunk(scene: _Scene, kind: str) -> ArticulatedRobot:
    """Without the base's body, where only the last link is to touch anything."""
    if kind == "self":
        return scene.robot
    first = Link(scene.robot.links[0].name)
    return replace(scene.robot, links=(first, *scene.robot.links[1:]))


def draw(rng: Rng, kind: str, twist: str, n: int, graze: bool, hair: float) -> Case | None:
    """A case, or None if it did not come out.

    Args:
        rng: the generator.
        kind: of ``KINDS``, what is touched.
        twist: of ``TWISTS``.
        n: dimension.
        graze: whether the least gap of the motion is the hair, or the gap at one place.
        hair: the gap as a share of the scene's size, negative for contact.
    """
    size = 1e-3 if twist == "small" else 1.0
    offset = 1e3 * random_scenes.unit_vector(rng, n) if twist == "offset" else np.zeros(n)
    base = str(rng.choice(["free", "translating", "fixed"]))
    robot = _robot(rng, n, twist, base, size, offset)
    first, second = _motion(rng, robot, twist, size, offset)
    ends = [0.0, 1.0, 10.0 ** rng.uniform(-9, -2), 1 - 10.0 ** rng.uniform(-9, -2)]
    s = rng.uniform(0.1, 0.9) if graze else float(rng.choice(ends))
    scene = _Scene(robot, first, second, s, np.zeros(n), size, offset)
    scene = replace(scene, robot=_shrunk(scene, kind))
    clearance = 0.0 if kind == "self" else float(rng.choice([0.0, 0.0, 0.05])) * size
    aim = Aim(kind, 1 if kind == "self" else 0, 0, clearance)
    scene = replace(scene, normal=_normal(rng, scene, aim, graze))
    if kind == "self":
        build = _against_itself(scene, aim)
    else:
        extent = size * 10.0 ** rng.uniform(-2, 0.3)
        if kind == "arena":
            extent = scene.robot.reach * rng.uniform(3.0, 6.0) + 15.0 * size
        build = _against_world(scene, aim, _arena_or_body(rng, n, kind, extent))
    return _settled(build, scene, (kind, twist, n, graze), hair)


def _arena_or_body(rng: Rng, n: int, kind: str, extent: float) -> Ellipsoid:
    if kind != "arena":
        return _body(rng, n, extent, np.zeros(n))
    axes = extent * rng.uniform(0.7, 1.0, size=n)
    return Ellipsoid(np.zeros(n), random_scenes.rotation(rng, n), axes)


def _settled(build: Any, scene: _Scene, label: Any, hair: float) -> Case | None:
    """The scene whose gap is the hair: shifted until it is, by the secant method."""
    kind, _, _, graze = label
    ends = scene.first, scene.second

    def found(t: float) -> Least:
        _, robot, aim = build(t)
        if graze:
            return judge.lowest(robot, aim, ends, scene.s)
        at = judge.configurations(robot, *ends, np.array([scene.s]))
        return Least(judge.gaps(robot, aim, at)[0], scene.s)

    world, robot, aim = build(0.0)
    space = ArticulatedCSpace(world, robot, aim.clearance)
    length = float(space.scene[layout.SCALE])
    unit = length / float(aim.other.semi_axes.min()) if kind == "arena" else length
    t, step = 0.0, 1e-3 * scene.size
    before = found(t).value - hair * unit
    if abs(before) > 1e3 * scene.size:
        return None
    for _ in range(12):
        after = found(t + step).value - hair * unit
        if after == before:
            return None
        t, step, before = t + step, -float(after * step / (after - before)), after
        if not abs(step) < 1e3 * scene.size:
            return None
        if abs(before) <= 1e-3 * abs(hair) * unit or abs(step) < 1e-17 * length:
            break
    world, robot, aim = build(t)
    space = ArticulatedCSpace(world, robot, aim.clearance)
    truth = min(judge.least(robot, aim, *ends), found(t))
    if label[1] in ("tiny", "half"):  # then it matters which end is the first
        truth = min(truth, judge.least(robot, aim, *ends[::-1]))
    return Case("-".join(map(str, label)), space, aim, *ends, truth, unit)
