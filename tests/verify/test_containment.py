"""The room of parts in arenas, against oracles."""

import numpy as np
import pytest

from planners.verify.containment import room, room_at_least
from tests.oracles import Body, arena_clearance, containment_value
from tests.random_scenes import matrix, unit_vector


def batch_of(dimension, count, kind="mild", ratio=4.0):
    """Arenas, parts and offsets: some parts inside, some not."""
    rng = np.random.default_rng(6)
    arenas = np.array([matrix(rng, dimension, size=3.0) for _ in range(count)])
    parts = np.array([matrix(rng, dimension, kind, ratio, size=0.6) for _ in range(count)])
    offsets = [rng.uniform(0, 3.0) * unit_vector(rng, dimension) for _ in range(count)]
    return arenas, parts, np.array(offsets)


@pytest.mark.parametrize("dimension", [2, 3])
def test_room_is_the_oracle_s(dimension):
    arenas, parts, offsets = batch_of(dimension, 25)
    found = room(arenas, parts, offsets)
    zero = np.zeros(dimension)
    for k, value in enumerate(found):
        expected = arena_clearance(Body(zero, arenas[k]), Body(offsets[k], parts[k]))
        assert value == pytest.approx(expected, abs=1e-7)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("kind", ["mild", "needle"])
def test_the_sign_tells_inside_from_outside(dimension, kind):
    arenas, parts, offsets = batch_of(dimension, 60, kind, ratio=100.0)
    found = room(arenas, parts, offsets)
    zero = np.zeros(dimension)
    inside = [
        containment_value(Body(zero, arena), Body(offset, part)) <= 1.0
        for arena, part, offset in zip(arenas, parts, offsets, strict=True)
    ]
    assert 10 < sum(inside) < 58
    assert np.array_equal(found > 0.0, inside)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_cheap_bound_is_below(dimension):
    batch = batch_of(dimension, 100)
    low = room_at_least(*batch)
    assert np.any(np.isfinite(low))
    assert np.all(low <= room(*batch) + 1e-12)
