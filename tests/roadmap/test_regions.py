"""Where a query looks in a large world."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scale_scenes import scale_scenario
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.roadmap.regions import query_box, within

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def ends_of(cspace, *places):
    rows = np.zeros((len(places), 7))
    rows[:, 6] = 1.0
    rows[:, : cspace.dimension] = places
    return rows


@DIMENSIONS
def test_boxes_hold_their_ends_and_grow_to_the_whole(dimension):
    cspace = scale_scenario(1000, dimension).cspace()
    random = np.random.default_rng(1)
    low, high = cspace.world.low, cspace.world.high
    for _ in range(50):
        places = random.uniform(low, high, size=(3, dimension)) * random.choice([0.01, 0.1, 1.0])
        ends = ends_of(cspace, *places)
        inner = places, places
        for doublings in range(20):
            box = query_box(cspace, ends, doublings)
            if box is None:
                break
            assert np.all(box[0] <= np.min(inner[0], axis=0))
            assert np.all(box[1] >= np.max(inner[1], axis=0))
            assert np.all(box[0] >= low)
            assert np.all(box[1] <= high)
            inner = (box[0][None], box[1][None])
        assert box is None


@DIMENSIONS
def test_the_box_depends_on_the_ends_and_not_on_the_world(dimension):
    boxes = []
    for count in (1000, 10_000):
        scenario = scale_scenario(count, dimension)
        cspace = scenario.cspace()
        boxes.append(query_box(cspace, cspace.poses([scenario.start, scenario.goal]), 0))
    assert np.array_equal(*boxes)


@DIMENSIONS
def test_a_small_world_is_taken_as_a_whole(dimension):
    scenario = scale_scenario(10, dimension)
    cspace = scenario.cspace()
    box = query_box(cspace, cspace.poses([scenario.start, scenario.goal]), 0)
    assert box is None
    assert within(cspace, box) is cspace


def test_queries_side_by_side_share_a_box():
    cspace = scale_scenario(10_000, 2).cspace()
    first = query_box(cspace, ends_of(cspace, [0.1, 0.1], [2.0, 1.0]), 0)
    second = query_box(cspace, ends_of(cspace, [0.15, 0.12], [1.98, 1.03]), 0)
    assert np.array_equal(first, second)
    assert isinstance(within(cspace, first), LocalCSpace)


def test_a_query_in_one_place_has_room_to_turn():
    cspace = scale_scenario(10_000, 2).cspace()
    low, high = query_box(cspace, ends_of(cspace, [3.0, 3.0], [3.0, 3.0]), 0)
    assert np.all(high - low > 1.0)
    assert np.all(high - low < 10.0)
