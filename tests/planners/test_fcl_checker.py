"""The FCL checker against ours and against a dense check."""

import numpy as np
import pytest

from ellipsoid_planning.errors import PlannerError
from planners.bindings import ompl_output
from planners.fcl import FclValidityChecker, check_motions_discretely
from planners.setup import simple_setup
from planners.spaces import read_configuration, write_configuration
from planners.validity import EllipsoidValidityChecker
from tests.planners.planner_scenes import KINDS, random_states, scenario_of, space_information

DEPTH = 1e-5
"""FCL is trusted down to this depth, relative to the size of the bodies (about 1 here)."""


@pytest.mark.parametrize("clearance", [0.0, 0.2])
@pytest.mark.parametrize("kind", KINDS)
def test_it_agrees_with_our_checker_on_random_states(kind, clearance):
    cspace = scenario_of(kind, clearance).cspace()
    si = space_information(cspace)
    ours, theirs = EllipsoidValidityChecker(si, cspace), FclValidityChecker(si, cspace)
    states = random_states(si, 1500)
    disagreeing = [state for state in states if ours.isValid(state) != theirs.isValid(state)]
    for state in disagreeing:
        assert abs(ours.clearance(state) - clearance) < DEPTH
    assert len(disagreeing) < 5


@pytest.mark.parametrize("kind", KINDS)
def test_clearances_agree_where_the_robot_is_free(kind):
    cspace = scenario_of(kind).cspace()
    si = space_information(cspace)
    ours, theirs = EllipsoidValidityChecker(si, cspace), FclValidityChecker(si, cspace)
    free = [state for state in random_states(si, 100) if ours.isValid(state)]
    for state in free:
        assert theirs.clearance(state) == pytest.approx(ours.clearance(state), rel=1e-3, abs=1e-4)
    assert len(free) > 10


@pytest.mark.parametrize(
    ("kind", "configuration"),
    [
        ("planar", [-6.0, 0.0, 3.2]),
        ("planar", [-9.1, 0.0, 0.0]),
        ("spatial", [-6.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.1]),
    ],
)
def test_bounds_and_malformed_states_are_invalid_as_for_ours(kind, configuration):
    cspace = scenario_of(kind).cspace()
    si = space_information(cspace)
    state = si.allocState()
    write_configuration(state, np.array(configuration), cspace)
    assert not FclValidityChecker(si, cspace).isValid(state)


def test_motions_are_checked_state_by_state_at_the_resolution(monkeypatch):
    scenario = scenario_of("planar")
    cspace = scenario.cspace()
    checked = []
    is_valid = FclValidityChecker.isValid
    monkeypatch.setattr(FclValidityChecker, "isValid", lambda *a: checked.append(1) or is_valid(*a))
    counts = []
    for resolution in (0.01, 0.001):
        si = simple_setup(scenario, "fcl", resolution=resolution).getSpaceInformation()
        first, second = si.allocState(), si.allocState()
        write_configuration(first, scenario.start, cspace)
        write_configuration(second, scenario.start + np.array([0.5, 4.0, 0.0]), cspace)
        checked.clear()
        assert si.checkMotion(first, second)
        counts.append(len(checked))
    assert 8 <= counts[1] / counts[0] <= 12


@pytest.mark.parametrize("resolution", [0.0, -0.1, 1.5])
def test_bad_resolutions_are_refused(resolution):
    si = space_information(scenario_of("planar").cspace())
    with pytest.raises(PlannerError, match="resolution"):
        check_motions_discretely(si, resolution)


def test_a_world_without_obstacles_is_fine():
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.world import World

    full = scenario_of("spatial")
    cspace = CSpace(World(full.world.low, full.world.high), full.robot)
    si = space_information(cspace)
    checker = FclValidityChecker(si, cspace)
    with ompl_output("silent"):
        states = random_states(si, 5)
    assert all(checker.isValid(state) for state in states)
    assert checker.clearance(states[0]) == np.inf
    assert read_configuration(states[0], cspace).shape == (7,)
