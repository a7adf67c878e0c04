"""Sweep lines that graze a C-obstacle or the free region of an arena, against the judge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from tests import random_scenes
from tests.adversarial.judge import wide
from tests.adversarial.outcome import Counterexample, Outcome
from tests.adversarial.rigid_motion import closest, is_proved_closer
from tests.adversarial.rigid_setups import ellipsoid, margin
from tests.random_scenes import Rng

Array = NDArray[np.float64]


def _checked(
    rng: Rng, scenario: Scenario, axis: int, at: float | None, *, free: bool = False
) -> Outcome:
    """Judge the free intervals of the line through the start; they hold ``at`` if that is free."""
    start = np.array(scenario.start)
    intervals = scenario.cspace().layer(start).free_intervals(start[: scenario.dimension], axis)
    places = [*intervals.ravel(), *(rng.uniform(*row) for row in intervals)]
    if at is not None:
        places += [at for low, high in intervals if low <= at <= high]
    false = []
    for place in places:
        point = start.copy()
        point[axis] = place
        found = closest(scenario, point, point, count=1, zoom=False)
        if found.gap < scenario.clearance and is_proved_closer(scenario, found):
            what = f"free interval holds {place!r}, {scenario.clearance - found.gap:.3g} too close"
            false.append(Counterexample(f"{what}, along axis {axis}", scenario))
    refused = []
    if free and not any(low <= at <= high for low, high in intervals):
        refused.append(Counterexample(f"free intervals lack {at!r} of axis {axis}", scenario))
    return Outcome(1, int(len(intervals) > 0), tuple(false), tuple(refused))


def _robot(rng: Rng, n: int, ratio: float, far: float) -> tuple[RigidRobot, Array, Array, Array]:
    """A robot of one part, a configuration, and where its part is then: (robot, q, centre, A)."""
    part = ellipsoid(rng, n, ratio, 1.0, rng.uniform(0, 2) * random_scenes.unit_vector(rng, n))
    robot = RigidRobot((part,))
    position = far * rng.uniform(-1, 1, n)
    turn = [rng.uniform(-np.pi, np.pi)] if n == 2 else random_scenes.unit_vector(rng, 4)
    configuration = np.append(position, turn)
    placed = robot.bodies_at(configuration)[0]
    return robot, configuration, np.array(placed.centre), np.array(placed.matrix)


def _scenario(robot: RigidRobot, q: Array, clearance: float, **bodies: tuple[Ellipsoid, ...]):
    n = robot.dimension
    world = World(q[:n] - 20.0, q[:n] + 20.0, **bodies)
    return Scenario("line", world, robot, q, q, clearance)


def line_beside_an_obstacle(seed: int) -> Outcome:
    """The line passes the C-obstacle by a hair, or cuts it by one."""
    rng = np.random.default_rng(seed)
    n, ratio = int(rng.choice([2, 3])), 10 ** rng.uniform(0, rng.choice([2, 6]))
    clearance = float(rng.choice([0.0, 10 ** rng.uniform(-6, 0)]))
    robot, q, centre, matrix = _robot(rng, n, ratio, float(10 ** rng.uniform(-1, 5)))
    axis = int(rng.integers(n))
    across = random_scenes.unit_vector(rng, n)
    across[axis] = 0.0
    across /= np.linalg.norm(across)
    body = ellipsoid(rng, n, ratio, 10 ** rng.uniform(-2, 0.5))
    shift = rng.uniform(-3, 3) * np.eye(n)[axis]
    size = margin(_scenario(robot, q, clearance)) / 1.4e-14
    tolerance = 1e-11 * size
    outcome = Outcome()
    for hair in (2 * tolerance, *(size * rng.choice([-1, 1], 4) * 10 ** rng.uniform(-16, -9, 4))):
        u = wide(across)
        u = u / np.sqrt((u * u).sum())
        away = random_scenes.boundary_point(body.matrix, u)
        away = away + random_scenes.boundary_point(matrix, u) + np.longdouble(clearance + hair) * u
        placed = np.asarray(wide(centre + shift) - away, dtype=float)
        obstacle = Ellipsoid(placed, body.rotation, body.semi_axes)
        scenario = _scenario(robot, q, clearance, obstacles=(obstacle,))
        at = float(q[axis] + shift[axis])
        # With a clearance, lines that graze lose more, as the offset of a body is no ellipsoid;
        # so do those that graze needles.
        free = hair >= tolerance and clearance == 0.0 and ratio < 100.0
        outcome += _checked(rng, scenario, axis, at, free=free)
    return outcome


def line_in_an_arena(seed: int) -> Outcome:
    """The part fits into the arena along the line by a hair."""
    rng = np.random.default_rng(seed)
    n, ratio = int(rng.choice([2, 3])), 10 ** rng.uniform(0, rng.choice([1, 5]))
    robot, q, centre, _ = _robot(rng, n, ratio, float(10 ** rng.uniform(-1, 5)))
    axis = int(rng.integers(n))
    middle = centre + rng.uniform(0, 1) * random_scenes.unit_vector(rng, n)
    arena = ellipsoid(rng, n, 10 ** rng.uniform(0, 2), 3.0, middle)
    plain = _scenario(robot, q, 0.0, arenas=(arena,))
    place = closest(plain, plain.start, plain.start, count=1, zoom=False)
    tight = 1.0 - place.gap / float(arena.semi_axes.min())
    room = margin(plain) / 1.4e-14 / float(arena.semi_axes.min() * tight)
    outcome = Outcome()
    for hair in (1e-10 * (1 + room), *(10 ** rng.uniform(-16, -6, 4)), -1e-14):
        scaled = Ellipsoid(middle, arena.rotation, tight * (1 + hair) * arena.semi_axes)
        scenario = _scenario(robot, q, 0.0, arenas=(scaled,))
        outcome += _checked(rng, scenario, axis, float(q[axis]), free=hair >= 1e-10 * (1 + room))
    return outcome
