"""The validity checker and the motion validator against the C-space and a dense check."""

import math
from itertools import pairwise

import numpy as np
import pytest

from planners.motion import CertifiedMotionValidator
from planners.spaces import read_configuration, state_access, write_configuration
from planners.validity import EllipsoidValidityChecker
from tests.motion_oracle import clearances
from tests.planners.planner_scenes import (
    KINDS,
    arrays_of,
    least_clearance,
    random_states,
    scenario_of,
    space_information,
)


@pytest.mark.parametrize("clearance", [0.0, 0.2])
@pytest.mark.parametrize("kind", KINDS)
def test_validity_agrees_with_the_cspace_and_with_a_dense_check(kind, clearance):
    scenario = scenario_of(kind, clearance)
    cspace = scenario.cspace()
    si = space_information(cspace)
    checker = EllipsoidValidityChecker(si, cspace)
    states = random_states(si, 200)
    rows = np.array([read_configuration(state, cspace) for state in states])
    valid = np.array([checker.isValid(state) for state in states])
    assert np.array_equal(valid, cspace.are_valid(rows))
    distance = clearances(arrays_of(scenario), rows)
    clear_cut = np.abs(distance - clearance) > 1e-6
    assert np.array_equal(valid[clear_cut], distance[clear_cut] > clearance)
    assert 0.1 < valid.mean() < 0.9


@pytest.mark.parametrize("kind", KINDS)
def test_clearance_is_that_of_the_cspace(kind):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    checker = EllipsoidValidityChecker(si, cspace)
    for state in random_states(si, 20):
        assert checker.clearance(state) == cspace.clearance(read_configuration(state, cspace))


@pytest.mark.parametrize(
    ("kind", "configuration"),
    [
        ("planar", [-6.0, 0.0, 3.2]),
        ("planar", [-6.0, 0.0, -3.2]),
        ("planar", [-6.0, 0.0, math.nan]),
        ("planar", [-9.001, 0.0, 0.0]),
        ("planar", [math.nan, 0.0, 0.0]),
        ("spatial", [-6.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0 + 1e-9]),
        ("spatial", [-6.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ("spatial", [-6.0, 0.0, 0.0, math.nan, 0.0, 0.0, 1.0]),
        ("spatial", [-6.0, 0.0, 9.001, 0.0, 0.0, 0.0, 1.0]),
        ("spatial translation", [-6.0, 0.0, math.inf]),
        ("planar translation", [-9.001, 0.0]),
    ],
)
def test_malformed_and_outlying_states_and_their_motions_are_invalid(kind, configuration):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    checker = EllipsoidValidityChecker(si, cspace)
    motions = CertifiedMotionValidator(si, cspace)
    good, bad = si.allocState(), si.allocState()
    write_configuration(good, scenario.start, cspace)
    state_access(cspace).write(bad, list(configuration))  # unchecked, as OMPL may
    assert checker.isValid(good)
    assert motions.checkMotion(good, good)
    assert not checker.isValid(bad)
    assert not motions.checkMotion(good, bad)
    assert not motions.checkMotion(bad, good)


def test_headings_at_half_turns_are_valid():
    cspace = scenario_of("planar").cspace()
    si = space_information(cspace)
    checker, state = EllipsoidValidityChecker(si, cspace), si.allocState()
    for yaw in (math.pi, -math.pi):
        write_configuration(state, np.array([-6.0, 0.0, yaw]), cspace)
        assert checker.isValid(state)


@pytest.mark.parametrize("kind", KINDS)
def test_motions_agree_with_the_cspace_and_certified_ones_with_a_dense_check(kind):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    motions = CertifiedMotionValidator(si, cspace)
    access = state_access(cspace)
    certified = 0
    states = [s for s in random_states(si, 400) if cspace.is_valid(access.read(s))]
    for first, second in pairwise(states):
        a, b = read_configuration(first, cspace), read_configuration(second, cspace)
        valid = motions.checkMotion(first, second)
        assert valid == cspace.is_motion_valid(a, b)
        if valid and certified < 12:
            certified += 1
            assert least_clearance(scenario, np.array([a, b])) > 0.0
    assert certified > 3


def test_the_checker_reaches_the_scene_for_planners():
    cspace = scenario_of("spatial").cspace()
    si = space_information(cspace)
    si.setStateValidityChecker(EllipsoidValidityChecker(si, cspace))
    assert si.getStateValidityChecker().cspace is cspace
