"""Rotations that miss being orthonormal by a little are replaced by the nearest."""

from __future__ import annotations

import numpy as np
import pytest

from ellipsoid_planning.geometry.dual import containment_of
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.orientation import check_rotation
from tests import exact, oracles, random_scenes


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_is_nearly_a_rotation_becomes_one(dimension: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        rotation = random_scenes.rotation(rng, dimension)
        off = rotation + 1e-10 * rng.uniform(-1, 1, rotation.shape)
        checked = check_rotation(off, dimension)
        assert np.abs(checked.T @ checked - np.eye(dimension)).max() < 1e-15
        assert np.abs(checked - off).max() < 1e-9
        assert np.array_equal(check_rotation(rotation, dimension), rotation)


@pytest.mark.parametrize("dimension", [2, 3])
def test_no_part_is_said_to_be_inside_an_arena_that_is_off_by_a_little(dimension: int) -> None:
    """The arena's stored matrix was smaller by 4e-10 than the one that the decision inverted."""
    rng = np.random.default_rng(2)
    rotation, axes = random_scenes.rotation(rng, dimension), np.linspace(2.0, 3.0, dimension)
    arena = Ellipsoid(np.zeros(dimension), (1.0 - 4e-10) * rotation, axes)
    part = Ellipsoid(np.zeros(dimension), rotation, (1.0 - 2e-10) * axes)
    inside = exact.is_contained(oracles.body_of(arena), oracles.body_of(part))
    assert containment_of(part, arena).extent > 1.0 or inside
