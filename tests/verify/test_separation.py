"""Distances of pairs of bodies, against oracles and against bodies built to touch."""

import numpy as np
import pytest

from planners.verify.separation import cheap_bounds, distances
from tests.oracles import Body, distance_bounds
from tests.random_scenes import crossing_needles, matrix, touching_pair, unit_vector


def arrays(pairs):
    """Matrices and offsets of pairs of bodies."""
    first = np.array([pair[0].matrix for pair in pairs])
    second = np.array([pair[1].matrix for pair in pairs])
    return first, second, np.array([pair[1].centre - pair[0].centre for pair in pairs])


def random_pairs(rng, dimension, count, reach=4.0):
    """Pairs of bodies at random distances, some of which overlap."""
    offsets = [rng.uniform(0, reach) * unit_vector(rng, dimension) for _ in range(count)]
    bodies = [(matrix(rng, dimension), matrix(rng, dimension)) for _ in range(count)]
    zero = np.zeros(dimension)
    return [(Body(zero, a), Body(c, b)) for (a, b), c in zip(bodies, offsets, strict=True)]


@pytest.mark.parametrize("dimension", [2, 3])
def test_distances_are_the_oracle_s(dimension):
    pairs = random_pairs(np.random.default_rng(1), dimension, 200)
    found = distances(*arrays(pairs))
    apart = found.lower > 0.0
    assert 50 < np.sum(apart) < 200
    for k in np.flatnonzero(apart):
        low, high = distance_bounds(*pairs[k])
        assert found.lower[k] == pytest.approx(low, abs=1e-11)
        assert found.upper[k] == pytest.approx(high, abs=1e-9)
    assert np.all(found.meet == ~apart)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("gap", [1e-3, 1e-8, 1e-12])
def test_pairs_built_to_touch_are_told_apart(dimension, gap):
    rng = np.random.default_rng(2)
    pairs = [touching_pair(rng, dimension, gap) for _ in range(100)]
    found = distances(*arrays(pairs))
    assert np.all(found.lower > 0.5 * gap)
    assert not np.any(found.meet)
    pairs = [touching_pair(rng, dimension, -gap) for _ in range(100)]
    found = distances(*arrays(pairs))
    assert np.all(found.meet)
    assert np.all(found.lower == pytest.approx(-gap, rel=0.1, abs=1e-13))


@pytest.mark.parametrize("ratio", [1e2, 1e4])
def test_needles_that_cross_or_miss(ratio):
    rng = np.random.default_rng(3)
    miss = distances(*arrays([crossing_needles(rng, ratio, 1e-6) for _ in range(50)]))
    assert np.all(miss.lower > 0.0)
    assert not np.any(miss.meet)
    cross = distances(*arrays([crossing_needles(rng, ratio, -1e-6) for _ in range(50)]))
    assert np.all(cross.meet)
    assert np.all(cross.lower < 0.0)


def test_concentric_bodies_meet():
    rng = np.random.default_rng(4)
    first = np.array([matrix(rng, 3) for _ in range(10)])
    found = distances(first, first, np.zeros((10, 3)))
    assert np.all(found.meet)
    assert np.all(np.isfinite(found.lower))


def test_cheap_bounds_hold_the_distance():
    batch = arrays(random_pairs(np.random.default_rng(5), 3, 200))
    found = distances(*batch)
    low, high = cheap_bounds(*batch)
    apart = found.lower > 0.0
    assert np.all(low[apart] <= found.upper[apart] + 1e-12)
    assert np.all(high[apart] >= found.lower[apart] - 1e-12)
