"""The Fourier cost: zero at its target, its definition, and its derivatives."""

import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes, simulate
from ellipsoid_planning.crystal.diffraction.reflections import all_reflections
from ellipsoid_planning.crystal.diffraction.structure_factors import structure_factors
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.errors import CrystalError

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


def case(name, scaled=False, factor=1.0):
    model = load_model(name)
    target = load_target(f"{name}-target", model)
    exact = simulate(model, target)
    magnitudes = Magnitudes(exact.reflections, factor * exact.values)
    return model, target, FourierCost(model, magnitudes, scaled)


@pytest.mark.parametrize("name", NAMES)
def test_the_target_costs_nothing(name):
    _, target, cost = case(name)
    assert cost.value(target) == 0.0
    value, gradient = cost.value_and_gradient(target)
    assert value < 1e-11 * cost.norm and np.all(np.isfinite(gradient))
    assert cost.value(target + 0.01) > 1e-4 * cost.norm
    assert cost.correlations([target])[0] == pytest.approx(1.0)
    assert cost.scale(target) == 1.0


@pytest.mark.parametrize("name", NAMES)
def test_it_is_the_sum_over_the_whole_sphere(name):
    """Over one of each Friedel pair, whatever the group makes alike."""
    model, target, cost = case(name)
    other = target + 0.2
    whole = all_reflections(model.cell, model.resolution)
    sizes = np.abs(structure_factors(model, [target, other], whole))
    assert cost.value(other) == pytest.approx(np.linalg.norm(sizes[0] - sizes[1]), rel=1e-10)
    assert cost.norm == pytest.approx(np.linalg.norm(sizes[0]), rel=1e-10)
    present = sizes.max(axis=0) > 1e-9  # those that the group forbids are no data
    correlation = np.corrcoef(sizes[:, present])[0, 1]
    assert cost.correlations([other])[0] == pytest.approx(correlation, rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_a_scale_of_its_own_does_not_matter_where_scaled(name):
    _, target, cost = case(name, scaled=True, factor=7.0)
    plain = case(name, scaled=True)[2]
    assert cost.value(target) < 1e-12 * cost.norm
    assert cost.scale(target) == pytest.approx(7.0)
    other = target + 0.1
    assert cost.value(other) == pytest.approx(7.0 * plain.value(other), rel=1e-10)
    sizes = cost.structure.magnitudes(other[None])[0]
    for k in (0.99, 1.01):
        worse = np.sqrt(cost.weights) * (cost.magnitudes.values - k * cost.scale(other) * sizes)
        assert np.linalg.norm(worse) > cost.value(other)
    assert cost.value(other) <= case(name, factor=7.0)[2].value(other)


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_the_differences(name, scaled):
    _, target, cost = case(name, scaled, 1.3)
    other = target + np.linspace(0.05, 0.1, len(target))
    value, gradient = cost.value_and_gradient(other)
    jacobian, step = cost.jacobian(other), 1e-6
    shifts = step * np.eye(len(other))
    assert value == pytest.approx(cost.value(other), rel=1e-12)
    differences = (cost.values(other + shifts) - cost.values(other - shifts)) / (2.0 * step)
    assert np.max(np.abs(gradient - differences)) < 1e-7 * np.abs(gradient).max()
    sides = [[cost.residuals(other + sign * shift) for shift in shifts] for sign in (1, -1)]
    differences = (np.array(sides[0]) - np.array(sides[1])).T / (2.0 * step)
    assert np.max(np.abs(jacobian - differences)) < 1e-6 * np.abs(jacobian).max()
    assert np.linalg.norm(cost.residuals(other)) == pytest.approx(value, rel=1e-12)


def test_missing_reflections_are_not_compared():
    model, target, cost = case("rabbit-p1")
    kept = np.arange(0, len(cost.magnitudes), 3)
    reflections = cost.magnitudes.reflections.subset(kept)
    part = FourierCost(model, Magnitudes(reflections, cost.magnitudes.values[kept]))
    other = target + 0.1
    assert part.value(other) == pytest.approx(np.linalg.norm(cost.residuals(other)[kept]))


def test_wrong_configurations_are_refused():
    _, target, cost = case("rabbit-plane")
    for wrong in (target[:2], np.append(target, 0.0), target * np.nan):
        for ask in (cost.value, cost.value_and_gradient, cost.residuals, cost.scale):
            with pytest.raises(CrystalError, match="expected configurations of 3 finite numbers"):
                ask(wrong)
