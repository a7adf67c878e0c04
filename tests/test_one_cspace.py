"""``CSpace(world, robot)`` is right for every robot, and what knows one kind refuses the other."""

import copy
import pickle

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.cspace import ArticulatedCSpace, CSpace
from ellipsoid_planning.cspace.articulated_rows import configurations_of_rows, rows_of
from ellipsoid_planning.cspace.articulated_sampling import ArticulatedSampling
from ellipsoid_planning.cspace.fitting import narrowest_directions, width
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.cspace.packing import pack_scene
from ellipsoid_planning.cspace.poses import configurations_from_poses, interpolate, poses
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling
from ellipsoid_planning.errors import EllipsoidPlanningError, GeometryError, PlannerError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.trees.connect import FreeIntervalRRTConnect
from planners.setup import CHECKERS, install, simple_setup
from planners.spaces import read_configuration, state_space, write_configuration
from tests.articulated import twin
from tests.articulated_scenes import random_configurations
from tests.safety.scenes import crowd, robot

ARTICULATED = ("snake", "planar arm", "mixed spatial")


def rigid(dimension=2):
    return RigidRobot((Ellipsoid.from_semi_axes(np.arange(1.0, dimension + 1.0) / 4),))


@pytest.mark.parametrize("kind", ARTICULATED)
def test_an_articulated_robot_gets_its_own_kind(kind):
    """Answers are those of a twin that places links one by one: joints are no coordinates."""
    own = robot(kind)
    world = crowd(own.dimension, 12)
    for space in (
        CSpace(world, own),
        CSpace(world, robot=own, clearance=0.0),
        CSpace(world=world, robot=own),
    ):
        assert type(space) is ArticulatedCSpace
    rows = random_configurations(own, np.random.default_rng(3), 150, -7.0, 7.0)
    gaps = np.minimum(twin.obstacle_gaps(world, own, rows), twin.self_gaps(own, rows))
    sure = np.abs(gaps) > 1e-6
    assert 10 < (gaps > 0)[sure].sum() < sure.sum() - 10
    assert np.array_equal(space.are_valid(rows)[sure], (gaps > 0)[sure])


def test_a_rigid_robot_keeps_its_kind():
    world = crowd(2, 3)
    space = CSpace(world, rigid())
    assert type(space) is CSpace
    assert type(LocalCSpace(space, [-1, -1], [1, 1])) is LocalCSpace
    rows = np.random.default_rng(1).uniform(-7.0, 7.0, (50, 3))
    other = CSpace(world, robot("snake"))
    for made in (copy.copy(space), pickle.loads(pickle.dumps(space)), copy.deepcopy(other)):
        assert type(made) in (CSpace, ArticulatedCSpace)
    assert np.array_equal(pickle.loads(pickle.dumps(space)).are_valid(rows), space.are_valid(rows))
    assert type(pickle.loads(pickle.dumps(other))) is ArticulatedCSpace


def test_what_is_no_robot_or_no_world_is_refused():
    world, scenario = crowd(2, 3), load_scenario("rabbit-2d-open")
    for given in (
        (world, None),
        (world, "arm-6r"),
        (world, scenario),
        (rigid(), world),
        (scenario, rigid()),
        (world, rigid(3)),
        (world, robot("chain")),
        (world, rigid(), -1.0),
        (world, rigid(), "0"),
        (world, robot("snake"), np.nan),
    ):
        with pytest.raises(GeometryError, match=r"expected .* got "):
            CSpace(*given)
    with pytest.raises(GeometryError, match="ArticulatedRobot, got RigidRobot"):
        ArticulatedCSpace(world, rigid())


def test_what_knows_one_kind_of_robot_refuses_the_other():
    world = crowd(2, 3)
    own, stiff = robot("planar arm"), rigid()
    space, plain = CSpace(world, own), CSpace(world, stiff)
    q = np.zeros(3)  # as many numbers as [x, y, yaw]
    refused = [
        lambda: poses(own, q),
        lambda: configurations_from_poses(own, np.zeros((1, 7))),
        lambda: interpolate(own, q, q, 0.5),
        lambda: rows_of(stiff, q),
        lambda: configurations_of_rows(stiff, np.zeros((1, 7))),
        lambda: pack_scene(world, own, 0.0),
        lambda: width(own, [[1.0, 0.0]]),
        lambda: narrowest_directions(own),
        lambda: FreeIntervalSampling(space, 1),
        lambda: ArticulatedSampling(plain, 1),
        lambda: LocalCSpace(space, [-1, -1], [1, 1]),
        lambda: FreeIntervalRRTConnect(space),
    ]
    for call in refused:
        with pytest.raises(EllipsoidPlanningError, match=r"expected .*got "):
            call()


@pytest.mark.parametrize("checker", CHECKERS)
def test_installed_checkers_know_the_joints(checker):
    """By one name, every checker is that of the robot: its answers are the twin's."""
    own = robot("planar arm")
    world = crowd(2, 12)
    space = CSpace(world, own)
    si = ob.SpaceInformation(state_space(space))
    install(si, space, checker)
    si.setup()
    rows = random_configurations(own, np.random.default_rng(4), 60, -7.0, 7.0)
    gaps = np.minimum(twin.obstacle_gaps(world, own, rows), twin.self_gaps(own, rows))
    state = si.allocState()
    for row, gap in zip(rows, gaps, strict=True):
        write_configuration(state, row, space)
        assert np.array_equal(read_configuration(state, space), row)
        if abs(gap) > 1e-5:
            assert si.isValid(state) == (gap > 0)


def test_setups_refuse_what_is_no_cspace_or_another_scenarios():
    scenario, other = load_scenario("rabbit-2d-open"), load_scenario("arm-6r")
    si = ob.SpaceInformation(state_space(scenario.cspace()))
    for given in (scenario, scenario.world, None):
        with pytest.raises(PlannerError, match="expected a CSpace, got"):
            install(si, given)
    with pytest.raises(PlannerError, match="expected a CSpace, got Scenario"):
        simple_setup(scenario, cspace=scenario)
    grown = CSpace(scenario.world, scenario.robot, scenario.clearance + 1.0)
    for space in (other.cspace(), grown):
        with pytest.raises(PlannerError, match=r"make it with scenario\.cspace\(\)"):
            simple_setup(scenario, cspace=space)
    simple_setup(scenario, cspace=scenario.cspace())
