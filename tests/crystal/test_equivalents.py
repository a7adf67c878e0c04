import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors
from ellipsoid_planning.crystal.phasing.body_fit import fit_bodies
from ellipsoid_planning.crystal.phasing.equivalents import Equivalents
from ellipsoid_planning.crystal.phasing.indistinguishable import indistinguishable
from ellipsoid_planning.crystal.phasing.placed_bodies import Bodies, body_rates
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.operation import Operation

from .diffraction import lattice_points, magnitudes, random_configurations
from .packings import model_from, one_body

MODELS = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


@pytest.mark.parametrize(
    ("name", "shifts", "inversions", "directions"),
    [
        ("p1", 1, 1, 2),
        ("p2", 4, 0, 0),
        ("p3", 3, 3, 0),
        ("P1", 1, 1, 3),
        ("P-1", 8, 0, 0),
        ("P2", 4, 4, 1),
        ("Pm", 2, 2, 2),
        ("P212121", 8, 8, 0),
        ("C2221", 4, 4, 0),
        ("P41", 2, 0, 1),
        ("P41212", 4, 0, 0),
        ("R3", 1, 1, 1),
        ("I213", 1, 1, 0),
        ("F432", 2, 2, 0),
    ],
)
def test_the_isometries_are_those_of_the_normaliser(name, shifts, inversions, directions):
    # The numbers of Tables 3.5.2 of International Tables A; P41 is its mirror image P43's twin.
    group = space_group(name)
    found = indistinguishable(group)
    signs = [one.rotation[0][0] for one in found.isometries]
    assert signs.count(1) == shifts
    assert signs.count(-1) == inversions
    assert len(found.directions) == directions
    assert len(set(found.isometries)) == len(found.isometries)
    assert found.isometries[0] == Operation.identity(group.dimension)


@pytest.mark.parametrize("name", ["P212121", "C2221", "P41212", "I213", "R32", "F432", "p4", "p3"])
def test_each_isometry_conjugates_the_group_into_itself(name):
    group = space_group(name)
    own = set(group.operations)
    for isometry in indistinguishable(group).isometries:
        back = isometry.inverse()
        assert {(isometry @ one @ back).modulo() for one in group.operations} == own


@pytest.mark.parametrize("name", MODELS)
def test_equivalents_have_the_same_magnitudes(name):
    model = load_model(name)
    vectors = lattice_points(model, model.resolution)
    equivalents = Equivalents(model)
    rng = np.random.default_rng(3)
    seen = set()
    for target in random_configurations(model, 4, seed=2):
        found = target + rng.normal(scale=0.1, size=len(target))
        expected = magnitudes(model, found, vectors)
        near = equivalents.near(found, target)
        assert len(near) >= 2
        for one in near:
            seen.add(one.isometry)
            got = magnitudes(model, one.configuration, vectors)
            assert got == pytest.approx(expected, abs=1e-6 * expected.max())
    assert seen <= set(equivalents.isometries)


def test_the_rabbit_in_p1_has_a_twin_with_its_ears_exchanged():
    model = load_model("rabbit-p1")
    (found,) = random_configurations(model, 1, seed=5)
    exchanged = found[[0, 1, 2, 5, 6, 3, 4]]
    nearest = Equivalents(model).near(found, exchanged)[0]
    assert nearest.isometry.triplet() == "-x,-y,-z"
    assert nearest.configuration == pytest.approx(exchanged, abs=1e-8)


def test_shifts_of_the_origin_count_for_nothing():
    model = load_model("rabbit-p212121")
    (target,) = random_configurations(model, 1, seed=6)
    for axis in range(3):
        found = target.copy()
        found[axis] -= 11.0  # half the cell's edge
        nearest = Equivalents(model).near(found, target)[0]
        assert nearest.configuration == pytest.approx(target, abs=1e-8)


def test_half_a_turn_counts_for_nothing_in_the_plane():
    model = load_model("rabbit-plane")
    (target,) = random_configurations(model, 1, seed=7)
    for turns in (np.pi, -np.pi, 3.0 * np.pi):
        found = target + turns * np.eye(3)[0]
        nearest = Equivalents(model).near(found, target)[0]
        assert nearest.configuration == pytest.approx(target, abs=1e-8)


@pytest.mark.parametrize("angle", [70.0, 105.0])
def test_free_shifts_may_lie_askew_to_the_lattice(angle):
    # R3 on rhombohedral axes: along the sum of all three.
    cell = f"{{lengths: [30, 30, 30], angles_deg: [{angle}, {angle}, {angle}]}}"
    turn = "{lower: 0, upper: 90, step: 90}"
    shift = "{lower: 0, upper: 30, step: 30}"
    model = one_body(
        "R3:R",
        cell,
        [1.0, 1.5, 2.0],
        f"{{position: {{x: {shift}, y: {shift}, z: {shift}}}, orientation: {{alpha_deg: {turn}, "
        f"beta_deg: {turn}, gamma_deg: {turn}}}}}",
    )
    assert np.linalg.norm(Equivalents(model).directions, axis=1) == pytest.approx([1.0])
    vectors = lattice_points(model, 4.0)
    rng = np.random.default_rng(3)
    for target in random_configurations(model, 4, seed=10):
        found = target.copy()
        found[:3] += 30.0 * rng.integers(-2, 3, 3) + rng.uniform(-30.0, 30.0)
        expected = magnitudes(model, target, vectors)
        assert magnitudes(model, found, vectors) == pytest.approx(expected, abs=1e-8)
        nearest = Equivalents(model).near(found, target)[0]
        assert nearest.configuration == pytest.approx(target, abs=1e-7)


@pytest.mark.parametrize("name", MODELS)
def test_rates_of_bodies_are_their_difference_quotients(name):
    molecule = load_model(name).molecule
    (configuration,) = random_configurations(load_model(name), 1, seed=8)
    centres, shapes = body_rates(molecule, configuration)
    for k, step in enumerate(1e-6 * np.eye(len(configuration))):
        up, down = (Bodies.of(molecule, configuration + sign * step) for sign in (1.0, -1.0))
        assert centres[k] == pytest.approx((up.centres - down.centres) / 2e-6, abs=1e-7)
        assert shapes[k] == pytest.approx((up.shapes - down.shapes) / 2e-6, abs=1e-6)


def test_bodies_that_the_molecule_cannot_make_leave_a_misfit():
    model = load_model("rabbit-p1")
    (configuration,) = random_configurations(model, 1, seed=9)
    bodies = Bodies.of(model.molecule, configuration)
    torn = Bodies(bodies.centres + np.outer([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), bodies.shapes)
    assert fit_bodies(model.molecule, torn, configuration, np.eye(3)).misfit > 1e-3
    assert fit_bodies(model.molecule, bodies, configuration, np.eye(3)).misfit < 1e-12


SLIDE = """\
format: 1
name: slide
dimension: 2
group: {group}
cell: {{lengths: [10, 14]}}
molecule:
  links:
    - name: body
      parts: [{{semi_axes: [1.5, 0.6]}}]
    - name: ear
      parts: [{{semi_axes: [1, 0.4]}}]
  joints:
    - name: slide
      type: prismatic
      parent: body
      child: ear
      axis: [1, 0]
      limit: {{lower: -9, upper: 9}}
      origin: {{position: [0, 2.5]}}
search:
  position: {{x: {{lower: 0, upper: 10, step: 5}}}}
  orientation: {{yaw_deg: {{lower: 0, upper: 180, step: 90}}}}
  joints: {{slide: {{step: 3}}}}
diffraction: {{resolution: 1}}
"""


@pytest.mark.parametrize("group", ["p1", "pg"])
def test_whose_ear_it_is_diffraction_does_not_see(group):
    model = model_from(SLIDE.format(group=group))
    vectors = lattice_points(model, model.resolution)
    for away in (0.0, 0.05):
        target = np.array([1.0, away, -4.0])
        found = np.array([1.0 + away, 0.0, 6.0 + away])  # the ear of the molecule next to it
        if not away:
            same = magnitudes(model, target, vectors)
            assert magnitudes(model, found, vectors) == pytest.approx(same, abs=1e-10)
        errors = arrangement_errors(model, found, target)
        assert errors.mean_turn <= away + 1e-9 and errors.mean_shift <= away + 1e-9
        got = magnitudes(model, errors.configuration, vectors)
        assert got == pytest.approx(magnitudes(model, found, vectors), abs=1e-5)
