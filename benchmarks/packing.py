"""The pruned search of a grid of packings against looking at each of them; a Markdown table.

    python -m benchmarks.packing

*each* tests every arrangement by itself with the same kernels; *FCL* does so with python-fcl: the
molecule's parts against those of all copies, up to three cells away, whose bounding spheres meet.
Both are measured on a sample of the arrangements and scaled up; the sample's answers must
agree with the search's.
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
    began = time.perf_counter()
    free = search.free(0, model.grid.base_poses)
    return free, time.perf_counter() - began


def each(model: PackingModel, numbers: np.ndarray) -> tuple[np.ndarray, float]:
    """Whether arrangements (m,) are free, and the seconds for one."""
    arrangements = model.grid.configurations(numbers)
    model.are_free(arrangements[:1])
    began = time.perf_counter()
    free = model.are_free(arrangements)
    return free, (time.perf_counter() - began) / len(numbers)


def by_fcl(model: PackingModel, numbers: np.ndarray) -> tuple[np.ndarray, float]:
    """The same by FCL."""
    arrangements = model.grid.configurations(numbers)
    began = time.perf_counter()
    free = np.array([fcl_free(model, q) for q in arrangements])
    return free, (time.perf_counter() - began) / len(numbers)


def fcl_free(model: PackingModel, configuration: np.ndarray) -> bool:
    """Whether FCL finds no two copies that meet; parts of one molecule are left to our kernels."""
    if own_parts_meet(model, configuration):
        return False
    operations, basis, _, _ = model.crystal
    centres, matrices = model.molecule.placed(configuration)
    axes = np.linalg.norm(matrices, axis=1)
    turns = matrices / axes[:, None, :]
    shapes = [fcl.Ellipsoid(*a) for a in axes]
    radii = axes.max(axis=1)
    own = [
        fcl.CollisionObject(shape, fcl.Transform(turn, centre))
        for shape, turn, centre in zip(shapes, turns, centres, strict=True)
    ]
    near = range(-CELLS, CELLS + 1)
    cells = near if model.dimension == 3 else (0,)
    for g, row in enumerate(operations):
        q, t = row[:9].reshape(3, 3), row[9:]
        for v in itertools.product(near, near, cells):
            if g == 0 and not any(v):
                continue
            moved = centres @ q.T + t + basis @ np.array(v, float)
            apart = np.linalg.norm(moved[None] - centres[:, None], axis=2)
            for i, j in np.argwhere(apart < radii[:, None] + radii):
                other = fcl.CollisionObject(shapes[j], fcl.Transform(q @ turns[j], moved[j]))
                if fcl.collide(own[i], other, fcl.CollisionRequest(), fcl.CollisionResult()):
                    return False
    return True


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
