"""Passages: proved motions that dense checks find free, through openings and nowhere else."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.cspace.poses import configurations_from_poses
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.families import make_family, make_family_scene
from ellipsoid_planning.kernels import centring
from ellipsoid_planning.roadmap.highway import EXHAUSTED, SOLVED, TIMEOUT, HighwayRoadmap
from ellipsoid_planning.roadmap.passages import PassageFinder
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.families.oracle import CASES, WALLS
from tests.motion_oracle import Scene, clearances, interpolate
from tests.oracles import body_of
from tests.roadmap.family_paths import is_proved, query
from tests.roadmap.scenes import body, configuration

# Pieces of work that a test waits for.
PIECES = 400


def never():
    return False


def passages_of(space, start, goal, pieces=PIECES):
    """Passages that a finder comes upon for a query, as configurations (m, d)."""
    finder = PassageFinder(space)
    finder.begin(space.poses(start), space.poses(goal))
    for _ in range(pieces):
        if not finder.advance(100, never):
            break
    assert all(np.isfinite(passage.poses).all() for passage in finder.found)
    return [configurations_from_poses(space.robot, passage.poses) for passage in finder.found]


def scene_of(space):
    world = space.world
    return Scene(
        world.low,
        world.high,
        tuple(map(body_of, world.obstacles)),
        tuple(map(body_of, world.arenas)),
        tuple(map(body_of, space.robot.parts)),
        space.robot.rotates,
    )


def least_clearance(space, path, each):
    """The smallest clearance of samples of a path."""
    scene, s = scene_of(space), np.linspace(0.0, 1.0, each)
    rows = [interpolate(scene, *motion, s) for motion in itertools.pairwise(path)]
    return clearances(scene, np.vstack(rows), far=0.1).min()


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_passages_are_free_and_proved_from_end_to_end(name, dimension):
    for clearance in (1e-2, 1e-6):
        scenario = make_family(name, clearance, dimension, 1)
        space = scenario.cspace()
        found = passages_of(space, scenario.start, scenario.goal, 60)
        assert found
        for path in found[:3]:
            assert len(path) >= 2
            assert is_proved(space, path)
            assert least_clearance(space, path, max(3, 40 // len(path))) >= 0.0


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(("name", "dimension"), WALLS)
def test_passages_lead_through_openings_but_never_through_blocked_ones(name, dimension, seed):
    """A ball within the robot must cross the plane of each gate."""
    for clearance, blocked in ((1e-6, False), (1e-6, True), (0.1, True)):
        made = make_family_scene(name, clearance, dimension, seed, blocked=blocked)
        space = made.scenario.cspace()
        found = passages_of(space, made.scenario.start, made.scenario.goal, 150)
        crossed = 0
        for gate in made.gates:
            hull = made.scenario.robot.bodies_at(gate.configuration)[0].centre
            for path in found:
                centres = [space.robot.bodies_at(row)[0].centre for row in path]
                sides = np.sign((np.array(centres) - hull) @ gate.travel)
                crossed += len(set(sides[sides != 0.0])) == 2
        assert (crossed == 0) if blocked else (crossed > 0)


@pytest.mark.parametrize(("name", "dimension"), [("bend", 2), ("turned-gap", 3), ("window-3d", 3)])
def test_the_same_query_finds_the_same_passages(name, dimension):
    scenario = make_family(name, 1e-3, dimension, 4)
    first, second = (
        passages_of(scenario.cspace(), scenario.start, scenario.goal, 40) for _ in range(2)
    )
    assert first
    for one, other in zip(first, second, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_second_query_forgets_nothing_and_stays_right():
    scenario = make_family("turned-gap", 1e-4, 2, 1)
    planner, there = query(scenario)
    back = planner.solve(scenario.goal[None], scenario.start[None], never)
    assert (there.status, back.status) == (SOLVED, SOLVED)
    assert is_proved(planner.cspace, back.path)
    np.testing.assert_allclose(back.path[0], scenario.goal, atol=1e-12)


# --------------------------------------------------------------------------- odd worlds


def jaws(n, gap, thick=1.0, *, robot=None, rotates=True):
    """A wall across an arena with a gap of this width in its middle."""
    walls = tuple(
        body([thick, 5.0, 40.0][:n], [0.0, side * (5.0 + 0.5 * gap), 0.0][:n])
        for side in (1.0, -1.0)
    )
    arena = body([8.0, 6.0, 5.0][:n])
    robot = robot or (body([1.0, 0.3, 0.35][:n]),)
    world = World(np.full(n, -9.0), np.full(n, 9.0), walls, (arena,))
    return CSpace(world, RigidRobot(tuple(robot), rotates=rotates))


def crossing(space, limit=200_000):
    """The outcome of a query from one side to the other, in so many calls of the clock."""
    calls = iter(range(limit))
    start = configuration(space, *[-4.0, 1.0, 0.0][: space.dimension], yaw=1.0)
    goal = configuration(space, *[4.0, -1.0, 0.0][: space.dimension], yaw=1.5)
    assert space.are_valid(np.vstack([start, goal])).all()
    planner = HighwayRoadmap(space)
    outcome = planner.solve(start, goal, lambda: next(calls, None) is None)
    if outcome.path is not None:
        assert is_proved(space, outcome.path)
        assert least_clearance(space, outcome.path, 40) >= 0.0
    return outcome


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("play", [1e-2, 1e-6])
@pytest.mark.parametrize("thick", [1.0, 5e-6])
def test_walls_may_be_blades_of_an_axis_ratio_of_a_million(n, play, thick):
    assert crossing(jaws(n, 0.6 * (1 + play), thick)).status == SOLVED


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("rotates", [True, False])
@pytest.mark.parametrize("play", [1e-2, 1e-6, 1e-9])
def test_a_ball_passes_at_any_orientation(n, rotates, play):
    ball = body(np.full(n, 0.5))
    assert crossing(jaws(n, 1.0 + play, robot=[ball], rotates=rotates)).status == SOLVED


@pytest.mark.parametrize("n", [2, 3])
def test_a_robot_may_be_a_needle(n):
    needle = body([1.0, 1e-6, 1e-6][:n])
    assert crossing(jaws(n, 1e-5, robot=[needle])).status == SOLVED


@pytest.mark.parametrize("n", [2, 3])
def test_a_robot_may_have_many_parts(n):
    beads = [body(np.full(n, 0.2), [0.2 * k - 1.0, *[0.0] * (n - 1)]) for k in range(11)]
    assert crossing(jaws(n, 0.4001, robot=beads)).status == SOLVED


@pytest.mark.parametrize("n", [2, 3])
def test_a_gap_that_is_too_narrow_is_left_alone(n):
    # In space the walls draw back above and below, by a tenth of that.
    space = jaws(n, 0.6 * (1 - (1e-3 if n == 2 else 0.3)))
    outcome = crossing(space, 150)
    assert outcome.status in (TIMEOUT, EXHAUSTED)
    assert outcome.path is None


@pytest.mark.parametrize("n", [2, 3])
def test_nothing_around_is_no_trouble(n):
    robot = RigidRobot((body([1.0, 0.5, 0.4][:n]),))
    space = CSpace(World(np.full(n, -9.0), np.full(n, 9.0)), robot)
    start = configuration(space, *[-5.0, 0.0, 0.0][:n])
    assert passages_of(space, start, start) == []
    goal = configuration(space, *[5.0, 0.0, 0.0][:n], yaw=2.0)
    assert all(is_proved(space, path) for path in passages_of(space, start, goal))
    assert HighwayRoadmap(space).solve(start, goal, never).status == SOLVED


@pytest.mark.parametrize("n", [2, 3])
def test_two_arenas_that_are_tight_together_leave_room_to_turn(n):
    """Each is long, one along x and one along y: the robot turns where they cross."""
    arenas = (body([6.0, 1.02, 1.02][:n]), body([1.02, 6.0, 1.02][:n]))
    world = World(np.full(n, -9.0), np.full(n, 9.0), (), arenas)
    space = CSpace(world, RigidRobot((body([1.0, 0.3, 0.3][:n]),)))
    start, goal = configuration(space, *[0.0] * n), configuration(space, *[0.0] * n, yaw=3.0)
    outcome = HighwayRoadmap(space).solve(start, goal, never)
    assert outcome.status == SOLVED
    assert is_proved(space, outcome.path)


def test_a_workspace_serves_one_scene_and_counts_up():
    scenario = make_family("gap", 1e-3, 2, 1)
    work = centring.new_workspace(scenario.cspace().scene)
    assert work.pairs[0] == 0
    assert (work.keys == -1).all()
