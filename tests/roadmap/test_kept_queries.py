"""Queries on a kept roadmap go the way that they would go on an empty one, with less to compute."""

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap import highway
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.trees.connect import FreeIntervalRRTConnect
from ellipsoid_planning.world import World
from tests.articulated_scenes import chain, slit
from tests.roadmap.scenes import body, cage, configuration
from tests.roadmap.test_articulated_roadmap import free
from tests.roadmap.test_level import free_ends, never, random_cspace

WORK = ("expansions", "edges_certified", "edges_refused")
TREE_WORK = ("steps", "blocked_draws", "edges_certified", "edges_refused")


def asked(planner, query, counts=WORK):
    """Path and counts of work of one query."""
    before = planner.statistics
    outcome = planner.solve(*query, never)
    after = planner.statistics
    return outcome.path, [after.get(name, 0) - before.get(name, 0) for name in counts]


def assert_as_fresh(cspace, queries, parameters=None):
    """Ask a roadmap that is kept, and an empty one for every query: the work of either."""
    kept, total = HighwayRoadmap(cspace, parameters), np.zeros((2, len(WORK)))
    for query in queries:
        path, work = asked(kept, query)
        fresh_path, fresh_work = asked(HighwayRoadmap(cspace, parameters), query)
        np.testing.assert_array_equal(path, fresh_path)
        assert work[0] == fresh_work[0]
        assert sum(work) <= sum(fresh_work)
        total += [work, fresh_work]
    return total


def maze_queries(count, seed=7):
    cspace, random = load_scenario("maze-2d").cspace(), np.random.default_rng(seed)
    low, high = [*cspace.world.low, -np.pi], [*cspace.world.high, np.pi]
    rows = random.uniform(low, high, (60 * count, 3))
    rows = [row[None] for row in rows if cspace.is_valid(row)][: 2 * count]
    assert len(rows) == 2 * count
    return cspace, list(zip(rows[::2], rows[1::2], strict=True))


def test_many_queries_in_a_maze():
    cspace, queries = maze_queries(20)
    kept, fresh = assert_as_fresh(cspace, [*queries, *queries[:3]])
    assert fresh[0] > 1000
    # The search is the same, but a part of what it looks at is known.
    assert kept[1] + kept[2] < 0.98 * (fresh[1] + fresh[2])


@pytest.mark.parametrize(("n", "rotates"), [(2, True), (2, False), (3, True), (3, False)])
def test_random_scenes(n, rotates):
    cspace = random_cspace(5, n, rotates=rotates)
    ends = free_ends(cspace, 6)
    assert_as_fresh(cspace, [(next(ends), next(ends)) for _ in range(8)])


def test_levels_are_turned_alike_whichever_query_makes_them():
    cspace = cage(2, 8.0)
    parameters = RoadmapParameters(lines=2, layers=3, refine=2)
    inside = configuration(cspace, 0.0, 0.0)
    queries = [(inside, configuration(cspace, 6.5, y)) for y in (6.5, -6.5)]
    assert_as_fresh(cspace, [*queries, (queries[0][1], queries[1][1])], parameters)


def test_robots_with_joints():
    cspace, random = CSpace(slit(0.5), chain(3)), np.random.default_rng(7)
    starts = free(cspace, random, 3, [-12.0, -3.0, -3.0], [-6.0, 3.0, 3.0], 1.0)
    goals = free(cspace, random, 3, [6.0, -3.0, -3.0], [12.0, 3.0, 3.0], 1.0)
    assert_as_fresh(cspace, [(a[None], b[None]) for a, b in zip(starts, goals, strict=True)])


def test_an_arm_finds_the_layers_again_that_it_knew():
    scenario = load_scenario("arm-6r")
    query = scenario.start[None], scenario.goal[None]
    roadmap = HighwayRoadmap(scenario.cspace())
    path, work = asked(roadmap, query)
    back, _ = asked(roadmap, query[::-1])
    again, less = asked(roadmap, query)
    assert len(back) > 2
    np.testing.assert_array_equal(again, path)
    assert less[0] == work[0]


def test_a_loaded_roadmap(tmp_path):
    cspace, queries = maze_queries(6)
    kept = HighwayRoadmap(cspace)
    for query in queries[:4]:
        kept.solve(*query, never)
    kept.save(tmp_path / "maze.roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "maze.roadmap", cspace)
    for query in queries[2:]:
        path, work = asked(loaded, query)
        fresh_path, fresh_work = asked(HighwayRoadmap(cspace), query)
        np.testing.assert_array_equal(path, fresh_path)
        assert work[0] == fresh_work[0]


def test_boxes_of_a_large_world_are_kept_up_to_a_number(monkeypatch):
    monkeypatch.setattr(highway, "_MOST_BOXES", 2)
    robot = RigidRobot((body([1.0, 0.4]),))
    grid = np.stack(np.meshgrid(*[np.arange(-300.0, 301.0, 20.0)] * 2), axis=-1).reshape(-1, 2)
    world = World([-320.0] * 2, [320.0] * 2, tuple(body([2.0, 7.5], place) for place in grid))
    cspace = CSpace(world, robot)
    queries = [
        (configuration(cspace, x - 15.0, 5.0), configuration(cspace, x + 25.0, 4.0, yaw=1.0))
        for x in (-200.0, -100.0, 0.0, 100.0, 200.0)
    ]
    assert_as_fresh(cspace, queries)
    roadmap = HighwayRoadmap(cspace)
    for query in queries:
        assert roadmap.solve(*query, never).status == SOLVED
    boxes = {id(level.passages) for level in roadmap.levels if level.box is not None}
    assert 0 < len(boxes) <= 2
    assert len(roadmap.passages) == len({id(level.passages) for level in roadmap.levels})


def test_trees_do_not_depend_on_the_queries_before():
    cspace, queries = maze_queries(6)
    kept = FreeIntervalRRTConnect(cspace)
    for query in queries:
        path, work = asked(kept, query, TREE_WORK)
        fresh_path, fresh_work = asked(FreeIntervalRRTConnect(cspace), query, TREE_WORK)
        np.testing.assert_array_equal(path, fresh_path)
        assert work == fresh_work
