"""Minima of the Gaussian cost in the cells of a grid."""

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.crystal.packing.potential_candidates import (
    candidate_counts,
    candidates_by_potential,
    cells_of,
)
from ellipsoid_planning.errors import CrystalError

PLANE = load_model("rabbit-plane")
TARGETS = [
    (100.82, -72.21, -3.03),
    (42.29, 64.37, -69.25),
    (136.67, -68.70, -67.33),
    (114.21, -63.46, -51.42),
    (54.83, -49.51, -70.41),
    (159.67, 47.67, -2.65),
    (101.63, -67.65, 12.06),
    (113.89, -73.69, 30.76),
    (66.41, 27.29, -76.94),
    (97.19, -1.59, -86.46),
]


def test_printed_48_candidates():
    """Thesis 3.5.1: 30° cells, m_b = 0.2; the extent of the lattice sum is not printed there."""
    found = candidates_by_potential(PLANE, GaussianMixture(0.2), copies=3, starts=1)
    assert len(found.cells) == 216
    assert found.free.sum() == 48


def test_free_share_of_the_planar_rabbit():
    """26.5 %: of the nodes 0, 30, ..., 150 of the heading and -90, -60, ..., 90 of both ears."""
    ears = np.radians(np.arange(-90, 91, 30))
    nodes = np.stack(np.meshgrid(np.radians(np.arange(0, 180, 30)), ears, ears), -1).reshape(-1, 3)
    assert (PLANE.are_free(nodes).sum(), len(nodes)) == (78, 294)


def test_counts_at_larger_spread_do_not_depend_on_the_lattice_sum():
    for copies in (1, None):
        counts = candidate_counts(PLANE, np.array([3.2]), np.radians([30.0]), copies=copies)
        assert counts.tolist() == [[168]]  # of 216


def test_minima_lie_near_all_ten_targets():
    """Thesis Table 3.2; theta_3 is minus the left ear's angle, yaw + 180° the inversion twin."""
    targets = np.array(TARGETS) * [1, 1, -1]
    step = np.radians(15)
    found = candidates_by_potential(PLANE, GaussianMixture(3.2), step=step, nodes=3).kept
    apart = np.degrees(found)[None] - targets[:, None]
    apart[..., 0] = (apart[..., 0] + 90) % 180 - 90
    assert np.abs(apart).max(axis=-1).min(axis=1).max() < 12.0


def test_minima_are_minima_of_their_cells_whatever_the_threads():
    mixture, step, seen = GaussianMixture(1.6), np.radians(60), []
    found = candidates_by_potential(
        PLANE, mixture, step=step, threads=2, on_progress=lambda *done: seen.append(done)
    )
    assert seen[-1] == (27, 27)
    cells = cells_of(PLANE, step)
    assert np.all(found.configurations >= cells[..., 0])
    assert np.all(found.configurations <= cells[..., 1])
    potential = GaussianPotential(PLANE, mixture)
    assert potential.values(found.configurations) == pytest.approx(found.potentials, rel=1e-12)
    rng = np.random.default_rng(0)
    inside = cells[..., 0] + rng.random((100, 27, 3)) * (cells[..., 1] - cells[..., 0])
    others = potential.values(inside.reshape(-1, 3)).reshape(100, 27)
    assert np.all(found.potentials <= others.min(axis=0) + 1e-12)
    alone = candidates_by_potential(PLANE, mixture, step=step)
    assert np.array_equal(alone.configurations, found.configurations)
    assert len(found.kept) == found.free.sum()
    assert np.all(PLANE.are_free(found.kept))


def test_cells_are_numbered_like_arrangements():
    numbers = np.arange(PLANE.grid.count)
    assert cells_of(PLANE).mean(axis=-1) == pytest.approx(PLANE.grid.configurations(numbers))
    spatial = load_model("rabbit-p1")
    coarse = cells_of(spatial, np.radians(45))
    assert coarse.shape == (2**3 * 2**4, 7, 2)
    assert np.all(coarse[..., 0] < coarse[..., 1])


def test_steps_that_do_not_divide_a_range_leave_a_narrower_last_cell():
    cells = np.degrees(cells_of(PLANE, np.radians(40)))
    assert len(cells) == 125
    assert cells[-1] == pytest.approx(np.array([[160, 180], [70, 90], [70, 90]]))


def test_bad_input():
    mixture = GaussianMixture(1.0)
    with pytest.raises(CrystalError, match="step > 0"):
        candidates_by_potential(PLANE, mixture, step=0.0)
    for tiny in (1e-3, 1e-9, 5e-324):  # refused before memory is taken for them
        with pytest.raises(CrystalError, match="cells or more"):
            cells_of(PLANE, tiny)
    for name in ("threads", "nodes", "starts"):
        with pytest.raises(CrystalError, match=f"{name} >= 1"):
            candidates_by_potential(PLANE, mixture, **{name: 0})
