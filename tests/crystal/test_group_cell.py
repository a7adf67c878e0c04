"""Cells that fit groups, and the message when one does not."""

import numpy as np
import pytest

from ellipsoid_planning.crystal import SpaceGroup, UnitCell, space_group
from ellipsoid_planning.errors import CrystalError

# A cell of each system, as general as the system allows.
FITTING = [
    ("P1", (5, 6, 7), (81, 92, 103)),
    ("P21", (5, 6, 7), (90, 92, 90)),
    ("P112", (5, 6, 7), (90, 90, 103)),
    ("P212121", (5, 6, 7), None),
    ("I41", (5, 5, 7), None),
    ("P3", (5, 5, 7), (90, 90, 120)),
    ("R32", (5, 5, 7), (90, 90, 120)),
    ("R32:R", (5, 5, 5), (77, 77, 77)),
    ("P6122", (5, 5, 7), (90, 90, 120)),
    ("F4132", (5, 5, 5), None),
    ("p1", (5, 6), 101),
    ("p2", (5, 6), 101),
    ("pg", (5, 6), None),
    ("c2mm", (5, 6), None),
    ("p4", (5, 5), None),
    ("p3", (5, 5), 120),
    ("p6mm", (5, 5), 120),
]


@pytest.mark.parametrize(("name", "lengths", "angles"), FITTING)
def test_operations_are_isometries_of_fitting_cells(name, lengths, angles):
    group, cell = space_group(name), UnitCell.from_parameters(lengths, angles)
    rotations, translations = group.cartesian(cell)
    unit = np.eye(group.dimension)
    assert np.allclose(rotations @ rotations.transpose(0, 2, 1), unit, atol=1e-9)
    points = np.random.default_rng(2).normal(size=(6, group.dimension))
    for i, operation in enumerate(group.operations):
        moved = points @ group.rotations[i].T + group.translations[i]
        world = cell.cartesian(points) @ rotations[i].T + translations[i]
        assert np.allclose(world, cell.cartesian(moved), atol=1e-9)
        assert [float(entry) for entry in operation.translation] == pytest.approx(
            group.translations[i]
        )


def test_rounded_parameters_are_good_enough():
    space_group("P4").check_cell(UnitCell.from_parameters((10, 10.000001, 7)))
    space_group("P6").check_cell(UnitCell.from_parameters((10, 10, 7), (90, 90, 120.00001)))


@pytest.mark.parametrize(
    ("name", "lengths", "angles", "words"),
    [
        ("P4", (10, 11, 12), None, "P4: expected a = b, got a = 10 and b = 11; change the cell"),
        ("P21", (5, 6, 7), (90, 92, 93), "expected gamma = 90, got 93 degrees"),
        ("P112", (5, 6, 7), (91, 90, 93), "expected alpha = 90, got 91 degrees"),
        ("P212121", (5, 6, 7), (90, 92, 90), "expected beta = 90, got 92 degrees"),
        ("P6122", (5, 5, 7), None, "expected gamma = 120, got 90 degrees"),
        ("R32", (5, 5, 5), (77, 77, 77), "expected alpha = 90, got 77 degrees"),
        ("R32:R", (5, 5, 5.1), (77, 77, 77), "expected a = c, got a = 5 and c = 5.1"),
        ("R32:R", (5, 5, 5), (77, 77, 78), "expected alpha = gamma, got alpha = 77 and gamma = 78"),
        ("P23", (5, 5, 6), None, "expected a = c, got a = 5 and c = 6; expected b = c"),
        ("p4", (5, 6), None, "expected a = b, got a = 5 and b = 6"),
        ("p3", (5, 5), 60, "expected gamma = 120, got 60 degrees"),
        ("pm", (5, 6), 91, "expected gamma = 90, got 91 degrees"),
        ("p4", (5, 5, 5), None, "expected a cell in 2 dimensions, got one in 3"),
    ],
)
def test_cells_that_contradict_the_group(name, lengths, angles, words):
    with pytest.raises(CrystalError) as caught:
        space_group(name).cartesian(UnitCell.from_parameters(lengths, angles))
    assert words in str(caught.value)
    assert str(caught.value).startswith(name)


def test_unusual_axes_get_a_general_message():
    primitive = SpaceGroup("skew", None, tuple(_skewed(space_group("pm"))))
    with pytest.raises(CrystalError, match="does not keep the cell's lengths and angles"):
        primitive.check_cell(UnitCell.from_parameters((5, 6), 91))


def _skewed(group):
    from ellipsoid_planning.crystal import Operation

    change = Operation.parse("x+2y,y")
    return [(change @ operation @ change.inverse()).modulo() for operation in group.operations]


@pytest.mark.parametrize(
    ("name", "lengths", "angles"),
    [
        ("P4", (10.0, 10.000004, 7.0), (90.0, 90.0, 90.00001)),
        ("P6", (10.0, 10.000004, 7.0), (90.0, 90.00001, 119.99999)),
        ("R3:R", (9.0, 9.000003, 9.0), (75.0, 75.00001, 75.0)),
        ("p4", (5.0, 5.000002), 90.00001),
    ],
)
def test_what_was_rounded_in_a_cell_is_corrected(name, lengths, angles):
    group = space_group(name)
    cell = UnitCell.from_parameters(lengths, angles)
    fitted = group.fitted_cell(cell)
    np.testing.assert_allclose(fitted.basis, cell.basis, atol=1e-5)
    turns, _ = group.cartesian(fitted)
    unit = np.eye(group.dimension)
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1), [unit] * group.order, atol=1e-14)
    assert group.fitted_cell(fitted) is fitted


def test_a_cell_that_fits_stays_as_it_is():
    for name, cell in (
        ("P23", UnitCell.from_parameters((7.3, 7.3, 7.3))),
        ("P1", UnitCell.from_parameters((7, 8, 9), (75, 100, 62))),
        ("P61", UnitCell.from_parameters((7.3, 7.3, 9.1), (90, 90, 120))),
    ):
        assert space_group(name).fitted_cell(cell) is cell
