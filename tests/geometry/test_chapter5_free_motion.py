"""Thesis 5.5.2: the volume of free motion, its conditions for equality, and what fails else.

The thesis calls the closed form an upper bound where its conditions do not hold. It is a lower
one: motions that meet two obstacles, or an obstacle and the boundary, are subtracted more than
once or without having been counted.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.clearance import inner_clearance
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.free_motion import free_motion_volume
from ellipsoid_planning.geometry.kinematic import containment_formula, principal_formula
from ellipsoid_planning.geometry.rotation_ranges import yaw_range
from tests.geometry.chapter5 import ball, random_ellipsoid
from tests.oracles import combinations

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])
ARENA = Ellipsoid.from_semi_axes([10.0, 8.0], name="hall")
ROBOT = Ellipsoid.from_semi_axes([0.9, 0.4])
APART = (
    Ellipsoid.from_semi_axes([1.0, 0.5], [4.0, 0.0], 0.3),
    Ellipsoid.from_semi_axes([1.0, 0.7], [-4.0, 1.0], 0.9),
)
CLOSE = (
    Ellipsoid.from_semi_axes([1.0, 0.5], [1.0, 0.0], 0.3, name="left"),
    Ellipsoid.from_semi_axes([1.0, 0.7], [2.5, 1.0], 0.9, name="right"),
    Ellipsoid.from_semi_axes([1.0, 0.7], [-9.0, 1.0], 0.9, name="edge"),
    Ellipsoid.from_semi_axes([1.0, 1.0], [0.0, -5.0], name="alone"),
    Ellipsoid.from_semi_axes([1.0, 1.0], [40.0, -5.0], name="elsewhere"),
)


def measured(arena, obstacles, robot, count, *, rotates=True, low=0.0, high=2.0 * math.pi):
    """The free volume by rejection in a box around the arena, and its standard deviation."""
    rng = np.random.default_rng(552)
    yaw = rng.uniform(low, high, count) if rotates else np.zeros(count)
    half = arena.semi_axes
    positions = arena.centre + rng.uniform(-1.0, 1.0, (count, 2)) * half
    c, s = np.cos(yaw), np.sin(yaw)
    turned = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2) @ robot.matrix
    # Inside: by support functions in many normals.
    normals = unit_directions(2, 720)
    room = arena.support(normals) - positions @ normals.T
    free = np.all(np.linalg.norm(normals @ turned, axis=2) <= room, axis=1)
    for obstacle in obstacles:
        fixed = np.broadcast_to(obstacle.matrix, turned.shape)
        value, _ = combinations(obstacle.centre - positions, fixed, turned, 40)
        free &= value > 1.0
    box = 4.0 * float(np.prod(half)) * ((high - low) if rotates else 1.0)
    share = float(np.mean(free))
    return box * share, box * math.sqrt(share * (1.0 - share) / count)


def test_apart_the_closed_form_is_exact():
    found = free_motion_volume(ARENA, APART, ROBOT)
    assert found.kind == "exact"
    assert found.failing == ()
    assert found.upper == found.value
    expected = float(containment_formula(ARENA.semi_axes, ROBOT.semi_axes)) - sum(
        float(principal_formula(body.semi_axes, ROBOT.semi_axes)) for body in APART
    )
    assert found.value == pytest.approx(expected, rel=1e-14)
    assert found.fraction == pytest.approx(found.value / found.contained.value)


@pytest.mark.statistical
@pytest.mark.parametrize("rotates", [True, False])
def test_apart_the_closed_form_is_what_rejection_measures(rotates):
    found = free_motion_volume(ARENA, APART, ROBOT, rotates=rotates)
    assert found.kind == "exact"
    volume, deviation = measured(ARENA, APART, ROBOT, 3000, rotates=rotates)
    assert abs(found.value - volume) < 4.0 * deviation


@pytest.mark.statistical
@pytest.mark.parametrize("rotates", [True, False])
def test_close_together_it_is_a_lower_bound_and_not_an_upper_one(rotates):
    found = free_motion_volume(ARENA, CLOSE, ROBOT, rotates=rotates)
    assert found.kind == "lower"
    volume, deviation = measured(ARENA, CLOSE, ROBOT, 6000, rotates=rotates)
    assert found.value < volume + 4.0 * deviation
    assert volume - 4.0 * deviation < found.upper
    assert found.value < found.upper
    pairs = {frozenset((c.first, c.second)) for c in found.failing}
    assert {"edge", "the arena's boundary"} in pairs
    assert {"left", "right"} in pairs
    assert not any("elsewhere" in pair for pair in pairs)
    assert found.blocked[-1] == 0.0


def test_the_lower_bound_can_be_far_below_and_never_above():
    """Two obstacles in one place: their motions are subtracted twice."""
    one = APART[0]
    once = free_motion_volume(ARENA, [one], ROBOT)
    twice = free_motion_volume(ARENA, [one, one], ROBOT)
    assert once.kind == "exact"
    assert twice.kind == "lower"
    assert twice.value == pytest.approx(once.value - once.blocked[0], rel=1e-12)
    assert twice.value < once.value  # the true volume, so that the closed form is no upper bound
    assert twice.upper == pytest.approx(once.value, rel=1e-12)


def test_the_conditions_are_sharp():
    """Equality while the gap is at least the robot's length, 2 max(a)."""
    length = 2.0 * float(np.max(ROBOT.semi_axes))
    for extra, kind in ((1e-6, "exact"), (-1e-6, "lower")):
        pair = [ball(1.0, 2, [0.0, 0.0]), ball(1.0, 2, [2.0 + length + extra, 0.0])]
        assert free_motion_volume(ARENA, pair, ROBOT).kind == kind
        near = ball(1.0, 2, [0.0, 7.0 - length - extra])
        assert free_motion_volume(ARENA, [near], ROBOT).kind == kind
    # Without rotation: obstacles whose C-obstacles touch, the robot's width across apart.
    width = 2.0 * float(ROBOT.semi_axes[1])
    for extra, kind in ((1e-6, "exact"), (-1e-6, "lower")):
        pair = [ball(1.0, 2, [0.0, -1.0]), ball(1.0, 2, [0.0, 1.0 + width + extra])]
        assert free_motion_volume(ARENA, pair, ROBOT, rotates=False).kind == kind


def test_restricted_rotations_and_bodies_that_do_not_roll():
    part = free_motion_volume(ARENA, APART, ROBOT, rotations=yaw_range(0.2, 1.0))
    volume, deviation = measured(ARENA, APART, ROBOT, 3000, low=0.2, high=1.0)
    assert abs(part.value - volume) < 4.0 * deviation
    arena = Ellipsoid.from_semi_axes([10.0, 2.0])
    found = free_motion_volume(arena, [], ROBOT)
    assert found.contained.method == "quadrature"
    volume, deviation = measured(arena, [], ROBOT, 3000)
    assert abs(found.value - volume) < 4.0 * deviation


def test_space():
    arena = Ellipsoid.from_semi_axes([12.0, 10.0, 11.0])
    robot = Ellipsoid.from_semi_axes([0.5, 0.8, 1.0])
    obstacles = [ball(1.0, 3, [4.0, 0.0, 0.0]), Ellipsoid.from_semi_axes([1.0, 2.0, 0.5])]
    found = free_motion_volume(arena, obstacles, robot)
    assert found.kind == "lower"  # 4 - 1 - 1 = 2 apart, and the robot is 2 long
    moved = [ball(1.0, 3, [4.1, 0.0, 0.0]), obstacles[1]]
    found = free_motion_volume(arena, moved, robot)
    assert found.kind == "exact"
    blocked = [float(principal_formula(b.semi_axes, robot.semi_axes)) for b in moved]
    assert found.blocked == pytest.approx(tuple(blocked), rel=1e-14)
    assert free_motion_volume(arena, moved, robot, rotates=False).kind == "exact"


def test_a_full_arena_has_no_free_motion_and_one_too_small_none():
    crowd = [ball(3.0, 2, [x, 0.0]) for x in (-4.0, 0.0, 4.0)] * 3
    found = free_motion_volume(ARENA, crowd, ROBOT)
    assert found.value == 0.0
    assert found.kind == "lower"
    tiny = free_motion_volume(ball(0.3, 2), [], ROBOT)
    assert tiny.value == tiny.upper == tiny.fraction == 0.0


@settings(deadline=None, max_examples=12)
@given(seeds, dimensions)
def test_inner_clearance_is_the_distance_to_the_complement(seed, dimension):
    rng = np.random.default_rng(seed)
    outer = random_ellipsoid(rng, dimension, 4.0, 9.0)
    inner = random_ellipsoid(rng, dimension, 0.2, 1.0)
    found = inner_clearance(outer, inner)

    def slack(v):
        u = v / np.linalg.norm(v)
        return float(outer.support(u) - inner.support(u))

    starts = sorted(rng.normal(size=(500, dimension)), key=slack)[:2]
    best = min(minimize(slack, start, method="Nelder-Mead", tol=1e-12).fun for start in starts)
    assert found == pytest.approx(best, abs=1e-7)


def test_inner_clearance_of_flat_bodies():
    disc = Ellipsoid.from_semi_axes([1.0, 1.0, 1e-3])
    assert inner_clearance(disc, ball(4e-4, 3)) == pytest.approx(6e-4, rel=1e-9)
    assert inner_clearance(ball(2.0, 2), ball(0.5, 2, [1.0, 0.0])) == pytest.approx(0.5, rel=1e-12)
    assert inner_clearance(ball(2.0, 2), ball(0.5, 2, [5.0, 0.0])) == pytest.approx(-3.5, rel=1e-12)


def test_mixed_dimensions_are_refused():
    with pytest.raises(GeometryError, match="one dimension"):
        free_motion_volume(ARENA, [ball(1.0, 3)], ROBOT)
    with pytest.raises(GeometryError, match="one dimension"):
        inner_clearance(ARENA, ball(1.0, 3))
