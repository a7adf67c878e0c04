"""Structures in other frames, of other ages and with odd names are read right, or refused."""

from __future__ import annotations

import gemmi
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ellipsoid_planning.crystal.structures.calculated import factors_at
from ellipsoid_planning.crystal.structures.domains import assign, find_hinges, parse_domain
from ellipsoid_planning.crystal.structures.structure import read_structure
from ellipsoid_planning.errors import CrystalError, ScenarioError
from tests.crystal.structure_texts import CELL, chain_text

MONOCLINIC = gemmi.UnitCell(95.317, 120.743, 301.263, 90, 107.31, 90)
HEXAGONAL = gemmi.UnitCell(93.117, 93.117, 130.911, 90, 90, 120)


def pdb_text(cell, group, points, turn, shift):
    """A file whose frame is turned and shifted: fractional coordinates are S x + s."""
    basis = np.array(cell.orth.mat.tolist())
    scale = np.linalg.inv(turn @ basis)
    text = "CRYST1{:9.3f}{:9.3f}{:9.3f}{:7.2f}{:7.2f}{:7.2f}".format(*cell.parameters)
    text += f" {group:<11s}   4\n"
    for row in range(3):
        text += "SCALE{:d}    {:10.6f}{:10.6f}{:10.6f}".format(row + 1, *scale[row])
        text += f"     {shift[row]:10.5f}\n"
    for number, point in enumerate(points):
        x, y, z = turn @ (point - basis @ shift)
        text += f"ATOM  {number:5d}  CA  ALA A{number + 1:4d}    {x:8.3f}{y:8.3f}{z:8.3f}"
        text += "  1.00 10.00           C\n"
    return text


@pytest.mark.parametrize(
    ("cell", "group"), [(MONOCLINIC, "P 1 21 1"), (HEXAGONAL, "P 61 2 2")], ids=["P21", "P6122"]
)
@pytest.mark.parametrize("degrees", [(90, 0, 0), (0, 180, 0), (10, 20, 30)])
@pytest.mark.parametrize("shift", [(0, 0, 0), (0.25, -0.5, 0.125)])
def test_another_frame_changes_nothing(tmp_path, cell, group, degrees, shift):
    points = np.random.default_rng(0).uniform(-30.0, 30.0, (12, 3))
    turn = Rotation.from_euler("zyx", degrees, degrees=True).as_matrix()
    usual, other = tmp_path / "usual.pdb", tmp_path / "other.pdb"
    usual.write_text(pdb_text(cell, group, points, np.eye(3), np.zeros(3)))
    other.write_text(pdb_text(cell, group, points, turn, np.array(shift)))
    plain, found = read_structure(usual), read_structure(other)
    assert plain.notes == () and "SCALE" in found.notes[0]
    assert np.array_equal(found.cell.basis, plain.cell.basis), "the cell is that of CRYST1"
    # The rotation has the digits of SCALE; distances are kept to those of the coordinates.
    np.testing.assert_allclose(found.atoms.positions, points, atol=0.05)
    for a, b in ((found.atoms.positions, points), (plain.atoms.positions, points)):
        away = [np.linalg.norm(p[:, None] - p[None], axis=2) for p in (a, b)]
        np.testing.assert_allclose(*away, atol=3e-3)
    hkl = np.random.default_rng(1).integers(-4, 5, (30, 3))
    np.testing.assert_allclose(factors_at(found, hkl), factors_at(plain, hkl), atol=1.0)


def test_the_same_frame_in_mmcif(tmp_path):
    points = np.random.default_rng(0).uniform(-30.0, 30.0, (5, 3))
    turn = Rotation.from_euler("zyx", (10, 20, 30), degrees=True).as_matrix()
    text = pdb_text(MONOCLINIC, "P 1 21 1", points, turn, np.array([0.25, 0, 0]))
    made = gemmi.read_pdb_string(text)
    made.setup_entities()
    made.make_mmcif_document().write_file(str(tmp_path / "a.cif"))
    found = read_structure(tmp_path / "a.cif")
    np.testing.assert_allclose(found.atoms.positions, points, atol=0.05)


@pytest.mark.parametrize(
    "turn",
    [np.diag([1.0, 1.0, -1.0]), -np.eye(3), np.diag([1.02, 1.0, 1.0]), np.eye(3) + 0.1],
    ids=["mirror", "inversion", "longer", "sheared"],
)
def test_a_frame_that_contradicts_the_cell_is_refused(tmp_path, turn):
    path = tmp_path / "odd.pdb"
    path.write_text(pdb_text(MONOCLINIC, "P 1 21 1", np.zeros((2, 3)), turn, np.zeros(3)))
    with pytest.raises(ScenarioError, match=r"odd.pdb: SCALE: expected the cell of CRYST1"):
        read_structure(path)


def test_files_of_before_1996_are_read(tmp_path):
    """An entry's name and line numbers where elements and charges are now."""
    new, old = tmp_path / "new.pdb", tmp_path / "old.pdb"
    text = (
        CELL + chain_text() + "HETATM   90 ZN    ZN A 201       5.000   5.000   5.000  1.00 10.00"
    )
    new.write_text(text + "          ZN\n")
    lines = [f"{line[:66]:<72s}1ABC{k:4d}" for k, line in enumerate(text.splitlines(), 9990)]
    old.write_text("\n".join(lines[:9]) + "\r\n" + "\n".join(line[:80] for line in lines[9:]))
    plain, found = read_structure(new), read_structure(old)
    assert found.atoms.elements.tolist() == plain.atoms.elements.tolist()
    assert {"C", "Zn"} == set(found.atoms.elements.tolist())
    assert np.array_equal(found.atoms.positions, plain.atoms.positions)
    assert plain.notes == () and "73 to 80 are not read" in found.notes[0]
    assert found.group.name == "P212121"


def test_names_of_chains(tmp_path):
    path = tmp_path / "odd.pdb"
    path.write_text(CELL + "".join(chain_text(4, chain) + "TER\n" for chain in " 1-A"))
    found = read_structure(path)
    assert found.chains == ("", "1", "-", "A")
    for text, rows in (("n=/", 0), ("n=/1-4", 0), ("n=1/", 8), ("n=1/1-4", 8), ("n=-/", 16)):
        domain = parse_domain(text)
        assert str(domain) == text
        assert np.flatnonzero(assign(found, [domain]) == 0).tolist() == list(range(rows, rows + 8))
    for text in ("n=A+1/+-/2-3+4-4", "n=1/1-2+1/", "n=-/-3--1+5-9"):
        assert str(parse_domain(text)) == text
    for text in ("n=1", "n=1-4", "n=-"):
        with pytest.raises(CrystalError, match="named by a number or a sign as 1/"):
            parse_domain(text)
    with pytest.raises(ScenarioError, match=r"there are one without a name .*, 1, -, A"):
        assign(found, [parse_domain("n=Z")])


def test_insertion_codes(tmp_path):
    """Residues 1, 2, 2B, 2A, 3, 4: codes are not always in alphabetical order."""
    names = ["   1 ", "   2 ", "   2B", "   2A", "   3 ", "   4 "]
    lines = chain_text(6).splitlines(keepends=True)
    text = "".join(line[:22] + names[k // 2] + line[27:] for k, line in enumerate(lines))
    path = tmp_path / "codes.pdb"
    path.write_text(CELL + text)
    found = read_structure(path)
    assert [found.atoms.residue_name(row) for row in (2, 4, 6, 8)] == ["2", "2B", "2A", "3"]
    for text, residues in (
        ("A/1-2", {0, 1, 2, 3}),
        ("A/2", {1, 2, 3}),
        ("A/2-3", {1, 2, 3, 4}),
        ("A/2B-3", {2, 3, 4}),
        ("A/1-2B", {0, 1, 2}),
        ("A/2A", {3}),
        ("A/2B-2A", {2, 3}),
    ):
        owners = assign(found, [parse_domain(f"n={text}")])
        assert set((np.flatnonzero(owners == 0) // 2).tolist()) == residues, text
    assert str(parse_domain("n=A/2B-3+9-12C")) == "n=A/2B-3+9-12C"
    domains = [parse_domain("n=A/1-2B"), parse_domain("c=A/2A-4")]
    (hinge,) = find_hinges(found, domains, assign(found, domains))
    assert hinge.crossings == ("A/2B-2A",)
    with pytest.raises(ScenarioError, match=r"there are no residues 2C to 3 in chain A; .* 1 to 4"):
        assign(found, [parse_domain("n=A/2C-3")])
    with pytest.raises(ScenarioError, match="residue 2B is also in the domain"):
        assign(found, [parse_domain("n=A/1-2B"), parse_domain("c=A/2B-4")])


def test_files_that_are_something_else(tmp_path):
    core = "data_x\n_cell_length_a 5\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.1\n"
    data = "data_x\nloop_\n_refln.index_h\n_refln.F_meas_au\n1 2\n"
    for text, told in ((core, "small molecule's file .core CIF."), (data, "file of reflections")):
        (tmp_path / "a.cif").write_text(text)
        with pytest.raises(ScenarioError, match=told):
            read_structure(tmp_path / "a.cif")


def test_marks_models_and_blocks(tmp_path):
    path = tmp_path / "a.pdb"
    one, other = chain_text(3), chain_text(3).replace("   0.000   0.000", "   0.000   9.000")
    path.write_text(CELL + f"MODEL        1\n{one}ENDMDL\nMODEL        2\n{other}ENDMDL\n")
    found = read_structure(path)
    assert len(found.atoms) == 6 and found.notes == ("the first of 2 models is read",)
    path.write_bytes(b"\xef\xbb\xbf" + (CELL + one).encode())
    assert read_structure(path).group.name == "P212121"
    made = gemmi.read_pdb_string(CELL + one)
    made.setup_entities()
    text = made.make_mmcif_document().as_string()
    start = text.index("data_")
    name = text[start:].split("\n", 1)[0]
    path.write_text(text + text.replace(name, "data_second"))
    assert read_structure(path).notes == (f"the block {name[5:]} is read, and not second",)
