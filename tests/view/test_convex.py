"""Plane sections of convex bodies against the closed form for ellipsoids."""

import numpy as np
import pytest

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.directions import unit_directions
from planners.view.convex import intersect_half_planes, section_support

ROTATION = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
ROTATION *= np.sign(np.linalg.det(ROTATION))


@pytest.mark.parametrize("axes", [[3.0, 2.0, 1.0], [30.0, 1.0, 0.1], [1.0, 1.0, 1.0]])
def test_section_of_an_ellipsoid_is_the_ellipse(axes):
    body = Ellipsoid.from_semi_axes(axes, [0.1, 0.02, 0.05], ROTATION)
    # x'Mx - 2 m'x + k <= 1 with y = 0 is an ellipse in (x, z).
    precision = np.linalg.inv(body.shape_matrix)
    shown = [0, 2]
    flat, linear = precision[np.ix_(shown, shown)], (precision @ body.centre)[shown]
    centre = np.linalg.solve(flat, linear)
    scale = 1.0 - body.centre @ precision @ body.centre + centre @ flat @ centre
    ellipse = Ellipsoid.from_shape_matrix(scale * np.linalg.inv(flat), centre)
    unit = np.eye(3)
    found = section_support(body.support, unit[shown], unit[1], 60)
    np.testing.assert_allclose(found, ellipse.support(unit_directions(2, 60)), rtol=1e-6)


def test_section_that_misses_has_a_negative_width():
    ball = Ellipsoid.from_semi_axes([1.0, 1.0, 1.0], [0.0, 1.5, 0.0])
    unit = np.eye(3)
    found = section_support(ball.support, unit[[0, 2]], unit[1], 8)
    assert np.all(found[:4] + found[4:] < 0.0)


def test_half_planes_cut_a_square_to_a_triangle():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    cut = intersect_half_planes(square, np.array([[1.0, 1.0]]), np.array([1.0]))
    assert {tuple(corner) for corner in cut.round(12)} == {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)}


def test_half_planes_can_leave_nothing():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert len(intersect_half_planes(square, np.array([[1.0, 0.0]]), np.array([-1.0]))) == 0
