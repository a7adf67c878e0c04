"""Whole motions: what is proved between samples is so, and what cannot be is said to be open."""

from dataclasses import replace

import numpy as np
import pytest

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.verify import verify_result
from planners.verify.arena_rooms import InsideArenas
from planners.verify.bends import bends
from planners.verify.containment_proof import furthest_out, is_inside
from planners.verify.intervals import Places
from planners.verify.placement import part_placements
from planners.verify.questions import Bodies, FromItself, FromObstacles
from planners.verify.report import NOT_RESOLVED, NOT_VERIFIED, VERIFIED
from planners.verify.resolution import resolve
from planners.verify.self_collision import self_pairs
from planners.verify.unrolled import unrolled
from tests.oracles import sphere_grid
from tests.planners.articulated_scenes import robot_of
from tests.verify.aimed_motions import KINDS, SHAPES, aimed, ends_of

ball = Ellipsoid.from_semi_axes


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("graze", [False, True])
def test_a_motion_that_touches_by_a_hair_is_never_proved(kind, graze):
    rng = np.random.default_rng([KINDS.index(kind), graze])
    for shape in SHAPES:
        found = aimed(kind, shape, -1e-9, rng, graze).resolved()
        assert len(found.undecided)
        assert found.worst.gap < 0.0


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9])
def test_motions_that_graze_at_a_hair_s_distance_are_proved(gap):
    # A unit disc turns and goes along a straight edge, nearly: the edge of a long ellipse.
    robot = RigidRobot((ball([1.0, 0.6], [0.5, 0.0]), ball([1.0, 1.0])))
    motions = unrolled(robot, np.array([[-2.0, 0.0, np.pi / 2], [2.0, 0.0, np.pi / 2]]))
    wall = Bodies.of((ball([1e4, 1.0], [0.0, -2.0 - gap]),), 2)
    found = resolve(motions, Places(motions), FromObstacles(motions, wall, 0.0))
    assert found.worst is None
    assert not len(found.undecided)


@pytest.mark.parametrize("kind", KINDS)
def test_points_stay_as_near_to_their_chords_as_the_bends_say(kind):
    rng = np.random.default_rng(3)
    for _ in range(10):
        robot, path = ends_of(kind, rng)
        motions = unrolled(robot, path)
        s = np.sort(rng.uniform(0, 1, 2))
        times = np.concatenate([s, np.linspace(*s, 17)[1:-1]])
        rows = motions.at(np.zeros(len(times), dtype=np.intp), times)
        centres, matrices = part_placements(robot, rows)
        unit = sphere_grid(40, robot.dimension)
        for part, ellipsoid in enumerate(robot.parts):
            labels = unit if np.ptp(ellipsoid.semi_axes) else 0.0 * unit
            points = centres[:, part, None] + np.einsum("sij,pj->spi", matrices[:, part], labels)
            share = ((times - s[0]) / (s[1] - s[0]))[2:, None, None]
            off = points[2:] - (1 - share) * points[0] - share * points[1]
            allowed = bends(motions)[0][0, part] * (s[1] - s[0]) ** 2 / 8.0
            assert np.max(np.linalg.norm(off, axis=2)) <= allowed + 1e-12


def test_how_far_out_a_part_reaches_is_its_maximum():
    rng = np.random.default_rng(4)
    for n in (2, 3):
        shapes = 0.3 * rng.normal(size=(50, n, n))
        centres = 0.3 * rng.normal(size=(50, n))
        points = np.einsum("kij,pj->kpi", shapes, sphere_grid(20000, n)) + centres[:, None]
        truth = np.max(np.linalg.norm(points, axis=2), axis=1)
        bound = furthest_out(shapes, centres)
        assert np.all(bound >= truth)
        fits = truth < 1.0  # beyond it does not matter how far
        assert fits.sum() > 10
        assert bound[fits] == pytest.approx(truth[fits], rel=1e-3)


def test_a_part_inside_with_room_is_shown_to_be_and_without_is_not():
    arena, part = np.diag([3.0, 2.0])[None], np.diag([1.0, 0.5])[None]
    offset, up = np.array([[0.0, 0.5]]), np.array([[0.0, 1.0]])
    for room, kept in ((0.0, True), (0.9, True), (0.999999, True), (1.000001, False), (2.0, False)):
        assert is_inside((arena, part, offset), np.array([room]), up, np.zeros(1))[0] == kept


@pytest.mark.parametrize(("room", "proved"), [(1e-6, True), (-1e-9, False)])
def test_a_turn_along_an_arena_s_wall(room, proved):
    robot = RigidRobot((ball([1.0, 0.5], [3.0, 0.0]),))
    motions = unrolled(robot, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2.5]]))
    arena = Bodies.of((ball([4.0 + room] * 2),), 2)
    found = resolve(motions, Places(motions), InsideArenas(motions, arena, 0.0))
    assert (len(found.undecided) == 0) == proved


def test_half_turns_are_proved_both_ways():
    robot = RigidRobot((ball([1.0, 0.1], [1.0, 0.0]),))
    motions = unrolled(robot, np.array([[0.0, 0.0, 0.0], [0.0, 0.0, np.pi]]))
    assert sorted(motions.change[motions.index == 0, 2]) == pytest.approx([-np.pi, np.pi])
    robot = RigidRobot((ball([1.0, 0.1, 0.1], [1.0, 0.0, 0.0]),))
    path = np.array([[0, 0, 0, 0, 0, 0, 1.0], [0, 0, 0, 0, 0, 1.0, 0]])
    motions = unrolled(robot, path)
    ways = motions.at(np.flatnonzero(motions.index == 0), np.full(2, 0.5))
    assert sorted(ways[:, 5]) == pytest.approx([-np.sqrt(0.5), np.sqrt(0.5)])


def test_a_turn_that_ompl_leaves_out_is_a_jump_of_its_own():
    robot = RigidRobot((ball([1.0, 0.1, 0.1], [1.0, 0.0, 0.0]),))
    turned = [0.0, 0.0, np.sin(2e-5), np.cos(2e-5)]
    motions = unrolled(robot, np.array([[0, 0, 0, 0, 0, 0, 1.0], [1, 0, 0, *turned]]))
    begin, end = (motions.at(np.flatnonzero(motions.index == 0), np.full(2, s)) for s in (0.0, 1.0))
    assert begin[:, 0] == pytest.approx([0.0, 1.0])
    assert end == pytest.approx(np.array([[1, 0, 0, 0, 0, 0, 1.0], [1, 0, 0, *turned]]), abs=1e-15)


def test_a_robot_that_meets_itself_between_its_ends_is_not_proved():
    robot = robot_of("snake")
    still = np.zeros(3)
    for first, second, free in (
        ([-2.0, -2.0, -2.0], [-1.0, -1.0, -1.0], False),
        ([1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], True),
    ):
        motions = unrolled(robot, np.array([[*still, *first], [*still, *second]]))
        places = Places(motions, from_base=True)
        found = resolve(motions, places, FromItself(motions, self_pairs(robot)))
        assert (len(found.undecided) == 0) == free


def passing(needle, *, clearance=0.0, stated=0.0, length=1e7):
    """A disc that goes far along a wall, so that it is always close; a needle may stand there."""
    wall = ball([0.05 * length, 1.0], [0.5 * length, -1.501], name="wall")
    world = World(np.array([-1.0, -10.0]), np.array([length + 1.0, 10.0]), (wall, needle))
    robot = RigidRobot((ball([0.5, 0.5], name="disc"),), rotates=False)
    path = np.array([[0.0, 0.0], [length, 0.0]])
    scenario = Scenario("far", world, robot, path[0], path[1], clearance)
    found = PathResult.from_configurations(robot, path, min_clearance=stated, certified=True)
    return PlanResult(scenario, "by hand", "solved", path=found)


@pytest.fixture(autouse=True)
def few_samples(monkeypatch):
    """Leave the work to the proofs."""
    monkeypatch.setattr("planners.verify.sampling._MOST_SAMPLES", 100)


def test_a_needle_on_a_long_way_is_found():
    needle = ball([1e-3, 0.3], [0.62739e7, 0.2], name="thorn")
    report = verify_result(passing(needle))
    assert report.verdict == NOT_VERIFIED
    (hit,) = (check for check in report.failures if check.name == "obstacles")
    assert "'disc' hits obstacle 'thorn'" in hit.detail
    assert "at 0.62739" in hit.detail


def test_a_needle_that_leaves_less_than_stated_is_found():
    needle = ball([1e-3, 0.3], [0.62739e7, 0.5 + 0.3 + 5e-4])
    assert verify_result(passing(needle)).verdict == VERIFIED
    report = verify_result(passing(needle, stated=9e-4))
    assert [check.name for check in report.failures] == ["stated clearance"]
    report = verify_result(passing(needle, clearance=9e-4))
    assert [check.name for check in report.failures] == ["clearance"]


def test_what_rounding_hides_is_not_resolved():
    # Touching, to the last bit or two: neither a contact nor a gap can be shown.
    report = verify_result(passing(ball([0.3, 0.3], [0.3e7, 0.8])))
    assert report.verdict == NOT_RESOLVED
    (check,) = report.failures
    assert (check.name, check.open) == ("between samples", True)
    assert check.detail.startswith("not resolved: part 'disc' and obstacle")
    assert 0.0 < report.resolved < 1.0


def test_a_result_can_be_judged_against_another_scenario():
    result = passing(ball([0.3, 0.3], [0.3e7, 5.0]))
    own = result.scenario
    post = ball([0.3, 0.3], [0.3e7, 0.2], name="post")
    world = World(own.world.low, own.world.high, (*own.world.obstacles, post))
    yours = replace(own, world=world)
    assert verify_result(result).verdict == VERIFIED
    assert "the result's own, 'far', 2 obstacles" in verify_result(result).scenario
    report = verify_result(result, yours)
    assert {check.name for check in report.failures} >= {"obstacles", "clearance"}
    assert "the result's own has other obstacles" in report.scenario
    assert "has other" not in verify_result(result, own).scenario
    moved = replace(own, goal=own.goal + np.array([0.0, 0.5]), clearance=2e-3)
    assert {check.name for check in verify_result(result, moved).failures} == {"goal", "clearance"}


def test_a_path_of_another_robot_is_not_judged():
    result = passing(ball([0.3, 0.3], [0.3e7, 5.0]))
    own = result.scenario
    turning = replace(
        own, robot=RigidRobot(own.robot.parts), start=np.zeros(3), goal=np.array([1.0, 0, 0])
    )
    (check,) = verify_result(result, turning).failures
    assert check.name == "robot"
    assert "2 numbers a state" in check.detail
