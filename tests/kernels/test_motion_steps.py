"""How many proofs a motion takes: no more than the root of 1/gap asks for."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.steps_cases import CASES, GAPS, exponent, proofs
from tests import motion_oracle, random_scenes
from tests.oracles import Body

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_proofs_grow_no_faster_than_the_root(case):
    counts = [proofs(case, gap) for gap in GAPS]
    assert min(counts) > 0
    assert exponent(GAPS[1:], counts[1:]) <= 0.55
    # Bisection costs at most a factor of two beside the root.
    assert max(np.diff(np.log(counts[1:]))) <= np.log(10.0) / 2 + np.log(2.0)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_what_meets_by_a_hair_is_refused_soon(case):
    count = proofs(case, -1e-4)
    assert -100_000 < count < 0


@DIMENSIONS
def test_motions_that_are_tight_once_take_few_proofs(dimension):
    rng = np.random.default_rng(21)
    counts = {1e-2: [], 1e-5: [], 1e-8: []}
    for _ in range(12):
        scene = random_scenes.random_scene(rng, dimension, obstacles=1, arenas=0, parts=1)
        first = random_scenes.random_configurations(rng, scene, 1, spread=3)[0]
        second = random_scenes.nearby_configuration(rng, scene, first, 2.0, 2.8)
        middle = 0.5 * (first + second)[:dimension]
        side = 4 * random_scenes.unit_vector(rng, dimension)
        scene = scene._replace(obstacles=(Body(middle + side, scene.obstacles[0].matrix),))
        for gap, found in counts.items():
            pushed = motion_oracle.pushed(scene, first, second, gap)
            found.append(random_scenes.space_of(pushed).motion_proofs(first, second)[0])
    for found in counts.values():
        assert min(found) > 0
    assert max(counts[1e-8]) < 100
