"""Poses, one-part robots and random motions for the tests of motions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tests.motion_oracle import Scene
from tests.oracles import Body
from tests.random_scenes import Rng, nearby_configuration, random_configurations

Array = NDArray[np.float64]


def pose(position: list[float], angle: float, axis: tuple[float, ...] = (0, 0, 1)) -> Array:
    """A configuration turned by an angle, about z in the plane or about any axis in space."""
    if len(position) == 2:
        return np.array([*position, angle])
    v = np.sin(angle / 2) * np.array(axis) / np.linalg.norm(axis)
    return np.array([*position, *v, np.cos(angle / 2)])


def one_part(part: Body, obstacles: tuple[Body, ...] = (), arenas: tuple[Body, ...] = ()) -> Scene:
    """A robot of one part in wide bounds."""
    n = len(part.centre)
    return Scene(np.full(n, -50.0), np.full(n, 50.0), obstacles, arenas, (part,))


def bar(dimension: int) -> Body:
    """A long part: semi-axes 2 along x, 0.3 across."""
    return Body(np.zeros(dimension), np.diag([2.0, 0.3, 0.3][:dimension]))


def random_motion(rng: Rng, scene: Scene) -> tuple[Array, Array]:
    """A motion of random length and turn, some of them pure translations or pure turns."""
    first = random_configurations(rng, scene, 1, spread=6)[0]
    step, turn = rng.choice([0.0, 1.0, 4.0]), rng.choice([0.0, 0.3, 1.5, 3.1])
    second = nearby_configuration(rng, scene, first, step, turn)
    n = scene.dimension
    second[:n] = np.clip(second[:n], scene.low, scene.high)
    return first, second
