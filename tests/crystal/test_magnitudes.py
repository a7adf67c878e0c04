"""Magnitudes: simulated, written to MTZ and read again, and what wrong files are told."""

import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.magnitude_files import read_magnitudes
from ellipsoid_planning.crystal.diffraction.magnitude_writing import write_magnitudes
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes, simulate
from ellipsoid_planning.crystal.diffraction.reflections import all_reflections
from ellipsoid_planning.crystal.diffraction.structure_factors import (
    reflections_of,
    structure_factors,
)
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.errors import CrystalError, ScenarioError
from tests.crystal.packings import one_body
from tests.crystal.reflection_files import FIT, HEADER, ROWS, write, write_mtz


@pytest.fixture(scope="module")
def model():
    return load_model("rabbit-p212121")


@pytest.fixture(scope="module")
def target(model):
    return simulate(model, load_target("rabbit-p212121-target", model))


def test_calculated_ones_are_read_only_where_there_are_no_others(model, tmp_path):
    rows = [[1, 0, 1, 1.0, 2.0]]
    for first, found in (("F_XDS", 1.0), ("F-model", 1.0), ("FCALC", 2.0)):
        path = write_mtz(tmp_path / "data.mtz", rows, [(first, "F"), ("FC", "F")])
        assert read_magnitudes(path, model).values.tolist() == [found]
    rows = [[1, 0, 1, 1.0, 2.0, 3.0]]
    path = write_mtz(tmp_path / "data.mtz", rows, [("FC", "F"), ("X", "F"), ("Y", "F")])
    with pytest.raises(ScenarioError, match="the file has FC, X, Y, name the right one"):
        read_magnitudes(path, model)


def test_names_in_cif_do_not_depend_on_case_and_huge_indices_are_refused(model, tmp_path):
    path = tmp_path / "data.cif"
    text = HEADER.format(**FIT).replace("_refln.index", "_REFLN.Index") + "_refln.f_MEAS_au\n"
    path.write_text(text + "1 0 1 3.0\n")
    assert read_magnitudes(path, model).values.tolist() == [3.0]
    path.write_text(text + "1e23 0 1 3.0\n")
    with pytest.raises(ScenarioError, match="index_h: expected whole numbers"):
        read_magnitudes(path, model)


@pytest.mark.parametrize("name", ["rabbit-plane", "rabbit-p1", "rabbit-p212121"])
def test_what_is_written_is_read_again(name, tmp_path):
    model = load_model(name)
    given = simulate(model, load_target(f"{name}-target", model))
    sigmas = 0.01 * given.values + 0.1
    whole = Magnitudes(given.reflections, given.values, sigmas)
    for magnitudes in (given, whole):
        write_magnitudes(tmp_path / "data.mtz", magnitudes, model)
        found = read_magnitudes(tmp_path / "data.mtz", model)
        assert np.array_equal(found.indices, magnitudes.indices)
        assert np.allclose(found.values, magnitudes.values, rtol=1e-6)
        assert found.completeness == 1.0 and len(found.missing) == 0 and found.relative
        assert (found.sigmas is None) == (magnitudes.sigmas is None)
    assert np.allclose(found.sigmas, sigmas, rtol=1e-6)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["data.mtz"]


def test_equivalents_are_merged_whatever_their_indices(model, target, tmp_path):
    """All of the sphere, both signs, in any order, with absent ones and ones beyond it."""
    whole = all_reflections(model.cell, 0.8 * model.resolution)
    configuration = load_target("rabbit-p212121-target", model)
    values = np.abs(structure_factors(model, configuration, whole))
    rows = np.vstack([np.column_stack([s * whole.indices, values]) for s in (1, -1)])
    np.random.default_rng(0).shuffle(rows)
    path = write_mtz(tmp_path / "data.mtz", rows, [("FOBS", "F")])
    found = read_magnitudes(path, model)
    assert np.array_equal(found.indices, target.indices)
    assert np.allclose(found.values, target.values, rtol=1e-5, atol=1e-4)


def test_equivalents_average(model, tmp_path):
    path = write(tmp_path, "_refln.F_meas_au\n_refln.F_meas_sigma_au\n1 0 1 3 3\n-1 0 1 5 4\n")
    found = read_magnitudes(path, model)
    assert found.indices.tolist() == [[1, 0, 1]]
    assert found.values.tolist() == [4.0] and found.sigmas.tolist() == [2.5]
    assert len(found.missing) == len(reflections_of(model)) - 1
    path = write(tmp_path, "_refln.F_meas_au\n_refln.F_meas_sigma_au\n1 0 1 3 3\n-1 0 1 5 *\n")
    odd = read_magnitudes(path, model)
    assert odd.values.tolist() == [4.0] and odd.sigmas is None
    assert found.completeness == pytest.approx(1 / 80)


def test_intensities_become_magnitudes(model, tmp_path):
    rows = [[1, 0, 1, 16.0, 2.0], [2, 0, 0, 0.0, 4.0]]
    path = write_mtz(tmp_path / "data.mtz", rows, [("IMEAN", "J"), ("SIGIMEAN", "Q")])
    found = read_magnitudes(path, model)
    assert found.values.tolist() == [4.0, 0.0]
    assert found.sigmas == pytest.approx([0.25, 2.0], rel=0.05)
    path = write(tmp_path, "_refln.intensity_meas\n1 0 1 16\n")
    assert read_magnitudes(path, model).values.tolist() == [4.0]


def test_small_molecules_cif_is_read(model, tmp_path):
    text = HEADER.format(**FIT) + "_refln.F_squared_meas\n1 0 1 16.0(3)\n"
    text = text.replace("_cell.", "_cell_").replace("_refln.", "_refln_")
    text = text.replace("_symmetry.space_group", "_symmetry_space_group")
    (tmp_path / "data.cif").write_text(text)
    assert read_magnitudes(tmp_path / "data.cif", model).values.tolist() == [4.0]
    wrong = tmp_path / "wrong.cif"
    wrong.write_text(text.replace("P 21 21 21", "P 2 2 2"))
    with pytest.raises(ScenarioError, match="space group"):
        read_magnitudes(wrong, model)


def test_columns_are_chosen_or_named(model, tmp_path):
    rows = [[1, 0, 1, 1.0, 2.0, 3.0, 4.0]]
    columns = [("FC", "F"), ("FP", "F"), ("I", "J"), ("PHI", "P")]
    path = write_mtz(tmp_path / "data.mtz", rows, columns)
    assert read_magnitudes(path, model).values.tolist() == [2.0]
    assert read_magnitudes(path, model, "FC").values.tolist() == [1.0]
    assert read_magnitudes(path, model, "I").values.tolist() == [pytest.approx(3.0**0.5)]
    for wrong in ("PHI", "NOPE"):
        with pytest.raises(ScenarioError, match=f"'{wrong}' is none; the file has FC, FP, I"):
            read_magnitudes(path, model, wrong)
    odd = write_mtz(tmp_path / "odd.mtz", rows, [("X", "F"), ("Y", "F"), ("Z", "J"), ("P", "P")])
    with pytest.raises(ScenarioError, match="the file has X, Y, Z, name the right one"):
        read_magnitudes(odd, model, "")
    none = write_mtz(tmp_path / "none.mtz", [[1, 0, 1, 1.0]], [("PHI", "P")])
    with pytest.raises(ScenarioError, match="magnitudes or intensities; the file has none"):
        read_magnitudes(none, model)


def test_missing_ones_are_refused_or_left_out(model, tmp_path):
    cif = write(tmp_path, "_refln.F_meas_au\n1 0 1 3.0\n2 0 0 ?\n0 2 0 .\n9 9 9 ?\n")
    rows = [[1, 0, 1, 3.0], [2, 0, 0, np.nan], [0, 2, 0, np.nan], [9, 9, 9, np.nan]]
    mtz = write_mtz(tmp_path / "data.mtz", rows, [("FP", "F")])
    for path, column in ((cif, "F_meas_au"), (mtz, "FP")):
        message = (
            rf"{column}: reflection \(2, 0, 0\) \(and 1 more\): expected a magnitude, got none"
        )
        with pytest.raises(ScenarioError, match=message) as caught:
            read_magnitudes(path, model)
        assert caught.value.file == str(path) and caught.value.field == column
        assert read_magnitudes(path, model, skip_missing=True).indices.tolist() == [[1, 0, 1]]


def test_negative_ones_are_refused(model, tmp_path):
    path = write(tmp_path, "_refln.F_meas_au\n1 0 1 3.0\n2 0 0 -0.5\n")
    for skip in (False, True):
        with pytest.raises(
            ScenarioError, match=r"\(2, 0, 0\): expected a magnitude of 0 .* got -0.5"
        ):
            read_magnitudes(path, model, skip_missing=skip)
    path = write(tmp_path, "_refln.intensity_meas\n1 0 1 9.0\n2 0 0 -0.5\n")
    with pytest.raises(ScenarioError, match=r"\(2, 0, 0\): expected an intensity of 0 or more"):
        read_magnitudes(path, model)
    assert read_magnitudes(path, model, skip_missing=True).values.tolist() == [3.0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"a": 23}, "cell: expected the model's cell with a = 22, got 23"),
        ({"gamma": 91}, "cell: expected the model's cell with gamma = 90, got 91"),
        ({"group": "P 21 21 2"}, "space group: expected the model's space group P212121, got P 21"),
    ],
)
def test_data_of_another_crystal_are_refused(model, tmp_path, changes, message):
    with pytest.raises(ScenarioError, match=message):
        read_magnitudes(write(tmp_path, ROWS, **changes), model)
    assert len(read_magnitudes(write(tmp_path, ROWS, a=22.05), model)) == 2


def test_broken_files_are_refused(model, tmp_path):
    cases = {
        "none.mtz": (None, "no such file"),
        "text.mtz": ("nonsense", "no readable MTZ file"),
        "text.cif": ("nonsense", "no readable CIF file"),
        "model.cif": ("data_x\n_cell.length_a 3\n", "the file has none; this may be"),
        "data.txt": ("nonsense", "expected a file of reflections .*got .txt"),
        "word.cif": (
            HEADER.format(**FIT) + ROWS.replace("3.0", "x"),
            "expected a number, got x",
        ),
        "half.cif": (HEADER.format(**FIT) + ROWS.replace("1 0 1", "1 0.5 1"), "whole numbers only"),
        "far.cif": (HEADER.format(**FIT) + "_refln.F_meas_au\n9 9 9 1\n", "resolution of 4.6"),
        "zero.cif": (HEADER.format(**FIT) + "_refln.F_meas_au\n1 0 1 0\n", "all magnitudes are 0"),
        "flat.cif": (
            HEADER.format(**FIT).replace("_refln.index_l\n", "") + "_refln.F_meas_au\n1 0 1\n",
            "index_l: this column is missing",
        ),
    }
    for name, (text, message) in cases.items():
        if text is not None:
            (tmp_path / name).write_text(text)
        with pytest.raises((ScenarioError, CrystalError), match=message) as caught:
            read_magnitudes(tmp_path / name, model)
        assert name in str(caught.value)


def test_nothing_left_is_refused(model, tmp_path):
    path = write(tmp_path, "_refln.F_meas_au\n1 0 1 ?\n")
    with pytest.raises(CrystalError, match="there are none"):
        read_magnitudes(path, model, skip_missing=True)


def test_magnitudes_check_themselves(target):
    for values, message in (
        (target.values[1:], "expected 80 numbers"),
        (-target.values, r"reflection \(\d, \d, \d\): expected a magnitude of 0 or more, got -"),
        (np.full(80, np.nan), "got nan"),
        (np.zeros(80), "all magnitudes are 0"),
        (np.full(80, 1e170), "the largest is 1e.170"),
        (np.full(80, 1e-170), "the largest is 1e-170"),
    ):
        with pytest.raises(CrystalError, match=message):
            Magnitudes(target.reflections, values)
    with pytest.raises(ValueError, match="read-only"):
        target.values[0] = 1.0


def test_a_molecule_that_stands_still_has_magnitudes(tmp_path):
    model = one_body("P21", "{lengths: [9, 9, 9]}", [1.0, 1.0, 1.0])
    odd = one_body("P1", "{lengths: [9, 9, 9]}", [1.0, 1.0, 1.0])
    write_magnitudes(tmp_path / "a.mtz", simulate(model, []), model)
    assert len(read_magnitudes(tmp_path / "a.mtz", model)) == len(reflections_of(model))
    with pytest.raises(ScenarioError, match="space group"):
        read_magnitudes(tmp_path / "a.mtz", odd)
