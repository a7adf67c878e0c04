"""The pruned search of a grid of packings against looking at each of them; a Markdown table.

    python -m benchmarks.packing

*each* tests every arrangement by itself with the same kernels; *FCL* does so with python-fcl: the
molecule's parts against those of all copies, up to three cells away, whose bounding spheres meet
the molecule's, by FCL's own broad phase (a dynamic AABB tree). Both are measured on a sample of
the arrangements and scaled up; the sample's answers must agree with the search's. Times are of the
processor.
"""

from __future__ import annotations

import argparse
import itertools
import time

import fcl
import numpy as np

from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import PackingModel, load_model
from ellipsoid_planning.geometry.dual import gap

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")
EACH, FCL = 200_000, 400
CELLS = 3  # 1 misses copies that meet


def searched(model: PackingModel) -> tuple[np.ndarray, float]:
    """Numbers of the free arrangements, and the seconds that finding them took."""
    search = GridSearch(model)
    search.free(0, 1)
    began = time.process_time()
    free = search.free(0, model.grid.base_poses)
    return free, time.process_time() - began


def each(model: PackingModel, numbers: np.ndarray) -> tuple[np.ndarray, float]:
    """Whether arrangements (m,) are free, and the seconds for one."""
    arrangements = model.grid.configurations(numbers)
    model.are_free(arrangements[:1])
    began = time.process_time()
    free = model.are_free(arrangements)
    return free, (time.process_time() - began) / len(numbers)


def by_fcl(model: PackingModel, numbers: np.ndarray) -> tuple[np.ndarray, float]:
    """The same by FCL."""
    arrangements = model.grid.configurations(numbers)
    copies = copies_of(model)
    fcl_free(model, copies, arrangements[0])
    began = time.process_time()
    free = np.array([fcl_free(model, copies, q) for q in arrangements])
    return free, (time.process_time() - began) / len(numbers)


def copies_of(model: PackingModel) -> tuple[np.ndarray, np.ndarray]:
    """Rotations (C, 3, 3) and shifts (C, 3) of all copies but the molecule itself."""
    operations, basis, _, _ = model.crystal
    near = range(-CELLS, CELLS + 1)
    lattice = np.array(list(itertools.product(near, near, near if model.dimension == 3 else (0,))))
    rotations = np.repeat(operations[:, :9].reshape(-1, 3, 3), len(lattice), axis=0)
    shifts = (operations[:, None, 9:] + lattice @ basis.T).reshape(-1, 3)
    itself = np.tile(~lattice.any(axis=1), len(operations))
    itself[len(lattice) :] = False
    return rotations[~itself], shifts[~itself]


def fcl_free(
    model: PackingModel, copies: tuple[np.ndarray, np.ndarray], configuration: np.ndarray
) -> bool:
    """Whether FCL finds no two copies that meet; parts of one molecule are left to our kernels.

    The parts of the copies whose bounding spheres meet the molecule's go into one of FCL's
    dynamic AABB trees, the molecule's own parts into another, and FCL collides the two.
    """
    if own_parts_meet(model, configuration):
        return False
    centres, matrices = model.molecule.placed(configuration)
    axes = np.linalg.norm(matrices, axis=1)
    turns = matrices / axes[:, None, :]
    middle = centres.mean(axis=0)
    reach = float((np.linalg.norm(centres - middle, axis=1) + axes.max(axis=1)).max())
    rotations, shifts = copies
    near = np.linalg.norm(rotations @ middle + shifts - middle, axis=1) < 2.0 * reach
    shapes = [fcl.Ellipsoid(*a) for a in axes]
    others = [
        fcl.CollisionObject(shape, fcl.Transform(q @ turn, q @ centre + t))
        for q, t in zip(rotations[near], shifts[near], strict=True)
        for shape, turn, centre in zip(shapes, turns, centres, strict=True)
    ]
    own = [
        fcl.CollisionObject(shape, fcl.Transform(turn, centre))
        for shape, turn, centre in zip(shapes, turns, centres, strict=True)
    ]
    meeting = Meeting()
    tree_of(own).collide(tree_of(others), meeting, collide_pair)
    return not meeting.found


class Meeting:
    """Whether a pair has met."""

    found = False


def collide_pair(first: fcl.CollisionObject, second: fcl.CollisionObject, meeting: Meeting) -> bool:
    """FCL's callback for a pair whose boxes overlap; true ends the search."""
    meeting.found = bool(fcl.collide(first, second, fcl.CollisionRequest(), fcl.CollisionResult()))
    return meeting.found


def tree_of(objects: list[fcl.CollisionObject]) -> fcl.DynamicAABBTreeCollisionManager:
    """FCL's broad phase of some bodies."""
    tree = fcl.DynamicAABBTreeCollisionManager()
    tree.registerObjects(objects)
    tree.setup()
    return tree


def own_parts_meet(model: PackingModel, configuration: np.ndarray) -> bool:
    """Whether parts of one molecule meet that must not: only the planar rabbit's ears can."""
    if model.dimension == 3:
        return False
    bodies = model.molecule.bodies(configuration)
    return gap(bodies[1], bodies[2]).value <= 0.0


def row(name: str) -> str:
    """One line of the table."""
    model = load_model(name)
    free, seconds = searched(model)
    rng = np.random.default_rng(0)
    count = model.grid.count
    sample = np.sort(rng.choice(count, min(EACH, count), replace=False))
    ours, single = each(model, sample)
    assert np.array_equal(ours, np.isin(sample, free)), "the search disagrees with each alone"
    few = sample[:: max(1, len(sample) // FCL)]
    theirs, slow = by_fcl(model, few)
    differ = int(np.sum(theirs != np.isin(few, free)))
    assert differ == 0, f"FCL disagrees {differ} times"
    return (
        f"| {name} | {count:,} | {len(free):,} | {seconds:.3g} s "
        f"| {count * single / seconds:.3g}x | {count * slow / seconds:.2g}x |"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", nargs="*", default=list(NAMES), help="packing models, by name")
    print("| model | arrangements | free | pruned search | each alone | FCL |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for name in parser.parse_args().models:
        print(row(name), flush=True)


if __name__ == "__main__":
    main()
