"""The tree planner without OMPL: its paths, its edges, its samples, and how it ends."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.cspace.poses import configurations_from_poses
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.kernels import sampling, tree, tree_tables
from ellipsoid_planning.metric import path_length
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.trees.connect import FreeIntervalRRTConnect
from ellipsoid_planning.trees.parameters import TreeParameters
from ellipsoid_planning.trees.tables import grown, new_trees
from tests.motion_oracle import clearances
from tests.planners.planner_scenes import KINDS, arrays_of, least_clearance, scenario_of
from tests.roadmap.scenes import cage, configuration

BOTH = [2, 3]


def after(polls):
    """Told to stop when asked for the ``polls``-th time."""
    count = itertools.count(1)
    return lambda: next(count) >= polls


def never():
    return False


def solved(scenario, **parameters):
    planner = FreeIntervalRRTConnect(scenario.cspace(), TreeParameters(**parameters))
    outcome = planner.solve(scenario.start[None], scenario.goal[None], never)
    assert outcome.status == "solved"
    return planner, outcome.path


def assert_edges_are_proved(planner):
    first, last = planner.edges()
    assert len(first) == planner.statistics["start_vertices"] + (
        planner.statistics["goal_vertices"] - 2
    )
    assert planner.cspace.are_motions_valid(first, last).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_every_motion_of_a_path_is_proved(kind, clearance):
    scenario = scenario_of(kind, clearance)
    planner, path = solved(scenario)
    np.testing.assert_allclose(path[[0, -1]], [scenario.start, scenario.goal], atol=1e-12)
    assert planner.cspace.are_motions_valid(path[:-1], path[1:]).all()
    assert least_clearance(scenario, path) >= clearance - 1e-9
    assert planner.statistics["direct_motions"] == 0
    assert len(path) > 2


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("reach", [None, 1.5])
def test_every_edge_of_both_trees_is_proved(kind, reach):
    scenario = scenario_of(kind, blocked=True)
    planner = FreeIntervalRRTConnect(scenario.cspace(), TreeParameters(range=reach))
    outcome = planner.solve(scenario.start[None], scenario.goal[None], after(8))
    assert (outcome.status, outcome.path) == ("timeout", None)
    assert min(planner.statistics[f"{side}_vertices"] for side in ("start", "goal")) > 20
    assert_edges_are_proved(planner)
    first, last = planner.edges()
    configurations = np.vstack([first, last])
    assert clearances(arrays_of(scenario), configurations).min() >= 0.0
    if reach is not None:
        steps = np.linalg.norm((last - first)[:, : scenario.dimension], axis=1)
        assert steps.max() <= reach * (1.0 + 1e-9)


@pytest.mark.parametrize("n", BOTH)
def test_separated_components_are_never_joined(n):
    cspace = cage(n)
    planner = FreeIntervalRRTConnect(cspace)
    start, goal = configuration(cspace, *[20.0] * n), configuration(cspace, *[0.0] * n)
    for _ in range(3):
        assert planner.solve(start, goal, after(4)).status == "timeout"
    assert_edges_are_proved(planner)
    first, last = planner.edges()
    inside = np.abs(np.vstack([first, last])[:, :n]).max(axis=1) < 3.0
    half = len(first)
    assert (inside[:half] == inside[half:]).all()
    assert inside.any()
    assert not inside.all()


@pytest.mark.parametrize("kind", KINDS)
def test_start_and_goal_may_be_the_same(kind):
    scenario = scenario_of(kind)
    planner = FreeIntervalRRTConnect(scenario.cspace())
    outcome = planner.solve(scenario.start[None], scenario.start[None], never)
    np.testing.assert_allclose(outcome.path, [scenario.start] * 2, atol=1e-12)
    assert planner.statistics["direct_motions"] == 1


@pytest.mark.parametrize("kind", KINDS)
def test_the_seed_decides_everything_however_long_bursts_are(kind, monkeypatch):
    scenario = scenario_of(kind)
    planner, path = solved(scenario, seed=5)
    before = planner.statistics
    assert not np.array_equal(path, solved(scenario, seed=6)[1])
    for burst in (1, 3):
        monkeypatch.setattr("ellipsoid_planning.trees.connect._FIRST_BURST", burst)
        monkeypatch.setattr("ellipsoid_planning.trees.connect._LONGEST_BURST", burst)
        again, same = solved(scenario, seed=5)
        np.testing.assert_array_equal(path, same)
        assert again.statistics == before
    planner.clear()
    outcome = planner.solve(scenario.start[None], scenario.goal[None], never)
    np.testing.assert_array_equal(path, outcome.path)


def test_several_starts_and_goals():
    scenario = scenario_of("planar")
    cspace = scenario.cspace()
    starts = np.array([[-6.0, 0.0, 0.0], [-6.0, 2.0, 1.0], [-5.0, -2.0, -2.0]])
    goals = np.array([[6.0, 0.0, 1.0], [6.0, 1.0, 0.0]])
    planner = FreeIntervalRRTConnect(cspace)
    path = planner.solve(starts, goals, never).path
    assert (np.abs(starts - path[0]).max(axis=1) < 1e-12).any()
    assert (np.abs(goals - path[-1]).max(axis=1) < 1e-12).any()
    direct = planner.solve(starts, starts[1:2] + 0.1, never).path
    assert len(direct) == 2


def test_more_ends_than_a_tree_has_room_for():
    cspace = cage(2)
    random = np.random.default_rng(1)
    starts = random.uniform([10.0, 10.0, -3.0], [29.0, 29.0, 3.0], (700, 3))
    goals = random.uniform([-0.5, -0.5, -3.0], [0.5, 0.5, 3.0], (900, 3))
    planner = FreeIntervalRRTConnect(cspace)
    assert planner.solve(starts, goals, after(3)).status == "timeout"
    assert planner.statistics["start_vertices"] >= 700
    first, _ = planner.edges()
    counts = planner.statistics["start_vertices"], planner.statistics["goal_vertices"]
    assert len(first) == sum(counts) - 1600


def test_a_stopped_query_goes_on_and_another_one_starts_anew():
    scenario = scenario_of("planar", blocked=True)
    planner = FreeIntervalRRTConnect(scenario.cspace())
    start, goal = scenario.start[None], scenario.goal[None]
    planner.solve(start, goal, after(4))
    first = planner.statistics["start_vertices"]
    planner.solve(start, goal, after(4))
    assert planner.statistics["start_vertices"] > first
    planner.solve(start + 0.1, goal, after(2))
    assert planner.statistics["start_vertices"] < first
    for _ in range(2):
        planner.solve(start, goal, after(4))
    grown_to = planner.statistics["start_vertices"]
    planner.clear_query()
    planner.solve(start, goal, after(2))
    assert planner.statistics["start_vertices"] < grown_to
    planner.clear()
    assert planner.statistics["steps"] == 0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("uniform", [0.0, 1.0])
def test_all_that_is_drawn_is_valid(kind, uniform):
    """Without halvings and with nothing in the way of growing, nodes are the samples themselves."""
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    planner = FreeIntervalRRTConnect(cspace, TreeParameters(uniform=uniform, halvings=0))
    planner._plant(cspace.poses(scenario.start), cspace.poses(scenario.goal))
    drawn = 0
    for _ in range(300):
        before = planner.statistics
        planner._grow(np.empty((0, 7)), 1)
        if planner.statistics["blocked_draws"] == before["blocked_draws"]:
            drawn += 1
            sample = configurations_from_poses(cspace.robot, planner._trees.ends[:1])
            assert cspace.are_valid(sample).all()
    assert drawn > 30


def test_gates_are_tried_in_their_share_of_the_steps():
    scenario = scenario_of("spatial", blocked=True)
    cspace = scenario.cspace()
    # Far outside: nothing is joined to them, they are only counted.
    gates = np.array([[100.0 + k, 0, 0, 0, 0, 0, 1] for k in range(4)], dtype=float)
    planner = FreeIntervalRRTConnect(cspace, TreeParameters(gate_share=0.3))
    planner._plant(cspace.poses(scenario.start), cspace.poses(scenario.goal))
    seen = np.zeros(4)
    for _ in range(2000):
        before = planner.statistics["blocked_draws"]
        planner._grow(gates, 1)
        x = planner._trees.ends[0, 0]
        if x >= 100.0 and planner.statistics["blocked_draws"] == before:
            seen[int(x - 100.0)] += 1
    # Four standard deviations.
    assert abs(seen.sum() - 600) < 82
    assert np.abs(seen - 150).max() < 49


def test_gates_in_the_passage_help():
    scenario = load_scenario("rabbit-2d-narrow")
    cspace, steps = scenario.cspace(), {}
    _, path = solved(scenario, seed=99)
    for seeds in (None, cspace.poses(path[1:-1])):
        taken = []
        for seed in range(7):
            planner = FreeIntervalRRTConnect(cspace, TreeParameters(seed=seed))
            planner.solve(scenario.start[None], scenario.goal[None], never, seeds=seeds)
            taken.append(planner.statistics["steps"])
        steps[seeds is None] = np.median(taken)
    assert 1.5 * steps[False] < steps[True]


def test_a_gate_is_one_node_however_often_it_is_drawn():
    cspace = cage(2)
    start, goal = configuration(cspace, 20.0, 20.0), configuration(cspace, 0.0, 0.0)
    planner = FreeIntervalRRTConnect(cspace, TreeParameters(gate_share=1.0))
    gate = cspace.poses(configuration(cspace, 15.0, 15.0, yaw=1.0))
    planner.solve(start, goal, after(6), seeds=gate)
    assert planner.statistics["steps"] > 100
    assert planner.statistics["start_vertices"] == 2


@pytest.mark.parametrize(
    "seeds",
    [np.zeros((2, 7)), np.ones((2, 6)), np.ones((1, 1, 7)), [[np.nan] * 7], np.ones(3)],
)
def test_seeds_that_are_no_poses_are_refused(seeds):
    scenario = scenario_of("planar")
    planner = FreeIntervalRRTConnect(scenario.cspace())
    with pytest.raises(PlannerError, match=r"^seeds: expected"):
        planner.solve(scenario.start[None], scenario.goal[None], never, seeds=seeds)


def test_no_seeds_are_as_good_as_none():
    scenario = scenario_of("planar")
    paths = []
    for seeds in (None, [], np.empty((0, 7))):
        planner = FreeIntervalRRTConnect(scenario.cspace())
        start, goal = scenario.start[None], scenario.goal[None]
        paths.append(planner.solve(start, goal, never, seeds=seeds).path)
    np.testing.assert_array_equal(paths[0], paths[1])
    np.testing.assert_array_equal(paths[0], paths[2])


@pytest.mark.parametrize("kind", KINDS)
def test_anytime_gives_out_ever_shorter_paths(kind):
    scenario = scenario_of(kind)
    planner = FreeIntervalRRTConnect(scenario.cspace(), TreeParameters(anytime=True))
    found = []
    outcome = planner.solve(scenario.start[None], scenario.goal[None], after(600), found.append)
    lengths = [path_length(scenario.robot, path) for path in found]
    assert len(lengths) > 1
    assert (np.diff(lengths) < 0.0).all()
    np.testing.assert_array_equal(outcome.path, found[-1])
    for path in found:
        assert planner.cspace.are_motions_valid(path[:-1], path[1:]).all()


def test_trees_grow_beyond_their_first_tables():
    scenario = scenario_of("spatial", blocked=True)
    planner = FreeIntervalRRTConnect(scenario.cspace(), TreeParameters(range=0.5))
    first = planner._trees.poses.shape[1]
    while planner.statistics["start_vertices"] <= 3 * first:
        planner.solve(scenario.start[None], scenario.goal[None], after(20))
    assert planner._trees.poses.shape[1] > first
    assert_edges_are_proved(planner)


def test_a_step_without_room_changes_nothing():
    scenario = scenario_of("planar", blocked=True)
    cspace = scenario.cspace()
    planner = FreeIntervalRRTConnect(cspace)
    planner.solve(scenario.start[None], scenario.goal[None], after(5))
    trees = planner._trees
    tight = trees._replace(poses=trees.poses[:, : trees.counters[:2].max() + 2].copy())
    before = trees.counters.copy()
    numbers = np.random.default_rng(0).random((5, tree.ROW))
    status = tree.grow(
        cspace.scene, tight, sampling.PLANAR, planner._rest, np.empty((0, 7)), numbers,
        0.0, 0.5, np.inf, 1.0, 3,
    )  # fmt: skip
    assert status == tree_tables.GROW
    assert tight.counters[tree_tables.ROWS_USED] == 0
    before[tree_tables.ROWS_USED] = 0
    np.testing.assert_array_equal(before, tight.counters)


def test_grown_tables_keep_what_they_held():
    trees = new_trees()
    trees.counters[:2] = 400, 20
    trees.poses[:] = np.arange(trees.poses.size).reshape(trees.poses.shape)
    larger = grown(trees, 5000)
    assert larger.poses.shape[1] > 5400
    np.testing.assert_array_equal(larger.poses[:, : trees.poses.shape[1]], trees.poses)
    np.testing.assert_array_equal(larger.links[:, : trees.links.shape[1]], trees.links)
    assert grown(larger) is larger
