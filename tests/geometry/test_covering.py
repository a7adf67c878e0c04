"""Solids in several ellipsoids: nothing of surface or inside is left out."""

import math

import numpy as np
import pytest
from scipy.spatial import Delaunay

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid, solids
from ellipsoid_planning.geometry.covering import cover, enclose, union_volume
from ellipsoid_planning.geometry.triangles import are_inside, cut_triangles
from tests.importing.descriptions import BEND_FACES, BEND_VERTICES

TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


def area(triangles):
    edges = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return 0.5 * np.linalg.norm(edges, axis=1).sum()


def volume(triangles):
    a, b, c = np.moveaxis(triangles, 1, 0)
    return np.sum(a * np.cross(b, c)) / 6.0


def on_surface(triangles, count=20_000):
    rng = np.random.default_rng(1)
    weights = rng.dirichlet([1.0, 1.0, 1.0], size=count)
    return np.einsum("ij,ijk->ik", weights, triangles[rng.integers(len(triangles), size=count)])


def inside(solid, count=2_000):
    corners = solid.surface.reshape(-1, 3)
    points = np.random.default_rng(2).uniform(corners.min(axis=0), corners.max(axis=0), (count, 3))
    return points[are_inside(points, solid.surface)]


def in_union(bodies, points):
    return np.any([body.contains(points) for body in bodies], axis=0)


def bend():
    return solids.mesh(BEND_VERTICES, BEND_FACES).transform(TURN, np.array([1.0, -2.0, 0.5]))


SHAPES = {
    "sphere": solids.sphere(0.7),
    "box": solids.box([1.0, 2.0, 5.0]),
    "cylinder": solids.cylinder(0.3, 4.0),
    "capsule": solids.capsule(0.3, 4.0),
}


@pytest.mark.parametrize("name", SHAPES)
def test_surfaces_are_around_their_solids(name):
    solid = SHAPES[name]
    assert solid.volume <= volume(solid.surface) * (1 + 1e-12) < 1.02 * solid.volume
    # Every face has the whole solid on its inner side.
    a, b, c = np.moveaxis(solid.surface, 1, 0)
    normals = np.cross(b - a, c - a)
    for normal, corner in zip(normals, a, strict=True):
        assert solid.extent(normal)[1] <= normal @ corner + 1e-9


@pytest.mark.parametrize("name", SHAPES)
def test_one_ellipsoid_is_the_closed_form(name):
    placed = SHAPES[name].transform(TURN, np.array([3.0, 0.0, -1.0]))
    ratio = {"sphere": 1.0, "box": math.sqrt(27) * math.pi / 6, "cylinder": math.sqrt(3.0)}
    (body,) = cover([placed])
    assert body.contains(placed.points).all()
    if name in ratio:
        assert union_volume([body]) == pytest.approx(ratio[name] * placed.volume, rel=1e-9)
    assert union_volume([body]) < 3.0 * placed.volume


@pytest.mark.parametrize("parts", [1, 2, 3, 6])
def test_a_bent_solid_is_covered_wholly(parts):
    solid = bend()
    bodies = cover([solid], parts)
    assert 1 <= len(bodies) <= parts
    assert in_union(bodies, solid.points).all()
    assert in_union(bodies, on_surface(solid.surface)).all()
    assert in_union(bodies, inside(solid)).all()


def test_more_parts_are_closer():
    solid = bend()
    volumes = [union_volume(cover([solid], parts)) for parts in (1, 2, 4)]
    assert volumes[1] < 0.6 * volumes[0] and volumes[2] < volumes[1]


@pytest.mark.parametrize("n", [2, 3])
def test_what_two_bodies_share_counts_once(n):
    one, two = (Ellipsoid.from_semi_axes(np.full(n, 1.0), [x, *[0.0] * (n - 1)]) for x in (0, 1.0))
    # The lens of two unit discs or balls whose centres are 1 apart.
    whole, lens = (
        (math.pi, 2.0 * math.pi / 3.0 - math.sqrt(3.0) / 2.0)
        if n == 2
        else (4.0 * math.pi / 3.0, 5.0 * math.pi / 12.0)
    )
    assert union_volume([one, two]) == pytest.approx(2.0 * whole - lens, rel=0.01)
    again = Ellipsoid.from_semi_axes(np.full(n, 1.0))
    assert union_volume([one, again]) == pytest.approx(whole)


def test_curved_solids_that_are_cut_stay_covered():
    rng = np.random.default_rng(3)
    solid = SHAPES["cylinder"]
    bodies = cover([solid], 4)
    angle, reach = rng.uniform(0, 2 * math.pi, 5000), 0.3 * np.sqrt(rng.uniform(0, 1, 5000))
    heights = rng.choice([-2.0, 2.0, *rng.uniform(-2, 2, 100)], 5000)
    points = np.column_stack([reach * np.cos(angle), reach * np.sin(angle), heights])
    assert len(bodies) > 1 and in_union(bodies, points).all()
    assert union_volume(bodies) < 0.9 * union_volume(cover([solid]))


def test_groups_are_split_between_solids():
    far = np.array([0.0, 5.0, 0.0])
    group = [solids.sphere(1.0), solids.sphere(0.5).transform(np.eye(3), far)]
    bodies = cover(group, 5)
    assert len(bodies) == 2
    assert sorted(body.semi_axes[0] for body in bodies) == pytest.approx([0.5, 1.0])
    together = enclose(group)
    directions = np.random.default_rng(0).normal(size=(1000, 3))
    for solid, body in zip(group, sorted(bodies, key=lambda b: -b.semi_axes[0]), strict=True):
        assert solid.points.shape == (0, 3)
        assert together.contains(body.support_points(directions)).all()


def test_corners_of_three_cuts_inside_belong_to_the_piece():
    piece = SHAPES["box"]
    for normal in np.eye(3):
        piece = piece.cut(-normal, 0.0)[0]
    assert np.any(np.all(piece.points == 0.0, axis=1))
    hull = Delaunay(piece.points)
    sample = np.random.default_rng(4).uniform(0, 1, (500, 3)) * [0.5, 1.0, 2.5]
    assert np.all(hull.find_simplex(sample, tol=1e-9) >= 0)


def test_cutting_loses_no_area():
    surface = bend().surface
    normal = np.array([0.6, 0.0, 0.8])
    for offset in (-2.0, 0.3, 1.1, 9.0):
        below = cut_triangles(surface, normal, offset)
        above = cut_triangles(surface, -normal, -offset)
        assert area(below) + area(above) == pytest.approx(area(surface), rel=1e-12)
        if len(below):
            assert np.max(below @ normal) <= offset + 1e-12


def test_solids_that_are_none():
    for make in (
        lambda: solids.sphere(0.0),
        lambda: solids.box([1.0, -1.0, 1.0]),
        lambda: solids.box([1.0, 1.0]),
        lambda: solids.cylinder(math.nan, 1.0),
        lambda: solids.mesh([[0, 0, 0]], np.zeros((0, 3))),
        lambda: solids.mesh([[0, 0, math.inf]] * 3, [[0, 1, 2]]),
        lambda: cover([solids.box([0.0, 0.0, 0.0])]),
    ):
        with pytest.raises(GeometryError):
            make()
    assert cover([solids.box([1.0, 1.0, 0.0])], 2)[0].contains([0.5, 0.5, 0.0])
