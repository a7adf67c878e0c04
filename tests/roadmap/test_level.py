"""The lazy search on one level and over levels, against the eager roadmap and dense checks."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import roadmap_tables
from ellipsoid_planning.metric import path_length
from ellipsoid_planning.roadmap import level, tables
from ellipsoid_planning.roadmap.eager import eager_roadmap, layer_orientations
from ellipsoid_planning.roadmap.graph import explored_graph
from ellipsoid_planning.roadmap.highway import EXHAUSTED, SOLVED, TIMEOUT, HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.world import World
from tests.random_scenes import rotation
from tests.roadmap.scenes import body, cage, components, configuration, pillars
from tests.told import StopAt


def never():
    return False


def random_cspace(seed, n, *, rotates=True, obstacles=14):
    random = np.random.default_rng(seed)
    cspace = pillars(n, rotates=rotates)
    blocks = tuple(
        body(random.uniform(0.5, 3.0, n), random.uniform(-8.0, 8.0, n), rotation(random, n))
        for _ in range(obstacles if n == 2 else 4 * obstacles)
    )
    world = World(cspace.world.low, cspace.world.high, blocks)
    return CSpace(world, cspace.robot)


def free_ends(cspace, seed):
    random = np.random.default_rng(seed)
    layers = layer_orientations(cspace)
    while True:
        row = layers[random.integers(len(layers))].copy()
        row[: cspace.dimension] = random.uniform(cspace.world.low, cspace.world.high)
        if cspace.is_valid(row):
            yield row[None]


def is_proved(cspace, path):
    return bool(cspace.are_motions_valid(path[:-1], path[1:]).all())


@pytest.mark.parametrize(
    ("n", "rotates", "lines", "layers"),
    [(2, True, 14, 12), (2, False, 20, 1), (3, True, 5, 20), (3, False, 9, 1)],
)
def test_what_the_eager_roadmap_joins_the_lazy_search_finds(n, rotates, lines, layers):
    parameters = RoadmapParameters(lines=lines, layers=layers, refine=0)
    found = 0
    for seed in range(8):
        cspace = random_cspace(seed, n, rotates=rotates)
        graph = eager_roadmap(cspace, layer_orientations(cspace, layers), parameters)
        label = components(len(graph.configurations), graph.edges)
        random = np.random.default_rng(seed)
        for _ in range(12):
            a, b = random.integers(len(label), size=2)
            start, goal = graph.configurations[[[a], [b]]]
            planner = HighwayRoadmap(cspace, parameters)
            outcome = planner.solve(start, goal, never)
            assert outcome.status in (SOLVED, EXHAUSTED)
            if label[a] == label[b]:
                assert outcome.status == SOLVED
            if outcome.path is None:
                continue
            found += 1
            np.testing.assert_allclose(outcome.path[[0, -1]], np.vstack([start, goal]), atol=1e-12)
            assert is_proved(cspace, outcome.path)
    assert found > 30


@pytest.mark.parametrize(("n", "axis"), [(2, 0), (2, 1), (3, 0), (3, 1), (3, 2)])
def test_every_swept_axis_works(n, axis):
    cspace = random_cspace(3, n)
    ends = free_ends(cspace, 3)
    solved = 0
    for _ in range(8):
        planner = HighwayRoadmap(cspace, RoadmapParameters(axis=axis, refine=0))
        outcome = planner.solve(next(ends), next(ends), never)
        solved += outcome.status == SOLVED
        assert outcome.path is None or is_proved(cspace, outcome.path)
    assert solved >= 4


@pytest.mark.parametrize("n", [2, 3])
def test_a_blocked_query_is_exhausted_at_the_first_level_without_refinement(n):
    cspace = cage(n)
    planner = HighwayRoadmap(cspace, RoadmapParameters(refine=0, axis=0))
    inside, outside = configuration(cspace, *[0.0] * n), configuration(cspace, *[20.0] * n)
    assert planner.solve(inside, outside, never).status == EXHAUSTED
    assert len(planner.levels) == 1
    # From the other side there is more to search.
    assert planner.solve(outside, inside, never).status == EXHAUSTED


def test_refinement_ends_at_its_cap():
    cspace = cage(2, 8.0)
    parameters = RoadmapParameters(lines=2, layers=3, refine=3, axis=1)
    planner = HighwayRoadmap(cspace, parameters)
    ends = configuration(cspace, 0.0, 0.0), configuration(cspace, 6.5, 6.5)
    assert planner.solve(*ends, never).status == EXHAUSTED
    assert planner.statistics["levels"] == 4
    lines = [len(level.grid.columns) for level in planner.levels]
    layers = [level.grid.own_layers for level in planner.levels]
    assert lines == sorted(lines)
    assert layers == [3, 8, 19, 47]


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("look", [1, 2, 10, 60])
def test_refinement_ends_soon_after_it_is_told(n, look):
    # The start sees so little that level after level is exhausted at once.
    cspace, stop = cage(n, 300.0), StopAt(look)
    start, goal = configuration(cspace, *[0.0] * n), configuration(cspace, *[200.0] * n)
    assert HighwayRoadmap(cspace).solve(start, goal, stop).status == TIMEOUT
    assert 0 <= stop.later <= 5


@pytest.mark.parametrize(("each_lasts", "most"), [(1.0, 60), (0.0, 60 * 1024)])
def test_bursts_that_last_long_are_cut_short(each_lasts, most, monkeypatch):
    ticks = itertools.count()
    clock = SimpleNamespace(perf_counter=lambda: each_lasts * next(ticks))
    monkeypatch.setattr(level, "time", clock)
    cspace, stop = cage(2, 60.0), StopAt(60)
    planner = HighwayRoadmap(cspace)
    ends = configuration(cspace, 40.0, 40.0), configuration(cspace, 0.0, 0.0)
    assert planner.solve(*ends, stop).status == TIMEOUT
    assert most / 100 < planner.statistics["expansions"] <= most


def test_the_same_seed_gives_the_same_path():
    cspace = random_cspace(5, 3)
    ends = free_ends(cspace, 5)
    start, goal = next(ends), next(ends)
    paths = [
        HighwayRoadmap(cspace, RoadmapParameters(lines=3, layers=4, seed=7)).solve(
            start, goal, never
        )
        for _ in range(3)
    ]
    assert paths[0].status == SOLVED
    for other in paths[1:]:
        np.testing.assert_array_equal(paths[0].path, other.path)


def test_a_second_query_evaluates_next_to_nothing():
    cspace = random_cspace(5, 3)
    ends = free_ends(cspace, 6)
    start, goal = next(ends), next(ends)
    planner = HighwayRoadmap(cspace, RoadmapParameters(refine=0))
    first = planner.solve(start, goal, never)
    before = planner.statistics
    second = planner.solve(start, goal, never)
    assert first.status == second.status == SOLVED
    assert planner.statistics["lines"] == before["lines"]
    assert planner.statistics["intervals"] == before["intervals"]
    planner.clear()
    assert not any(planner.statistics.values())


def test_tables_that_start_tiny_grow_without_changing_the_path(monkeypatch):
    cspace = random_cspace(4, 2, obstacles=25)
    ends = free_ends(cspace, 2)
    queries = [(next(ends), next(ends)) for _ in range(6)]
    parameters = RoadmapParameters(refine=2)
    expected = [HighwayRoadmap(cspace, parameters).solve(*q, never) for q in queries]
    grow = []
    monkeypatch.setattr(tables, "_ROWS", 1 << 7)
    monkeypatch.setattr(tables, "_WHITENED", 4)
    enough = tables._enough

    def counted(size, used):
        grow.append(enough(size, used) > size)
        return enough(size, used)

    monkeypatch.setattr(tables, "_enough", counted)
    for query, known in zip(queries, expected, strict=True):
        outcome = HighwayRoadmap(cspace, parameters).solve(*query, never)
        assert outcome.status == known.status
        if known.path is not None:
            np.testing.assert_array_equal(outcome.path, known.path)
    assert sum(grow) > 10


def test_thousands_of_starts_and_goals_fit_the_tables():
    cspace = cage(2, 12.0)
    random = np.random.default_rng(1)
    starts = np.column_stack([random.uniform(-1.0, 1.0, (3000, 2)), np.zeros(3000)])
    goals = np.column_stack([random.uniform(9.0, 11.0, (2, 2)), np.full(2, 0.2)])
    starts, goals = (rows[cspace.are_valid(rows)] for rows in (starts, goals))
    assert len(starts) > 1500
    level = HighwayRoadmap(cspace)._level(
        0, 0, None, cspace.poses(starts[:1]), cspace.poses(goals[:1])
    )
    status, path = level.solve(cspace.poses(starts), cspace.poses(goals), 1.0, 1.0, never)
    assert (status, len(path)) == (roadmap_tables.EXHAUSTED, 0)
    # More intervals than the tables begin with.
    assert level.tables.counters[roadmap_tables.NODES] > 4096


def test_many_neighbours_fit_the_tables():
    cspace = random_cspace(4, 3)
    ends = free_ends(cspace, 8)
    parameters = RoadmapParameters(neighbours=1000, layers=1500, refine=0, lines=4)
    outcome = HighwayRoadmap(cspace, parameters).solve(next(ends), next(ends), never)
    assert outcome.status == SOLVED


def test_anytime_gives_out_ever_shorter_paths():
    cspace = random_cspace(6, 2)
    ends = free_ends(cspace, 9)
    parameters = RoadmapParameters(anytime=True, inflation=10.0)
    improved = 0
    for _ in range(6):
        given = []
        outcome = HighwayRoadmap(cspace, parameters).solve(
            next(ends), next(ends), StopAt(400), given.append
        )
        if outcome.status != SOLVED:
            continue
        lengths = [path_length(cspace.robot, path) for path in given]
        assert lengths == sorted(lengths, reverse=True)
        assert lengths[-1] == pytest.approx(path_length(cspace.robot, outcome.path))
        assert all(is_proved(cspace, path) for path in given)
        improved += len(given) > 1
    assert improved >= 2


def test_start_and_goal_may_coincide():
    cspace = pillars(3)
    start = configuration(cspace, 0.0, 0.0, 0.0)
    outcome = HighwayRoadmap(cspace).solve(start, start, never)
    assert outcome.status == SOLVED
    np.testing.assert_array_equal(outcome.path, np.vstack([start, start]))


@pytest.mark.parametrize("n", [2, 3])
def test_the_explored_graph_has_proved_edges_only(n):
    cspace = random_cspace(4, n)
    planner = HighwayRoadmap(cspace, RoadmapParameters(refine=0))
    assert len(explored_graph(planner).configurations) == 0
    ends = free_ends(cspace, 8)
    for _ in range(4):
        planner.solve(next(ends), next(ends), never)
    graph = explored_graph(planner)
    assert len(graph.edges) > 10
    assert is_proved(cspace, graph.configurations[graph.edges[0]])
    first, last = graph.configurations[graph.edges.T]
    assert cspace.are_motions_valid(first, last).all()
    assert graph.edges.max() < len(graph.configurations) == len(graph.layers)
