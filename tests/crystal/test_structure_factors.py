"""Structure factors: against quadrature, sums over grids of points, and the group's relations."""

from concurrent.futures import ThreadPoolExecutor

import gemmi
import numpy as np
import pytest
from scipy import special

from ellipsoid_planning.crystal.diffraction.reflections import absent, all_reflections
from ellipsoid_planning.crystal.diffraction.structure_factors import (
    StructureFactors,
    reflections_of,
    roots_of_unity,
    structure_factors,
)
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.model_files import locate_model
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import bessel
from tests.crystal import diffraction
from tests.crystal.packings import model_from, one_body

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")
SEARCH = "{position: {x: {lower: 0, upper: 4, step: 1}, y: {lower: 0, upper: 4, step: 1}}}"
SEARCH_3D = SEARCH[:-2] + ", z: {lower: 0, upper: 4, step: 1}}}"


def rabbit(group, lengths, angles="[90, 90, 90]", search=True):
    """The spatial rabbit in another group, free to move."""
    text = locate_model("rabbit-p1").read_text()
    text = text.replace("group: P1", f"group: {group}").replace(
        "{lengths: [14, 14, 14]}", f"{{lengths: {lengths}, angles_deg: {angles}}}"
    )
    if search:
        text = text.replace("search:\n", f"search:\n  position: {SEARCH_3D[11:-1]}\n")
    return model_from(text)


def somewhere(model, seed=0):
    random = np.random.default_rng(seed)
    return np.array([random.uniform(r.lower, r.upper + 0.5) for r in model.grid.ranges])


def test_the_disc_and_the_ball_are_the_textbooks():
    near, far = np.linspace(0.0, 8.0, 400), np.linspace(8.0, 300.0, 4000)
    for w in (np.concatenate([np.geomspace(1e-9, 1.0, 50), near[1:]]), far):
        envelope = np.where(w <= 8.0, 1.0, np.sqrt(2.0 / (np.pi * w)))
        disc = np.array([bessel.disc(x) for x in w]) * w / (2.0 * np.pi)
        slope = np.array([bessel.disc_slope(x) for x in w]) * w * w / (2.0 * np.pi)
        assert np.max(np.abs(disc - special.jv(1, w)) / envelope) < 1e-14
        assert np.max(np.abs(slope + special.jv(2, w)) / envelope) < 1e-14
        ball = np.array([bessel.ball(x) for x in w]) * w / (4.0 * np.pi)
        slope = np.array([bessel.ball_slope(x) for x in w]) * w * w / (4.0 * np.pi)
        assert np.max(np.abs(ball - special.spherical_jn(1, w))) < 2e-15
        assert np.max(np.abs(slope + special.spherical_jn(2, w))) < 2e-15


def test_near_nothing_the_transforms_are_the_volume():
    for w in (0.0, 1e-300, 1e-12, 1e-8, 1e-4):
        # 1 − w²/8 and 1 − w²/10 times the volume.
        assert bessel.disc(w) == pytest.approx(np.pi * (1.0 - w * w / 8.0), rel=1e-15)
        assert bessel.ball(w) == pytest.approx(4 * np.pi / 3 * (1.0 - w * w / 10.0), rel=1e-15)
        assert bessel.disc_slope(w) == pytest.approx(-np.pi / 4.0, rel=1e-8)
        assert bessel.ball_slope(w) == pytest.approx(-4.0 * np.pi / 15.0, rel=1e-8)


@pytest.mark.parametrize("seam", [bessel.NEAR, bessel.SERIES])
def test_the_transforms_have_no_step_at_their_seams(seam):
    for transform in (bessel.disc, bessel.disc_slope, bessel.ball, bessel.ball_slope):
        ends = transform(np.nextafter(seam, 0.0)), transform(np.nextafter(seam, 99.0))
        assert ends[0] == pytest.approx(ends[1], abs=4e-15)


def quadrature(part, vectors):
    """∫ exp(2πi s·x) over an ellipsoid, by Gauss' rule in polar coordinates."""
    radii, weights = special.roots_legendre(30)
    radii, weights = (radii + 1.0) / 2.0, weights / 2.0
    turns = np.arange(60) * 2.0 * np.pi / 60
    circle = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    if part.dimension == 2:
        points = radii[:, None, None] * circle
        measure = np.broadcast_to((weights * radii)[:, None] * 2.0 * np.pi / 60, points.shape[:2])
    else:
        heights, slices = special.roots_legendre(30)
        flat = np.sqrt(1.0 - heights**2)[:, None, None] * circle
        high = np.broadcast_to(heights[:, None, None], (30, 60, 1))
        points = radii[:, None, None, None] * np.concatenate([flat, high], axis=2)
        measure = (weights * radii**2)[:, None, None] * slices[:, None] * 2.0 * np.pi / 60
        measure = np.broadcast_to(measure, points.shape[:3])
    points = points.reshape(-1, part.dimension) @ part.matrix.T + part.centre
    measure = measure.ravel() * np.linalg.det(part.matrix)
    return np.array([measure @ np.exp(2j * np.pi * (points @ s)) for s in vectors])


@pytest.mark.parametrize(
    ("group", "cell", "axes"),
    [
        ("p1", "{lengths: [5, 7], angles_deg: [70]}", [1.1, 2.0]),
        ("P1", "{lengths: [6, 6, 9]}", [2.0, 0.7, 1.3]),
    ],
)
def test_one_ellipsoid_is_its_quadrature(group, cell, axes):
    model = one_body(group, cell, axes, SEARCH if len(axes) == 2 else SEARCH_3D)
    configuration = somewhere(model)
    vectors = (reflections := all_reflections(model.cell, 1.2)).vectors
    found = structure_factors(model, configuration, reflections)
    (body,) = model.molecule.bodies(configuration)
    assert np.max(np.abs(found - quadrature(body, vectors))) < 1e-11 * abs(found).max()


@pytest.mark.parametrize(
    ("group", "cell"),
    [
        ("p2", "{lengths: [7, 6], angles_deg: [75]}"),
        ("p3", "{lengths: [7, 7], angles_deg: [120]}"),
        ("pg", "{lengths: [7, 6]}"),
        ("cm", "{lengths: [7, 6]}"),
        ("P212121", "{lengths: [8, 7, 6]}"),
        ("P31", "{lengths: [7, 7, 6], angles_deg: [90, 90, 120]}"),
    ],
)
def test_the_whole_cell_is_the_transform_of_its_points(group, cell):
    n = 3 if group.startswith("P") else 2
    search = SEARCH if n == 2 else SEARCH_3D
    model = one_body(group, cell, [1.2, 0.8, 0.6][:n], search, [1.3, 0.4, 0.2][:n])
    configuration = somewhere(model, 3)
    count = 400 if n == 2 else 64
    axes = [np.arange(count) / count] * n
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    density = np.zeros(grid.shape[:-1])
    (body,) = model.molecule.bodies(configuration)
    inverse = np.linalg.inv(body.matrix)
    for rotation, shift in zip(model.group.rotations, model.group.translations, strict=True):
        # A point x is in the copy where the operation's inverse brings it into the body.
        back = (grid - shift) @ np.linalg.inv(rotation).T - model.cell.fractional(body.centre)
        back = (back - np.round(back)) @ model.cell.basis.T
        density += np.sum((back @ inverse.T) ** 2, axis=-1) <= 1.0
    transform = np.fft.ifftn(density) * model.cell.volume
    reflections = all_reflections(model.cell, 1.5)
    expected = transform[tuple(reflections.indices.T)]
    found = structure_factors(model, configuration, reflections)
    assert np.max(np.abs(found - expected)) < 0.02 * np.abs(expected).max()


@pytest.mark.parametrize("name", NAMES)
def test_the_bundled_models_follow_the_textbook(name):
    model = load_model(name)
    for configuration in (load_target(f"{name}-target", model), somewhere(model, 1)):
        reflections = all_reflections(model.cell, model.resolution)
        vectors = np.zeros((len(reflections), 3))
        vectors[:, : model.dimension] = reflections.vectors
        expected = diffraction.structure_factors(model, configuration, vectors)
        found = structure_factors(model, configuration, reflections)
        assert np.max(np.abs(found - expected)) < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize(
    ("group", "lengths", "angles"),
    [
        ("P212121", "[22, 23, 25]", "[90, 90, 90]"),
        ("I4132", "[40, 40, 40]", "[90, 90, 90]"),
        ("P61", "[22, 22, 40]", "[90, 90, 120]"),
        ("P21/c", "[22, 23, 25]", "[90, 107, 90]"),
    ],
)
def test_magnitudes_have_the_groups_symmetry_and_absences(group, lengths, angles):
    model = rabbit(group, lengths, angles)
    configuration = somewhere(model)
    whole = all_reflections(model.cell, 7.0)
    found = structure_factors(model, configuration, whole)
    size = np.abs(found).max()
    gone = absent(model.group, whole.indices)
    assert np.all(np.abs(found[gone]) < 1e-10 * size)
    values = {tuple(h): f for h, f in zip(whole.indices.tolist(), found, strict=True)}
    values |= {tuple(h): np.conj(f) for h, f in zip((-whole.indices).tolist(), found, strict=True)}
    for op, rotation in enumerate(model.group.integer_rotations):
        phases = np.exp(2j * np.pi * (whole.indices @ model.group.translations[op]))
        turned = np.array([values[tuple(h)] for h in (whole.indices @ rotation).tolist()])
        assert np.max(np.abs(phases * turned - found)) < 1e-10 * size
    unique = reflections_of(model).subset(reflections_of(model).spacings >= 7.0)
    energy = np.sum(
        unique.multiplicities * np.abs(structure_factors(model, configuration, unique)) ** 2
    )
    assert energy == pytest.approx(np.sum(np.abs(found) ** 2), rel=1e-10)


@pytest.mark.parametrize("name", ["P212121", "P41212", "C2221", "P-1"])
def test_phases_are_those_of_gemmi_for_an_atom_at_the_place(name):
    lengths = [11.0, 11.0 if name == "P41212" else 13.0, 17.0]
    model = one_body(name, f"{{lengths: {lengths}}}", [0.4] * 3, position=[1.3, 2.9, 4.4])
    reflections = all_reflections(model.cell, 2.5)
    found = structure_factors(model, [], reflections)
    small = gemmi.SmallStructure()
    small.cell = gemmi.UnitCell(*lengths, 90, 90, 90)
    small.spacegroup_hm = name
    small.determine_and_set_spacegroup("2")
    site = gemmi.SmallStructure.Site()
    site.fract = gemmi.Fractional(*(np.array([1.3, 2.9, 4.4]) / lengths))
    site.occ, site.element = 1.0, gemmi.Element("C")
    small.add_site(site)
    small.setup_cell_images()
    assert len(small.cell.images) == model.group.order - 1
    calculator = gemmi.StructureFactorCalculatorX(small.cell)
    theirs = [
        calculator.calculate_sf_from_small_structure(small, h) for h in reflections.indices.tolist()
    ]
    large = np.abs(theirs) > 1e-3 * np.abs(theirs).max()
    assert np.all(np.abs(found[~large]) < 0.05 * np.abs(found).max())
    ratio = found[large] / np.array(theirs)[large]  # of the two form factors, both positive
    assert np.max(np.abs(ratio.imag)) < 1e-5 * ratio.real.min()


def test_shifts_in_p1_change_phases_only():
    model = rabbit("P1", "[30, 31, 33]", "[80, 95, 107]")
    first = somewhere(model)
    second = first.copy()
    second[:3] += [3.0, -2.0, 1.5]
    moved = model.molecule.placed(second)[0][0] - model.molecule.placed(first)[0][0]
    reflections = all_reflections(model.cell, 6.0)
    old, new = structure_factors(model, [first, second], reflections)
    assert np.allclose(new, old * np.exp(2j * np.pi * (reflections.vectors @ moved)), rtol=1e-10)


def test_homometric_twins_have_the_same_magnitudes():
    model = load_model("rabbit-p1")
    configuration = load_target("rabbit-p1-target", model)
    twin = configuration[[0, 1, 2, 5, 6, 3, 4]]  # the ears change places: the inverted molecule
    first, second = structure_factors(model, [configuration, twin], reflections_of(model))
    assert np.allclose(first, np.conj(second), atol=1e-11 * np.abs(first).max())


PRISMATIC = """\
format: 1
name: drawer
dimension: {n}
group: {group}
cell: {cell}
molecule:
  links:
    - name: box
      parts: [{{name: big, semi_axes: {big}}}, {{name: small, semi_axes: {small}, position: {at}}}]
    - name: drawer
      parts: [{{name: handle, semi_axes: {small}}}]
  joints:
    - name: pull
      type: prismatic
      parent: box
      child: drawer
      axis: {at}
      limit: {{lower: 0, upper: 1}}
search:
  position: {position}
  joints: {{pull: {{step: 0.5}}}}
diffraction: {{resolution: 1.5, densities: {{drawer: 2}}}}
"""


def drawers():
    plane = {"n": 2, "group": "p4", "cell": "{lengths: [9, 9]}", "big": "[1, 2]"}
    space = {"n": 3, "group": "P41", "cell": "{lengths: [9, 9, 12]}", "big": "[1, 2, 3]"}
    plane |= {"small": "[0.5, 1]", "at": "[1, 0]", "position": SEARCH[11:-1]}
    space |= {"small": "[0.5, 1, 0.7]", "at": "[0, 1, 0]", "position": SEARCH_3D[11:-1]}
    return [model_from(PRISMATIC.format(**plane)), model_from(PRISMATIC.format(**space))]


def test_rates_are_the_differences_of_the_factors():
    models = [load_model(name) for name in NAMES] + drawers()
    models.append(rabbit("P61", "[22, 22, 40]", "[90, 90, 120]"))
    for model in models:
        prepared = StructureFactors(model, reflections_of(model))
        configuration = somewhere(model, 2)
        factors, rates = prepared.factors_and_rates(configuration)
        assert np.allclose(factors, prepared.factors(configuration[None])[0], rtol=1e-12, atol=0.0)
        step = 1e-5
        sides = [
            prepared.factors(configuration + s * step * np.eye(rates.shape[1])) for s in (1, -1)
        ]
        differences = (sides[0] - sides[1]).T / (2.0 * step)
        assert np.max(np.abs(rates - differences)) < 1e-7 * np.abs(rates).max()
        sizes, slopes = prepared.magnitudes_and_rates(configuration)
        differences = (np.abs(sides[0]) - np.abs(sides[1])).T / (2.0 * step)
        clear = sizes > 1e-2 * sizes.max()  # |F| is bent sharply where F is nearly 0
        assert np.max(np.abs(slopes - differences)[clear]) < 1e-6 * np.abs(rates).max()


def test_a_factor_of_nothing_has_finite_rates():
    model = load_model("rabbit-p212121")
    whole = all_reflections(model.cell, model.resolution)
    gone = whole.subset(absent(model.group, whole.indices))
    sizes, slopes = StructureFactors(model, gone).magnitudes_and_rates(somewhere(model))
    assert np.all(sizes == 0.0) and np.all(slopes == 0.0)


def test_many_at_a_time_and_in_threads_are_as_one_by_one():
    model = load_model("rabbit-p212121")
    prepared = StructureFactors(model, reflections_of(model))
    many = np.array([somewhere(model, seed) for seed in range(40)])
    together = prepared.factors(many)
    with ThreadPoolExecutor(4) as pool:
        single = list(pool.map(lambda q: prepared.factors(q[None])[0], many))
    assert np.array_equal(together, np.array(single))


def test_wrong_configurations_are_refused():
    model = load_model("rabbit-plane")
    reflections = reflections_of(model)
    for wrong in ([0.0, 0.0], [[0.0] * 4], [0.0, np.nan, 0.0]):
        with pytest.raises(CrystalError, match="expected configurations of 3 finite numbers"):
            structure_factors(model, wrong, reflections)


def test_roots_of_unity_are_exact_at_quarters():
    for order in (1, 2, 3, 4, 6, 8, 12):
        roots = roots_of_unity(order)
        assert np.allclose(roots**order, 1.0, atol=1e-14)
        for k in range(order):
            if 4 * k % order == 0:
                assert roots[k] == (1, 1j, -1, -1j)[4 * k // order]
