"""The bundled scenarios: free at both ends, solvable, and narrow where they say so."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_checks import check_endpoints
from tests.passages import plane, room, widths

OBSTACLES = {
    "maze-2d": 42,
    "rabbit-2d-narrow": 9,
    "rabbit-2d-open": 5,
    "rabbit-3d-cluttered": 13,
    "rabbit-3d-narrow": 8,
    "rabbit-3d-open": 2,
    "translation-2d": 7,
    "translation-3d": 12,
    "window-3d": 4,
}
WIDE = ["maze-2d", "rabbit-2d-open", "rabbit-3d-cluttered", "rabbit-3d-open", "translation-2d"]
MOST_PLAY = 0.15


@dataclass(frozen=True)
class Wall:
    """A plane that every path crosses, and the only place in it with room for the robot.

    Attributes:
        normal: of the plane (n,), a unit vector; start and goal lie on different sides.
        gap: centre of the gap (n,), in the plane.
        size: nothing farther than this from the centre has room.
        play: the room for a ball within the robot exceeds the ball by this part of it.
    """

    normal: tuple[float, ...]
    gap: tuple[float, ...]
    size: float
    play: float


WALLS = {
    "rabbit-2d-narrow": [
        Wall((1, 0), (-30, 12.125), 0.2, 0.0625),
        Wall((0.96, -0.28), (-3.395, -11.64), 0.2, 0.0625),
        Wall((1, 0), (30, 12.125), 0.2, 0.0625),
    ],
    "rabbit-3d-narrow": [
        Wall((1, 0, 0), (-18, 0, 0), 6.5, 0.107),
        Wall((1, 0, 0), (18, 0, 0), 6.5, 0.107),
    ],
    "translation-3d": [
        Wall((1, 0, 0), (-28, -6, 6), 2.5, 0.063),
        Wall((1, 0, 0), (0, 6, -6), 2.5, 0.063),
        Wall((1, 0, 0), (28, -6, 6), 2.5, 0.063),
    ],
    "window-3d": [Wall((1, 0, 0), (0, 0, 0), 5.5, 0.135)],
}
BOTH = [(name, wall) for name, walls in WALLS.items() for wall in walls]

LEVEL = (0.0, 0.0, 0.0, 1.0)
ROLLED = (np.sin(np.radians(36.87) / 2), 0.0, 0.0, np.cos(np.radians(36.87) / 2))

# Ways through the gaps between start and goal; headings in degrees.
WAYS = {
    "rabbit-2d-narrow": [
        (-38, 12.125, 0),
        (-22, 12.125, 0),
        (-12.5, 19.5, 100),
        (-15, 1, -95),
        (-11.075, -9.4, -16.26),
        (4.285, -13.88, -16.26),
        (12, -8, 80),
        (13.5, -5, 90),
        (16.5, 4.5, 70),
        (22, 12.125, 0),
        (38, 12.125, 0),
    ],
    "rabbit-3d-narrow": [(-42, 0, 0, *LEVEL), (0, 0, 0, *LEVEL), (0, 0, 0, *ROLLED)],
    "translation-3d": [
        (-44, -6, 6),
        (-16, -6, 6),
        (-9, 6, -6),
        (12, 6, -6),
        (19, -6, 6),
        (44, -6, 6),
    ],
    "window-3d": [(-32, 0, 0, *LEVEL), (32, 0, 0, *LEVEL)],
}


def ball_radius(scenario):
    """Radius of the largest ball about the base within the robot's first part."""
    body = scenario.robot.parts[0]
    assert np.all(body.centre == 0.0)
    return float(np.min(body.semi_axes))


def test_these_scenarios_are_bundled():
    assert set(bundled_scenarios()) >= set(OBSTACLES)


@pytest.mark.parametrize("name", sorted(OBSTACLES))
def test_scenario_is_as_named_and_free_at_both_ends(name):
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.description
    assert scenario.dimension == (3 if "3d" in name else 2)
    assert scenario.robot.rotates is ("translation" not in name)
    assert len(scenario.world.obstacles) == OBSTACLES[name]
    check_endpoints(scenario)


@pytest.mark.parametrize("name", sorted(OBSTACLES))
def test_direct_motion_does_not_solve_it(name):
    scenario = load_scenario(name)
    assert not scenario.cspace().is_motion_valid(scenario.start, scenario.goal)


@pytest.mark.parametrize("name", WIDE)
def test_certified_path_is_found(name):
    from planners.solve import plan

    result = plan(load_scenario(name), planner="RRTConnect", seed=1, time_limit=600.0)
    assert result.status == "solved"
    assert result.path is not None
    assert result.path.certified


@pytest.mark.parametrize("name", sorted(WAYS))
def test_way_through_the_gaps_is_certified(name):
    scenario = load_scenario(name)
    inner = np.array(WAYS[name], dtype=float)
    if scenario.dimension == 2:
        inner[:, 2] = np.radians(inner[:, 2])
    way = np.vstack([scenario.start, inner, scenario.goal])
    assert np.all(scenario.cspace().are_motions_valid(way[:-1], way[1:]))


@pytest.mark.parametrize("name", sorted(WALLS))
def test_robot_is_as_wide_as_its_ball(name):
    """Play relative to the ball is play relative to the robot's least width."""
    scenario = load_scenario(name)
    width = 2.0 * ball_radius(scenario)
    directions = unit_directions(scenario.dimension, 20001)
    if not scenario.robot.rotates:
        directions = np.array([[0.0, 0.0, 1.0]])
    found = widths(scenario.robot, directions)
    assert width <= np.min(found) + 1e-12
    assert np.min(found) == pytest.approx(width, rel=1e-3)


@pytest.mark.parametrize(("name", "wall"), BOTH)
def test_every_path_passes_the_gap(name, wall):
    """Start and goal lie on two sides of a plane, in which only the gap has room for the ball."""
    scenario = load_scenario(name)
    n = scenario.dimension
    sides = [np.dot(wall.normal, end[:n] - wall.gap) for end in (scenario.start, scenario.goal)]
    assert sides[0] < 0.0 < sides[1]
    reach = float(np.linalg.norm(scenario.world.high - scenario.world.low))
    step = 0.02 if n == 2 else 0.4
    points = plane(wall.normal, wall.gap, reach, step)
    roomy = points[room(scenario.world, points) >= ball_radius(scenario) - step]
    assert len(roomy)
    assert np.max(np.linalg.norm(roomy - wall.gap, axis=1)) < wall.size


@pytest.mark.parametrize(("name", "wall"), BOTH)
def test_gap_leaves_little_play_at_any_orientation(name, wall):
    scenario = load_scenario(name)
    radius = ball_radius(scenario)
    step = 0.001 if scenario.dimension == 2 else 0.03
    points = plane(wall.normal, wall.gap, wall.size, step)
    most = np.max(room(scenario.world, points))
    assert most / radius - 1.0 == pytest.approx(wall.play, abs=0.005)
    assert (most + 0.71 * step) / radius - 1.0 < MOST_PLAY


def test_maze_is_closed():
    """Where the bounds end there is no room for the rabbit, so it stays among the walls."""
    scenario = load_scenario("maze-2d")
    step = 0.1
    low, high = scenario.world.low, scenario.world.high
    for axis in range(2):
        for edge in (low[axis], high[axis]):
            normal = np.eye(2)[axis]
            points = plane(normal, edge * normal, high[1 - axis], step)
            assert np.max(room(scenario.world, points)) + step < ball_radius(scenario)
