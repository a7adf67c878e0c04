"""Saddle points between C-obstacles against closest points of densely sampled boundaries."""

import itertools

import numpy as np
import pytest
from scipy.optimize import minimize

from ellipsoid_planning.kernels import centring, layout, saddles
from ellipsoid_planning.roadmap.gates import probe
from tests.motion_oracle import Scene
from tests.oracles import Body, signed_gaps, sphere_grid
from tests.random_scenes import boundary_point, matrix, rotation, space_of, unit_vector


def scene_of(obstacles, parts):
    n = len(parts[0].centre)
    return Scene(np.full(n, -20.0), np.full(n, 20.0), obstacles, (), parts, rotates=False)


def found_saddle(scene, pairs, start=None):
    """What the kernel finds: gap, whether found, point (n,), normals (k, n), pairs looked at."""
    space = space_of(scene)
    parts, placed = probe(space)
    obstacles = layout.obstacle_rows(space.scene)
    rows = np.array(pairs, dtype=np.int64)
    centres = obstacles[rows[:, 1], :3] - placed[rows[:, 0], :3]
    point = centres.mean(axis=0) if start is None else np.append(start, np.zeros(3 - len(start)))
    normals, work = np.full((len(pairs), 3), np.nan), centring.new_workspace(space.scene)
    size = float(obstacles[rows[:, 1], layout.BODY_RADIUS].mean())
    before = placed.copy()
    gap, found = saddles.saddle(
        obstacles, parts, placed, rows, len(rows), size, point, normals, work
    )
    np.testing.assert_allclose(placed, before, atol=1e-12)
    n = scene.dimension
    assert np.isfinite(point).all()
    assert not point[n:].any()
    return gap, bool(found), point[:n], normals[:, :n], int(work.pairs[0])


def sums_boundary(scene, pair, u):
    """Boundary points (m, n) of a C-obstacle with normals u (m, n)."""
    part, body = scene.parts[pair[0]], scene.obstacles[pair[1]]
    points = np.broadcast_to(body.centre - part.centre, u.shape)
    for a in (body.matrix, part.matrix):
        back = u @ a
        points = points + (back / np.linalg.norm(back, axis=1, keepdims=True)) @ a.T
    return points


def closest_points(scene, first, second):
    """Distance of two C-obstacles and the midpoint of their closest points, by dense points."""
    n = scene.dimension
    u = sphere_grid(720 if n == 2 else 2500, n)
    one, other = (sums_boundary(scene, pair, u) for pair in (first, second))
    apart = np.linalg.norm(one[:, None] - other[None], axis=2)
    i, j = np.unravel_index(np.argmin(apart), apart.shape)

    def ends(v):
        return [
            sums_boundary(scene, pair, w[None] / np.linalg.norm(w))[0]
            for pair, w in ((first, v[:n]), (second, v[n:]))
        ]

    polished = minimize(
        lambda v: float(np.linalg.norm(np.subtract(*ends(v)))),
        np.concatenate([u[i], u[j]]),
        method="BFGS",
        options={"gtol": 1e-11},
    )
    return float(polished.fun), np.mean(ends(polished.x), axis=0)


def gaps_at(scene, pairs, point):
    """Gaps (k,) of pairs with the base at a point, and their directions (k, n)."""
    c = [point + scene.parts[i].centre - scene.obstacles[j].centre for i, j in pairs]
    a1 = [scene.obstacles[j].matrix for _, j in pairs]
    a2 = [scene.parts[i].matrix for i, _ in pairs]
    return signed_gaps(np.array(c), np.array(a1), np.array(a2))


def smallest_ball(scene, pairs, start):
    """The least largest gap and its place, by scipy."""
    n = scene.dimension

    def room(x):
        return x[n] - gaps_at(scene, pairs, x[:n])[0]

    def slopes(x):
        u = gaps_at(scene, pairs, x[:n])[1]
        return np.column_stack([-u, np.ones(len(u))])

    begin = np.append(start, gaps_at(scene, pairs, start)[0].max())
    found = minimize(
        lambda x: x[n],
        begin,
        jac=lambda _: np.eye(n + 1)[n],
        constraints={"type": "ineq", "fun": room, "jac": slopes},
        method="SLSQP",
        options={"ftol": 1e-13, "maxiter": 200},
    )
    return float(found.x[n]), found.x[:n]


def random_scene(rng, n, count, gap, kind="mild", ratio=3.0, parts=1, jitter=0.4):
    """Obstacles around the origin, each `gap` from a part of the robot if that is there.

    Two of them without jitter are on opposite sides: their C-obstacles are 2 `gap` apart.
    """
    robot = tuple(
        Body(rng.uniform(-0.5, 0.5, n) * (i > 0), matrix(rng, n, kind, ratio, 0.5))
        for i in range(parts)
    )
    bodies, frame = [], rotation(rng, n)
    for k in range(count):
        turn = 2 * np.pi * k / count + rng.uniform(-jitter, jitter)
        u = frame @ np.array([np.cos(turn), np.sin(turn), 0.0])[:n]
        part, a = robot[k % parts], matrix(rng, n, kind, ratio, rng.uniform(0.7, 2))
        offset = boundary_point(a, u) + boundary_point(part.matrix, u) + gap * u
        bodies.append(Body(part.centre + np.asarray(offset, dtype=float), a))
    return scene_of(tuple(bodies), robot)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize(("kind", "ratio"), [("sphere", 1), ("mild", 3)])
@pytest.mark.parametrize("parts", [1, 2])
def test_pairs_meet_half_way_between_closest_points(n, kind, ratio, parts):
    rng = np.random.default_rng(1)
    for gap in (0.5, 0.2, 0.05, 1e-3):
        scene = random_scene(rng, n, 2, gap, kind, ratio, parts, 0.0 if gap < 0.1 else 0.4)
        pairs = [(0, 0), (parts - 1, 1)]
        distance, middle = closest_points(scene, *pairs)
        found_gap, found, point, normals, _ = found_saddle(scene, pairs)
        assert found
        assert found_gap == pytest.approx(0.5 * distance, rel=1e-6, abs=1e-9)
        np.testing.assert_allclose(point, middle, atol=1e-3)
        np.testing.assert_allclose(normals[0], -normals[1], atol=1e-3)
        # The two gaps there, anew.
        np.testing.assert_allclose(gaps_at(scene, pairs, point)[0], found_gap, rtol=2e-3)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("kind", ["mild", "needle", "disc"])
@pytest.mark.parametrize("parts", [1, 2])
def test_gaps_of_pairs_are_those_they_were_made_with(n, kind, parts):
    rng = np.random.default_rng(6)
    for gap in (0.05, 1e-3, 1e-6):
        scene = random_scene(rng, n, 2, gap, kind, 2.0, parts, 0.0)
        pairs = [(0, 0), (parts - 1, 1)]
        found_gap, found, point, _, _ = found_saddle(scene, pairs)
        assert found
        assert found_gap == pytest.approx(gap, rel=1e-3, abs=1e-12)
        np.testing.assert_allclose(gaps_at(scene, pairs, point)[0], gap, rtol=2e-3)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("kind", ["mild", "needle", "disc"])
@pytest.mark.parametrize("parts", [1, 2])
def test_saddles_between_plates_and_needles_are_found_nearly(n, kind, parts):
    """The smallest ball between flat bodies is hard to place: to a hundredth of their size."""
    rng = np.random.default_rng(7)
    for ratio in (20.0, 1e3):
        for gap in (0.05, 1e-3, 1e-6, 1e-9):
            for _ in range(5):
                scene = random_scene(rng, n, 2, gap, kind, ratio, parts, 0.0)
                pairs = [(0, 0), (parts - 1, 1)]
                found_gap, found, point, _, _ = found_saddle(scene, pairs)
                assert found
                assert gap * (1 - 1e-6) - 1e-13 <= found_gap <= gap + 0.01
                assert np.abs(gaps_at(scene, pairs, point)[0] - gap).max() <= 0.02


@pytest.mark.parametrize("parts", [1, 3])
def test_triples_are_centres_of_the_smallest_ball_that_touches_all(parts):
    rng = np.random.default_rng(2)
    bounded = 0
    for _ in range(12):
        scene = random_scene(rng, 3, 3, rng.choice([0.3, 0.05, 1e-3]), parts=parts)
        pairs = [(k % parts, k) for k in range(3)]
        gap, found, point, normals, _ = found_saddle(scene, pairs)
        best, place = smallest_ball(scene, pairs, np.zeros(3))
        expected = gaps_at(scene, pairs, place)[0]
        if best > 1e-6:
            assert gap == pytest.approx(best, rel=1e-5, abs=1e-9)
        if best > 1e-6 and expected.min() > (1 - 1e-5) * best:
            assert found
            bounded += 1
            np.testing.assert_allclose(point, place, atol=1e-3)
            np.testing.assert_allclose(gaps_at(scene, pairs, point)[0], gap, rtol=2e-3)
            # They balance: some convex combination of the normals vanishes.
            assert np.linalg.svd(normals)[1][-1] <= 1e-3
        elif best < -1e-6 or expected.min() < best - 1e-2:
            assert not found
    assert bounded >= 4


def test_three_spheres_that_overlap_in_pairs_leave_a_hole():
    """Unit spheres 1.9 apart: the largest ball between them has the radius 1.9/√3 − 1."""
    angles = np.radians([90, 210, 330])
    far = 1.9 / np.sqrt(3)
    spheres = tuple(Body(far * np.array([np.cos(t), np.sin(t), 0.0]), np.eye(3)) for t in angles)
    ball = Body(np.array([0.1, 0.2, -0.3]), 0.04 * np.eye(3))
    scene = scene_of(spheres, (ball,))
    gap, found, point, normals, _ = found_saddle(scene, [(0, 0), (0, 1), (0, 2)])
    assert found
    assert gap == pytest.approx(far - 1.0 - 0.04, rel=1e-6)
    np.testing.assert_allclose(point, -ball.centre, atol=1e-4)
    np.testing.assert_allclose(normals.sum(axis=0), 0.0, atol=1e-3)
    for pair in itertools.combinations([(0, 0), (0, 1), (0, 2)], 2):
        assert not found_saddle(scene, list(pair))[1]


@pytest.mark.parametrize("n", [2, 3])
def test_bodies_that_overlap_have_none(n):
    rng = np.random.default_rng(3)
    for _ in range(10):
        a = [matrix(rng, n) for _ in range(2)]
        shift = 0.3 * unit_vector(rng, n)
        bodies = (Body(np.zeros(n), a[0]), Body(shift, a[1]))
        scene = scene_of(bodies, (Body(np.zeros(n), 0.2 * np.eye(n)),))
        gap, found, _, _, looked = found_saddle(scene, [(0, 0), (0, 1)])
        assert not found
        assert gap <= 0.0
        assert looked <= 2 * 41


@pytest.mark.parametrize("n", [2, 3])
def test_sums_that_overlap_have_none_though_the_bodies_do_not(n):
    bodies = tuple(Body(np.array([x, 0.0, 0.0])[:n], np.eye(n)) for x in (-1.2, 1.2))
    for radius, passes in ((0.19, True), (0.21, False)):
        scene = scene_of(bodies, (Body(np.zeros(n), radius * np.eye(n)),))
        gap, found, *_ = found_saddle(scene, [(0, 0), (0, 1)])
        assert found == passes
        if passes:
            assert gap == pytest.approx(0.01, rel=1e-6)


@pytest.mark.parametrize("n", [2, 3])
def test_the_same_body_twice_has_none(n):
    body = Body(np.ones(n), matrix(np.random.default_rng(4), n))
    scene = scene_of((body, body), (Body(np.zeros(n), 0.2 * np.eye(n)),))
    _, found, *_ = found_saddle(scene, [(0, 0), (0, 1)])
    assert not found


def test_a_wide_pair_and_a_far_third_are_no_triple():
    """The third body is too far away to bound the place."""
    bodies = tuple(
        Body(np.array(c), np.eye(3)) for c in ([-1.1, 0.0, 0.0], [1.1, 0.0, 0.0], [0.0, 0.5, 0.0])
    )
    scene = scene_of(bodies, (Body(np.zeros(3), 0.01 * np.eye(3)),))
    # Moving away from the third, the pair's closest points are in the way no more.
    gap, found, point, _, _ = found_saddle(scene, [(0, 0), (0, 1), (0, 2)])
    best, place = smallest_ball(scene, [(0, 0), (0, 1), (0, 2)], np.array([0.0, -1.0, 0.0]))
    assert gap == pytest.approx(best, rel=1e-5)
    np.testing.assert_allclose(point, place, atol=1e-3)
    expected = gaps_at(scene, [(0, 0), (0, 1), (0, 2)], place)[0]
    assert found == bool(expected.min() > best - 1e-3)


@pytest.mark.parametrize("scale", [1e-3, 1e6])
def test_the_unit_of_length_does_not_matter(scale):
    scene = random_scene(np.random.default_rng(5), 3, 3, 0.05)

    def scaled(bodies):
        return tuple(Body(scale * b.centre, scale * b.matrix) for b in bodies)

    pairs = [(0, 0), (0, 1)]
    gap, found, point, _, _ = found_saddle(scene, pairs)
    other = scene._replace(
        low=scale * scene.low,
        high=scale * scene.high,
        obstacles=scaled(scene.obstacles),
        parts=scaled(scene.parts),
    )
    gap_scaled, found_scaled, point_scaled, _, _ = found_saddle(other, pairs)
    assert found == found_scaled
    assert gap_scaled / scale == pytest.approx(gap, rel=1e-6)
    np.testing.assert_allclose(point_scaled / scale, point, atol=1e-4)
