"""Structures from files: what is read, what is refused, and the bundled protein."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.model_files import locate_model
from ellipsoid_planning.crystal.structures.domains import assign, find_hinges, parse_domain
from ellipsoid_planning.crystal.structures.structure import read_structure
from ellipsoid_planning.errors import CrystalError, ScenarioError
from tests.crystal.structure_texts import CELL, atom_line, chain_text

PROTEIN = locate_model("dd-peptidase").with_name("dd-peptidase.pdb.gz")


@pytest.fixture
def written(tmp_path):
    def write(text, name="tiny.pdb"):
        file = tmp_path / name
        file.write_text(text)
        return file

    return write


def test_what_is_read(written):
    text = CELL + chain_text(2)
    text += atom_line(8, "ALA", 2, (3.8, -1.0, 0.0), atom="N", occupancy=0.4, other="A")
    text += atom_line(9, "ALA", 2, (3.8, -1.2, 0.0), atom="N", occupancy=0.6, other="B")
    text += atom_line(10, "ALA", 2, (3.8, -1.2, 1.0), atom="HA") + "TER\n"
    text += atom_line(11, "HOH", 101, (9.0, 9.0, 9.0), atom="O")
    found = read_structure(written(text))
    atoms = found.atoms
    assert (found.name, found.group.name, found.chains) == ("tiny", "P212121", ("A",))
    assert found.cell.lengths.tolist() == [20.0, 30.0, 40.0]
    assert atoms.names.tolist() == ["CA", "CB", "CA", "CB", "N", "N"], "no hydrogen, no water"
    assert atoms.occupancies.tolist() == pytest.approx([1, 1, 1, 1, 0.4, 0.6])
    # C3H5NO without hydrogens is C3NO: 71.08 Da against 66.04.
    carbon = 12.011 * 71.079 / 66.039
    assert atoms.masses[0] == pytest.approx(carbon, rel=1e-3)
    assert atoms.electrons[0] == pytest.approx(6.0 + (carbon - 12.011) / 1.008, rel=1e-3)
    assert atoms.masses[-2:].sum() == pytest.approx(14.007 * 71.079 / 66.039, rel=1e-3)
    assert not atoms.positions.flags.writeable


def test_mmcif_and_gzip_read_alike(written, tmp_path):
    import gemmi

    plain = written(CELL + chain_text() + "END\n")
    made = gemmi.read_structure(str(plain))
    made.setup_entities()
    made.make_mmcif_document().write_file(str(tmp_path / "tiny.cif"))
    (tmp_path / "tiny.pdb.gz").write_bytes(gzip.compress(plain.read_bytes()))
    whole = [read_structure(tmp_path / name) for name in ("tiny.pdb", "tiny.cif", "tiny.pdb.gz")]
    for other in whole[1:]:
        np.testing.assert_allclose(other.atoms.positions, whole[0].atoms.positions, atol=1e-3)
        np.testing.assert_allclose(other.cell.basis, whole[0].cell.basis)
        assert other.group.name == "P212121"
        assert other.atoms.residues.tolist() == whole[0].atoms.residues.tolist()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (chain_text(), ["CRYST1", "expected a unit cell", "_cell"]),
        (CELL[:54] + "\n" + chain_text(), ["CRYST1", "expected a space group"]),
        (CELL.replace("P 21 21 21", "P 99      ") + chain_text(), ["CRYST1", "P 99"]),
        (CELL.replace("P 21 21 21", "P 4       ") + chain_text(), ["CRYST1", "20", "30"]),
        (CELL, ["expected atoms, there are none"]),
        (
            CELL + atom_line(1, "HOH", 1, (0.0, 0.0, 0.0), atom="O"),
            ["expected atoms other than", "water"],
        ),
        (
            CELL
            + "MTRIX1   1  1.000000  0.000000  0.000000        9.00000\n"
            + "MTRIX2   1  0.000000  1.000000  0.000000        0.00000\n"
            + "MTRIX3   1  0.000000  0.000000  1.000000        0.00000\n"
            + chain_text(),
            ["MTRIX", "write out all"],
        ),
    ],
)
def test_files_that_are_refused(written, text, told):
    with pytest.raises(ScenarioError) as caught:
        read_structure(written(text))
    assert str(caught.value).count("tiny.pdb") == 1
    for part in told:
        assert part in str(caught.value)


def test_unreadable_files(written, tmp_path):
    broken = tmp_path / "broken.pdb.gz"
    broken.write_bytes(b"\x1f\x8b\x08\x00 no gzip")
    cif = written("data_x\nloop_\n_a.b\n_a.c\n1\n", "odd.cif")
    for file in (tmp_path / "none.pdb", tmp_path, written("hello", "text.txt"), broken, cif):
        with pytest.raises(ScenarioError, match=file.name):
            read_structure(file)


def test_domains_are_read_and_printed():
    for text in ("n=A/1-90+251-333", "c=A/-3-5+B/7-7+9-12", "whole=A", "x=AA2/1-2+B"):
        assert str(parse_domain(text)) == text
    assert str(parse_domain(" one = A/5 ")) == "one=A/5-5"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("A/1-90", "expected NAME="),
        ("=A/1-90", "expected NAME="),
        ("n=", "expected NAME="),
        ("n=1-90", "cannot read the range '1-90'"),
        ("n=A/1-x", "cannot read the range 'A/1-x'"),
        ("n=A/1-9++A/5-6", "cannot read the range ''"),
        ("n=A/90-1", "ends before it begins"),
    ],
)
def test_domains_that_are_refused(text, told):
    with pytest.raises(CrystalError) as caught:
        parse_domain(text)
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("texts", "told"),
    [
        ([], "expected at least one domain"),
        (["n=A/1-6", "n=A/7-12"], "domain 'n': there are two"),
        (["n=Z/1-6"], "there is no chain 'Z' with a polymer; there are A"),
        (["n=A/50-60"], "no residues 50 to 60 in chain A; it has 1 to 12"),
        (["n=A/1-6", "c=A/6-12"], "residue 6 is also in the domain n=A/1-6"),
    ],
)
def test_domains_that_the_file_has_not(written, texts, told):
    found = read_structure(written(CELL + chain_text()))
    with pytest.raises((CrystalError, ScenarioError)) as caught:
        assign(found, [parse_domain(text) for text in texts])
    assert told in str(caught.value)


def test_hinges_where_chains_cross(written):
    found = read_structure(written(CELL + chain_text()))

    def hinges(*texts):
        domains = [parse_domain(text) for text in texts]
        return find_hinges(found, domains, assign(found, domains))

    (one,) = hinges("n=A/1-4", "c=A/9-12")
    assert (one.first, one.second, one.crossings, one.axis) == ("n", "c", ("A/4-9",), None)
    np.testing.assert_allclose(one.centre, [3.8 * 5.5, 0.0, 0.0], atol=1e-3)
    (two,) = hinges("n=A/1-4+9-12", "c=A/5-8")
    assert two.crossings == ("A/4-5", "A/8-9")
    np.testing.assert_allclose(two.points[:, 0], [3.8 * 3.5, 3.8 * 7.5], atol=1e-3)
    np.testing.assert_allclose(two.axis, [1.0, 0.0, 0.0], atol=1e-6)
    assert len(hinges("a=A/1-4", "b=A/5-8", "c=A/9-12")) == 2


def test_the_bundled_protein():
    protein = read_structure(PROTEIN)
    assert (protein.name, protein.group.name) == ("dd-peptidase", "P212121")
    assert protein.cell.lengths.tolist() == [50.9, 66.7, 99.6]
    polymer = protein.atoms.polymer
    assert len(set(protein.atoms.residues[polymer].tolist())) == 345
    # 37.4 kDa in 349 residues; four are not in the crystal's density.
    assert 36.5e3 < protein.atoms.masses[polymer].sum() < 37.4e3
    assert "DD-PEPTIDASE" in protein.title
    head = gzip.decompress(Path(PROTEIN).read_bytes())[:1200].decode()
    assert "1PWC" in head and "CC0" in head
