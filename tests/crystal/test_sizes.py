"""Models and searches of sizes that make no sense are refused with what they come to."""

import warnings

import pytest

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.packing.model_files import locate_model
from ellipsoid_planning.crystal.structures.fitted_model import SearchSteps
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, ScenarioError


def test_grids_of_too_many_arrangements(tmp_path):
    """Each joint's 1,200 values alone are few; together with the poses they are 1.5e15."""
    text = locate_model("rabbit-p1").read_text()
    steps = "joints: {"
    assert text.count("joints:") >= 2, "the molecule's, and the search's"
    start = text.rindex("joints:")
    end = text.index("diffraction:")
    keys = load_model("rabbit-p1").keys[3:]
    fine = steps + ", ".join(f"{key}: {{step: 0.05}}" for key in keys) + "}\n"
    path = tmp_path / "many.yaml"
    path.write_text(text[:start] + fine + text[end:])
    with pytest.raises(
        ScenarioError, match=r"at most 1e\+07 poses .* and 1e\+14 arrangements, got"
    ):
        load_model(path)


@pytest.mark.parametrize("size", [1e-99, 1e99])
def test_enormous_and_tiny_cells_overflow_nowhere(size):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        space_group("P212121").check_cell(UnitCell.from_parameters([size, 1.0, 1.0]))
        for lengths in ([size, 1.0, 1.0], [1.0, size, 1.0]):
            with pytest.raises(CrystalError, match="expected a = b"):
                space_group("P4").check_cell(UnitCell.from_parameters(lengths))


@pytest.mark.parametrize("spread", [0.0, -1.0, float("nan"), float("inf"), 1e300])
def test_spreads_out_of_their_range(spread):
    with pytest.raises(CrystalError, match="expected 0 < m_b <= 1e"):
        GaussianMixture(spread)


@pytest.mark.parametrize("name", ["shift", "turn_deg", "resolution"])
@pytest.mark.parametrize("value", [0.0, 1e-9, float("nan"), float("inf")])
def test_steps_that_a_file_would_round_to_nothing(name, value):
    with pytest.raises(CrystalError, match=f"{name} .*expected a number from 0.001 on"):
        SearchSteps(**{name: value})
