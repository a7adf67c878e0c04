"""Where a query looks in a large world."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scale_scenes import scale_scenario
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.roadmap.regions import is_same, query_boxes, within

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
        inner_low, inner_high = places.min(axis=0), places.max(axis=0)
        boxes = query_boxes(cspace, ends)
        assert boxes[-1] is None
        for box in boxes[:-1]:
            assert np.all(box[0] <= inner_low)
            assert np.all(box[1] >= inner_high)
            assert np.all(box[0] >= low)
            assert np.all(box[1] <= high)
            inner_low, inner_high = box
        assert len(boxes) < 6


@DIMENSIONS
def test_the_box_depends_on_the_ends_and_not_on_the_world(dimension):
    boxes = []
    for count in (1000, 10_000):
        scenario = scale_scenario(count, dimension)
        cspace = scenario.cspace()
        boxes.append(query_boxes(cspace, cspace.poses([scenario.start, scenario.goal])))
    assert is_same(boxes[0][0], boxes[1][0])
    assert len(boxes[0]) < len(boxes[1])


@DIMENSIONS
def test_a_small_world_is_taken_as_a_whole(dimension):
    scenario = scale_scenario(10, dimension)
    cspace = scenario.cspace()
    assert query_boxes(cspace, cspace.poses([scenario.start, scenario.goal])) == [None]
    assert within(cspace, None) is cspace


def test_queries_side_by_side_share_a_box():
    cspace = scale_scenario(10_000, 2).cspace()
    first = query_boxes(cspace, ends_of(cspace, [0.1, 0.1], [2.0, 1.0]))
    second = query_boxes(cspace, ends_of(cspace, [0.15, 0.12], [1.98, 1.03]))
    assert len(first) == len(second)
    assert all(map(is_same, first, second))
    assert not is_same(first[0], first[1])
    assert not is_same(first[0], None)
    assert isinstance(within(cspace, first[0]), LocalCSpace)


def test_a_query_in_one_place_has_room_to_turn():
    cspace = scale_scenario(10_000, 2).cspace()
    low, high = query_boxes(cspace, ends_of(cspace, [3.0, 3.0], [3.0, 3.0]))[0]
    assert np.all(high - low > 1.0)
    assert np.all(high - low < 10.0)
