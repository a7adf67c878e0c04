"""Ellipsoids: construction, support function, surface, containment, rigid motion."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ellipsoid_planning.errors import EllipsoidPlanningError, GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.orientation import (
    normalised_heading,
    quaternion_from_rotation,
    rotation_from_quaternion,
    rotation_from_yaw,
    yaw_from_rotation,
)

axis_lengths = st.floats(0.01, 100.0)
coordinates = st.floats(-50.0, 50.0)
unit_quaternions = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .filter(lambda q: math.hypot(*q) > 0.1)
    .map(lambda q: np.array(q) / math.hypot(*q))
)


@st.composite
def rotations(draw: st.DrawFn, dimension: int) -> np.ndarray:
    if dimension == 2:
        return rotation_from_yaw(draw(st.floats(-math.pi, math.pi)))
    return rotation_from_quaternion(draw(unit_quaternions))


@st.composite
def ellipsoids(draw: st.DrawFn) -> Ellipsoid:
    dimension = draw(st.sampled_from([2, 3]))
    axes = [draw(axis_lengths) for _ in range(dimension)]
    centre = [draw(coordinates) for _ in range(dimension)]
    return Ellipsoid.from_semi_axes(axes, centre, draw(rotations(dimension)))


@given(ellipsoids())
def test_support_function_is_attained_at_the_support_point(body):
    directions = unit_directions(body.dimension, 40)
    points = body.support_points(directions)
    heights = np.sum(points * directions, axis=1)
    np.testing.assert_allclose(heights, body.support(directions), rtol=1e-12, atol=1e-10)
    everywhere = body.surface_points(60) @ directions.T
    assert np.all(everywhere <= body.support(directions) + 1e-10)


@given(ellipsoids())
def test_contains_the_scaled_surface_and_no_more(body):
    surface = body.surface_points(30) - body.centre
    assert np.all(body.contains(body.centre + (1.0 - 1e-9) * surface))
    assert not np.any(body.contains(body.centre + (1.0 + 1e-9) * surface))


@given(ellipsoids(), st.data())
def test_rigid_motion_moves_the_support_points(body, data):
    turn = data.draw(rotations(body.dimension))
    shift = np.array([data.draw(coordinates) for _ in range(body.dimension)])
    directions = unit_directions(body.dimension, 12)
    moved = body.transform(turn, shift).support_points(directions @ turn.T)
    expected = body.support_points(directions) @ turn.T + shift
    np.testing.assert_allclose(moved, expected, atol=1e-10)


@given(ellipsoids())
def test_shape_matrix_round_trip(body):
    again = Ellipsoid.from_shape_matrix(body.shape_matrix, body.centre)
    scale = np.max(body.shape_matrix)
    np.testing.assert_allclose(again.shape_matrix, body.shape_matrix, atol=1e-12 * scale)
    assert np.linalg.det(again.rotation) == pytest.approx(1.0)


def test_covariance_gives_the_mahalanobis_ball():
    body = Ellipsoid.from_covariance(np.diag([4.0, 9.0]), mean=[1.0, 2.0], radius=3.0, name="blob")
    assert sorted(body.semi_axes) == pytest.approx([6.0, 9.0])
    assert body.name == "blob"
    assert body.centre.tolist() == [1.0, 2.0]


def test_support_of_a_needle_is_exact_to_rounding():
    angle = 0.3
    needle = Ellipsoid.from_semi_axes([1.0, 1e-6], rotation=angle)
    across = np.array([-math.sin(angle), math.cos(angle)])
    assert float(needle.support(across)) == pytest.approx(1e-6, rel=1e-9)


def test_arrays_are_copied_and_read_only():
    axes = np.array([2.0, 1.0])
    body = Ellipsoid.from_semi_axes(axes)
    axes[0] = 7.0
    assert body.semi_axes.tolist() == [2.0, 1.0]
    for array in (body.centre, body.rotation, body.semi_axes, body.matrix, body.shape_matrix):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@pytest.mark.parametrize(
    "arguments",
    [
        {"semi_axes": [1.0]},
        {"semi_axes": [1.0, 0.0]},
        {"semi_axes": [1.0, -2.0, 3.0]},
        {"semi_axes": [1.0, math.nan]},
        {"semi_axes": [1.0, math.inf]},
        {"semi_axes": [1.0, 1.0], "position": [0.0, 0.0, 0.0]},
        {"semi_axes": [1.0, 1.0], "position": [0.0, math.nan]},
        {"semi_axes": [1.0, 1.0], "rotation": np.eye(3)},
        {"semi_axes": [1.0, 1.0], "rotation": [[1.0, 0.1], [0.0, 1.0]]},
        {"semi_axes": [1.0, 1.0], "rotation": np.diag([1.0, -1.0])},
        {"semi_axes": [1.0, 1.0], "rotation": math.nan},
        {"semi_axes": [1.0, 1.0, 1.0], "rotation": 0.3},
    ],
)
def test_nonsense_is_refused(arguments):
    with pytest.raises(GeometryError):
        Ellipsoid.from_semi_axes(**arguments)


@pytest.mark.parametrize("matrix", [np.eye(4), [[1.0, 0.5], [0.0, 1.0]], [[1.0, 2.0], [2.0, 1.0]]])
def test_a_matrix_that_is_no_shape_matrix_is_refused(matrix):
    with pytest.raises(GeometryError):
        Ellipsoid.from_shape_matrix(matrix)


def test_geometry_errors_are_ours_and_value_errors():
    assert issubclass(GeometryError, EllipsoidPlanningError)
    assert issubclass(GeometryError, ValueError)


def test_zero_directions_and_wrong_shapes_are_refused():
    body = Ellipsoid.from_semi_axes([1.0, 2.0])
    with pytest.raises(GeometryError, match="non-zero"):
        body.support_points([[0.0, 0.0]])
    with pytest.raises(GeometryError, match="shape"):
        body.contains([1.0, 2.0, 3.0])


def test_directions_are_unit_and_balanced():
    for dimension in (2, 3):
        directions = unit_directions(dimension, 500)
        np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, rtol=1e-14)
        assert np.linalg.norm(directions.mean(axis=0)) < 5e-3


@given(st.floats(-1e6, 1e6))
def test_headings_are_normalised_to_the_half_open_turn(yaw):
    heading = normalised_heading(yaw)
    assert -math.pi <= heading < math.pi
    assert math.cos(heading - yaw) == pytest.approx(1.0)
    assert normalised_heading(heading) == heading
    assert yaw_from_rotation(rotation_from_yaw(heading)) == pytest.approx(heading, abs=1e-14) or (
        abs(heading) == pytest.approx(math.pi)
    )


def test_pi_becomes_minus_pi():
    assert normalised_heading(math.pi) == -math.pi


@given(unit_quaternions)
def test_quaternion_round_trip(quaternion):
    again = quaternion_from_rotation(rotation_from_quaternion(quaternion))
    assert abs(float(again @ quaternion)) == pytest.approx(1.0, abs=1e-14)
    assert again[3] >= 0.0
