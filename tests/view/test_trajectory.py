"""Paths followed at constant speed."""

import numpy as np
import pytest

from ellipsoid_planning.metric import path_length
from planners.view.trajectory import follow, nearest_indices
from tests.view.scenes import planar_scenario, solved, spatial_scenario


@pytest.mark.parametrize("make", [planar_scenario, spatial_scenario])
def test_samples_are_the_motions_of_the_space(make):
    scenario = make()
    corners = solved(scenario).path.configurations
    cspace = scenario.cspace()
    trajectory = follow(cspace, corners, samples=50)
    assert trajectory.travelled[-1] == pytest.approx(path_length(scenario.robot, corners))
    for corner in corners:
        assert np.min(np.linalg.norm(trajectory.configurations - corner, axis=1)) == 0.0
    first = cspace.distance(corners[0], corners[1])
    on_first = trajectory.travelled <= first
    expected = [
        cspace.interpolate(corners[0], corners[1], way / first)
        for way in trajectory.travelled[on_first]
    ]
    np.testing.assert_allclose(trajectory.configurations[on_first], expected, atol=1e-9)


def test_travelled_measures_the_samples_themselves():
    scenario = spatial_scenario()
    cspace = scenario.cspace()
    trajectory = follow(cspace, solved(scenario).path.configurations)
    steps = [
        cspace.distance(a, b)
        for a, b in zip(trajectory.configurations[:-1], trajectory.configurations[1:], strict=True)
    ]
    np.testing.assert_allclose(np.diff(trajectory.travelled), steps, atol=1e-6)


@pytest.mark.parametrize("count", [1, 2])
def test_a_path_that_goes_nowhere(count):
    scenario = planar_scenario()
    trajectory = follow(scenario.cspace(), np.tile(scenario.start, (count, 1)))
    assert len(trajectory.configurations) == count
    np.testing.assert_array_equal(trajectory.fractions, np.zeros(count))
    np.testing.assert_array_equal(trajectory.evenly(5)[0], scenario.start)


def test_evenly_keeps_both_ends():
    scenario = planar_scenario()
    trajectory = follow(scenario.cspace(), solved(scenario).path.configurations)
    chosen = trajectory.evenly(9)
    assert len(chosen) == 9
    np.testing.assert_array_equal(chosen[[0, -1]], [scenario.start, scenario.goal])


def test_nearest_indices():
    ascending = np.array([0.0, 0.1, 0.5, 1.0])
    np.testing.assert_array_equal(nearest_indices(ascending, np.array([0.06, 0.4, 0.9])), [1, 2, 3])
    np.testing.assert_array_equal(nearest_indices(np.array([0.0]), np.array([0.0, 1.0])), [0])
