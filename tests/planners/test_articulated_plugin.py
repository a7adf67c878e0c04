"""Checkers, motions and samplers of articulated robots inside OMPL."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy import stats

from ellipsoid_planning.cspace.articulated_sampling import ArticulatedSampling
from planners.motion import CertifiedMotionValidator
from planners.sampler import FreeIntervalSampler
from planners.spaces import read_configuration, state_access, write_configuration
from planners.validity import EllipsoidValidityChecker
from tests.planners.articulated_scenes import ROBOTS, random_configurations, scenario_of
from tests.planners.planner_scenes import random_states, space_information


@pytest.mark.parametrize("kind", ROBOTS)
def test_states_and_motions_are_judged_as_by_the_cspace(kind):
    cspace = scenario_of(kind, clearance=0.05).cspace()
    si = space_information(cspace)
    checker, validator = EllipsoidValidityChecker(si, cspace), CertifiedMotionValidator(si, cspace)
    states = random_states(si, 150)
    rows = np.array([read_configuration(state, cspace) for state in states])
    valid = [checker.isValid(state) for state in states]
    assert valid == cspace.are_valid(rows).tolist()
    assert 20 < sum(valid) < 150
    free = [validator.checkMotion(first, second) for first, second in pairwise(states)]
    assert free == cspace.are_motions_valid(rows[:-1], rows[1:]).tolist()
    assert any(free)
    lows = [checker.clearance(state) for state in states[:10]]
    assert lows == [cspace.clearance(row) for row in rows[:10]]


@pytest.mark.parametrize(
    ("kind", "place", "value"),
    [
        ("snake", 2, 3.2),  # a heading beyond pi
        ("snake", 0, 7.1),  # beyond the bounds
        ("snake", 4, 2.1),  # beyond a limit
        ("snake", 3, math.nan),
        ("snake", 3, math.inf),
        ("mixed planar", 2, 0.71),
        ("mixed planar", 3, -3.2),  # a continuous joint beyond -pi
        ("mixed spatial", 6, 1.001),  # the base's quaternion
        ("mixed spatial", 11, 1.001),  # a ball joint's
        ("mixed spatial", 11, 0.0),
        ("chain", 6, 0.999),
        ("arm", 0, math.nan),
    ],
)
def test_malformed_states_are_invalid(kind, place, value):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    checker, validator = EllipsoidValidityChecker(si, cspace), CertifiedMotionValidator(si, cspace)
    good, bad = si.allocState(), si.allocState()
    write_configuration(good, scenario.start, cspace)
    assert checker.isValid(good)
    assert validator.checkMotion(good, good)
    spoilt = scenario.start.copy()
    spoilt[place] = value
    state_access(cspace).write(bad, spoilt.tolist())  # unchecked, as OMPL may
    assert not checker.isValid(bad)
    assert not validator.checkMotion(good, bad)
    assert not validator.checkMotion(bad, good)


def test_checks_from_several_threads_do_not_mix():
    from concurrent.futures import ThreadPoolExecutor

    cspace = scenario_of("arm").cspace()
    si = space_information(cspace)
    checker, states = EllipsoidValidityChecker(si, cspace), random_states(si, 300)
    wanted = [checker.isValid(state) for state in states]
    with ThreadPoolExecutor(4) as threads:
        found = threads.map(lambda _: [checker.isValid(state) for state in states], range(8))
        assert all(each == wanted for each in found)


@pytest.mark.parametrize("uniform", [True, False])
@pytest.mark.parametrize("kind", ROBOTS)
def test_sampled_states_are_valid_and_near_when_asked(kind, uniform):
    scenario = scenario_of(kind, clearance=0.05)
    cspace = scenario.cspace()
    si = space_information(cspace)
    sampler = FreeIntervalSampler(si, cspace, uniform, seed=3)
    checker = EllipsoidValidityChecker(si, cspace)
    start, state = si.allocState(), si.allocState()
    write_configuration(start, scenario.start, cspace)
    drawn = 0
    for _ in range(50):
        if sampler.sample(state):
            drawn += 1
            assert checker.isValid(state)
        for distance in (0.01, 1.0, 30.0):
            if sampler.sampleNear(state, start, distance):
                drawn += 1
                assert checker.isValid(state)
                travelled = si.distance(start, state)
                assert travelled <= distance * (1.0 + 1e-9)
    assert drawn > 150


@pytest.mark.statistical
@pytest.mark.parametrize("kind", ["snake", "mixed spatial", "arm"])
def test_uniform_samples_have_the_distribution_of_rejection(kind):
    cspace = scenario_of(kind).cspace()
    sampling = ArticulatedSampling(cspace, seed=4, uniform=True)
    drawn, row = [], np.empty(cspace.robot.configuration_size)
    while len(drawn) < 3000:
        if sampling.sample(row):
            drawn.append(row.copy())
    tried = random_configurations(cspace.robot, 8000, seed=5, reach=7.0)
    kept = tried[cspace.are_valid(tried)]
    for k in range(row.size):
        assert stats.ks_2samp(np.array(drawn)[:, k], kept[:, k]).pvalue > 1e-4
