"""Roadmaps that are saved and loaded answer as those that were kept."""

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.roadmap.scenes import body, cage, configuration, pillars
from tests.roadmap.stored import (
    answers,
)
from tests.roadmap.test_level import free_ends, is_proved, never, random_cspace


@pytest.mark.parametrize(
    ("n", "rotates", "values"),
    [
        (2, True, {}),
        (3, True, {}),
        (2, False, {}),
        (3, False, {}),
        (2, True, {"lines": 2, "layers": 3, "axis": 0, "seed": 5}),
        (3, True, {"lines": 2, "layers": 3, "neighbours": 2}),
    ],
)
def test_a_loaded_roadmap_answers_as_the_one_that_was_kept(n, rotates, values, tmp_path):
    cspace = random_cspace(5, n, rotates=rotates)
    ends = free_ends(cspace, 6)
    queries = [(next(ends), next(ends)) for _ in range(8)]
    kept = HighwayRoadmap(cspace, RoadmapParameters(**values))
    answers(kept, queries[:4])
    kept.save(tmp_path / "a.roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "a.roadmap", cspace)
    assert loaded.loaded
    assert loaded.statistics == kept.statistics
    back = [(goal, start) for start, goal in queries[:4]]
    for more in (queries[:4], back, queries[4:]):
        assert answers(loaded, more) == answers(kept, more)


@pytest.mark.parametrize("n", [2, 3])
def test_what_was_asked_before_takes_no_new_line(n, tmp_path):
    cspace = random_cspace(5, n)
    ends = free_ends(cspace, 6)
    kept = HighwayRoadmap(cspace)
    for _ in range(40):
        query, before = (next(ends), next(ends)), kept.statistics.get("lines", 0)
        if (
            kept.solve(*query, never).status == "solved"
            and kept.statistics.get("lines", 0) > before + 20
        ):
            break
    # Passages that were found on the way may lead elsewhere when they are known at first.
    for _ in range(10):
        before = kept.statistics
        kept.solve(*query, never)
        if kept.statistics["lines"] == before["lines"]:
            break
    before = kept.statistics
    kept.save(tmp_path / "a.roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "a.roadmap", cspace)
    assert loaded.solve(*query, never).status == "solved"
    for name in ("lines", "intervals", "layers"):
        assert loaded.statistics[name] == before[name] > 0


def test_finer_levels_go_on_with_the_same_random_orientations(tmp_path):
    cspace = cage(2, 8.0)
    parameters = RoadmapParameters(lines=2, layers=3, refine=1, axis=1, seed=9)
    query = configuration(cspace, 0.0, 0.0), configuration(cspace, 6.5, 6.5)
    kept = HighwayRoadmap(cspace, parameters)
    answers(kept, [query])
    kept.save(tmp_path / "a.roadmap")
    more = RoadmapParameters(**{**vars(parameters), "refine": 3})
    loaded = HighwayRoadmap.load(tmp_path / "a.roadmap", cspace, more)
    whole = HighwayRoadmap(cspace, more)
    answers(loaded, [query])
    answers(whole, [query])
    assert len(loaded.levels) == len(whole.levels) == 4
    for one, other in zip(loaded.levels, whole.levels, strict=True):
        np.testing.assert_array_equal(one.grid.orientations, other.grid.orientations)


def test_boxes_of_large_worlds_are_kept_too(tmp_path):
    robot = RigidRobot((body([1.0, 0.4]),))
    grid = np.stack(np.meshgrid(*[np.arange(-300.0, 301.0, 20.0)] * 2), axis=-1).reshape(-1, 2)
    world = World([-320.0] * 2, [320.0] * 2, tuple(body([2.0, 7.5], place) for place in grid))
    cspace = CSpace(world, robot)
    queries = [
        (configuration(cspace, -15.0, 5.0), configuration(cspace, 25.0, 4.0, yaw=1.0)),
        (configuration(cspace, 105.0, 105.0), configuration(cspace, 145.0, 103.0)),
    ]
    kept = HighwayRoadmap(cspace)
    answers(kept, queries)
    assert sum(level.box is not None for level in kept.levels) >= 2
    kept.save(tmp_path / "a.roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "a.roadmap", cspace)
    assert answers(loaded, queries * 2) == answers(kept, queries * 2)


def test_a_query_that_was_stopped_leaves_a_roadmap_like_any_other(tmp_path):
    cspace = cage(2, 60.0)
    query = configuration(cspace, 40.0, 40.0), configuration(cspace, 0.0, 0.0)
    kept, asked = HighwayRoadmap(cspace, RoadmapParameters(refine=0)), []

    def should_stop():
        asked.append(1)
        return len(asked) > 6

    kept.solve(*query, should_stop)
    kept.save(tmp_path / "a.roadmap")
    loaded = HighwayRoadmap.load(tmp_path / "a.roadmap", cspace)
    assert answers(loaded, [query]) == answers(kept, [query])


def test_an_empty_roadmap_can_be_kept(tmp_path):
    cspace = pillars(3)
    for roadmap in (HighwayRoadmap(cspace), HighwayRoadmap(cspace)):
        roadmap.save(tmp_path / "a.roadmap")
        roadmap.prepare()
    assert HighwayRoadmap.load(tmp_path / "a.roadmap", cspace).statistics["levels"] == 0


def test_the_same_roadmap_makes_the_same_file(planned, file, tmp_path):
    cspace, _ = planned
    HighwayRoadmap.load(file, cspace).save(tmp_path / "b.roadmap")
    assert (tmp_path / "b.roadmap").read_bytes() == file.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.roadmap", "b.roadmap"]


def test_a_loaded_roadmap_can_be_improved_anytime(planned, file):
    cspace, _ = planned
    ends = free_ends(cspace, 6)
    query = next(ends), next(ends)
    loaded = HighwayRoadmap.load(file, cspace, RoadmapParameters(anytime=True, refine=0))
    given, asked = [], []

    def should_stop():
        asked.append(1)
        return len(asked) > 200

    assert loaded.solve(*query, should_stop, given.append).status == "solved"
    assert given
    assert all(is_proved(cspace, path) for path in given)
