"""The tree over the obstacles: exact for any input, and little of it is looked at."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.scale_scenes import scale_scenario, side
from ellipsoid_planning.cspace.bounding_tree import bounding_tree
from ellipsoid_planning.kernels import broad_phase, layout, placement, validity
from ellipsoid_planning.kernels.layout import NODE_HIGH, NODE_LOW, NODE_OBSTACLE, NODE_SKIP
from tests import random_scenes

CENTRE, EXTENT = layout.BODY_CENTRE, layout.BODY_EXTENT


def boxes(rng, count, spread=5.0, kind="random"):
    """Body rows that have centres and half-extents only."""
    rows = np.zeros((count, layout.BODY))
    rows[:, CENTRE : CENTRE + 3] = rng.uniform(-spread, spread, size=(count, 3))
    if kind == "coincident":
        rows[:, CENTRE : CENTRE + 3] = rows[:1, CENTRE : CENTRE + 3]
    elif kind == "planar":
        rows[:, CENTRE + 2] = 0.0
    elif kind == "in a row":
        rows[:, CENTRE + 1 : CENTRE + 3] = 1.0
    elif kind == "twins":
        rows[: count // 2, CENTRE : CENTRE + 3] = rows[-(count // 2) :, CENTRE : CENTRE + 3]
    rows[:, EXTENT : EXTENT + 3] = rng.uniform(0.1, 1.0, size=(count, 3))
    return rows


def found(tree, low, high):
    """The obstacles that the kernel finds, as often as it finds them."""
    obstacles, node = [], broad_phase.next_overlap(tree, 0, *low, *high)
    while node >= 0:
        obstacles.append(int(tree[node, NODE_OBSTACLE]))
        node = broad_phase.next_overlap(tree, node + 1, *low, *high)
    return obstacles


def looked_at(tree, low, high):
    """How many nodes a traversal looks at: what the kernel does, in Python."""
    count, node = 0, 0
    while node < len(tree):
        count += 1
        box = tree[node]
        meets = np.all(box[NODE_LOW : NODE_LOW + 3] <= high)
        meets &= np.all(box[NODE_HIGH : NODE_HIGH + 3] >= low)
        node = node + 1 if meets else int(box[NODE_SKIP])
    return count


@pytest.mark.parametrize("kind", ["random", "coincident", "planar", "in a row", "twins"])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 7, 64, 501])
def test_the_tree_finds_what_brute_force_finds(kind, count):
    rng = np.random.default_rng([count, len(kind)])
    rows = boxes(rng, count, kind=kind)
    tree = bounding_tree(rows)
    assert len(tree) == 2 * count - 1
    assert sorted(tree[tree[:, NODE_OBSTACLE] >= 0, NODE_OBSTACLE]) == list(range(count))
    low = rows[:, CENTRE : CENTRE + 3] - rows[:, EXTENT : EXTENT + 3]
    high = rows[:, CENTRE : CENTRE + 3] + rows[:, EXTENT : EXTENT + 3]
    for _ in range(60):
        centre, half = rng.uniform(-6, 6, size=3), 10 ** rng.uniform(-3, 1, size=3)
        if rng.uniform() < 0.3:
            centre = rows[rng.integers(count), CENTRE : CENTRE + 3]
        meets = np.all((low <= centre + half) & (high >= centre - half), axis=1)
        assert sorted(found(tree, centre - half, centre + half)) == np.flatnonzero(meets).tolist()
    everything = found(tree, np.full(3, -np.inf), np.full(3, np.inf))
    assert sorted(everything) == list(range(count))


def test_a_box_that_only_touches_is_found():
    tree = bounding_tree(boxes(np.random.default_rng(1), 50))
    for node in tree[tree[:, NODE_OBSTACLE] >= 0]:
        corner = node[NODE_HIGH : NODE_HIGH + 3]
        assert int(node[NODE_OBSTACLE]) in found(tree, corner, corner + 1.0)


@pytest.mark.parametrize("count", [1, 2, 5, 100])
def test_nodes_hold_what_is_below_them(count):
    tree = bounding_tree(boxes(np.random.default_rng(count), count))
    for index, node in enumerate(tree):
        below = tree[index : int(node[NODE_SKIP])]
        assert np.all(below[:, NODE_LOW : NODE_LOW + 3] >= node[NODE_LOW : NODE_LOW + 3])
        assert np.all(below[:, NODE_HIGH : NODE_HIGH + 3] <= node[NODE_HIGH : NODE_HIGH + 3])
        leaves = np.count_nonzero(below[:, NODE_OBSTACLE] >= 0)
        assert len(below) == 2 * leaves - 1
        if leaves > 1:  # balanced
            left = int(tree[index + 1, NODE_SKIP]) - index - 1
            assert abs(left - (len(below) - 1 - left)) <= 2


def test_no_obstacle_makes_no_tree():
    tree = bounding_tree(np.zeros((0, layout.BODY)))
    assert tree.shape == (0, layout.NODE)
    assert found(tree, np.full(3, -np.inf), np.full(3, np.inf)) == []
    assert broad_phase.near_obstacle(tree, 0.0, 0.0, 0.0) == -1


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_hundred_times_the_obstacles_do_not_double_what_is_looked_at(dimension):
    rng = np.random.default_rng(7)
    looked = {}
    for count in (100, 10_000):
        tree = layout.tree_rows(scale_scenario(count, dimension).cspace().scene)
        spread, total = 0.5 * side(count, dimension), 0
        for _ in range(200):
            centre, half = np.zeros(3), np.full(3, 0.3)
            centre[:dimension] = rng.uniform(-spread, spread, size=dimension)
            total += looked_at(tree, centre - half, centre + half)
        looked[count] = total / 200
    assert looked[10_000] < 120
    assert looked[10_000] < 2.6 * looked[100]


@pytest.mark.parametrize("dimension", [2, 3])
def test_clearances_are_those_of_all_obstacles(dimension):
    rng = np.random.default_rng(3)
    scene = random_scenes.random_scene(rng, dimension, obstacles=120, arenas=0, parts=2, ratio=20)
    cspace = random_scenes.space_of(scene._replace(low=scene.low * 4, high=scene.high * 4))
    placed = np.empty((2, layout.PLACED))
    gaps = np.empty((2, 120))
    for pose in cspace.poses(random_scenes.random_configurations(rng, scene, 60, spread=30.0)):
        placement.place(cspace.scene, *pose, placed)
        validity.obstacle_gaps(cspace.scene, placed, gaps)
        value = validity.clearance_of(cspace.scene, *pose)
        if gaps.min() > 0:
            assert value == pytest.approx(gaps.min(), rel=1e-9, abs=1e-12)
        else:
            assert value <= 0
