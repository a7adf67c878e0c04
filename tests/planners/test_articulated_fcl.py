"""The FCL checker of articulated robots against ours."""

import numpy as np
import pytest

from planners.fcl import FclValidityChecker
from planners.placing import PartPlaces
from planners.spaces import write_configuration
from planners.validity import EllipsoidValidityChecker
from tests.planners.articulated_scenes import ROBOTS, random_configurations, robot_of, scenario_of
from tests.planners.planner_scenes import random_states, space_information

DEPTH = 1e-5
"""FCL is trusted down to this depth, relative to the size of the bodies (about 1 here)."""


@pytest.mark.parametrize("kind", ROBOTS)
def test_parts_are_placed_as_by_the_robot(kind):
    robot, places = robot_of(kind), PartPlaces(robot_of(kind))
    n = robot.dimension
    for row in random_configurations(robot, 20, seed=2):
        rotations, centres = places(row)
        for body, rotation, centre in zip(robot.bodies_at(row), rotations, centres, strict=True):
            assert body.rotation == pytest.approx(rotation[:n, :n], abs=1e-14)
            assert body.centre == pytest.approx(centre[:n], abs=1e-13)
            assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-14)


@pytest.mark.parametrize("clearance", [0.0, 0.2])
@pytest.mark.parametrize("kind", ROBOTS)
def test_it_agrees_with_our_checker_on_random_states(kind, clearance):
    cspace = scenario_of(kind, clearance).cspace()
    si = space_information(cspace)
    ours, theirs = EllipsoidValidityChecker(si, cspace), FclValidityChecker(si, cspace)
    states = random_states(si, 400)
    judged = np.array([(ours.isValid(state), theirs.isValid(state)) for state in states])
    assert 20 < judged[:, 0].sum() < 400
    for k in np.flatnonzero(judged[:, 0] != judged[:, 1]):
        assert abs(ours.clearance(states[k]) - clearance) < DEPTH
    free = np.flatnonzero(judged[:, 0])[:30]
    for k in free:
        assert theirs.clearance(states[k]) == pytest.approx(
            ours.clearance(states[k]), rel=1e-3, abs=1e-4
        )


def test_the_robot_meets_itself_only_where_it_may_not():
    scenario = scenario_of("snake")
    cspace = scenario.cspace()
    si = space_information(cspace)
    theirs, state = FclValidityChecker(si, cspace), si.allocState()
    bent = scenario.start.copy()
    bent[3:] = [1.0, 2.0, 2.0]  # the last link comes back to the first
    write_configuration(state, bent, cspace)
    assert not theirs.isValid(state)
    assert [contact.kind for contact in cspace.explain(bent)] == ["self"]


@pytest.mark.parametrize(
    ("kind", "place", "value"),
    [("snake", 4, 2.1), ("mixed planar", 3, 3.2), ("chain", 6, 1.1), ("snake", 0, 7.1)],
)
def test_limits_and_malformed_states_are_invalid_as_for_ours(kind, place, value):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    theirs, state = FclValidityChecker(si, cspace), si.allocState()
    write_configuration(state, scenario.start, cspace)
    assert theirs.isValid(state)
    spoilt = scenario.start.copy()
    spoilt[place] = value
    write_configuration(state, spoilt, cspace)
    assert not theirs.isValid(state)
