"""Thesis 5.5: kinematic formulas and their translative and restricted versions; Figs. 5.15, 16."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.difference_volume import difference_volume
from ellipsoid_planning.geometry.kinematic import containment_formula, principal_formula
from ellipsoid_planning.geometry.motion_volume import contained_motions, meeting_motions
from ellipsoid_planning.geometry.rolling import rolls_at_every_orientation
from ellipsoid_planning.geometry.rotation_ranges import (
    all_rotations,
    angle_range,
    euler_zxz_range,
    single_rotation,
    yaw_range,
)
from ellipsoid_planning.geometry.sum_volume import sum_volume
from tests.geometry.chapter5 import ball, random_ellipsoid
from tests.oracles import Body, combinations

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])
FULL = {2: 2.0 * math.pi, 3: 8.0 * math.pi**2}
PLANE = ([18.0, 15.0], [2.0, 3.0])
SPACE = ([30.0, 40.0, 50.0], [1.0, 2.0, 3.0])


def body(axes):
    return Ellipsoid.from_semi_axes(axes)


def over_all(function, first, second, count):
    every = all_rotations(len(first), count)
    return float(function(np.diag(first), every.rotations @ np.diag(second)) @ every.weights)


def test_figure_5_15_containment_in_the_plane():
    """3799.811 both ways; the thesis' 3.799e3 is cut, not rounded."""
    assert rolls_at_every_orientation(*PLANE)
    formula = float(containment_formula(*PLANE))
    assert formula == pytest.approx(3799.811, abs=0.0005)
    assert over_all(difference_volume, *PLANE, 60) == pytest.approx(formula, rel=1e-9)
    headings = yaw_range(0.3, 0.3 + 2.0 * math.pi, 200)
    assert contained_motions(body(PLANE[0]), body(PLANE[1]), headings).value == pytest.approx(
        formula, rel=1e-9
    )


def test_figure_5_16_containment_in_space():
    """1.668926e7; printed are 1.64e7 by the formula and 1.57e7 by a coarse grid."""
    assert rolls_at_every_orientation(*SPACE)
    formula = float(containment_formula(*SPACE))
    assert formula == pytest.approx(1.668926e7, rel=1e-6)
    assert over_all(difference_volume, *SPACE, 14) == pytest.approx(formula, rel=1e-9)
    assert contained_motions(body(SPACE[0]), body(SPACE[1])).value == formula
    assert contained_motions(body(SPACE[0]), body(SPACE[1])).method == "closed form"


@pytest.mark.statistical
def test_figure_5_16_by_haar_monte_carlo():
    turns = Rotation.random(20000, random_state=516).as_matrix()
    volumes = difference_volume(np.diag(SPACE[0]), turns @ np.diag(SPACE[1]))
    spread = FULL[3] * volumes.std() / math.sqrt(len(volumes))
    mean = FULL[3] * volumes.mean()
    assert abs(mean - float(containment_formula(*SPACE))) < 4.0 * spread
    assert spread < 1e-3 * mean


@pytest.mark.parametrize("dimension", [2, 3])
def test_balls_have_the_thesis_examples(dimension):
    """After (5.98): 2 pi, 8 pi^2 times the ball of the radii's sum or difference."""
    unit = math.pi if dimension == 2 else 4.0 / 3.0 * math.pi
    one, two = [3.0] * dimension, [1.25] * dimension
    for formula, radius in ((principal_formula, 4.25), (containment_formula, 1.75)):
        expected = FULL[dimension] * unit * radius**dimension
        assert float(formula(one, two)) == pytest.approx(expected, rel=1e-13)


@settings(deadline=None, max_examples=15)
@given(seeds, dimensions)
def test_formulas_are_means_over_all_rotations(seed, dimension):
    rng = np.random.default_rng(seed)
    outer, inner = rng.uniform(4.0, 6.0, dimension), rng.uniform(0.8, 1.2, dimension)
    count = 40 if dimension == 2 else 14
    meet = over_all(sum_volume, outer, inner, count)
    assert meet == pytest.approx(float(principal_formula(outer, inner)), rel=1e-9)
    assert meet == pytest.approx(float(principal_formula(inner, outer)), rel=1e-9)
    assert rolls_at_every_orientation(outer, inner)
    inside = over_all(difference_volume, outer, inner, count)
    assert inside == pytest.approx(float(containment_formula(outer, inner)), rel=1e-9)


@pytest.mark.statistical
def test_the_principal_formula_by_rejection():
    """Poses in a box, contact decided by the separating family (3.1)."""
    rng = np.random.default_rng(595)
    first, second = np.array([3.0, 1.0]), np.array([2.0, 0.5])
    count, half = 20000, 5.5
    yaw = rng.uniform(0.0, 2.0 * math.pi, count)
    c, s = np.cos(yaw), np.sin(yaw)
    turned = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2) * second
    offsets = rng.uniform(-half, half, (count, 2))
    fixed = np.broadcast_to(np.diag(first), (count, 2, 2))
    value, _ = combinations(offsets, fixed, turned, 45)
    hits = float(np.mean(value <= 1.0))
    box = FULL[2] * (2.0 * half) ** 2
    deviation = box * math.sqrt(hits * (1.0 - hits) / count)
    assert abs(box * hits - float(principal_formula(first, second))) < 4.0 * deviation
    assert Body(offsets[0], fixed[0]).matrix.shape == (2, 2)


@pytest.mark.parametrize(
    ("outer", "inner"),
    [
        ([3.0, 4.0], [1.0, 2.0]),
        ([3.0, 4.0], [1.0, 3.5]),  # fits at some orientations only
        ([6.0, 4.0], [1.0, 3.0]),
        ([3.0, 4.0, 5.0], [1.0, 2.0, 2.5]),
    ],
)
def test_where_it_does_not_roll_quadrature_takes_over(outer, inner):
    assert not rolls_at_every_orientation(outer, inner)
    found = contained_motions(body(outer), body(inner))
    assert found.method == "quadrature"
    assert 0.0 <= found.error < 1e-4 * found.value
    rng = np.random.default_rng(1)
    n = len(outer)
    if n == 3:
        turns = Rotation.random(3000, random_state=rng).as_matrix()
    else:
        yaw = np.linspace(0.0, math.pi, 3001)[:-1]
        c, s = np.cos(yaw), np.sin(yaw)
        turns = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    volumes = FULL[n] * difference_volume(np.diag(outer), turns @ np.diag(inner))
    spread = volumes.std() / math.sqrt(len(volumes)) if n == 3 else 1e-5 * found.value
    assert abs(volumes.mean() - found.value) < 4.0 * spread
    # In the plane the formula is then too small (Matheron), and not a volume at all.
    if n == 2:
        assert float(containment_formula(outer, inner)) < found.value


@settings(deadline=None, max_examples=20)
@given(seeds, dimensions)
def test_translative_versions_are_sums_and_differences(seed, dimension):
    rng = np.random.default_rng(seed)
    outer = random_ellipsoid(rng, dimension, 3.0, 6.0)
    inner = random_ellipsoid(rng, dimension, 0.5, 1.5)
    still = single_rotation(np.eye(dimension))
    meet, stay = meeting_motions(outer, inner, still), contained_motions(outer, inner, still)
    assert meet.value == float(sum_volume(outer, inner))
    assert meet.method == "closed form"
    assert stay.value == float(difference_volume(outer, inner))


def test_restricted_ranges_add_up():
    outer, inner = body(PLANE[0]), body(PLANE[1])
    parts = [(0.0, 0.4), (0.4, 2.0), (2.0, 2.0 * math.pi)]
    for function, whole in (
        (contained_motions, containment_formula(*PLANE)),
        (meeting_motions, principal_formula(*PLANE)),
    ):
        pieces = [function(outer, inner, yaw_range(*part)).value for part in parts]
        assert sum(pieces) == pytest.approx(float(whole), rel=1e-9)
    outer, inner = body(SPACE[0]), body(SPACE[1])
    turn = (0.0, 2.0 * math.pi)
    betas = [(0.0, 1.0), (1.0, math.pi)]
    total = sum(
        contained_motions(outer, inner, euler_zxz_range(turn, beta, turn)).value for beta in betas
    )
    assert total == pytest.approx(float(containment_formula(*SPACE)), rel=1e-9)


def test_ranges_have_their_measures():
    assert yaw_range(-0.5, 1.0).measure == pytest.approx(1.5, rel=1e-14)
    turn = (0.0, 2.0 * math.pi)
    assert euler_zxz_range(turn, (0.0, math.pi), turn).measure == pytest.approx(FULL[3], rel=1e-13)
    small = euler_zxz_range((0.0, 0.1), (0.2, 0.5), (-1.0, 1.0), 8)
    expected = 0.1 * 2.0 * (math.cos(0.2) - math.cos(0.5))
    assert small.measure == pytest.approx(expected, rel=1e-13)
    for angle in (0.3, math.pi):
        expected = 8.0 * math.pi * (angle - math.sin(angle))
        assert angle_range(angle, 12).measure == pytest.approx(expected, rel=1e-12)
    for dimension in (2, 3):
        assert all_rotations(dimension, 6).measure == pytest.approx(FULL[dimension], rel=1e-13)
    for rotations in (
        small.rotations,
        angle_range(1.0, 4).rotations,
        yaw_range(0.0, 1.0).rotations,
    ):
        n = rotations.shape[-1]
        product = np.swapaxes(rotations, 1, 2) @ rotations
        np.testing.assert_allclose(product, np.broadcast_to(np.eye(n), product.shape), atol=1e-14)


def test_a_range_of_angles_matches_haar_samples_of_it():
    outer, inner = body([3.0, 4.0, 5.0]), body([1.0, 2.0, 2.6])
    largest = 0.7
    found = contained_motions(outer, inner, angle_range(largest, 10)).value
    turns = Rotation.random(60000, random_state=4)
    near = turns[turns.magnitude() <= largest].as_matrix()
    volumes = difference_volume(outer, near @ inner.matrix)
    measure = 8.0 * math.pi * (largest - math.sin(largest))
    spread = measure * volumes.std() / math.sqrt(len(volumes))
    assert abs(found - measure * volumes.mean()) < 4.0 * spread
    whole = meeting_motions(outer, inner, angle_range(math.pi, 12)).value
    expected = float(principal_formula(outer.semi_axes, inner.semi_axes))
    assert whole == pytest.approx(expected, rel=1e-8)
    # A narrow range is the translative value times its measure.
    tight = contained_motions(outer, inner, angle_range(1e-4, 4))
    assert tight.value / angle_range(1e-4, 4).measure == pytest.approx(
        float(difference_volume(outer, inner)), rel=1e-4
    )


def test_formulas_are_vectorised():
    rng = np.random.default_rng(3)
    one, two = rng.uniform(1.0, 2.0, (5, 1, 3)), rng.uniform(1.0, 2.0, (7, 3))
    assert principal_formula(one, two).shape == (5, 7)
    single = principal_formula(one[2, 0], two[4])
    assert principal_formula(one, two)[2, 4] == pytest.approx(float(single), rel=1e-15)


def test_bad_input_is_refused():
    for function in (principal_formula, containment_formula):
        with pytest.raises(GeometryError, match="one dimension"):
            function([1.0, 2.0], [1.0, 2.0, 3.0])
        with pytest.raises(GeometryError, match="positive"):
            function([1.0, 0.0], [1.0, 2.0])
    for function in (meeting_motions, contained_motions):
        with pytest.raises(GeometryError, match="one dimension"):
            function(ball(1.0, 2), ball(1.0, 3))
    with pytest.raises(GeometryError, match="at most a turn"):
        yaw_range(0.0, 7.0)
    with pytest.raises(GeometryError, match="at most a turn"):
        yaw_range(1.0, 0.0)
    with pytest.raises(GeometryError, match=r"\[0, pi\]"):
        euler_zxz_range((0.0, 1.0), (-0.1, 1.0), (0.0, 1.0))
    with pytest.raises(GeometryError, match=r"\[0, pi\]"):
        angle_range(4.0)
    with pytest.raises(GeometryError, match="rotations of dimension 3, got dimension 2"):
        meeting_motions(ball(1.0, 3), ball(1.0, 3), yaw_range(0.0, 1.0))
