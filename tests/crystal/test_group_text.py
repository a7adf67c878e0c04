"""Groups read from text and files, printed, and refused when they are none."""

from pathlib import Path

import pytest

from ellipsoid_planning.crystal import SpaceGroup, space_group, space_group_from_text
from ellipsoid_planning.crystal.symmetry.group_text import parse_cosets, print_cosets, print_group
from ellipsoid_planning.errors import ScenarioError

THESIS = """\
Coset 1
(x,y,z)
Coset 2
(-x+1/2,-y,z+1/2)
Coset 3
(x+1/2,-y+1/2,-z)
Coset 4
(-x,y+1/2,-z+1/2)
"""


def test_the_thesis_format_and_bare_triplets():
    expected = space_group("P212121")
    group = space_group_from_text(THESIS)
    assert group.operations == expected.operations
    assert (group.name, group.number) == ("group", None)
    assert print_group(group) == THESIS
    bare = "# P212121\n\nx,y,z\n-x+1/2, -y, z+1/2  # a screw\nx+1/2,1/2-y,-z\r\n-x,y+1/2,-z+3/2"
    assert space_group_from_text(bare).operations == expected.operations


def test_files(tmp_path):
    for name in ("P4132", "R32", "p31m", "C2/c"):
        file = tmp_path / "operations.txt"
        file.write_text(print_group(space_group(name)))
        group = space_group_from_text(file)
        assert group.operations == space_group(name).operations
        assert group.name == "operations"
        assert space_group_from_text(file, name=name).name == name


def test_coset_spaces_as_text():
    group = space_group("P222")
    text = print_cosets([group.operations[:2], group.operations[2:]])
    assert text.splitlines()[:3] == ["Coset 1", "(x,y,z)", "(-x,-y,z)"]
    assert [len(coset) for coset in parse_cosets(text)] == [2, 2]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x,y,z\n-x,-y,z+1/3", "g_2 o g_2 = (-x,-y,z+1/3) o (-x,-y,z+1/3) = (x,y,z+2/3) is not"),
        ("x,y,z\n-x,-y,z\n-x,y,-z", "g_2 o g_3 = (-x,-y,z) o (-x,y,-z) = (x,-y,-z) is not"),
        ("x,y\n-y,x-y", "g_2 o g_2 = (-y,x-y) o (-y,x-y) = (-x+y,-x) is not"),
        ("x,y,z\nx+0.333,y,z", "is not among them"),
        ("x,y,z\n-x,y,-z\n1-x,y,-z", "operation 3, -x,y,-z, is the same as operation 2"),
        ("-x,y,-z", "the identity x,y,z is missing"),
        ("-x,y,-z\nx,y,z", "expected the identity x,y,z first, it is operation 2"),
        ("", "at least the identity"),
        ("Coset 1\nCoset 2", "at least the identity"),
        ("x,y,z\n2x,y,z", "operation 2, 2x,y,z, does not map the cell's lattice to itself"),
        ("x,y,z\n1/2*x,y,z", "does not map the cell's lattice to itself"),
        ("x,y,z\nx+2000000y,y,z", "a few digits"),
        ("x,y,z\nx+1/99999999999999999999,y,z", "a few digits"),
        ("x,y,z\n\n(-x,y,q)", "line 3: "),
        ("x,y,z\n-x,y", "line 2: -x,y: expected 3 coordinates as in the lines before"),
    ],
)
def test_bad_groups(text, words, tmp_path):
    file = tmp_path / "ops.txt"
    file.write_text(text)
    with pytest.raises(ScenarioError) as caught:
        space_group_from_text(file)
    assert str(caught.value).startswith(str(file))
    with pytest.raises(ScenarioError) as caught:
        space_group_from_text(text)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unreadable_files(tmp_path):
    with pytest.raises(ScenarioError, match=r"missing\.txt: no such file"):
        space_group_from_text(tmp_path / "missing.txt")
    (tmp_path / "half").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioError, match="half: the text is damaged; save it as UTF-8"):
        space_group_from_text(tmp_path / "half")
    (tmp_path / "binary").write_bytes(b"\xfd\xff\x00")
    with pytest.raises(ScenarioError, match="expected a text file"):
        space_group_from_text(tmp_path / "binary")


def test_mixed_dimensions_in_python():
    from ellipsoid_planning.crystal import Operation
    from ellipsoid_planning.errors import CrystalError

    with pytest.raises(CrystalError, match="operation 2"):
        SpaceGroup("odd", None, (Operation.identity(3), Operation.identity(2)))


def test_files_with_a_byte_order_mark_and_any_line_ends(tmp_path):
    file = tmp_path / "operations.txt"
    file.write_bytes(b"\xef\xbb\xbf" + THESIS.replace("\n", "\r\n").encode())
    assert space_group_from_text(file).operations == space_group("P212121").operations


def test_files_that_never_end_and_marks(tmp_path):
    with pytest.raises(ScenarioError, match="/dev/zero: expected a regular file"):
        space_group_from_text(Path("/dev/zero"))
    with pytest.raises(ScenarioError, match="this is a folder"):
        space_group_from_text(tmp_path)
    file = tmp_path / "own.txt"
    file.write_text("# much\n" * (1 << 18))
    with pytest.raises(ScenarioError, match="at most 1,048,576 bytes"):
        space_group_from_text(file)
    file.write_bytes(THESIS.encode("utf-8-sig"))
    assert space_group_from_text(file).order == 4
