"""Tables in files: kept, found again, and refused when damaged or another's."""

import zipfile

import numpy as np
import pytest

from ellipsoid_planning.errors import TableError
from ellipsoid_planning.safety import TableParameters, TabulatedSafety, store
from ellipsoid_planning.safety.build import fill_tables
from ellipsoid_planning.safety.planning import plan_tables
from ellipsoid_planning.safety.store import load_table, save_table, table_path
from tests.safety.scenes import COARSE, crowded, states


@pytest.fixture
def plan():
    return plan_tables(crowded("spheroids"), COARSE).tables[0]


@pytest.fixture
def file(plan, tmp_path):
    save_table(fill_tables([plan])[0], tmp_path / "a.safety")
    return tmp_path / "a.safety"


def test_a_table_comes_back_as_it_was(plan, file):
    table, back = fill_tables([plan])[0], load_table(plan, file)
    assert back.loaded and not table.loaded
    assert back.offsets.tobytes() == table.offsets.tobytes()
    assert back.intervals.tobytes() == table.intervals.tobytes()
    first = file.read_bytes()
    save_table(back, file)
    assert file.read_bytes() == first


def test_tables_are_kept_in_a_folder_and_found_by_identical_links(tmp_path):
    cspace, folder = crowded("spheroids"), tmp_path / "new" / "tables"
    told = []
    first = TabulatedSafety(cspace, COARSE, folder=folder, on_progress=lambda *n: told.append(n))
    assert told and not first.report().tables[0].loaded
    told.clear()
    second = TabulatedSafety(
        crowded("spheroids"), COARSE, folder=folder, on_progress=lambda *n: told.append(n)
    )
    assert not told and second.report().tables[0].loaded
    drawn = states(cspace, 200)
    assert np.array_equal(first.answers(drawn), second.answers(drawn))
    assert len(list(folder.iterdir())) == len(first.tables)


def test_what_differs_has_another_key():
    keys = [
        plan_tables(cspace, parameters).tables[0].key()
        for cspace, parameters in (
            (crowded("spheroids"), COARSE),
            (crowded("spheroids", clearance=1e-9), COARSE),
            (crowded("spheroids", arena=True), COARSE),
            (crowded("discs"), COARSE),
            (crowded("spheroids"), TableParameters(lines=10)),
            (crowded("spheroids"), TableParameters(orientations=10)),
        )
    ]
    assert len(set(keys)) == len(keys)
    assert plan_tables(crowded("spheroids"), COARSE).tables[0].key() == keys[0]


def test_the_default_folder_is_in_the_cache(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "CACHE_FOLDER", tmp_path / "kernels-1")
    assert store.default_folder() == tmp_path / "safety-tables"


def test_the_table_of_something_else_is_refused(file):
    other = plan_tables(crowded("spheroids", clearance=0.1), COARSE).tables[0]
    with pytest.raises(TableError, match=r"a\.safety: expected the table of this link"):
        load_table(other, file)


@pytest.mark.parametrize("size", [0, 10, 1000, -30])
def test_files_that_were_cut_short_are_refused(plan, file, size):
    file.write_bytes(file.read_bytes()[:size])
    with pytest.raises(TableError, match=r"a\.safety: .*(another one|damaged)"):
        load_table(plan, file)


def test_a_changed_byte_is_found_wherever_it_is(plan, file):
    whole, rng = file.read_bytes(), np.random.default_rng(1)
    for place in rng.integers(len(whole), size=60):
        damaged = bytearray(whole)
        damaged[place] ^= 0x10
        file.write_bytes(bytes(damaged))
        try:
            back = load_table(plan, file)
        except TableError as error:
            message = str(error)
        else:  # a byte that means nothing, such as a date
            assert np.array_equal(back.intervals, fill_tables([plan])[0].intervals)
            continue
        assert "a.safety: " in message


def test_arrays_that_contradict_each_other_are_refused(plan, file):
    table = load_table(plan, file)
    table.offsets[5] = 1 << 30
    save_table(table, file)
    with pytest.raises(TableError, match="damaged safety table: offsets: "):
        load_table(plan, file)
    table = fill_tables([plan])[0]
    table.intervals[0] = table.intervals[0][::-1].copy()
    save_table(table, file)
    with pytest.raises(TableError, match="damaged safety table: intervals: "):
        load_table(plan, file)


def test_foreign_files_are_neither_read_nor_replaced(plan, tmp_path):
    archive = tmp_path / "photos.zip"
    with zipfile.ZipFile(archive, "w") as stream:
        stream.writestr("cat.jpg", b"cat")
    for path, content in ((tmp_path / "notes.txt", b"hello"), (archive, archive.read_bytes())):
        path.write_bytes(content)
        with pytest.raises(TableError, match="expected a safety table, this file is another one"):
            load_table(plan, path)
        with pytest.raises(TableError, match="expected a safety table"):
            save_table(fill_tables([plan])[0], path)
        assert path.read_bytes() == content


def test_a_damaged_file_in_the_folder_is_told_with_its_name(plan, tmp_path):
    table_path(plan, tmp_path).write_bytes(b"PK")
    with pytest.raises(TableError, match=plan.key()):
        TabulatedSafety(crowded("spheroids"), COARSE, folder=tmp_path)


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(TableError, match="cannot make the folder"):
        TabulatedSafety(crowded("spheroids"), COARSE, folder=tmp_path / "file" / "tables")
