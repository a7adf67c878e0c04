"""Ellipsoids of domains, how they pack, structure factors of atoms, and models made of them."""

from __future__ import annotations

import itertools
import json
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitude_files import read_magnitudes
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.model_build import model_of, target_of
from ellipsoid_planning.crystal.structures.calculated import (
    calculated_factors,
    factors_at,
    write_mtz,
)
from ellipsoid_planning.crystal.structures.contacts import closest_contacts, contact_factor
from ellipsoid_planning.crystal.structures.distinct_poses import distinct_poses, euler_zxz
from ellipsoid_planning.crystal.structures.domains import parse_domain
from ellipsoid_planning.crystal.structures.fitted_model import FittedModel, SearchSteps
from ellipsoid_planning.crystal.structures.fitting import (
    clusters,
    deepest_overlap,
    enclosing,
    fit_domains,
    loosened,
    moments,
)
from ellipsoid_planning.crystal.structures.solvent import solvent_factors
from ellipsoid_planning.crystal.structures.structure import Atoms, CrystalStructure, read_structure
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.dual import gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario_origin import Origin
from planners.cli.main import app
from tests.crystal.structure_texts import CELL, atom_line, chain_text
from tests.crystal.test_structure import PROTEIN

DOMAINS = ("alpha_beta=A/3-79+191-347", "alpha=A/80-190")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def protein():
    return read_structure(PROTEIN)


def fitted(structure, texts=DOMAINS, **options):
    return fit_domains(structure, [parse_domain(text) for text in texts], **options)


def made_of(points, cell, group, element="C"):
    """A structure of equal atoms, each a residue of its own."""
    count = len(points)
    plain = np.ones(count)
    texts = [np.full(count, text) for text in (element, "CA", "A")]
    numbers = np.arange(count, dtype=np.int64) + 1
    polymer = np.ones(count, dtype=bool)
    electrons = {"C": 6.0, "S": 16.0}[element] * plain
    radii, zeros = 1.7 * plain, 0.0 * plain
    codes = np.full(len(points), "")
    atoms = Atoms(points, plain, electrons, radii, plain, zeros, *texts, numbers, codes, polymer)
    return CrystalStructure("made", "made.pdb", "", cell, space_group(group), atoms)


def test_moments_give_an_ellipsoid_of_atoms_back():
    body = Ellipsoid.from_semi_axes(
        [5.0, 9.0, 14.0], [1.0, 2.0, 3.0], Rotation.random(rng=1).as_matrix()
    )
    radii = np.cbrt(np.random.default_rng(2).permutation((np.arange(20_000) + 0.5) / 20_000))
    ball = unit_directions(3, 20_000) * radii[:, None]
    points = body.centre + ball @ body.matrix.T
    found = made_of(points, UnitCell.from_parameters([90.0, 90.0, 90.0]), "P1")
    whole = moments(found.atoms, np.arange(len(points)))
    # Atoms are balls: each adds its own second moment.
    np.testing.assert_allclose(
        whole.semi_axes**2, np.array([25.0, 81.0, 196.0]) + 1.7**2, rtol=0.01
    )
    np.testing.assert_allclose(whole.centre, body.centre, atol=0.02)
    np.testing.assert_allclose(
        whole.shape_matrix, body.shape_matrix + 1.7**2 * np.eye(3), atol=0.01 * 196
    )
    one = moments(found.atoms, np.array([7]))
    np.testing.assert_allclose(one.semi_axes, 1.7)


def test_shapes_of_a_real_domain(protein):
    one = {
        shape: fitted(protein, shape=shape, parts=1) for shape in ("moments", "volume", "enclosing")
    }
    for fits in zip(*(entry.domains for entry in one.values()), strict=True):
        by_moments, by_volume, around = fits
        assert by_volume.ellipsoid_volume == pytest.approx(1.2122 * by_volume.mass, rel=1e-3)
        assert by_volume.ellipsoid_volume < by_moments.ellipsoid_volume < around.ellipsoid_volume
        assert by_moments.density * by_moments.ellipsoid_volume == pytest.approx(
            by_moments.electrons
        )
        assert 0.52 < by_moments.electrons / by_moments.mass < 0.55
    for entry, text in zip(one["enclosing"].domains, DOMAINS, strict=True):
        assert str(entry.domain) == text
        chosen = (protein.atoms.residues >= 80) & (protein.atoms.residues <= 190)
        rows = np.flatnonzero((chosen == (entry.domain.name == "alpha")) & protein.atoms.polymer)
        body = enclosing(protein.atoms, rows)
        np.testing.assert_allclose(body.semi_axes, entry.ellipsoids[0].semi_axes)
        # Every ball is inside: its farthest points along many directions are.
        tips = protein.atoms.positions[rows][:, None] + 1.5 * unit_directions(3, 50)
        assert np.all(body.contains(tips.reshape(-1, 3)))
    assert [entry.residues for entry in one["volume"].domains] == [234, 111]
    assert one["volume"].left_out == 0
    (hinge,) = one["volume"].hinges
    assert hinge.crossings == ("A/79-80", "A/190-191")


def test_parts_of_a_domain(protein):
    points, masses = protein.atoms.positions, protein.atoms.masses
    for count in (1, 2, 5):
        groups = clusters(points, masses, count)
        assert len(groups) == count
        assert sorted(itertools.chain(*groups)) == list(range(len(points)))
        again = clusters(points, masses, count)
        assert all(np.array_equal(*pair) for pair in zip(groups, again, strict=True))
    assert len(clusters(points[:2], masses[:2], 5)) == 2
    several = fitted(protein, parts=3)
    assert [body.name for body in several.ellipsoids][:3] == [f"alpha_beta {k}" for k in (1, 2, 3)]
    left = fitted(protein, ["n=A/3-79"], parts=1)
    assert (left.left_out, left.hinges) == (345 - 77, ())


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"shape": "box"}, "expected one of moments, volume, enclosing"),
        ({"parts": 0}, "at least one ellipsoid"),
        ({"scale": -1.0}, "expected a number from 0.001 to 1000"),
        ({"scale": math.nan}, "expected a number from 0.001 to 1000"),
        ({"scale": 1e300}, "expected a number from 0.001 to 1000"),
    ],
)
def test_fits_that_are_refused(protein, options, told):
    with pytest.raises(CrystalError) as caught:
        fitted(protein, **options)
    assert told in str(caught.value)


def test_contact_factors():
    ball = Ellipsoid.from_semi_axes([1.0, 1.0, 1.0])
    other = Ellipsoid.from_semi_axes([2.0, 2.0, 2.0], [0.0, 4.5, 0.0])
    assert contact_factor(ball, other) == pytest.approx(1.5)
    rng = np.random.default_rng(5)
    for _ in range(20):
        pair = [
            Ellipsoid.from_semi_axes(rng.uniform(0.5, 3.0, 3), rng.uniform(-4, 4, 3), turn)
            for turn in Rotation.random(2, rng=rng).as_matrix()
        ]
        factor = contact_factor(*pair)
        for change, meet in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
            grown = [
                Ellipsoid(body.centre, body.rotation, body.semi_axes * factor * change)
                for body in pair
            ]
            assert (gap(*grown).value <= 0.0) == meet


def test_contacts_in_a_crystal():
    cell = UnitCell.from_parameters([10.0, 12.0, 14.0])
    ball = Ellipsoid.from_semi_axes([6.0, 6.0, 6.0], [1.0, 2.0, 3.0], name="ball")
    (along_a,) = closest_contacts([ball], cell, space_group("P1"), 0.9)
    assert (along_a.factor, along_a.gap) == (pytest.approx(10.0 / 12.0), pytest.approx(-2.0))
    assert sorted(map(abs, along_a.shift)) == [0, 0, 1]
    # A twofold screw axis: all copies of many cells, one by one.
    skew = UnitCell.from_parameters([9.0, 12.0, 10.0], [90.0, 105.0, 90.0])
    group = space_group("P21")
    body = Ellipsoid.from_semi_axes(
        [3.0, 5.0, 4.0], [1.0, 2.0, 3.0], Rotation.random(rng=2).as_matrix()
    )
    rotations, translations = group.cartesian(skew)
    factors = set()
    for index, *shift in itertools.product(range(2), *[range(-3, 4)] * 3):
        if index or any(shift):
            move = translations[index] + skew.basis @ np.array(shift)
            factor = contact_factor(body, body.transform(rotations[index], move))
            factors |= {round(factor, 6)} if factor <= 1.2 else set()
    found = [contact.factor for contact in closest_contacts([body], skew, group, 1.2)]
    assert found == sorted(found) and {round(factor, 6) for factor in found} == factors


def test_loosened_molecules_are_apart(protein):
    for options in ({"shape": "volume", "parts": 1}, {"shape": "moments", "parts": 4}):
        fit = fitted(protein, **options)
        assert deepest_overlap(fit) > 0.5
        loose = loosened(fit)
        assert deepest_overlap(loose) == 0.0
        touch = closest_contacts(loose.ellipsoids, protein.cell, protein.group, 1.1)[0].factor
        assert 1.0 < touch < 1.003
    assert loosened(loose) is loose
    # Scales at which the deposited molecules touch.
    assert loosened(fitted(protein, shape="volume", parts=1)).scale == 0.9
    on_axis = made_of(np.zeros((1, 3)), UnitCell.from_parameters([30.0, 30.0, 30.0]), "P2")
    with pytest.raises(CrystalError, match="symmetry element"):
        loosened(fitted(on_axis, ["all=A"]))


@pytest.mark.parametrize("group", ["P1", "P21", "C2221", "P43212", "P6122", "I23", "P-1", "Pbca"])
def test_structure_factors_against_gemmi(group):
    import gemmi

    lengths = {"P43212": [20, 20, 30], "P6122": [20, 20, 30], "I23": [20, 20, 20]}
    angles = {"P1": [80, 95, 100], "P-1": [80, 95, 100], "P21": [90, 95, 90]}
    angles["P6122"] = [90, 90, 120]
    cell = UnitCell.from_parameters(lengths.get(group, [15, 20, 25]), angles.get(group))
    rng = np.random.default_rng(3)
    made = made_of(rng.uniform(0, 10, (12, 3)), cell, group, "S")
    factors = calculated_factors(made, 3.5)
    structure = gemmi.Structure()
    structure.cell = gemmi.UnitCell(*cell.lengths, *cell.angles_deg)
    structure.spacegroup_hm = gemmi.find_spacegroup_by_name(group).xhm()
    structure.setup_cell_images()
    model, residue = gemmi.Model(1), gemmi.Residue()
    for place in made.atoms.positions:
        atom = gemmi.Atom()
        atom.pos, atom.element, atom.b_iso = gemmi.Position(*place), gemmi.Element("S"), 0.0
        residue.add_atom(atom)
    chain = gemmi.Chain("A")
    chain.add_residue(residue)
    model.add_chain(chain)
    calculator = gemmi.StructureFactorCalculatorX(structure.cell)
    for k in range(0, len(factors.hkl), max(1, len(factors.hkl) // 10)):
        expected = calculator.calculate_sf_from_model(model, factors.hkl[k].tolist())
        assert abs(factors.values[k] - expected) < 1e-2
    assert factors.spacings.min() >= 3.5 and np.all(np.any(factors.hkl != 0, axis=1))
    far = factors_at(made, np.array([[0, 0, 0]]))[0]
    assert far == pytest.approx(16.0 * 12 * made.group.order, rel=1e-3)


def test_solvent_leaves_a_part_of_the_contrast(protein):
    dry, wet = (calculated_factors(protein, 12.0, solvent=solvent) for solvent in (False, True))
    assert np.array_equal(dry.hkl, wet.hkl)
    low = dry.spacings > 25.0
    # Babinet: the mask is what the molecules are not, so that it takes from every magnitude.
    shares = np.abs(wet.values[low]) / np.abs(dry.values[low])
    assert 0.1 < np.median(shares) < 0.35
    mask = wet.values - dry.values
    assert np.corrcoef(mask[low], dry.values[low])[0, 1].real < -0.95
    # One atom in a large cell: the transform of the hole that it leaves.
    one = made_of(np.zeros((1, 3)), UnitCell.from_parameters([60.0, 60.0, 60.0]), "P1")
    hole = solvent_factors(one, np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]]))
    np.testing.assert_allclose(hole, hole[0], rtol=1e-3)
    assert -0.35 * 60.0 < hole[0].real < -0.35 * 10.0 and abs(hole[0].imag) < 1e-3


def test_magnitudes_in_mtz_files(protein, tmp_path):
    model = load_model("dd-peptidase")
    factors = calculated_factors(protein, model.resolution)
    write_mtz(factors, tmp_path / "data.mtz")
    read = read_magnitudes(tmp_path / "data.mtz", model)
    bundled = read_magnitudes(PROTEIN.with_name("dd-peptidase.mtz"), model)
    assert len(read) == len(factors.hkl) == 76 and not len(read.missing)
    np.testing.assert_allclose(read.values, np.abs(factors_at(protein, read.indices)), rtol=1e-4)
    np.testing.assert_allclose(read.values, bundled.values, rtol=1e-4)
    for resolution, told in ((0.0, "positive"), (200.0, "no reflections"), (0.1, "at most")):
        with pytest.raises(CrystalError, match=told):
            calculated_factors(protein, resolution)
    with pytest.raises(CrystalError, match="cannot write"):
        write_mtz(factors, tmp_path / "none" / "data.mtz")


@pytest.mark.parametrize(
    ("group", "cell", "shares", "alpha", "beta"),
    [
        ("P1", ([9, 10, 11], [80, 95, 100]), (0, 0, 0), 360, 180),
        ("P21", ([9, 10, 11], [90, 95, 90]), (1 / 2, 0, 1 / 2), 360, 90),
        ("P212121", ([9, 10, 11], None), (1 / 2, 1 / 2, 1 / 2), 180, 90),
        ("P43212", ([9, 9, 11], None), (1, 1, 1 / 2), 90, 90),
        ("P61", ([9, 9, 11], [90, 90, 120]), (1, 1, 0), 60, 180),
        ("I222", ([9, 10, 11], None), (1 / 2, 1 / 2, 1 / 2), 180, 90),
    ],
)
def test_distinct_poses(group, cell, shares, alpha, beta):
    made = UnitCell.from_parameters(*cell)
    poses = distinct_poses(space_group(group), made)
    np.testing.assert_allclose(poses.shifts, shares * made.lengths)
    assert math.degrees(poses.alpha) == pytest.approx(alpha)
    assert math.degrees(poses.beta) == pytest.approx(beta)
    rng = np.random.default_rng(0)
    random = made_of(rng.uniform(0, 6, (5, 3)), made, group)
    hkl = calculated_factors(random, 2.5).hkl
    before = np.abs(factors_at(random, hkl))
    for _ in range(10):
        # The same crystal: a molecule in its own frame, put where the box has it.
        rotation, position = Rotation.random(rng=rng).as_matrix(), rng.uniform(-20, 20, 3)
        shifts, angles = poses.brought_inside(rotation, position)
        assert np.all((shifts >= 0) & (shifts <= poses.shifts))
        assert 0 <= angles[0] < poses.alpha + 1e-9 and 0 <= angles[1] <= poses.beta + 1e-9
        local = (random.atoms.positions - position) @ rotation
        turned = Rotation.from_euler("ZXZ", angles).as_matrix()
        moved = local @ turned.T + made.cartesian(shifts / made.lengths)
        after = np.abs(factors_at(made_of(moved, made, group), hkl))
        np.testing.assert_allclose(after, before, atol=1e-6)


def test_euler_angles():
    for angles in ([1.0, 2.0, 3.0], [6.0, 0.1, 0.0], [0.5, 0.0, 0.0], [0.5, math.pi, 0.0]):
        turn = Rotation.from_euler("ZXZ", angles).as_matrix()
        np.testing.assert_allclose(
            Rotation.from_euler("ZXZ", euler_zxz(turn)).as_matrix(), turn, atol=1e-12
        )


def test_the_model_is_the_deposited_molecule(protein):
    fit = fitted(protein, parts=8)
    made = FittedModel(fit, SearchSteps(), "protein", deepest_overlap(fit))
    model = model_of(made.model())
    pose = target_of(made.target(), Origin(), model)
    assert model.is_free(pose)
    assert not model_of({**made.model(), "packing": {"overlap": 3.2}}).is_free(pose)
    placed = closest_contacts(model.molecule.bodies(pose), model.cell, model.group)
    deposited = closest_contacts(fit.ellipsoids, protein.cell, protein.group)
    np.testing.assert_allclose(
        [contact.factor for contact in placed],
        [contact.factor for contact in deposited],
        atol=1e-3,
    )
    # The bundled model is this one.
    bundled = load_model("dd-peptidase")
    np.testing.assert_allclose(bundled.molecule.parts, model.molecule.parts, atol=2e-3)
    np.testing.assert_allclose(load_target("dd-peptidase-target", bundled), pose, atol=1e-4)
    assert bundled.overlap == model.overlap == 3.4


def test_the_real_magnitudes_single_the_deposited_pose_out():
    model = load_model("dd-peptidase")
    target = load_target("dd-peptidase-target", model)
    data = read_magnitudes(PROTEIN.with_name("dd-peptidase.mtz"), model)
    cost = FourierCost(model, data, scaled=True)
    numbers = np.random.default_rng(4).choice(model.grid.count, 4000, replace=False)
    others = model.grid.configurations(numbers)
    others = others[model.are_free(others)]
    assert len(others) > 60
    assert cost.value(target) < cost.values(others).min()
    assert cost.correlations(target[None])[0] > 0.9


def test_domains_that_no_chain_joins_move_as_one(tmp_path):
    text = CELL + chain_text(4, "A") + "TER\n"
    text += chain_text(4, "B").replace("   0.000   1.5", "   9.000  11.5") + "TER\n"
    file = tmp_path / "two.pdb"
    file.write_text(text)
    found = read_structure(file)
    two = fitted(found, ["a=A", "b=B/1-4"], parts=1, scale=0.3)
    made = FittedModel(two, SearchSteps(), "two").model()
    assert [joint["type"] for joint in made["molecule"]["joints"]] == ["fixed"]
    assert len(model_of(made).keys) == 6
    point = fitted(found, ["a=A/1-2", "b=A/3-4"], parts=1, scale=0.3)
    made = FittedModel(point, SearchSteps(), "point").model()
    assert model_of(made).keys[6:] == ("hinge_x_deg", "hinge_y_deg", "hinge_z_deg")
    stiff = FittedModel(point, SearchSteps(hinge_deg=0.0), "stiff").model()
    assert len(model_of(stiff).keys) == 6
    for wrong in ({"shift": 0.0}, {"turn_deg": -1.0}, {"hinge_deg": 200.0}):
        with pytest.raises(CrystalError, match=next(iter(wrong))):
            SearchSteps(**wrong)


def test_the_command(tmp_path):
    names = {"output": "model.yaml", "target": "target.yaml", "magnitudes": "data.mtz"}
    files = {name: tmp_path / file for name, file in names.items()}
    wanted = [option for name, file in files.items() for option in (f"--{name}", str(file))]
    domains = [option for text in DOMAINS for option in ("--domain", text)]
    found = run("crystal", "fit", str(PROTEIN), *domains, *wanted, "--json")
    assert found.exit_code == 0, found.stderr
    report = json.loads(found.stdout)
    assert [entry["residue_count"] for entry in report["domains"]] == [234, 111]
    assert report["model"]["packing"] == {"overlap": 4.5}
    assert report["contacts"][0]["gap"] == pytest.approx(-4.49, abs=0.01)
    assert "8 pairs of ellipsoids of different molecules meet" in found.stderr
    model = load_model(files["output"])
    assert model.is_free(load_target(files["target"], model))
    assert len(read_magnitudes(files["magnitudes"], model)) == 76
    plain = run("crystal", "fit", str(PROTEIN), *domains, "--scale", "auto", "--parts", "1")
    assert plain.exit_code == 0 and plain.stdout.startswith("format: 1\n")
    for wrong, told in (
        (["--scale", "big"], "--scale big"),
        (["--overlap", "-1"], "--overlap -1"),
        (["--domain", "x=B"], "no chain 'B'"),
        (["--domain", "x=A/80-81"], "also in the domain"),
        (["--shape", "cube"], "moments"),
        (["--magnitudes", "data.csv"], "expected a file .mtz"),
    ):
        failed = run("crystal", "fit", str(PROTEIN), *domains, *wrong)
        assert failed.exit_code == 2 and told in failed.stderr
    file = tmp_path / "nothing.pdb"
    file.write_text(atom_line(1, "ALA", 1, (0.0, 0.0, 0.0)))
    failed = run("crystal", "fit", str(file), "--domain", "x=A")
    assert failed.exit_code == 2 and "CRYST1" in failed.stderr
