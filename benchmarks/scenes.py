"""What the kernel benchmarks run on: a bundled scene, and random states, motions, pairs, lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario

Array = NDArray[np.float64]

PREFERRED = "rabbit-3d-cluttered"
STATES, MOTIONS, PAIRS = 64, 64, 64
STEP = 0.1
"""Longest translation of a random motion, as a fraction of the bounds' diagonal."""
TURN = np.radians(72.0)
"""Largest turn of a random motion: between neighbours of the icosahedral group."""


@dataclass(frozen=True, eq=False)
class Samples:
    """A scene with free states (m, d) and free motions between rows of ``first`` and ``last``."""

    scenario: Scenario
    cspace: CSpace
    states: Array
    first: Array
    last: Array


def reference_scenario() -> Scenario:
    """The cluttered scene in space; without it the bundled one in space with most obstacles."""
    if PREFERRED in bundled_scenarios():
        return load_scenario(PREFERRED)
    spatial = [s for s in map(load_scenario, bundled_scenarios()) if s.dimension == 3]
    return max((s for s in spatial if s.robot.rotates), key=lambda s: len(s.world.obstacles))


def samples(scenario: Scenario | None = None, seed: int = 1) -> Samples:
    """Free states, and proved motions of at most STEP and TURN, of a rotating spatial robot."""
    scenario = reference_scenario() if scenario is None else scenario
    cspace, random = scenario.cspace(), np.random.default_rng(seed)
    states = _free_states(cspace, 40 * MOTIONS, random)
    last = np.array([_nearby(cspace, state, random) for state in states])
    free = cspace.are_motions_valid(states, last)
    first, last = states[free][:MOTIONS], last[free][:MOTIONS]
    return Samples(scenario, cspace, states[:STATES], first, last)


def _free_states(cspace: CSpace, tries: int, random: np.random.Generator) -> Array:
    low, high = cspace.world.low, cspace.world.high
    quaternions = random.normal(size=(tries, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    rows = np.hstack([random.uniform(low, high, size=(tries, 3)), quaternions])
    return rows[cspace.are_valid(rows)]


def _nearby(cspace: CSpace, state: Array, random: np.random.Generator) -> Array:
    axis, step = random.normal(size=3), random.normal(size=3)
    half = 0.5 * TURN * random.uniform()
    vector = np.sin(half) * axis / np.linalg.norm(axis)
    diagonal = float(np.linalg.norm(cspace.world.high - cspace.world.low))
    out = state.copy()
    out[:3] += STEP * diagonal * random.uniform() * step / np.linalg.norm(step)
    q = state[3:]
    out[3:6] = np.cos(half) * q[:3] + q[3] * vector + np.cross(vector, q[:3])
    out[6] = np.cos(half) * q[3] - vector @ q[:3]
    return out


def pairs(seed: int = 2) -> list[tuple[Ellipsoid, Ellipsoid]]:
    """Pairs of ellipsoids with axis ratios up to 4, some apart and some overlapping."""
    random = np.random.default_rng(seed)
    return [
        (_ellipsoid(random, np.zeros(3)), _ellipsoid(random, random.uniform(-1.5, 1.5, size=3)))
        for _ in range(PAIRS)
    ]


def distant_pairs(seed: int = 3) -> list[tuple[Ellipsoid, Ellipsoid]]:
    """Pairs that do not meet, so that both libraries have a distance to compute."""
    random = np.random.default_rng(seed)
    found: list[tuple[Ellipsoid, Ellipsoid]] = []
    while len(found) < PAIRS:
        direction = random.normal(size=3)
        centre = random.uniform(2.1, 4.0) * direction / np.linalg.norm(direction)
        found.append((_ellipsoid(random, np.zeros(3)), _ellipsoid(random, centre)))
    return found


def nested_pairs(seed: int = 4) -> list[tuple[Ellipsoid, Ellipsoid]]:
    """Parts and arenas around them; about half of the parts stick out."""
    random = np.random.default_rng(seed)
    found: list[tuple[Ellipsoid, Ellipsoid]] = []
    for _ in range(PAIRS):
        arena, part = _ellipsoid(random, np.zeros(3)), _ellipsoid(random, np.zeros(3))
        ratio = random.uniform(0.3, 0.8)
        found.append((Ellipsoid(part.centre, part.rotation, ratio * part.semi_axes), arena))
    return found


def _ellipsoid(random: np.random.Generator, centre: Array) -> Ellipsoid:
    rotation, upper = np.linalg.qr(random.normal(size=(3, 3)))
    rotation = rotation * np.sign(np.diag(upper))
    if np.linalg.det(rotation) < 0.0:
        rotation[:, -1] *= -1.0
    axes = 4.0 ** -random.uniform(size=3)
    return Ellipsoid(centre, rotation, axes / axes.max())
