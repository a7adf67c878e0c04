"""Thesis 5.2: closed boundaries for drawing, the rolling condition, volumes of differences."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.approximations import kurzhanski_difference
from ellipsoid_planning.geometry.boundary_mesh import (
    difference_mesh,
    difference_polygon,
    sum_mesh,
    sum_polygon,
)
from ellipsoid_planning.geometry.difference_bounds import difference_volume_bounds
from ellipsoid_planning.geometry.difference_volume import difference_volume
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.minkowski import check_fits, difference_contains
from ellipsoid_planning.geometry.rolling import (
    rolling_margin,
    rolls_at_every_orientation,
    rolls_freely,
)
from ellipsoid_planning.geometry.sum_volume import sum_volume
from tests.geometry.chapter5 import (
    ball,
    radii_matrices,
    random_ellipsoid,
    random_rotation,
    steiner_twin,
)
from tests.oracles import combinations

seeds = st.integers(0, 2**32 - 1)
dimensions = st.sampled_from([2, 3])
CUT = [  # arenas and parts whose difference has a rim
    ([4.0, 1.0], [0.9, 0.9]),
    ([4.0, 3.0, 1.0], [0.9, 0.9, 0.9]),  # rim all around
    ([40.0, 5.0, 1.5], [1.0, 1.0, 1.0]),
    ([40.0, 3.0, 2.9], [2.0, 1.0, 1.0]),  # rim at the ends only
    ([5.0, 5.0, 1.0], [0.5, 0.7, 0.9]),
    ([5.0, 1.0, 1.0], [0.5, 0.7, 0.9]),
]


def polygon_area(corners):
    x, y = corners.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def fitting_pair(rng, dimension):
    """An arena and a part that fits, with and without a rim."""
    arena = random_ellipsoid(rng, dimension, 1.0, 5.0)
    return arena, random_ellipsoid(rng, dimension, 0.05, 0.95)


def edges_are_closed(triangles):
    """Every edge is run through once in each direction."""
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    forward = {tuple(edge) for edge in edges}
    return len(forward) == len(edges) and {(b, a) for a, b in forward} == forward


@settings(deadline=None, max_examples=40)
@given(seeds)
def test_polygons_lie_on_the_boundary(seed):
    rng = np.random.default_rng(seed)
    first, second = fitting_pair(rng, 2)
    corners = sum_polygon(first, second, 100)
    u = unit_directions(2, 3000)
    total = first.support(u) + second.support(u)
    reach = np.max(corners @ u.T - total, axis=1)
    assert np.all(reach < 1e-12) and np.all(reach > -1e-2)
    assert polygon_area(sum_polygon(first, second, 4000)) == pytest.approx(
        float(sum_volume(first, second)), rel=1e-4
    )
    corners = difference_polygon(first, second, 100)
    assert np.all(difference_contains(first, second, corners))
    centre = first.centre - second.centre
    outside = (
        corners + 1e-9 * (corners - centre) / np.linalg.norm(corners - centre, axis=1)[:, None]
    )
    # Beyond a rim's corner or a smooth point alike one leaves the difference.
    assert not np.any(difference_contains(first, second, outside))


@settings(deadline=None, max_examples=30)
@given(seeds)
def test_meshes_lie_on_the_boundary_and_are_closed(seed):
    rng = np.random.default_rng(seed)
    first, second = fitting_pair(rng, 3)
    mesh = sum_mesh(first, second, 6, 12)
    assert edges_are_closed(mesh.triangles)
    u = unit_directions(3, 3000)
    total = first.support(u) + second.support(u)
    assert np.all(mesh.vertices @ u.T - total < 1e-12)
    assert mesh.volume < float(sum_volume(first, second))
    mesh = difference_mesh(first, second, 6, 12)
    assert edges_are_closed(mesh.triangles)
    assert mesh.volume > 0.0
    assert np.all(difference_contains(first, second, mesh.vertices))
    away = mesh.vertices - (first.centre - second.centre)
    outside = mesh.vertices + 1e-8 * away / np.linalg.norm(away, axis=1)[:, None]
    assert not np.any(difference_contains(first, second, outside))


@settings(deadline=None, max_examples=20)
@given(seeds)
def test_meshes_of_needles_and_discs_lie_on_the_boundary(seed):
    rng = np.random.default_rng(seed)
    axes = 10.0 ** rng.uniform(-6.0, 0.0, (2, 3))
    first, second = (Ellipsoid.from_semi_axes(a, rotation=random_rotation(rng, 3)) for a in axes)
    vertices = sum_mesh(first, second, 4, 8).vertices
    # The separating family's value is 1 on the boundary of the sum.
    count = len(vertices)
    matrices = [np.broadcast_to(body.matrix, (count, 3, 3)) for body in (first, second)]
    lengths = np.array([body.semi_axes for body in (first, second)])
    if lengths.max() / lengths.min() < 1e4:  # the twin itself needs some digits
        value, _ = combinations(vertices, *matrices, 60)
        np.testing.assert_allclose(value, 1.0, rtol=1e-6)
    u = unit_directions(3, 3000)
    assert np.all(vertices @ u.T <= (first.support(u) + second.support(u)) * (1.0 + 1e-10))


def test_mesh_vertices_have_the_right_count_and_volume():
    first = Ellipsoid.from_semi_axes([7.0, 3.0, 3.0], rotation=np.eye(3))
    second = Ellipsoid.from_semi_axes([2.0, 3.0, 4.0])
    mesh = sum_mesh(first, second, 10, 24)
    assert mesh.vertices.shape == (2 + 19 * 24, 3)
    assert len(mesh.triangles) == 2 * len(mesh.vertices) - 4  # Euler's formula
    fine = [sum_mesh(first, second, k, 4 * k).volume for k in (60, 120)]
    assert (4.0 * fine[1] - fine[0]) / 3.0 == pytest.approx(float(sum_volume(first, second)), 1e-6)
    assert ConvexHull(mesh.vertices).volume == pytest.approx(mesh.volume, rel=3e-3)


def end_radius(body):
    """The radius of curvature at the end of the first axis, across the second."""
    return float(body.semi_axes[1] ** 2 / body.semi_axes[0])


def grown(body, factor):
    return Ellipsoid(body.centre, body.rotation, factor * body.semi_axes)


@settings(deadline=None, max_examples=60)
@given(seeds, dimensions)
def test_rolling_agrees_with_radii_of_curvature(seed, dimension):
    """Inner is a summand iff its radii of curvature nowhere exceed the outer's, in any normal."""
    rng = np.random.default_rng(seed)
    outer, inner = fitting_pair(rng, dimension)
    condition = rolls_freely(outer, inner)
    assert condition.holds == (condition.margin >= 0.0)

    def slack(size, unit):
        across = radii_matrices(outer.matrix, unit) - size * radii_matrices(inner.matrix, unit)
        return np.linalg.eigvalsh(across + 1e6 * unit[:, :, None] * unit[:, None, :])[:, 0]

    grown = 1.0 + condition.margin
    assert np.all(slack(grown * (1 - 1e-9), unit_directions(dimension, 800)) > -1e-7)
    decisive = slack(grown * (1 + 1e-6), condition.direction[None])
    assert decisive[0] < 0.0
    assert np.linalg.norm(condition.direction) == pytest.approx(1.0)


@settings(deadline=None, max_examples=30)
@given(seeds, dimensions)
def test_the_worst_orientation_decides_rolling_everywhere(seed, dimension):
    rng = np.random.default_rng(seed)
    outer, inner = rng.uniform(1.0, 3.0, (2, dimension))
    margin = rolling_margin(outer, inner)
    assert rolls_at_every_orientation(outer, inner) == (margin >= 0.0)
    body = Ellipsoid.from_semi_axes(outer)
    for _ in range(20):
        turned = Ellipsoid.from_semi_axes(inner, rotation=random_rotation(rng, dimension))
        assert rolls_freely(body, turned).margin >= margin - 1e-12
    # The worst: the inner's flattest place where the outer is sharpest.
    low, high = np.min, np.max
    rest = [np.median] * (dimension - 2)
    sharp = Ellipsoid.from_semi_axes([pick(outer) for pick in (high, low, *rest)])
    flat = Ellipsoid.from_semi_axes([pick(inner) for pick in (low, high, *rest)])
    assert end_radius(sharp) / end_radius(flat) - 1.0 == pytest.approx(margin, rel=1e-12)
    assert not rolls_freely(sharp, grown(flat, (1.0 + margin) * (1.0 + 1e-9))).holds


def test_circles_roll_to_the_last_digit():
    assert rolls_freely(ball(2.0, 2), ball(2.0, 2)).margin == pytest.approx(0.0, abs=1e-15)
    assert rolls_freely(ball(3.0, 3), ball(2.0, 3)).margin == pytest.approx(0.5, rel=1e-15)
    narrow = rolls_freely(Ellipsoid.from_semi_axes([4.0, 1.0]), ball(0.9, 2))
    assert not narrow.holds
    assert narrow.margin == pytest.approx(0.25 / 0.9 - 1.0, rel=1e-14)
    np.testing.assert_allclose(np.abs(narrow.direction), [1.0, 0.0], atol=1e-15)


@settings(deadline=None, max_examples=40)
@given(seeds, dimensions)
def test_volumes_of_summands_match_quadrature(seed, dimension):
    rng = np.random.default_rng(seed)
    arena = random_ellipsoid(rng, dimension, 4.0, 6.0)
    part = random_ellipsoid(rng, dimension, 0.9, 1.1)
    assert rolls_freely(arena, part).holds
    exact = float(difference_volume(arena, part))
    assert exact == pytest.approx(steiner_twin(arena, part, -1.0, 100), rel=1e-9)


@pytest.mark.parametrize(("arena", "part"), CUT)
def test_volumes_with_a_rim_converge_and_match_slow_twins(arena, part):
    one, two = Ellipsoid.from_semi_axes(arena), Ellipsoid.from_semi_axes(part)
    assert not rolls_freely(one, two).holds
    volume = float(difference_volume(one, two))
    assert volume == pytest.approx(float(difference_volume(one, two, 64)), rel=1e-9)
    # The radial function by bisection on the S-lemma's containment.
    n = len(arena)
    if n == 2:
        corners = difference_polygon(one, two, 4000)
        assert polygon_area(corners) == pytest.approx(volume, rel=1e-5)
    else:
        meshes = [difference_mesh(one, two, k, 4 * k).volume for k in (60, 120)]
        assert (4.0 * meshes[1] - meshes[0]) / 3.0 == pytest.approx(volume, rel=1e-4)
    stretch = np.array(arena)
    unit = unit_directions(n, 2000 if n == 2 else 4000) * stretch
    low, high = np.zeros(len(unit)), np.ones(len(unit))
    for _ in range(22):
        middle = 0.5 * (low + high)
        inside = difference_contains(one, two, middle[:, None] * unit)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    ball_volume = math.pi if n == 2 else 4.0 / 3.0 * math.pi
    radial = float(np.mean(low**n)) * ball_volume * float(np.prod(stretch))
    assert radial == pytest.approx(volume, rel=4e-3)


@settings(deadline=None, max_examples=60)
@given(seeds, dimensions)
def test_bounds_of_differences_bound(seed, dimension):
    rng = np.random.default_rng(seed)
    arena, part = fitting_pair(rng, dimension)
    bounds = difference_volume_bounds(arena, part)
    exact = float(bounds["exact"])
    for name, bound in bounds.items():
        if bound.kind in ("lower", "exact"):
            assert float(bound) <= exact * (1 + 1e-9), name
        if bound.kind in ("upper", "exact"):
            assert float(bound) >= exact * (1 - 1e-9), name
    inner = kurzhanski_difference(arena, part, "volume").ellipsoid
    unit = math.pi if dimension == 2 else 4.0 / 3.0 * math.pi
    volume = unit * float(np.prod(inner.semi_axes))
    assert float(bounds["kurzhanski_ellipsoid"]) == pytest.approx(volume, rel=1e-7)
    assert rolls_freely(arena, part).holds == (bounds["steiner"].kind == "exact")


@pytest.mark.parametrize(
    "arena",
    [[1e3, 1.5], [1e6, 30.0], [1e3, 3.0, 1.5], [1e5, 1e3, 20.0], [1e6, 2.0, 2.0], [10, 9, 1.0001]],
)
def test_quadrature_over_a_rim_converges_for_needles_and_discs(arena):
    volumes = [float(difference_volume(np.diag(arena), np.eye(len(arena)), k)) for k in (32, 96)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-12)


def test_the_volume_is_continuous_where_rolling_ends():
    # The least radius of curvature of (4, 2) is 1.
    sizes = np.array([1.0 - 1e-6, 1.0, 1.0 + 1e-6])
    for axes in ([4.0, 2.0], [4.0, 3.0, 2.0]):
        arena = np.diag(axes)
        parts = sizes[:, None, None] * np.eye(len(axes))
        volumes = difference_volume(arena, parts)
        steps = np.diff(volumes)
        assert steps[0] == pytest.approx(steps[1], rel=1e-4)
        assert np.all(steps < 0.0)


@pytest.mark.parametrize("room", [1e-3, 1e-6, 1e-9, 0.0])
@pytest.mark.parametrize("axes", [[3.0, 1.0], [3.0, 2.0, 1.0], [3.0, 1.0, 1.0], [1.0, 1.0, 1.0]])
def test_a_difference_that_hardly_exists(room, axes):
    arena = Ellipsoid.from_semi_axes(np.array(axes) + room)
    part = ball(1.0, len(axes))
    volume = float(difference_volume(arena, part))
    assert 0.0 <= volume <= 40.0 * room
    if len(axes) == 2:
        points = difference_polygon(arena, part, 20)
    else:
        points = difference_mesh(arena, part, 3, 8).vertices
    assert np.all(np.isfinite(points))
    # The lens over a plane across the shortest axis; thinner than the room.
    assert np.max(np.abs(points[:, -1])) <= room * (1 + 1e-6) + 1e-15


def test_an_empty_difference_has_no_boundary_and_no_volume():
    arena = Ellipsoid.from_semi_axes([5.0, 4.0, 2.0], name="hall")
    part = Ellipsoid.from_semi_axes([1.0, 1.0, 2.5], name="crate")
    assert float(difference_volume(arena, part)) == 0.0
    for build in (difference_mesh, difference_volume_bounds, check_fits):
        with pytest.raises(GeometryError) as caught:
            build(arena, part)
        for piece in ("hall", "crate", "1.0]", "2.5 exceeds the arena's 2 by 0.5"):
            assert piece in str(caught.value)


def test_bad_requests_are_refused():
    with pytest.raises(GeometryError, match="one dimension"):
        sum_polygon(ball(1.0, 2), ball(1.0, 3))
    with pytest.raises(GeometryError, match="planar"):
        difference_polygon(ball(2.0, 3), ball(1.0, 3))
    with pytest.raises(GeometryError, match="spatial"):
        sum_mesh(ball(2.0, 2), ball(1.0, 2))
    with pytest.raises(GeometryError, match="even number"):
        sum_polygon(ball(2.0, 2), ball(1.0, 2), 7)
    with pytest.raises(GeometryError, match="3 sectors"):
        sum_mesh(ball(2.0, 3), ball(1.0, 3), 4, 2)
    with pytest.raises(GeometryError, match="one dimension"):
        rolls_freely(ball(1.0, 2), ball(1.0, 3))
    with pytest.raises(GeometryError, match="one dimension"):
        rolls_at_every_orientation([1.0, 2.0], [1.0, 2.0, 3.0])
    with pytest.raises(GeometryError, match="positive"):
        rolls_at_every_orientation([1.0, 2.0], [1.0, -2.0])
