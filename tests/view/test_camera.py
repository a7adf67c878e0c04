"""Framing and projection."""

import numpy as np
import pytest

from planners.view.camera import SAFE_ASPECT, frame, side_view

POINTS = np.random.default_rng(7).normal(size=(200, 3)) * [30.0, 10.0, 5.0] + [4.0, -2.0, 9.0]


@pytest.mark.parametrize("azimuth", [None, 0.3, -2.0])
@pytest.mark.parametrize("aspect", [SAFE_ASPECT, 2.0])
def test_everything_is_in_the_picture_and_fills_it(azimuth, aspect):
    width, height = round(600 * aspect), 600
    pixels = frame(POINTS, azimuth).pixels(POINTS, width, height)
    assert np.all((pixels >= 0) & (pixels <= [width, height]))
    if aspect == SAFE_ASPECT:
        assert np.max(np.abs(pixels - [width / 2, height / 2]) / [width / 2, height / 2]) > 0.85


@pytest.mark.parametrize("azimuth", [None, 1.0])
def test_axes_are_a_right_handed_frame(azimuth):
    camera = frame(POINTS, azimuth)
    axes = np.array([camera.right, camera.up, camera.back])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(camera.pixels(camera.centre[None], 80, 60), [[40.0, 30.0]])
    np.testing.assert_allclose(camera.axes(camera.eye[None]), [[0, 0, camera.distance]], atol=1e-9)


def test_from_above_x_is_right_and_y_is_up():
    camera = frame(POINTS, None)
    (x, y), (u, v) = camera.pixels(camera.centre + np.array([[0, 0, 0], [1, 1, 0]]), 80, 60)
    assert u > x
    assert v < y


@pytest.mark.parametrize("way", [[5.0, 0, 1], [-3.0, 4, 0], [0.0, -2, 0]])
def test_the_way_runs_from_left_to_right(way):
    start, goal = np.zeros(3), np.array(way)
    camera = frame(POINTS, side_view(start, goal))
    assert goal @ camera.right > 0.8 * np.hypot(*way[:2])


def test_a_vertical_way_has_a_view_too():
    assert np.isfinite(side_view(np.zeros(3), np.array([0.0, 0.0, 1.0])))
