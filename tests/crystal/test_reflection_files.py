"""What files of reflections say beside their numbers: it is heeded, or refused in one line."""

import gzip

import gemmi
import numpy as np
import pytest

from ellipsoid_planning.crystal import file_content
from ellipsoid_planning.crystal.diffraction.magnitude_files import read_magnitudes
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.errors import EllipsoidPlanningError, ScenarioError
from planners.cli.crystal_data import load_data
from tests.crystal.reflection_files import FIT, HEADER, ROWS, cif_text, write, write_mtz

OPERATIONS = "loop_\n_symmetry_equiv.pos_as_xyz\n'{}'\n'1/2-x,-y,1/2+z'\n'-x,1/2+y,1/2-z'\n'{}'\n"


@pytest.fixture(scope="module")
def model():
    return load_model("rabbit-p212121")


@pytest.mark.parametrize("flag", [1e9, -99.9, 0.0, None])
def test_the_number_that_stands_for_missing_values_is_none(model, tmp_path, flag):
    none = np.nan if flag is None else flag
    rows = [[1, 0, 1, 3.0, 0.1], [2, 0, 0, none, none], [0, 1, 1, 1e3, none], [9, 9, 9, none, 0]]
    path = write_mtz(tmp_path / "data.mtz", rows, [("FP", "F"), ("SIGFP", "Q")], missing=flag)
    with pytest.raises(ScenarioError, match=r"FP: reflection \(2, 0, 0\): .* got none"):
        read_magnitudes(path, model)
    found = read_magnitudes(path, model, skip_missing=True)
    assert sorted(found.values.tolist()) == [3.0, 1e3] and found.sigmas is None
    assert found.notes == ("1 reflections have no usable value in FP and are left out",)


@pytest.mark.parametrize(
    "tag", ["_refln.status", "_refln_include_status", "_refln_observed_status"]
)
@pytest.mark.parametrize("code", ["o", "f", "<", "h", "l", "?", ".", "x", "-", "'x'", "q"])
def test_reflections_that_the_file_does_not_want_used_are_left_out(model, tmp_path, tag, code):
    text = ROWS.replace("_au\n", f"_au\n{tag}\n").replace("3.0", "3.0 o").replace("4.0", "4.0 ")
    path = write(tmp_path, text.replace("4.0 ", f"4.0 {code}"))
    if "." not in tag:
        path.write_text(path.read_text().replace("_refln.", "_refln_"))
    if code == "q":
        with pytest.raises(ScenarioError, match=rf"{tag}: reflection \(2, 0, 0\): .* got q"):
            read_magnitudes(path, model)
        return
    found = read_magnitudes(path, model)
    out = code.strip("'") in "x-"
    assert found.indices.tolist() == [[1, 0, 1]] if out else len(found) == 2
    assert (f"{tag} {code[1:2] or code}) and left out" in " ".join(found.notes)) == out


def test_what_is_compressed_is_unpacked_whatever_its_name(model, tmp_path):
    mtz = write_mtz(tmp_path / "data.mtz", [[1, 0, 1, 3.0], [2, 0, 0, 4.0]], [("FP", "F")])
    for name, content in (("a.mtz.gz", mtz.read_bytes()), ("a.cif.gz", cif_text().encode())):
        for suffix in (name, name.removesuffix(".gz")):
            (tmp_path / suffix).write_bytes(gzip.compress(content))
            found = load_data(str(tmp_path / suffix), model).cost.magnitudes
            assert sorted(found.values.tolist()) == [3.0, 4.0]


def test_damaged_and_enormous_archives_are_refused(model, tmp_path, monkeypatch):
    path = tmp_path / "data.mtz.gz"
    path.write_bytes(gzip.compress(cif_text().encode())[:-20])
    with pytest.raises(ScenarioError, match="cannot unpack the file"):
        read_magnitudes(path, model)
    path.write_bytes(b"\x1f\x8bnonsense")
    with pytest.raises(ScenarioError, match="cannot read the file"):
        read_magnitudes(path, model)
    monkeypatch.setattr(file_content, "LARGEST", 1000)
    path.write_bytes(gzip.compress(b" " * 1001))
    assert path.stat().st_size < 100
    with pytest.raises(ScenarioError, match="at most 1,000 bytes"):
        read_magnitudes(path, model)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_no_part_of_the_text(model, tmp_path, encoding):
    path = tmp_path / "data.cif"
    path.write_bytes(cif_text().encode(encoding))
    assert len(read_magnitudes(path, model)) == 2


def test_the_content_says_what_a_file_is(model, tmp_path):
    mtz = write_mtz(tmp_path / "data.mtz", [[1, 0, 1, 3.0]], [("FP", "F")]).read_bytes()
    for name in ("data.hkl", "data.txt", "data"):
        for content in (mtz, b"# journal's\n" + cif_text().encode()):
            (tmp_path / name).write_bytes(content)
            assert load_data(str(tmp_path / name), model).target is None
    shelx = b"   1   0   1    9.00    0.10   1\n   2   0   0   16.00    0.10   1\n"
    for name in ("data.hkl", "data.HKL", "data.sca", "data.hkl.gz"):
        (tmp_path / name).write_bytes(shelx)
        with pytest.raises(ScenarioError, match=r"file of reflections \(.mtz.* make an MTZ or CIF"):
            load_data(str(tmp_path / name), model)
    (tmp_path / "folder.mtz").mkdir()
    for name, told in (("folder.mtz", "this is a folder"), ("none.cif.gz", "no such file")):
        with pytest.raises(ScenarioError, match=told):
            load_data(str(tmp_path / name), model)


def test_blocks_are_named(model, tmp_path):
    path = write(tmp_path, ROWS)
    other = cif_text(ROWS.replace("3.0", "5.0")).replace("data_test", "data_peak")
    path.write_text("data_first\n_a.b 1\n" + path.read_text() + other)
    found = read_magnitudes(path, model)
    assert found.values.tolist() == [3.0, 4.0]
    assert found.notes == ("read the block test; choose another by its name: peak",)
    found = read_magnitudes(path, model, block="peak")
    assert found.values.tolist() == [5.0, 4.0] and found.notes == ()
    assert read_magnitudes(path, model, block="test").values.tolist() == [3.0, 4.0]
    with pytest.raises(ScenarioError, match=r"no block 'first' with reflections; .* test, peak"):
        read_magnitudes(path, model, block="first")
    mtz = write_mtz(tmp_path / "data.mtz", [[1, 0, 1, 3.0]], [("FP", "F")])
    with pytest.raises(ScenarioError, match="an MTZ file has no block 'test'"):
        read_magnitudes(mtz, model, block="test")
    with pytest.raises(EllipsoidPlanningError, match="--block: it belongs to a file"):
        load_data("rabbit-p212121-target", model, block="test")


def test_the_group_is_compared_by_its_operations(model, tmp_path):
    path = write(tmp_path, ROWS, group="Xyz 7")
    with pytest.raises(ScenarioError, match="space group: there is no space group 'Xyz 7'"):
        read_magnitudes(path, model)
    fit = OPERATIONS.format("x,y,z", "1/2+x,1/2-y,-z")
    path = write(tmp_path, ROWS + fit, group="Xyz 7")
    assert len(read_magnitudes(path, model)) == 2
    path = write(tmp_path, ROWS + OPERATIONS.format("x,y,z", "x,-y,-z"))
    with pytest.raises(ScenarioError, match="space group: expected the model's space group"):
        read_magnitudes(path, model)
    path = write(tmp_path, ROWS + OPERATIONS.format("x,y,z", "x,y"))
    with pytest.raises(ScenarioError, match=r"expected a symmetry operation .*got 'x,y'"):
        read_magnitudes(path, model)


def test_the_group_of_an_mtz_file_with_an_unknown_name(model, tmp_path):
    path = write_mtz(tmp_path / "data.mtz", [[1, 0, 1, 3.0]], [("FP", "F")])
    other = write_mtz(tmp_path / "other.mtz", [[1, 0, 1, 3.0]], [("FP", "F")], group="P 2 2 2")
    for file in (path, other):
        content = file.read_bytes()
        name = b"'P 21 21 21'" if file == path else b"'P 2 2 2'"
        assert name in content
        file.write_bytes(content.replace(name, b"'Xyz 7'".ljust(len(name))))
    assert len(read_magnitudes(path, model)) == 1, "its operations are listed"
    with pytest.raises(ScenarioError, match="space group: expected the model's space group"):
        read_magnitudes(other, model)
    path.write_bytes(path.read_bytes().replace(b"SYMM ", b"SOMM "))
    with pytest.raises(ScenarioError, match="there is no space group 'Xyz 7'"):
        read_magnitudes(path, model)


def test_what_cannot_be_compared_is_said(model, tmp_path):
    path = tmp_path / "data.cif"
    start = HEADER.index("loop_")
    path.write_text("data_x\n" + HEADER[start:].format(**FIT) + ROWS)
    told = read_magnitudes(path, model).notes
    assert [" ".join(note.split()[:6]) for note in told] == [
        "the file tells no cell: the",
        "the file tells no space group:",
    ]
    assert load_data(str(path), model).remarks[0].startswith(f"{path}: the file tells no cell")
    for value in ("?", "0", "-22", "x"):
        with pytest.raises(ScenarioError, match=r"_cell.length_a: expected a positive number"):
            read_magnitudes(write(tmp_path, ROWS, a=value), model)


def test_odd_tables_of_mtz_files_are_refused(model, tmp_path):
    columns = [("FP", "F"), ("FP", "F")]
    path = write_mtz(tmp_path / "twice.mtz", [[1, 0, 1, 3.0, 5.0]], columns)
    with pytest.raises(ScenarioError, match="the file has data/FP, data/FP'"):
        read_magnitudes(path, model)
    assert read_magnitudes(path, model, "data/FP'").values.tolist() == [5.0]
    for odd in (np.nan, 0.5, 1e9):
        path = write_mtz(tmp_path / "odd.mtz", [[1, 0, odd, 3.0]], [("FP", "F")])
        with pytest.raises(ScenarioError, match="row 1: expected whole numbers as Miller indices"):
            read_magnitudes(path, model)
    mtz = gemmi.read_mtz_file(str(path))
    mtz.batches.append(gemmi.Mtz.Batch())
    mtz.write_to_file(str(path))
    with pytest.raises(ScenarioError, match="the file has 1 batches of single measurements"):
        read_magnitudes(path, model)


def test_values_that_are_no_numbers_are_refused(model, tmp_path):
    for text in ("NaN", "inf", "3.0*"):
        with pytest.raises(ScenarioError, match=r"\(1, 0, 1\): expected a number, got"):
            read_magnitudes(write(tmp_path, ROWS.replace("3.0", text)), model)
    for value in (np.inf, 1e9):
        path = write_mtz(tmp_path / "a.mtz", [[1, 0, 1, value]], [("FP", "F")], missing=1e9)
        with pytest.raises(ScenarioError, match=r"\(1, 0, 1\): expected a magnitude, got"):
            read_magnitudes(path, model)
