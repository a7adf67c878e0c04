"""The highway roadmap over joints: layers, passages, stored roadmaps, robots on fixed bases."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.kernels import contact_model, robot_model
from ellipsoid_planning.kernels.centring import new_workspace
from ellipsoid_planning.kernels.roadmap_metric import turn_length
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.graph import explored_graph
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.joint_layers import (
    clear_of_itself,
    guided_layers,
    layer_metric,
    low_discrepancy,
    rotations_from_unit,
    spread_layers,
)
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.world import World
from tests.articulated_scenes import (
    chain,
    quaternions,
    random_configurations,
    scattered,
    slit,
    snake,
)


def never():
    return False


def free(cspace, rng, count, low, high, spread=np.pi):
    rows = random_configurations(cspace.robot, rng, 400, low, high, spread)
    found = rows[cspace.are_valid(rows)]
    assert len(found) >= count
    return found[:count]


def proved(cspace, path, start, goal):
    np.testing.assert_allclose(path[0], start, atol=1e-12)
    np.testing.assert_allclose(path[-1], goal, atol=1e-12)
    return bool(cspace.are_motions_valid(path[:-1], path[1:]).all())


def test_a_snake_finds_its_way_between_forty_obstacles():
    cspace = CSpace(scattered(), snake())
    rows = free(cspace, np.random.default_rng(1), 12, 0.0, 10.0)
    for start, goal in rows.reshape(-1, 2, 7):
        outcome = HighwayRoadmap(cspace).solve(start[None], goal[None], never)
        assert outcome.status == SOLVED
        assert proved(cspace, outcome.path, start, goal)
        again = HighwayRoadmap(cspace).solve(start[None], goal[None], never)
        np.testing.assert_array_equal(again.path, outcome.path)


@pytest.mark.parametrize("play", [0.1, 1e-5])
def test_a_chain_of_eighteen_degrees_of_freedom_threads_a_slit(play):
    cspace = CSpace(slit(play), chain())
    rng = np.random.default_rng(3)
    starts = free(cspace, rng, 3, [-12.0, -3.0, -3.0], [-6.0, 3.0, 3.0], 1.5)
    goals = free(cspace, rng, 3, [6.0, -3.0, -3.0], [12.0, 3.0, 3.0], 1.5)
    for start, goal in zip(starts, goals, strict=True):
        assert not cspace.is_motion_valid(start, goal)
        planner = HighwayRoadmap(cspace)
        outcome = planner.solve(start[None], goal[None], never)
        assert outcome.status == SOLVED
        assert proved(cspace, outcome.path, start, goal)
        assert play > 0.01 or planner.statistics["passages"] > 0


def test_a_closed_slit_is_not_passed():
    cspace = CSpace(slit(-1e-6), chain(2))
    rng = np.random.default_rng(3)
    start = free(cspace, rng, 1, [-12.0, -3.0, -3.0], [-6.0, 3.0, 3.0], 1.0)
    goal = free(cspace, rng, 1, [6.0, -3.0, -3.0], [12.0, 3.0, 3.0], 1.0)
    parameters = RoadmapParameters(layers=20, lines=4, refine=0)
    outcome = HighwayRoadmap(cspace, parameters).solve(start, goal, never)
    assert outcome.status == "exhausted"


def arm():
    link = Link("upper", (Ellipsoid.from_semi_axes([0.5, 0.1, 0.1], [0.5, 0.0, 0.0]),))
    hand = Link("hand", (Ellipsoid.from_semi_axes([0.5, 0.1, 0.1], [0.5, 0.0, 0.0]),))
    turn = {"lower": -3.0, "upper": 3.0}
    joints = (
        Joint.of("a", "foot", "turret", "continuous", [0.0, 0.0, 0.0], axis=[0, 0, 1]),
        Joint.of("b", "turret", "upper", "revolute", [0.0, 0.0, 0.0], axis=[0, 1, 0], **turn),
        Joint.of("c", "upper", "hand", "revolute", [1.0, 0.0, 0.0], axis=[0, 1, 0], **turn),
    )
    return ArticulatedRobot((Link("foot"), Link("turret"), link, hand), joints, "fixed")


def test_an_arm_on_a_fixed_base_goes_round_a_post():
    post = Ellipsoid.from_semi_axes([0.2, 0.2, 3.0], [1.2, 0.0, 0.0])
    cspace = CSpace(World(np.full(3, -3.0), np.full(3, 3.0), (post,)), arm())
    start, goal = np.array([0.7, 0.0, 0.0]), np.array([-0.7, 0.0, 0.0])
    assert cspace.are_valid([start, goal]).all()
    assert not cspace.is_motion_valid(start, goal)
    outcome = HighwayRoadmap(cspace).solve(start[None], goal[None], never)
    assert outcome.status == SOLVED
    assert proved(cspace, outcome.path, start, goal)


def test_layers_are_spread_within_limits_and_clear_of_themselves():
    planar, spatial = CSpace(scattered(), snake(2)), CSpace(slit(0.1), chain(3))
    grid = spread_layers(planar, 100)
    assert 80 <= len(grid) <= 400
    angles = np.unique(grid[:, 4])
    assert angles.min() == -2.4
    assert angles.max() == 2.4
    np.testing.assert_allclose(np.diff(angles), np.diff(angles)[0])
    rows = spread_layers(spatial, 200)
    assert 50 < len(rows) <= 200
    assert clear_of_itself(spatial, rows).all()
    for first in (0, 4, 8):
        lengths = np.linalg.norm(rows[:, first : first + 4], axis=1)
        np.testing.assert_allclose(lengths, 1.0)
    later = spread_layers(spatial, 200, 200)
    assert not np.isin(later[:, 0], rows[:, 0]).any()


def test_low_discrepancy_fills_the_cube_evenly():
    points = low_discrepancy(1000, 3)
    counts = np.histogramdd(points, bins=2, range=[(0, 1)] * 3)[0]
    assert counts.min() > 110
    turns = rotations_from_unit(points)
    np.testing.assert_allclose(np.abs(turns @ turns.T).mean(), 0.4244, atol=0.01)


def test_guides_lead_from_start_to_goal():
    cspace = CSpace(scattered(), snake(3))
    rng = np.random.default_rng(0)
    first, last = cspace.poses(free(cspace, rng, 2, 0.0, 10.0))
    rows = guided_layers(cspace, first, last, 3)
    middle = cspace.poses(cspace.interpolate(*cspace.configurations(np.array([first, last])), 0.5))[
        0
    ]
    aligned = np.abs(rows[:, :4] @ middle[3:7])
    joints = np.abs(rows[:, 4:] - middle[7:]).max(axis=1)
    assert np.any((aligned > 1.0 - 1e-12) & (joints < 1e-12))


def test_the_distance_of_layers_is_the_weighted_sum_of_turns():
    cspace = CSpace(slit(0.1), chain(3))
    robot, rng = cspace.robot, np.random.default_rng(5)
    one, two = cspace.poses(random_configurations(robot, rng, 2, -1.0, 1.0))
    expected = 2.0 * np.arccos(abs(one[3:7] @ two[3:7])) * 1.7
    for k, weight in enumerate(robot.joint_weights):
        part = slice(7 + 4 * k, 11 + 4 * k)
        expected += weight * np.arccos(abs(one[part] @ two[part]))
    found = turn_length(layer_metric(cspace), one[3:], two[3:], 1.7)
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("kind", ["snake", "chain"])
def test_gradients_of_gaps_are_those_of_finite_steps(kind):
    # Gaps to the walls of arenas are estimates, so there are none here.
    world = scattered() if kind == "snake" else replace(slit(0.4), arenas=())
    cspace = CSpace(world, snake() if kind == "snake" else chain())
    rng, model = np.random.default_rng(2), cspace.model
    low, high = (0.0, 10.0) if kind == "snake" else ([-6.0, -2.0, -0.5], [2.0, 2.0, 0.5])
    size, checked = robot_model.step_count(model), 0
    work = new_workspace(model)

    def rows_at(pose):
        table = np.empty((contact_model.CAPACITY, contact_model.MODEL + size))
        work.keys[:] = -1
        count = contact_model.contact_model(
            model, work.placed, pose, 0.3, 1.0 / cspace.reach, table, work.pairs, work.keys,
            work.known,
        )  # fmt: skip
        return table[:count]

    for row in random_configurations(cspace.robot, rng, 120, low, high, 1.0):
        pose = cspace.poses(row)[0]
        here = rows_at(pose)
        step = rng.normal(size=size)
        if kind == "snake":
            step[2:5] = 0.0
        ends = []
        for sign in (1e-6, -1e-6):
            out = pose.copy()
            contact_model.moved(model, pose, sign * step, 1.0 / cspace.reach, out)
            ends.append(rows_at(out))
        if len({len(here), *map(len, ends)}) > 1 or len(here) in (0, contact_model.CAPACITY):
            continue
        slopes = (ends[0][:, 0] - ends[1][:, 0]) / 2e-6
        # Where parts overlap, the depth has kinks; where they do not, it has none.
        apart = here[:, 0] > 1e-3
        np.testing.assert_allclose((here[:, 1 : 1 + size] @ step)[apart], slopes[apart], atol=2e-4)
        checked += int(apart.sum())
    assert checked > 15


def test_steps_and_differences_are_inverse():
    cspace = CSpace(slit(0.1), chain(3))
    rng, model = np.random.default_rng(4), cspace.model
    one, two = cspace.poses(random_configurations(cspace.robot, rng, 2, -1.0, 1.0, 1.0))
    step, out = np.empty(robot_model.step_count(model)), one.copy()
    contact_model.difference(model, one, two, cspace.reach, step)
    contact_model.moved(model, one, step, 1.0 / cspace.reach, out)
    for part in (slice(3, 7), slice(7, 11), slice(11, 15)):
        assert abs(out[part] @ two[part]) == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(out[:3], two[:3], atol=1e-12)


def test_a_roadmap_over_joints_is_saved_and_loaded(tmp_path):
    cspace = CSpace(slit(1e-3), chain(3))
    rng = np.random.default_rng(7)
    start = free(cspace, rng, 1, [-12.0, -3.0, -3.0], [-6.0, 3.0, 3.0], 1.0)
    goal = free(cspace, rng, 1, [6.0, -3.0, -3.0], [12.0, 3.0, 3.0], 1.0)
    planner = HighwayRoadmap(cspace)
    first = planner.solve(start, goal, never)
    assert first.status == SOLVED
    planner.save(tmp_path / "roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "roadmap", cspace)
    before = loaded.statistics["lines"]
    again = loaded.solve(start, goal, never)
    assert again.status == SOLVED
    assert proved(cspace, again.path, start[0], goal[0])
    assert loaded.statistics["lines"] - before < 200
    graph = explored_graph(planner)
    ends = graph.configurations[graph.edges]
    assert cspace.are_motions_valid(ends[:50, 0], ends[:50, 1]).all()
    stretched = ArticulatedRobot(
        cspace.robot.links,
        (
            Joint.of("j0", "l0", "l1", "ball", [2.2, 0.0, 0.0]),
            Joint.of("j1", "l1", "l2", "ball", [2.1, 0.0, 0.0]),
        ),
    )
    with pytest.raises(Exception, match="another robot"):
        HighwayRoadmap.load(tmp_path / "roadmap", CSpace(slit(1e-3), stretched))


def test_anytime_paths_get_no_longer():
    cspace = CSpace(scattered(), snake(3))
    rows = free(cspace, np.random.default_rng(11), 2, 0.0, 10.0)
    found = []
    calls = iter(range(400))
    planner = HighwayRoadmap(cspace, RoadmapParameters(anytime=True, refine=0, layers=60))
    outcome = planner.solve(rows[:1], rows[1:], lambda: next(calls, None) is None, found.append)
    assert outcome.status == SOLVED
    lengths = [sum(cspace.distance(a, b) for a, b in pairwise(path)) for path in found]
    assert lengths == sorted(lengths, reverse=True)
    assert proved(cspace, outcome.path, rows[0], rows[1])


def test_quaternions_of_tests_are_unit():
    turns = quaternions(np.random.default_rng(0), 10, 1.0)
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1.0)
