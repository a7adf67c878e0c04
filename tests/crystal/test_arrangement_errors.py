import math

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.phasing.arrangement_errors import (
    arrangement_errors,
    motion_error,
    plain_errors,
)
from ellipsoid_planning.crystal.phasing.body_fit import fit_bodies
from ellipsoid_planning.crystal.phasing.placed_bodies import Bodies

from .diffraction import random_configurations
from .packings import one_body

MODELS = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


@pytest.mark.parametrize("name", MODELS)
def test_the_target_itself_has_no_errors(name):
    model = load_model(name)
    (target,) = random_configurations(model, 1, seed=1)
    errors = arrangement_errors(model, target, target)
    assert errors.motion < 1e-6 and errors.mae_deg < 1e-7 and errors.e_max_deg < 1e-7


def test_errors_of_angles_and_shifts_are_their_mean_and_largest():
    model = load_model("rabbit-p212121")
    (target,) = random_configurations(model, 1, seed=2)
    away = np.array([0.1, -0.2, 0.3, *np.radians([1.0, -2.0, 3.0, 0.0, 0.0, 0.0, -1.0])])
    errors = plain_errors(model, target + away, target)
    assert errors.mean_shift == pytest.approx(0.2)
    assert errors.mae_deg == pytest.approx(1.0)
    assert errors.e_max_deg == pytest.approx(3.0)
    # Whole turns are none.
    whole = np.array([0.0, 0.0, 0.0, *(2.0 * math.pi * np.array([1, -1, 0, 0, 0, 0, 2]))])
    assert plain_errors(model, target + whole, target).e_max_deg < 1e-9


@pytest.mark.parametrize("name", MODELS)
def test_the_motion_error_is_the_distance_of_the_bodies_points(name):
    # A domain's norm is the root of ∫ |g x - h x|² dx; by quadrature on points of the unit ball.
    model = load_model(name)
    n = model.dimension
    first, second = random_configurations(model, 2, seed=3)
    rng = np.random.default_rng(4)
    points = rng.normal(size=(20_000, 3))
    points[:, n:] = 0.0
    radii = rng.random(len(points)) ** (1.0 / n)
    points *= (radii / np.linalg.norm(points, axis=1))[:, None]
    expected = 0.0
    (centres, matrices), (others, turned) = map(model.molecule.placed, (first, second))
    for k, part in enumerate(model.parts):
        ball = math.pi if n == 2 else 4.0 * math.pi / 3.0
        moved = points @ (matrices[k] - turned[k]).T + (centres[k] - others[k])
        mass = ball * float(np.prod(part.semi_axes))
        expected += math.sqrt(mass * float((moved**2).sum(axis=1).mean()))
    motion, turning = motion_error(model, first, second)
    assert motion == pytest.approx(expected, rel=0.01)
    assert 0.0 < turning < motion


def test_a_small_turn_of_one_ear_has_the_textbooks_error():
    # About the middle of a spheroid of mass M and semi-axes a, b across the axis of the turn.
    model = load_model("rabbit-p1")
    target = np.zeros(7)
    found = target + 1e-4 * np.eye(7)[3]
    mass = 4.0 / 3.0 * math.pi * 2.5 * 2.5 * 6.0
    expected = math.sqrt(mass * (2.5**2 + 6.0**2) / 5.0) * 1e-4
    assert motion_error(model, found, target) == pytest.approx((expected, expected), rel=1e-6)


def test_exchanged_ears_are_no_error_in_p1():
    model = load_model("rabbit-p1")
    for target in random_configurations(model, 5, seed=5):
        found = target[[0, 1, 2, 5, 6, 3, 4]] + 1e-3
        errors = arrangement_errors(model, found, target)
        assert errors.mae_deg < math.degrees(1.01e-3)
        assert errors.isometry == "-x,-y,-z"
        assert plain_errors(model, found, target).mae_deg > 1.0


def test_a_face_that_turns_under_its_ears_is_no_error():
    # The rabbit's face is a spheroid, its ears sit on the axis: gamma can be anything if the ears
    # are turned back.
    model = load_model("rabbit-p1")
    rng = np.random.default_rng(6)
    for target in random_configurations(model, 5, seed=6):
        found = target.copy()
        found[2] += rng.uniform(-0.5, 0.5)
        bodies = Bodies.of(model.molecule, target)
        found = fit_bodies(model.molecule, bodies, found, np.eye(3)).configuration
        assert abs(found[2] - target[2]) > 0.01
        assert arrangement_errors(model, found, target).e_max_deg < 1e-5


def test_a_molecule_that_stands_still_has_no_errors():
    model = one_body("P1", "{lengths: [9, 9, 9]}", [1.0, 1.0, 1.0])
    errors = arrangement_errors(model, [], [])
    assert errors.motion == errors.mean_turn == 0.0 and errors.mean_shift is None


@pytest.mark.parametrize("euler", ["ZXZ", "XYZ", "YXZ"])
def test_angles_across_the_pole_are_near(euler):
    # 0.02 to either side of the pole: 0.04 apart, but for signs of the outer angles far apart.
    turn = "{lower: 0, upper: 90, step: 90}"
    angles = f"alpha_deg: {turn}, beta_deg: {turn}, gamma_deg: {turn}"
    search = f"{{orientation: {{euler: {euler}, {angles}}}}}"
    model = one_body("P1", "{lengths: [9, 9, 9]}", [1.0, 1.5, 2.0], search)
    pole = 0.0 if euler == "ZXZ" else math.pi / 2.0
    target = np.array([0.5, pole + 0.02, 0.3])
    found = np.array([0.5 - math.pi, (pole and math.pi) - (pole - 0.02), 0.3 + math.pi])
    assert plain_errors(model, found, target).e_max_deg > 100.0
    assert motion_error(model, found, [0.5, pole - 0.02, 0.3])[0] < 1e-12
    errors = arrangement_errors(model, found, target)
    assert errors.e_max_deg == pytest.approx(math.degrees(0.04))


def test_the_distance_of_centres_is_that_of_a_shift():
    model = load_model("rabbit-p212121")
    target = load_target("rabbit-p212121-target", model)
    moved = target.copy()
    moved[:3] += [0.3, -0.4, 1.2]  # along x, y and z
    errors = plain_errors(model, moved, target)
    assert errors.distance == pytest.approx(1.3)
    assert errors.to_dict()["RMSD_centres"] == errors.distance
    turned = target.copy()
    turned[model.keys.index("alpha_deg")] += 0.1  # the ears move, the face does not
    centres = [model.molecule.placed(q)[0] for q in (turned, target)]
    away = np.linalg.norm(centres[0] - centres[1], axis=1)
    assert plain_errors(model, turned, target).distance == pytest.approx(np.sqrt((away**2).mean()))
    assert away.min() == 0.0 < away.max()
