"""Files of arrays: looked at before they are unpacked, and refused by one clear line."""

import io
import json
import zipfile

import numpy as np
import pytest

from ellipsoid_planning import __version__, array_members
from ellipsoid_planning.array_files import FileKind, read_document, read_header, write_document
from ellipsoid_planning.array_members import plain_array
from ellipsoid_planning.errors import RoadmapError

KIND = FileKind("roadmap", 1, RoadmapError)
HEADER = {"kind": KIND.title, "format": 1, "version": __version__}
PLACES = np.arange(6, dtype=np.int64).reshape(3, 2)


def npy(header, data=b""):
    text = header.encode()
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + data


def archive(file, array, header=HEADER, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(file, "w", method) as written:
        written.writestr(KIND.member, json.dumps(header))
        written.writestr("places.npy", array)
    return file


@pytest.fixture
def file(tmp_path):
    return tmp_path / "a.roadmap"


def test_arrays_come_back(file):
    flags = np.array([True, False])
    write_document(KIND, file, {"size": 3}, {"places": PLACES, "flags": flags, "none": PLACES[:0]})
    document = read_document(KIND, file)
    assert document.header["size"] == 3
    np.testing.assert_array_equal(document.array("places", np.int64, None, 2), PLACES)
    np.testing.assert_array_equal(document.array("flags", bool, 2), flags)
    assert document.array("none", np.int64, 0, 2).shape == (0, 2)
    assert document.array("places", np.int64, 3, 2).flags.writeable


SHAPE = "{{'descr': '<i8', 'fortran_order': False, 'shape': {}, }}\n"
CRAFTED = {
    "nested": SHAPE.format("(" * 2000 + ")" * 2000),
    "unhashable": "{{}: 1, 'descr': '<i8', 'fortran_order': False, 'shape': (3, 2), }\n",
    "unterminated": "{'descr': '<i8', 'fortran_order': False, 'shape': (3, 2\n",
    "string": "{'descr': '<i8\n",
    "long": SHAPE.format("(3L, 2L)"),
    "negative": SHAPE.format("(-3, -2)"),
    "objects": "{'descr': '|O', 'fortran_order': False, 'shape': (3, 2), }\n",
    "record": "{'descr': [('a', '<i8')], 'fortran_order': False, 'shape': (3, 2), }\n",
    "call": "{'descr': '<i8', 'fortran_order': False, 'shape': exit(), }\n",
    "columns": "{'descr': '<i8', 'fortran_order': True, 'shape': (3, 2), }\n",
    "endless": SHAPE.format("(" + "9" * 4000 + ",)"),
    "larger": SHAPE.format("(3, 3)"),
    "smaller": SHAPE.format("(3, 1)"),
    "nothing": "",
}


@pytest.mark.parametrize("case", CRAFTED)
def test_crafted_headers_of_arrays_are_refused(file, case):
    content = npy(CRAFTED[case], PLACES.tobytes())
    with pytest.raises(RoadmapError, match=r"a\.roadmap: damaged roadmap: ") as caught:
        read_document(KIND, archive(file, content)).array("places", np.int64, 3, 2)
    assert "\n" not in str(caught.value)
    with pytest.raises(ValueError, match="array"):
        plain_array(content)


def bomb(file, size):
    """An archive that unpacks to an array of `size` zeros, a thousand times as large."""
    text = SHAPE.format(f"({size},)").encode()
    content = io.BytesIO()
    content.write(b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text)
    content.write(bytes(8 * size))
    return archive(file, content.getvalue())


def test_what_would_fill_the_memory_is_not_unpacked(file, monkeypatch):
    read = []
    original = zipfile.ZipExtFile.read
    monkeypatch.setattr(
        zipfile.ZipExtFile,
        "read",
        lambda self, n=-1: read.append(len(data := original(self, n))) or data,
    )
    bomb(file, 1 << 22)
    with pytest.raises(RoadmapError, match="bytes are stated to hold 33554"):
        read_document(KIND, file)
    bomb(file, 1 << 20)
    with pytest.raises(RoadmapError, match=r"expected int64 numbers of shape \(any, 2\)"):
        read_document(KIND, file).array("places", np.int64, None, 2)
    assert sum(read) < 1 << 12


def test_no_more_is_read_than_is_stated(file):
    archive(file, npy(SHAPE.format("(3, 2)"), PLACES.tobytes()))
    whole = bytearray(file.read_bytes())
    entry = whole.rfind(b"PK\x01\x02")
    for stated in (0, 60, 1 << 31, (1 << 32) - 2):
        whole[entry + 24 : entry + 28] = stated.to_bytes(4, "little")
        file.write_bytes(whole)
        with pytest.raises(RoadmapError, match="damaged roadmap"):
            read_document(KIND, file).array("places", np.int64, 3, 2)


@pytest.mark.parametrize("text", ["[" * 100_000, '{"a": ' + "1" * 5000 + "}", "{", "\x00"])
def test_crafted_headers_of_files_are_refused(file, text):
    with zipfile.ZipFile(file, "w") as written:
        written.writestr(KIND.member, text)
    with pytest.raises(RoadmapError, match=r"a\.roadmap: ") as caught:
        read_header(KIND, file)
    assert "\n" not in str(caught.value)


def test_other_packings_are_refused(file):
    content = npy(SHAPE.format("(3, 2)"), PLACES.tobytes())
    archive(file, content, method=zipfile.ZIP_BZIP2)
    with pytest.raises(RoadmapError, match="expected members that are deflated"):
        read_document(KIND, file)


def test_randomly_changed_files_are_read_or_refused(file, tmp_path):
    write_document(KIND, file, {"size": 3}, {"places": PLACES})
    whole, rng, refused = file.read_bytes(), np.random.default_rng(4), 0
    changed = tmp_path / "changed.roadmap"
    for _ in range(1000):
        data = bytearray(whole)
        for place in rng.integers(len(data), size=rng.integers(1, 4)):
            data[place] = rng.integers(256)
        if rng.random() < 0.3:
            first = int(rng.integers(len(data)))
            del data[first : first + int(rng.integers(1, 40))]
        changed.write_bytes(data)
        try:
            document = read_document(KIND, changed)
            document.array("places", np.int64, 3, 2)
        except RoadmapError as error:
            assert str(changed) in str(error)  # noqa: PT017
            refused += 1
    assert refused > 500


def test_packed_arrays_tell_their_shape_unread(file):
    write_document(KIND, file, {}, {"places": PLACES})
    (packed,) = read_document(KIND, file).arrays.values()
    assert isinstance(packed, array_members.PackedArray)
    assert (packed.dtype, packed.shape) == (np.int64, (3, 2))
