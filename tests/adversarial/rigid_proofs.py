"""Aiming at the numbers of a proof: a motion that collides, and one proof of it that is all hairs.

A proof takes the first direction whose value exceeds what is required. That may be far from the
best, so that the value can be as small as one likes where bodies are not close at all, and nothing
next to it gives the motion away. No motion that is drawn has such a value; here an obstacle is
shifted until it has. The kernels only tell where to aim.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout, linear, motion, separation
from ellipsoid_planning.scenario import Scenario
from tests import random_scenes
from tests.adversarial.judge import wide
from tests.adversarial.rigid_motion import tracks
from tests.adversarial.rigid_setups import Setup, margin
from tests.random_scenes import Rng

Array = NDArray[np.float64]

_MOST_PROOFS = 12


class Proof(NamedTuple):
    """One proof of a pair: the middle ``s`` of its piece, by how much it exceeds, and along u."""

    s: float
    excess: float
    direction: Array


def proofs(scenario: Scenario) -> list[Proof]:
    """The first proofs of the first pair, as `kernels.motion` makes them, with the last refused."""
    space = scenario.cspace()
    scene, ends = space.scene, space.poses([scenario.start, scenario.goal])
    obstacles, parts = layout.obstacle_rows(scene), layout.part_rows(scene)
    required = scenario.clearance + margin(scenario)
    numbers, placed, _ = motion.motion_workspaces()
    _set(numbers, *ends)
    radii = obstacles[0, layout.BODY_RADIUS], parts[0, layout.PART_RADIUS]
    weight, pieces, found = radii[0] / sum(radii), [(0.0, 1.0)], []
    while pieces and len(found) < _MOST_PROOFS:
        low, high = pieces.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        lever = motion._place_at(parts, 0, numbers, middle, placed)
        value, *u, weight = separation.separation(
            obstacles, 0, placed, 0, weight, required, separation.AIM
        )
        weight = min(max(weight, 1e-9), 1.0 - 1e-9)
        found.append(Proof(middle, value - required, np.array(u[: scenario.dimension])))
        if not value > required:
            break
        slope, bend = motion._parabola(numbers, placed, *lever, *u)
        left = motion._reach(value - required, -slope, bend)
        right = motion._reach(value - required, slope, bend)
        if not left >= half:
            pieces.append((low, middle - left))
        if not right >= half:
            pieces.append((middle + right, high))
    return found


def _set(numbers: Array, first: Array, last: Array) -> None:
    """Fill in the motion between two poses (7,)."""
    turn = np.array(linear.product(*last[3:], *(first[3:] * [-1, -1, -1, 1])))
    turn /= math.copysign(float(np.linalg.norm(turn)), turn[3])
    sine = float(np.linalg.norm(turn[:3]))
    numbers[:3], numbers[3:6], numbers[6:10] = first[:3], last[:3] - first[:3], first[3:]
    numbers[10:13] = turn[:3] / sine if sine > 0.0 else (0.0, 0.0, 1.0)
    numbers[13] = 2.0 * math.atan2(sine, turn[3])


def put_in_the_way(rng: Rng, case: Setup, body: Ellipsoid) -> Ellipsoid:
    """The body with its centre inside the part somewhere along the motion."""
    part, n = case.robot.parts[0], case.dimension
    s = np.array([rng.uniform()])
    position, turn = tracks(case.robot, case.first, case.last)[0].at(s)
    depth = 0.9 * rng.uniform() * random_scenes.unit_vector(rng, n)
    centre = position[0] + turn[0] @ (wide(part.centre) + wide(part.matrix) @ depth)
    return Ellipsoid(np.asarray(centre, float), body.rotation, body.semi_axes)


def aimed(case: Setup, body: Ellipsoid, which: int) -> tuple[Scenario, ...]:
    """Scenarios whose proof ``which`` exceeds what it must by next to nothing, or by the last bit.

    The obstacle is moved against the proof's direction, then the bounds are widened: what is
    required has many more bits than a value that is a difference of large numbers.
    """
    first = _excess(case.scenario((body,)), which)
    if first is None:
        return ()
    direction = proofs(case.scenario((body,)))[which].direction

    def shifted(amount: float) -> Scenario:
        centre = body.centre + amount * direction
        return case.scenario((Ellipsoid(centre, body.rotation, body.semi_axes),))

    near, excess = _least(shifted, which, 1.5 * first, 45)
    if excess > 1e-10 * case.scale:
        return (near,)
    post = near.world.obstacles

    def widened(amount: float) -> Scenario:
        return case.scenario(post, (), amount)

    last, _ = _least(widened, which, 2.0 * excess / 1.4e-14, 60)
    return near, last


def _excess(scenario: Scenario, which: int) -> float | None:
    """By how much the proof of this number exceeds what it must, if it is one."""
    found = proofs(scenario)
    return found[which].excess if len(found) > which and found[which].excess > 0.0 else None


def _least(
    make: Callable[[float], Scenario], which: int, high: float, steps: int
) -> tuple[Scenario, float]:
    """Bisect to where a proof's excess is least before another direction takes over."""
    low, best = 0.0, make(0.0)
    excess = _excess(best, which) or 0.0
    for _ in range(steps):
        middle = 0.5 * (low + high)
        trial = make(middle)
        found = _excess(trial, which)
        if found is None or found > excess:
            high = middle
        else:
            low, best, excess = middle, trial, found
    return best, excess
