"""Nearest neighbours against looking at all of them."""

import numpy as np
import pytest

from ellipsoid_planning.kernels import tree_tables
from ellipsoid_planning.kernels.tree_nearest import distance, insert, nearest
from ellipsoid_planning.trees.tables import grown, new_trees
from tests.roadmap.scenes import cage

KINDS = ("planar", "spatial", "fixed")


def random_poses(kind, count, random, spread=30.0):
    out = np.zeros((count, 7))
    out[:, 6] = 1.0
    n = 2 if kind == "planar" else 3
    out[:, :n] = random.uniform(-spread, spread, (count, n))
    if kind == "planar":
        half = random.uniform(-np.pi, np.pi, count)
        out[:, 5], out[:, 6] = np.sin(half), np.cos(half)
    elif kind == "spatial":
        q = random.normal(size=(count, 4))
        out[:, 3:] = q / np.linalg.norm(q, axis=1)[:, None]
    return out


def reference(poses, target, weight):
    steps = np.linalg.norm(poses[:, :3] - target[:3], axis=1)
    cosines = np.minimum(np.abs(poses[:, 3:] @ target[3:]), 1.0)
    return steps + weight * 2.0 * np.arccos(cosines)


def tree_of(scene, poses, weight):
    trees = grown(new_trees(), len(poses))
    for pose in poses:
        insert(scene, trees, 1, pose, tree_tables.NONE, weight)
    return trees


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("weight", [0.0, 0.3, 5.0, 300.0])
def test_nearest_is_the_nearest(kind, weight):
    random = np.random.default_rng(7)
    scene = cage(2 if kind == "planar" else 3).scene
    poses = random_poses(kind, 1500, random)
    # Many in one place, many of one orientation, and a straight line of them.
    poses[200:300, :3] = poses[200, :3]
    poses[300:400] = poses[300]
    poses[400:600, :3] = np.linspace([-20.0, 0.0, 0.0], [20.0, 0.0, 0.0], 200)
    trees = tree_of(scene, poses, weight)
    targets = np.vstack([random_poses(kind, 300, random, 60.0), poses[::50]])
    targets[::3, 3:] *= -1.0
    for target in targets:
        all_of_them = reference(poses, target, weight)
        found = nearest(trees, 1, target, weight)
        assert all_of_them[found] <= all_of_them.min() + 1e-6 * (1.0 + weight)
        assert abs(distance(poses[found], target, weight) - all_of_them[found]) < 1e-7 * (
            10.0 + weight
        )


@pytest.mark.parametrize("kind", KINDS)
def test_few_nodes_are_looked_at(kind):
    """The k-d tree stays shallow for random poses: a path from the root is no list of them all."""
    random = np.random.default_rng(3)
    scene = cage(2 if kind == "planar" else 3).scene
    trees = tree_of(scene, random_poses(kind, 4000, random), 3.0)
    depth = np.zeros(4000, dtype=int)
    for node in range(4000):
        for child in trees.links[1, node, tree_tables.BELOW : tree_tables.ABOVE + 1]:
            if child != tree_tables.NONE:
                depth[child] = depth[node] + 1
    assert depth.max() < 50
    assert np.count_nonzero(depth == 0) == 1


def test_a_tree_of_equal_nodes_still_answers():
    scene = cage(3).scene
    poses = np.tile([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0], (600, 1))
    trees = tree_of(scene, poses, 2.0)
    assert 0 <= nearest(trees, 1, np.array([9.0, 9.0, 9.0, 0.0, 0.6, 0.0, 0.8]), 2.0) < 600
