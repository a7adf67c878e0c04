"""Which links share a table, which symmetries are seen, and what a turn does to a shape."""

import numpy as np
import pytest

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.orientation import rotation_from_quaternion
from ellipsoid_planning.geometry.rows import part_row
from ellipsoid_planning.safety.orientation_grid import DIRECTION, HEADING, NOTHING, QUATERNION
from ellipsoid_planning.safety.resolution import TableParameters
from ellipsoid_planning.safety.shapes import shape_of
from ellipsoid_planning.safety.tabulated import TabulatedSafety
from tests.random_scenes import rotation, unit_vector
from tests.safety.scenes import COARSE, KINDS, crowded


def placed_shape(bodies, turns=True):
    rows = np.array([part_row(body) for body in bodies])
    return shape_of(rows, bodies[0].dimension == 2, turns)


def bodies_of(dimension, *parts):
    return [Ellipsoid.from_semi_axes(axes[:dimension], at[:dimension]) for axes, at in parts]


SHAPES = {
    "ball": (3, NOTHING, 1, ([1.0, 1, 1], [0.3, 0, 0])),
    "disc": (2, NOTHING, 1, ([1.0, 1], [0.3, 0])),
    "ellipse": (2, HEADING, 2, ([0.2, 1.0], [0.3, 2])),
    "two discs": (2, HEADING, 2, ([1.0, 1], [0.0, 0]), ([1.0, 1], [1.5, 1])),
    "uneven": (2, HEADING, 4, ([1.0, 1], [0.0, 0]), ([0.5, 1], [1.5, 1])),
    "needle": (3, DIRECTION, 3, ([0.1, 0.1, 1.0], [1.0, 0, 2])),
    "coin": (3, DIRECTION, 3, ([0.5, 0.1, 0.5], [1.0, 0, 2])),
    "dumbbell": (3, DIRECTION, 3, ([0.5, 0.4, 0.4], [0.0, 0, 0]), ([0.5, 0.4, 0.4], [1.0, 0, 0])),
    "pin": (3, DIRECTION, 6, ([0.5, 0.5, 0.5], [0.0, 0, 0]), ([1.0, 0.2, 0.2], [1.0, 0, 0])),
    "potato": (3, QUATERNION, 1, ([0.5, 0.3, 0.4], [1.0, 1, 1])),
    "bent": (3, QUATERNION, 4, ([0.5, 0.5, 0.5], [0.0, 0, 0]), ([1.0, 0.2, 0.2], [1.0, 0.1, 0])),
}


@pytest.mark.parametrize("name", SHAPES)
def test_symmetries_are_seen_wherever_the_link_stands(name):
    dimension, vector, faces, *parts = SHAPES[name]
    rng = np.random.default_rng(4)
    first = placed_shape(bodies_of(dimension, *parts)).shape
    for _ in range(5):
        turned, at = rotation(rng, dimension), rng.normal(size=dimension)
        bodies = [body.transform(turned, at) for body in bodies_of(dimension, *parts)]
        shape = placed_shape(bodies).shape
        assert (shape.vector, shape.faces) == (vector, faces)
        assert shape.is_same(first)
        assert not shape.is_same(placed_shape(bodies, turns=False).shape)


@pytest.mark.parametrize("name", SHAPES)
def test_the_frame_puts_the_shape_where_the_parts_are(name):
    dimension, _, _, *parts = SHAPES[name]
    bodies = [
        body.transform(rotation(np.random.default_rng(4), dimension), np.ones(dimension))
        for body in bodies_of(dimension, *parts)
    ]
    placed = placed_shape(bodies)
    assert np.linalg.det(placed.turn) == pytest.approx(1.0)
    for body, centre, matrix in zip(
        bodies, placed.shape.centres, placed.shape.matrices, strict=True
    ):
        at, turned = placed.middle + placed.turn @ centre, placed.turn @ matrix
        row = part_row(body)
        assert at == pytest.approx(row[:3], abs=1e-9)
        own = row[3:12].reshape(3, 3)
        if placed.shape.vector != NOTHING:
            assert turned @ turned.T == pytest.approx(own @ own.T, abs=1e-12)


@pytest.mark.parametrize("name", SHAPES)
def test_a_turn_takes_a_shape_no_farther_out_of_itself_than_its_lever_says(name):
    dimension, _, _, *parts = SHAPES[name]
    rng, shape = np.random.default_rng(5), placed_shape(bodies_of(dimension, *parts)).shape
    planar = dimension == 2
    worst = 0.0
    for _ in range(300):
        axis = np.array([0.0, 0, 1]) if planar else unit_vector(rng, 3)
        angle = 10.0 ** rng.uniform(-3, 0)
        turn = rotation_from_quaternion([*np.sin(angle / 2) * axis, np.cos(angle / 2)])
        directions = rng.normal(size=(50, 3)) * [1, 1, 0 if planar else 1]
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        before, after = _supports(shape, directions), _supports(shape, directions @ turn)
        worst = max(worst, float((after - before).max()) / angle)
    assert worst <= shape.lever + 1e-12
    assert worst >= 0.6 * shape.lever


def _supports(shape, directions):
    """Support function (m,) of the union of the parts in unit directions (m, 3)."""
    return np.max(
        [
            directions @ centre + np.linalg.norm(directions @ matrix, axis=1)
            for centre, matrix in zip(shape.centres, shape.matrices, strict=True)
        ],
        axis=0,
    )


# A base that does not turn needs a table of its own.
TABLES = {"mixed planar": 2, "planar arm": 2, "chain": 2, "arm": 2}


@pytest.mark.parametrize("kind", KINDS)
def test_identical_links_share_one_table(kind):
    safety = TabulatedSafety(crowded(kind), COARSE, keep=False)
    report = safety.report()
    links = [link for table in report.tables for link in table.links]
    assert sorted(links) == sorted(link.name for link in safety.cspace.robot.links)
    assert len(report.tables) == TABLES.get(kind, 1)


def test_resolution_can_be_asked_for():
    cspace = crowded("chain")
    safety = TabulatedSafety(cspace, TableParameters(orientations=50, lines=100), keep=False)
    turning = [table for table in safety.report().tables if table.orientations > 1]
    assert [table.orientations for table in turning] == [64]
    assert all(100 <= table.lines <= 144 for table in safety.report().tables)
