"""Blocked scenes have no way through, and open ones none but the passage.

A ball around the centre of the main part with its least semi-axis goes wherever the robot goes.
"""

import numpy as np
import pytest

from planners.solve import plan
from tests.families.oracle import CASES, WALLS, scene
from tests.passages import distance

SEEDS = [None, 1, 2]
NARROWER = 0.02


def sections(name, around, arena):
    """Points (m, n) of surfaces that cut the arena in two between start and goal.

    A plane through the gate; in a bend the half plane out of the arena's centre and the one on
    the other side, within the divider.
    """
    n, centre = len(arena.centre), around.hull.centre
    axes = np.linalg.svd(around.gate.travel[None])[2][1:]
    reach = 1.1 * float(arena.semi_axes.max())
    coarse = np.linspace(-reach, reach, 2001 if n == 2 else 221)
    fine = np.linspace(-0.6, 0.6, 601 if n == 2 else 121)
    points = []
    for steps in (coarse, fine):
        grid = np.stack(np.meshgrid(*[steps] * (n - 1)), axis=-1).reshape(-1, n - 1)
        points.append(centre + grid @ axes)
    rows = np.concatenate(points)
    if name == "bend":
        rows = rows[(rows - arena.centre) @ (centre - arena.centre) > 0.0]
    return rows[arena.contains(rows)]


def room(scenario, rows):
    """Upper bound of the distance (m,) of points inside the arena from everything.

    The distance to an ellipsoid's wall is at most the room along the ray from its centre.
    """
    arena = scenario.world.arenas[0]
    outside = np.stack([distance(body, rows) for body in scenario.world.obstacles]).min(axis=0)
    away = rows - arena.centre
    scale = np.linalg.norm(away @ arena.rotation / arena.semi_axes, axis=1)
    wall = np.linalg.norm(away, axis=1) * (1.0 / np.maximum(scale, 1e-9) - 1.0)
    return np.minimum(outside, np.where(scale > 0.05, wall, np.inf))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), [*WALLS, ("bend", 2), ("bend", 3)])
def test_no_ball_within_the_robot_passes_a_blocked_passage(name, dimension, seed):
    scenario, gates = scene(name, NARROWER, dimension, seed, blocked=True)
    for around in gates:
        ball = float(around.hull.semi_axes.min())
        most = room(scenario, sections(name, around, scenario.world.arenas[0])).max()
        assert (1 - 3 * NARROWER) * ball <= most <= (1 - NARROWER) * ball * (1 + 1e-9)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), [*WALLS, ("bend", 2), ("bend", 3)])
def test_an_open_wall_has_one_opening(name, dimension, seed):
    scenario, gates = scene(name, 1e-1, dimension, seed)
    for around in gates:
        rows = sections(name, around, scenario.world.arenas[0])
        ball = float(around.hull.semi_axes.min())
        free = rows[room(scenario, rows) >= ball]
        assert len(free) > 0
        assert np.linalg.norm(free - around.hull.centre, axis=1).max() <= 0.8


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_room_behind_a_bend_is_closed(dimension, seed):
    """Between the arena's centre and its wall on the far side, all lies within the divider."""
    scenario, gates = scene("bend", 1e-1, dimension, seed)
    arena = scenario.world.arenas[0]
    outwards = gates[1].hull.centre - arena.centre
    outwards /= np.linalg.norm(outwards)
    rows = arena.centre - np.linspace(0.0, 7.0, 200)[:, None] * outwards
    if dimension == 3:
        up = arena.rotation[:, np.argmin(arena.semi_axes)]
        rows = np.concatenate([rows + height * up for height in np.linspace(-4.0, 4.0, 81)])
        rows = rows[arena.contains(rows)]
    ball = float(gates[1].hull.semi_axes.min())
    assert room(scenario, rows).max() < 0.9 * ball


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_blocked_arena_is_too_low_to_stand_in(dimension, seed):
    """The long axis points one way at the start and the other way at the goal.

    In between it must lie across the arena, whose longest chord there is twice the middle
    semi-axis.
    """
    scenario, gates = scene("tight-arena", NARROWER, dimension, seed, blocked=True)
    arena = scenario.world.arenas[0]
    along = arena.rotation[:, np.argmax(arena.semi_axes)]
    ends = [
        scenario.robot.bodies_at(end)[0].rotation[:, 0] @ along
        for end in (scenario.start, scenario.goal)
    ]
    assert ends[0] * ends[1] < 0.0
    longest = float(gates[0].hull.semi_axes.max())
    assert np.sort(arena.semi_axes)[-2] == pytest.approx((1 - NARROWER) * longest, rel=1e-12)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_a_sampling_planner_finds_the_wide_way_and_no_blocked_one(name, dimension):
    blocked, _ = scene(name, NARROWER, dimension, 1, blocked=True)
    result = plan(blocked, planner="RRTConnect", time_limit=0.3, seed=1, simplify=False)
    assert result.status == "timeout"
    wide, _ = scene(name, 1.0, dimension, 1)
    result = plan(wide, planner="RRTConnect", time_limit=600.0, seed=1, simplify=False)
    assert result.status == "solved"
