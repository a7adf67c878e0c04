"""Whatever takes a configuration refuses what is none, with one clear error."""

import itertools
import math

import numpy as np
import pytest

from ellipsoid_planning.cspace.articulated_sampling import ArticulatedSampling
from ellipsoid_planning.cspace.free_fraction import layer_fraction
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import EllipsoidPlanningError, GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.metric import base_travel, path_length
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.safety import ExactSafety, TabulatedSafety
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.trees.connect import FreeIntervalRRTConnect
from ellipsoid_planning.world import World
from planners.setup import simple_setup
from planners.spaces import write_configuration
from tests.safety.scenes import COARSE, robot

RIGID = ("planar", "spatial", "translating")
KINDS = (*RIGID, "mixed planar", "planar arm", "chain")


def space_of(kind, obstacles=()):
    """A C-space of a robot of the kind, in bounds of [-7, 7]ⁿ."""
    if kind in RIGID:
        n = 3 if kind == "spatial" else 2
        own = RigidRobot((Ellipsoid.from_semi_axes(np.full(n, 0.5)),), kind != "translating")
    else:
        own = robot(kind)
    n = own.dimension
    return CSpace(World(np.full(n, -7.0), np.full(n, 7.0), obstacles), own)


def home(space):
    """A configuration (d,): zero, with quaternions of no turn."""
    values = np.zeros(space.robot.configuration_size)
    if space.rotates and space.dimension == 3:
        values[6] = 1.0
    for joint in getattr(space.robot, "moving_joints", ()):
        if joint.type == "ball":
            values[space.robot.joint_slices[joint.name].stop - 1] = 1.0
    return values


def calls(space, good):
    """Everything of a C-space, its robot and their safety that takes one configuration."""
    sampling = FreeIntervalSampling if isinstance(space.robot, RigidRobot) else ArticulatedSampling
    out, rigid = np.empty(len(good)), isinstance(space.robot, RigidRobot)
    tables = TabulatedSafety(space, COARSE, keep=False)
    found = {
        "is_valid": space.is_valid,
        "clearance": space.clearance,
        "explain": space.explain,
        "pose": space.pose,
        "is_motion_valid": lambda q: space.is_motion_valid(good, q),
        "is_motion_valid from": lambda q: space.is_motion_valid(q, good),
        "motion_clearance": lambda q: space.motion_clearance(good, q),
        "interpolate": lambda q: space.interpolate(good, q, 0.5),
        "distance": lambda q: space.distance(good, q),
        "sample_near": lambda q: sampling(space, 1).sample_near(q, 1.0, out),
        "robot.pose": space.robot.pose,
        "bodies_at": space.robot.bodies_at,
        "link_poses": space.robot.link_poses,
        "exact safety": ExactSafety(space).is_safe,
        "tabulated safety": tables.is_safe,
    }
    if space.robot.base_size:
        found["layer"] = space.layer
        found["layer_fraction"] = lambda q: layer_fraction(space, q)
    if not rigid:
        found["placed"] = space.placed
    return found


def wrong_ones(good):
    """What is no configuration, by name: shapes, numbers that are none, no numbers at all."""
    no_number, endless = good.copy(), good.copy()
    no_number[-1], endless[0] = math.nan, -math.inf
    return {
        "two": np.array([good, good]),
        "a row": good[None],
        "one short": good[:-1],
        "one more": np.append(good, 0.0),
        "a number": 1.0,
        "nothing": [],
        "nan": no_number,
        "inf": endless,
        "text": ["0"] * len(good),
        "complex": good + 0j,
        "objects": [None] * len(good),
        "ragged": [[0.0], [0.0, 1.0]],
        "yes": [True] * len(good),
    }


@pytest.mark.parametrize("kind", KINDS)
def test_a_single_configuration_is_refused_unless_it_is_one(kind):
    space = space_of(kind)
    good = home(space)
    wrong = wrong_ones(good)
    for name, call in calls(space, good).items():
        call(good)
        call(good.tolist())
        for what, given in wrong.items():
            with pytest.raises(GeometryError, match="expected ") as caught:
                call(given)
            assert "\n" not in str(caught.value), (name, what)


@pytest.mark.parametrize("kind", KINDS)
def test_calls_on_many_answer_every_row(kind):
    """A body in the way of the second row: the first one's answer is not taken for both."""
    n = 3 if kind in ("spatial", "chain") else 2
    space = space_of(kind, (Ellipsoid.from_semi_axes(np.full(n, 0.1), np.full(n, 0.02)),))
    inside = home(space)
    outside = inside.copy()
    if space.robot.base_size:
        outside[:n] = 5.0 if kind in RIGID else [-5.5, *[-5.0] * (n - 1)]
    rows = np.array([outside, inside, outside])
    one_by_one = [space.is_valid(row) for row in rows]
    assert space.are_valid(rows).tolist() == one_by_one
    if space.robot.base_size:
        assert one_by_one == [True, False, True]
    motions = [space.is_motion_valid(row, row) for row in rows]
    assert space.are_motions_valid(rows, rows).tolist() == motions
    for first, second in ((rows, rows[:2]), (rows[0], rows), (rows[:1], rows)):
        with pytest.raises(GeometryError, match="as many"):
            space.are_motions_valid(first, second)


@pytest.mark.parametrize("kind", KINDS)
def test_rows_are_refused_unless_all_of_them_are_configurations(kind):
    space = space_of(kind)
    good = home(space)
    bad = np.array([good] * 3)
    bad[2, 0] = math.nan
    wrong = (bad[:, :-1], bad[None], bad, [["0"] * len(good)], [good, good[:-1]])
    planner = HighwayRoadmap if space.robot.base_size else None
    takes = [
        space.are_valid,
        space.poses,
        lambda rows: space.are_motions_valid(rows, rows),
        ExactSafety(space).are_safe,
        lambda rows: path_length(space.robot, rows),
        lambda rows: base_travel(space.robot, rows),
    ]
    if planner:
        takes.append(lambda rows: planner(space).solve(rows, good[None], lambda: True))
    if kind in RIGID:
        takes.append(
            lambda rows: FreeIntervalRRTConnect(space).solve(good[None], rows, lambda: True)
        )
    for call, rows in itertools.product(takes, wrong):
        with pytest.raises(GeometryError, match=r"expected .*got "):
            call(rows)


@pytest.mark.parametrize("kind", ["planar", "translating", "planar arm"])
def test_scenarios_and_states_take_one_configuration(kind):
    space = space_of(kind)
    good = home(space)
    scenario = Scenario("short", space.world, space.robot, good, good)
    state = simple_setup(scenario).getSpaceInformation().allocState()
    for given in wrong_ones(good).values():
        with pytest.raises(EllipsoidPlanningError, match="start: expected"):
            Scenario("short", space.world, space.robot, given, good)
        with pytest.raises(GeometryError):
            write_configuration(state, given, space)


def test_rotations_of_layers_are_rotations():
    for kind in ("planar", "spatial", "translating"):
        space = space_of(kind)
        n = space.dimension
        space.layer(np.eye(n))
        for given in (2.0 * np.eye(n), np.full((n, n), math.nan), np.zeros((n, n)), "eye"):
            with pytest.raises(GeometryError):
                space.layer(given)
