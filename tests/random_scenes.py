"""Bodies and scenes that are nasty on purpose: hypothesis strategies and seeded generators.

Shapes: spheres, needles, discs and blades up to axis ratio 1e6, and mild ones.  Rotations: the
identity, tiny and half-turn ones among the random.  Pairs built to touch, or to miss or overlap
by a given amount that needs no oracle to know.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from tests.motion_oracle import Scene
from tests.oracles import Body

Array = NDArray[np.float64]
Rng = np.random.Generator

KINDS = ("sphere", "mild", "needle", "disc", "blade")


def unit_vector(rng: Rng, dimension: int) -> Array:
    """A uniform direction (n,)."""
    v = rng.normal(size=dimension)
    return np.asarray(v / np.linalg.norm(v))


def rotation(rng: Rng, dimension: int, kind: str = "random") -> Array:
    """A rotation (n, n): "random", "identity", "tiny" (1e-14 to 1e-3 rad) or "half-turn"."""
    if kind == "identity":
        return np.eye(dimension)
    angle = {
        "random": rng.uniform(-np.pi, np.pi),
        "tiny": 10 ** rng.uniform(-14, -3),
        "half-turn": np.pi,
    }[kind]
    if dimension == 2:
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    if kind == "random":
        return rotation_of(unit_vector(rng, 4))
    half = 0.5 * angle
    return rotation_of(np.append(np.sin(half) * unit_vector(rng, 3), np.cos(half)))


def rotation_of(quaternion: Array) -> Array:
    """Rotation matrix of a unit quaternion (x, y, z, w)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def semi_axes(rng: Rng, dimension: int, kind: str = "mild", ratio: float = 4.0) -> Array:
    """Semi-axes (n,), the longest 1: by kind.

    "sphere"; "mild" (ratios up to `ratio`); "needle" and "disc" (that ratio); "blade" (a third
    axis anywhere between).
    """
    axes = np.ones(dimension)
    if kind == "mild":
        axes = ratio ** -rng.uniform(size=dimension)
        axes /= axes.max()
    elif kind == "needle":
        axes[1:] = rng.uniform(1, 2, size=dimension - 1) / ratio
    elif kind in ("disc", "blade"):
        axes[-1] = 1 / ratio
        if kind == "blade":
            axes[1:-1] = ratio ** -rng.uniform(size=dimension - 2)
    return axes


def matrix(
    rng: Rng, dimension: int, kind: str = "mild", ratio: float = 4.0, size: float = 1.0
) -> Array:
    """A random ellipsoid's matrix (n, n) with its longest semi-axis `size`."""
    axes = size * semi_axes(rng, dimension, kind, ratio)
    return np.asarray(rotation(rng, dimension) * axes)


def boundary_point(a: Array, u: Array) -> Array:
    """The boundary point of a centred ellipsoid with outward normal u, in long double."""
    wide = a.astype(np.longdouble)
    back = wide.T @ u.astype(np.longdouble)
    return np.asarray(wide @ back / np.sqrt((back * back).sum()))


def normal_at(a: Array, z: Array) -> Array:
    """The outward unit normal (n,) at the boundary point a @ z, |z| = 1."""
    u = np.linalg.solve(a.T, z)
    return np.asarray(u / np.linalg.norm(u), dtype=np.float64)


def touching_offset(a1: Array, a2: Array, u: Array, gap: float) -> Array:
    """Offset (n,) of the centres at which two ellipsoids are `gap` apart along the normal u.

    Exact by construction but for the rounding of the offset: positive gaps are distances,
    small negative ones overlaps.
    """
    wide = u.astype(np.longdouble)
    wide = wide / np.sqrt((wide * wide).sum())
    offset = boundary_point(a1, wide) + boundary_point(a2, wide) + np.longdouble(gap) * wide
    return np.asarray(offset.astype(np.float64))


def touching_pair(
    rng: Rng,
    dimension: int,
    gap: float,
    kinds: tuple[str, str] = ("mild", "mild"),
    ratio: float = 4.0,
    sizes: tuple[float, float] = (1.0, 1.0),
) -> tuple[Body, Body]:
    """Two bodies `gap` apart along a normal that is moderate for the first one."""
    a1 = matrix(rng, dimension, kinds[0], ratio, sizes[0])
    a2 = matrix(rng, dimension, kinds[1], ratio, sizes[1])
    u = unit_vector(rng, dimension)
    start = rng.normal(size=dimension) * rng.choice([0.0, 1.0])
    return Body(start, a1), Body(start + touching_offset(a1, a2, u, gap), a2)


def crossing_needles(
    rng: Rng, ratio: float, gap: float, angle: float | None = None
) -> tuple[Body, Body]:
    """Two needles that cross like swords, their waists `gap` apart (in units of the length)."""
    angle = rng.uniform(0.2, np.pi / 2) if angle is None else angle
    frame = rotation(rng, 3)
    first = np.array([1.0, 0.0, 0.0])
    second = np.array([np.cos(angle), np.sin(angle), 0.0])
    bodies = []
    for axis in (first, second):
        across = np.cross(np.array([0.0, 0.0, 1.0]), axis)
        turn = rng.uniform(0, np.pi)
        thin = np.array([0.0, 0.0, 1.0])
        local = np.stack(
            [
                axis,
                np.cos(turn) * across + np.sin(turn) * thin,
                -np.sin(turn) * across + np.cos(turn) * thin,
            ],
            axis=1,
        )
        bodies.append(frame @ local * semi_axes(rng, 3, "needle", ratio))
    # a normal nearly across both: the contact then sits well inside either needle's length
    tilt = rng.uniform(-1, 1, size=2) / ratio
    across_both = np.linalg.solve(np.stack([first, second])[:, :2], tilt)
    u = frame @ np.append(across_both, 1.0)
    offset = touching_offset(bodies[0], bodies[1], u / np.linalg.norm(u), gap)
    return Body(np.zeros(3), bodies[0]), Body(offset, bodies[1])


class Shape(NamedTuple):
    """What a hypothesis example is made of."""

    seed: int
    dimension: int
    kinds: tuple[str, str]
    ratio: float
    rotations: str

    @property
    def rng(self) -> Rng:
        """A fresh generator of this example."""
        return np.random.default_rng(self.seed)


def shapes(largest_ratio: float = 1e6) -> st.SearchStrategy[Shape]:
    """Pairs of kinds of shapes with an axis ratio, in 2-D and 3-D."""
    exponents = st.floats(0.0, float(np.log10(largest_ratio)))
    return st.builds(
        Shape,
        seed=st.integers(0, 2**32 - 1),
        dimension=st.sampled_from([2, 3]),
        kinds=st.tuples(st.sampled_from(KINDS), st.sampled_from(KINDS)),
        ratio=exponents.map(lambda e: float(10.0**e)),
        rotations=st.sampled_from(["random", "identity", "tiny", "half-turn"]),
    )


def pair_of(shape: Shape, gap: float | None = None) -> tuple[Body, Body]:
    """Two bodies of these shapes: `gap` apart by construction, or anyhow when it is None.

    The second is turned relative to the first by a rotation of the asked kind.  Contact is as
    often at a random place of the first body as along a random normal.
    """
    rng, n = shape.rng, shape.dimension
    frame = rotation(rng, n)
    a1 = frame * semi_axes(rng, n, shape.kinds[0], shape.ratio)
    a2 = (rotation(rng, n, shape.rotations) @ frame) * semi_axes(
        rng, n, shape.kinds[1], shape.ratio
    )
    a2 = a2 * 10 ** rng.uniform(-1, 1)
    u = unit_vector(rng, n)
    if rng.uniform() < 0.5:  # uniform on the first body instead: contact at a needle's waist
        u = normal_at(a1, u)
    if gap is None:
        offset = u * rng.uniform(0, 2) * (np.linalg.norm(a1, 2) + np.linalg.norm(a2, 2))
    else:
        offset = touching_offset(a1, a2, u, gap)
    return Body(np.zeros(n), a1), Body(offset, a2)


def embedded(body: Body, thickness: float = 1.0) -> Body:
    """A planar body as a spatial one, in z = 0, with any third semi-axis."""
    a, c = np.zeros((3, 3)), np.zeros(3)
    a[:2, :2], a[2, 2], c[:2] = body.matrix, thickness, body.centre
    return Body(c, a)


def ellipsoid_of(body: Body, name: str = "") -> Any:
    """The package's ellipsoid of a body (its rotation and semi-axes by the polar form)."""
    from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

    axes = np.linalg.norm(body.matrix, axis=0)
    frame = body.matrix / axes
    if np.linalg.det(frame) < 0:
        frame[:, -1] *= -1
    return Ellipsoid(centre=body.centre, rotation=frame, semi_axes=axes, name=name)


# --------------------------------------------------------------------------- whole scenes


def random_scene(
    rng: Rng,
    dimension: int,
    obstacles: int = 6,
    arenas: int = 1,
    parts: int = 3,
    ratio: float = 4.0,
    rotates: bool = True,
) -> Scene:
    """A robot of a few parts (reach about 2) among obstacles in a world of half-width 8."""
    n = dimension

    def bodies(count: int, spread: float, sizes: tuple[float, float]) -> tuple[Body, ...]:
        found = []
        for _ in range(count):
            centre = rng.uniform(-spread, spread, size=n)
            found.append(Body(centre, matrix(rng, n, "mild", ratio, rng.uniform(*sizes))))
        return tuple(found)

    return Scene(
        low=np.full(n, -8.0),
        high=np.full(n, 8.0),
        obstacles=bodies(obstacles, 7.0, (0.7, 2.5)),
        arenas=bodies(arenas, 0.5, (9.0, 12.0)),
        parts=bodies(parts, 1.0, (0.3, 1.2)),
        rotates=rotates,
    )


def snug_scene(rng: Rng, dimension: int, room: float = 0.02) -> Scene:
    """A robot of one part in an arena of the same shape that is hardly larger."""
    a = matrix(rng, dimension, "mild", 2.0)
    return Scene(
        low=np.full(dimension, -1.0),
        high=np.full(dimension, 1.0),
        obstacles=(),
        arenas=(Body(np.zeros(dimension), a * (1 + room)),),
        parts=(Body(np.zeros(dimension), a),),
    )


def random_configurations(rng: Rng, scene: Scene, count: int, spread: float = 8.0) -> Array:
    """Configurations (count, d), uniform in the box and over the rotations."""
    n = scene.dimension
    position = rng.uniform(-spread, spread, size=(count, n))
    if not scene.rotates:
        return position
    if n == 2:
        return np.column_stack([position, rng.uniform(-np.pi, np.pi, size=count)])
    q = rng.normal(size=(count, 4))
    return np.column_stack([position, q / np.linalg.norm(q, axis=1, keepdims=True)])


def nearby_configuration(rng: Rng, scene: Scene, first: Array, step: float, turn: float) -> Array:
    """A configuration at most `step` away and `turn` [rad] turned from another."""
    n = scene.dimension
    second = first.copy()
    second[:n] += step * rng.uniform() * unit_vector(rng, n)
    if not scene.rotates:
        return second
    if n == 2:
        second[2] = np.remainder(first[2] + rng.uniform(-turn, turn) + np.pi, 2 * np.pi) - np.pi
        return second
    half = 0.5 * turn * rng.uniform()
    second[3:] = quaternion_product(
        np.append(np.sin(half) * unit_vector(rng, 3), np.cos(half)), first[3:]
    )
    second[3:] *= rng.choice([-1.0, 1.0]) / np.linalg.norm(second[3:])
    return second


def quaternion_product(p: Array, q: Array) -> Array:
    """p q for quaternions (x, y, z, w)."""
    v = p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3])
    return np.append(v, p[3] * q[3] - p[:3] @ q[:3])


def space_of(scene: Scene, clearance: float = 0.0) -> Any:
    """The package's C-space of a scene."""
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.robots.rigid import RigidRobot
    from ellipsoid_planning.world import World

    world = World(
        low=scene.low,
        high=scene.high,
        obstacles=tuple(ellipsoid_of(body) for body in scene.obstacles),
        arenas=tuple(ellipsoid_of(body) for body in scene.arenas),
    )
    parts = tuple(ellipsoid_of(body) for body in scene.parts)
    return CSpace(world, RigidRobot(parts, rotates=scene.rotates), clearance)


def embedded_scene(scene: Scene) -> Scene:
    """A planar scene as a spatial one whose robot moves in z = 0."""
    return Scene(
        low=np.append(scene.low, -1.0),
        high=np.append(scene.high, 1.0),
        obstacles=tuple(embedded(body) for body in scene.obstacles),
        # the part's thickness must never decide: tall arenas, flat parts
        arenas=tuple(embedded(body, 1e3) for body in scene.arenas),
        parts=tuple(embedded(body, 1e-6) for body in scene.parts),
        rotates=scene.rotates,
    )


def embedded_configuration(configuration: Array) -> Array:
    """(x, y, yaw) as (x, y, 0, quaternion about z)."""
    x, y, yaw = configuration
    return np.array([x, y, 0.0, 0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)])
