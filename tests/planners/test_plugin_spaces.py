"""State spaces and configurations."""

from itertools import pairwise

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.errors import PlannerError
from planners.spaces import (
    check_space,
    read_configuration,
    state_access,
    state_space,
    write_configuration,
)
from tests.planners.planner_scenes import KINDS, random_states, scenario_of, space_information

TYPES = dict(
    zip(
        KINDS,
        [ob.SE2StateSpace, ob.SE3StateSpace, ob.RealVectorStateSpace, ob.RealVectorStateSpace],
        strict=True,
    )
)


@pytest.mark.parametrize("kind", KINDS)
def test_space_has_the_type_bounds_and_weights_of_ompl(kind):
    cspace = scenario_of(kind).cspace()
    space = state_space(cspace)
    assert type(space) is TYPES[kind]
    base = space.getSubspace(0) if cspace.rotates else space
    assert list(base.getBounds().low) == list(cspace.world.low)
    assert list(base.getBounds().high) == list(cspace.world.high)
    if cspace.rotates:
        assert list(space.getSubspaceWeights()) == [1.0, 0.5 if cspace.dimension == 2 else 1.0]


@pytest.mark.parametrize("kind", KINDS)
def test_configurations_survive_the_way_to_a_state_and_back(kind):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    state = space_information(cspace).allocState()
    write_configuration(state, scenario.goal, cspace)
    assert np.array_equal(read_configuration(state, cspace), scenario.goal)
    assert len(state_access(cspace).read(state)) == state_access(cspace).size


@pytest.mark.parametrize("kind", KINDS)
def test_distance_and_interpolation_agree_with_the_cspace(kind):
    cspace = scenario_of(kind).cspace()
    si = space_information(cspace)
    between = si.allocState()
    states = random_states(si, 40)
    for first, second in pairwise(states):
        a, b = read_configuration(first, cspace), read_configuration(second, cspace)
        assert cspace.distance(a, b) == pytest.approx(si.distance(first, second), abs=1e-12)
        si.getStateSpace().interpolate(first, second, 0.3, between)
        assert read_configuration(between, cspace) == pytest.approx(
            cspace.interpolate(a, b, 0.3), abs=1e-12
        )


@pytest.mark.parametrize(
    ("kind", "space"),
    [
        ("planar", ob.SE3StateSpace),
        ("spatial", ob.SE2StateSpace),
        ("planar", ob.DubinsStateSpace),
        ("planar translation", lambda: ob.RealVectorStateSpace(3)),
    ],
)
def test_a_space_with_other_states_or_motions_is_refused(kind, space):
    with pytest.raises(PlannerError, match="needs"):
        check_space(space(), scenario_of(kind).cspace())
