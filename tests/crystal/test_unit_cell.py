"""Unit cells: parameters, both coordinate systems, the reciprocal cell, bad input."""

import numpy as np
import pytest

from ellipsoid_planning.crystal import UnitCell
from ellipsoid_planning.errors import CrystalError, GeometryError

CELLS = [
    ((6.75, 9.0), None),
    ((3.0, 4.0), (100.0,)),
    ((5.0, 5.0), (120.0,)),
    ((22.0, 22.0, 22.0), None),
    ((5.0, 6.0, 7.0), (80.0, 95.0, 103.0)),
    ((4.0, 4.0, 9.0), (90.0, 90.0, 120.0)),
    ((4.0, 4.0, 4.0), (57.0, 57.0, 57.0)),
]


@pytest.mark.parametrize(("lengths", "angles"), CELLS)
def test_cells_have_their_parameters(lengths, angles):
    cell = UnitCell.from_parameters(lengths, angles)
    assert cell.dimension == len(lengths)
    assert cell.lengths == pytest.approx(lengths)
    expected = angles or (90.0,) * len(cell.angles_deg)
    assert cell.angles_deg == pytest.approx(expected)
    # a along x, b in the plane of x and y.
    assert np.all(np.tril(cell.basis, -1) == 0.0)
    assert np.all(np.diag(cell.basis) > 0.0)
    assert cell.volume == pytest.approx(np.sqrt(np.linalg.det(cell.metric)))


@pytest.mark.parametrize(("lengths", "angles"), CELLS)
def test_coordinates_and_the_reciprocal_cell(lengths, angles):
    cell = UnitCell.from_parameters(lengths, angles)
    points = np.random.default_rng(1).normal(size=(4, 5, cell.dimension))
    world = cell.cartesian(points)
    assert np.allclose(cell.fractional(world), points, atol=1e-14)
    assert np.allclose(world[2, 3], cell.basis @ points[2, 3])
    assert np.allclose(cell.reciprocal.T @ cell.basis, np.eye(cell.dimension), atol=1e-14)


def test_right_angles_are_exact_and_one_angle_may_be_a_number():
    assert np.array_equal(UnitCell.from_parameters((2, 3, 4)).basis, np.diag([2.0, 3.0, 4.0]))
    assert UnitCell.from_parameters((2, 2), 120).basis[0, 1] == -1.0
    assert UnitCell(np.diag([2.0, 3.0])).angles_deg == (90.0,)


def test_arrays_are_read_only():
    cell = UnitCell.from_parameters((2, 3, 4))
    for array in (cell.basis, cell.lengths, cell.metric, cell.reciprocal):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@pytest.mark.parametrize(
    ("lengths", "angles", "words"),
    [
        ((1.0,), None, "two or three lengths"),
        ((1.0, -2.0, 3.0), None, "length b, got -2"),
        ((1.0, 2.0, float("nan")), None, "length c, got nan"),
        ((1.0, 2.0), (90.0, 90.0, 90.0), "angles"),
        ((1.0, 2.0, 3.0), 90.0, "angles"),
        ((1.0, 2.0, 3.0), (90.0, 180.0, 90.0), "beta between 0 and 180"),
        ((1.0, 2.0, 3.0), (120.0, 120.0, 120.0), "make no cell"),
        ((1.0, 2.0, 3.0), (20.0, 30.0, 60.0), "make no cell"),
    ],
)
def test_bad_parameters(lengths, angles, words):
    with pytest.raises(CrystalError, match=words):
        UnitCell.from_parameters(lengths, angles)


def test_bad_bases():
    for basis in (np.eye(4), np.diag([1.0, -1.0]), np.ones((3, 3)), np.full((2, 2), np.inf)):
        with pytest.raises(CrystalError, match="unit cell"):
            UnitCell(basis)
    assert not issubclass(CrystalError, GeometryError)
