"""The Gaussian cost GCF: against integration, finite differences, larger cutoffs, symmetry."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.packing.model_build import model_of
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import gaussian_overlap

ANGLE = {"lower": 0, "upper": 360, "step": 30}
SHIFT = {"lower": 0, "upper": 5, "step": 1}


def packing(group, lengths, angles, head, ear):
    """A head and an ear on a hinge; with shifts, and all turns."""
    n = len(lengths)
    turns = ("yaw",) if n == 2 else ("alpha", "beta", "gamma")
    orientation = {f"{name}_deg": dict(ANGLE) for name in turns}
    if n == 3:
        orientation["beta_deg"]["upper"] = 180
    joint = {"name": "hinge", "type": "revolute", "parent": "head", "child": "ear"}
    joint |= {"limit": {"lower_deg": -90, "upper_deg": 90}}
    joint |= {"origin": {"position": [0.4, 0.7, 0.3][:n]}}
    if n == 3:
        joint["axis"] = [0.6, 0, 0.8]
    links = [
        {"name": "head", "parts": [{"name": "head", "semi_axes": head}]},
        {"name": "ear", "parts": [{"name": "ear", "semi_axes": ear, "position": [0.8, 0, 0][:n]}]},
    ]
    return model_of(
        {
            "format": 1,
            "name": "test",
            "dimension": n,
            "group": group,
            "cell": {
                "lengths": lengths,
                "angles_deg": [angles] * (2 * n - 3) if isinstance(angles, int) else angles,
            },
            "molecule": {"links": links, "joints": [joint]},
            "search": {
                "position": {name: dict(SHIFT) for name in "xyz"[:n]},
                "orientation": orientation,
                "joints": {"hinge_deg": {"step": 30}},
            },
            "diffraction": {"resolution": 1},
        }
    )


PLANE = packing("p2", [5, 6], 80, [1.2, 0.9], [0.8, 0.5])
SQUARE = packing("p4", [6, 6], 90, [1.2, 0.9], [0.8, 0.5])
TRICLINIC = packing("P1", [5, 5.5, 6], [80, 95, 100], [1.3, 1.1, 0.9], [1, 0.8, 0.7])
SCREW = packing("P212121", [5.5, 6, 7], 90, [1.3, 1.1, 0.9], [1, 0.8, 0.7])
SPHERES = packing("P1", [5, 5, 5], 90, [1.2, 1.2, 1.2], [0.8, 0.8, 0.8])
NEEDLES = packing("P212121", [7, 7, 7], 90, [2, 0.02, 0.02], [1.5, 0.015, 0.03])
MODELS = {
    "p2": PLANE,
    "p4": SQUARE,
    "P1": TRICLINIC,
    "P212121": SCREW,
    "spheres": SPHERES,
    "needles": NEEDLES,
}


def draw(model, seed=0):
    rng = np.random.default_rng(seed)
    return np.array([rng.uniform(r.lower, r.upper) for r in model.grid.ranges])


def integral(model, mixture, q, nodes, span):
    """The square of the density, summed over a grid of the cell: exact for so smooth a one."""
    n = model.dimension
    rotations, translations = model.group.cartesian(model.cell)
    sides = [np.arange(nodes) / nodes] * n
    points = model.cell.cartesian(np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, n))
    density = np.zeros(len(points))
    for rotation, translation in zip(rotations, translations, strict=True):
        for v in itertools.product(range(-span, span + 1), repeat=n):
            offset = translation + model.cell.cartesian(np.array(v, dtype=float))
            for body in model.molecule.bodies(q):
                density += mixture.density(body.transform(rotation, offset), points)
    return (density**2).mean() * model.cell.volume


@pytest.mark.parametrize(
    ("name", "spread", "nodes", "span"),
    [("p2", 1.0, 60, 4), ("p4", 0.4, 40, 5), ("P1", 0.8, 20, 3), ("P212121", 1.0, 22, 2)],
)
def test_closed_form_is_the_integral_over_the_cell(name, spread, nodes, span):
    model, mixture = MODELS[name], GaussianMixture(spread)
    q = draw(model)
    value = GaussianPotential(model, mixture).value(q)
    assert value == pytest.approx(integral(model, mixture, q, nodes, span), rel=1e-6)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("own_pairs", [True, False])
def test_gradient_against_finite_differences(name, own_pairs):
    model = MODELS[name]
    for spread, seed in ((0.5, 1), (2.0, 2)):
        potential = GaussianPotential(model, GaussianMixture(spread), own_pairs)
        q, h = draw(model, seed), 1e-5
        _, gradient = potential.value_and_gradient(q)
        steps = h * np.eye(len(q))
        rates = (potential.values(q + steps) - potential.values(q - steps)) / (2 * h)
        # The parts' overlaps with themselves are large constants, and cost the differences digits.
        noise = 1e-15 * potential.value(q) / h + 1e-12
        assert gradient == pytest.approx(rates, abs=1e-5 * np.abs(gradient).max() + noise)


def test_concentric_parts_have_the_overlap_of_their_sum_and_feel_no_force():
    joint = {"name": "hinge", "type": "revolute", "parent": "a", "child": "b"}
    joint |= {"limit": {"lower_deg": -90, "upper_deg": 90}}
    links = [
        {"name": "a", "parts": [{"name": "a", "semi_axes": [2, 1]}]},
        {"name": "b", "parts": [{"name": "b", "semi_axes": [2, 1]}]},
    ]
    model = model_of(
        {
            "format": 1,
            "name": "concentric",
            "dimension": 2,
            "group": "p1",
            "cell": {"lengths": [60, 60]},
            "molecule": {"links": links, "joints": [joint]},
            "search": {"joints": {"hinge_deg": {"step": 30}}},
            "diffraction": {"resolution": 1},
        }
    )
    potential = GaussianPotential(model, GaussianMixture(1.0))
    aligned, crossed = potential.values_and_gradients([[0.0], [np.pi / 2]])[0]
    assert potential.value_and_gradient([0.0])[1] == pytest.approx(0.0, abs=1e-15)
    assert potential.value_and_gradient([np.pi / 2])[1] == pytest.approx(0.0, abs=1e-15)
    # All four pairs alike; crossed, two of them have the covariances diag(4, 1) and diag(1, 4).
    own, other = aligned / 4, 0.0
    masses, exponents = GaussianMixture(1.0).masses(2), GaussianMixture(1.0).exponents
    for (m, b), (k, c) in itertools.product(zip(masses, exponents, strict=True), repeat=2):
        other += m * k / (2 * np.pi * np.sqrt((4 / b + 1 / c) * (1 / b + 4 / c)))
    assert crossed == pytest.approx(2 * own + 2 * other, rel=1e-12)
    assert own == pytest.approx(integral(model, GaussianMixture(1.0), [0.0], 300, 1) / 4, rel=1e-9)


@pytest.mark.parametrize("name", ["p2", "P1", "P212121"])
def test_copies_left_out_are_below_the_bound(name):
    model, mixture = MODELS[name], GaussianMixture(1.0)
    q = draw(model, 3)
    block = GaussianPotential(model, mixture, copies=9).value(q)
    for tail in (1e-2, 1e-5, 1e-10):
        potential = GaussianPotential(model, mixture, tail=tail)
        error = abs(potential.value(q) - block)
        assert error <= potential.truncation + 1e-14 * block
        assert potential.truncation < tail * block


@pytest.mark.parametrize("name", ["p2", "p4", "P212121"])
def test_operations_of_the_group_change_nothing(name):
    model = MODELS[name]
    potential = GaussianPotential(model, GaussianMixture(0.7))
    centres, matrices = model.molecule.placed(draw(model, 4))
    shapes = np.hstack([centres, matrices.reshape(-1, 9)])
    tables, planar = potential._tables, model.dimension == 2
    values = []
    for operation in model.crystal[0]:
        q, shift = operation[:9].reshape(3, 3), operation[9:]
        turned = np.hstack([centres @ q.T + shift, (q @ matrices).reshape(-1, 9)])
        wrenches = np.empty((len(shapes), 9))
        values.append(
            gaussian_overlap.overlap_of_parts(turned, *tables[6:11], tables[11], planar, wrenches)
        )
        forces = wrenches[:, :3] @ q
        if len(values) == 1:
            first = forces
        assert forces == pytest.approx(first, abs=1e-12)
    assert np.array(values) == pytest.approx(values[0], rel=1e-12)


def test_far_apart_molecules_only_feel_themselves():
    model = packing("p1", [500, 500], 90, [1.2, 0.9], [0.8, 0.5])
    mixture = GaussianMixture(1.0)
    q = draw(model)
    assert GaussianPotential(model, mixture, own_pairs=False).value(q) == 0.0
    assert GaussianPotential(model, mixture).value(q) > 0.0


def test_mixture_has_the_integral_one_and_the_thesis_numbers():
    mixture = GaussianMixture(1.16)
    # Thesis (3.12): 1.32, 0.44, 0.58, and 1.74 where 1.73 is printed.
    assert mixture.amplitudes(1) == pytest.approx([1.32, -0.44], abs=0.02)
    assert mixture.exponents / 2 == pytest.approx([0.58, 1.74])
    for n in (1, 2, 3):
        assert mixture.masses(n).sum() == pytest.approx(1.0)
    points = np.stack(np.meshgrid(*[np.linspace(-30, 30, 601)] * 2, indexing="ij"), -1)
    body = Ellipsoid.from_semi_axes([2.5, 1.5], [0.3, 0.2], 0.7)
    assert mixture.density(body, points).sum() * 0.01 == pytest.approx(1.0)


def test_bad_input():
    model = load_model("rabbit-plane")
    for spread in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(CrystalError, match="0 < m_b <= 1e"):
            GaussianMixture(spread)
    with pytest.raises(CrystalError, match="tail between"):
        GaussianPotential(model, GaussianMixture(1.0), tail=0.0)
    with pytest.raises(CrystalError, match="copies >= 0"):
        GaussianPotential(model, GaussianMixture(1.0), copies=-1)
    with pytest.raises(CrystalError, match="copies of the cell"):
        GaussianPotential(model, GaussianMixture(1e-9)).value(np.zeros(3))
    with pytest.raises(CrystalError, match="3 finite numbers"):
        GaussianPotential(model, GaussianMixture(1.0)).value([0.0, 1.0])
