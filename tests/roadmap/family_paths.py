"""Queries in the families' worlds, and paths judged without the kernels."""

from __future__ import annotations

import time

import numpy as np

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.verify.clearance import ClearanceTester
from planners.verify.motion import interpolate
from planners.verify.sampling import SampledPath, sample_path
from tests import exact
from tests.oracles import body_of

# How long a query may take on a busy machine [s].
LIMIT = 600.0


def query(scenario, limit=LIMIT, **parameters):
    """A fresh planner and its outcome."""
    space = scenario.cspace()
    planner = HighwayRoadmap(space, RoadmapParameters(**parameters))
    planner.compile_kernels()
    end = time.monotonic() + limit
    outcome = planner.solve(
        scenario.start[None], scenario.goal[None], lambda: time.monotonic() > end
    )
    return planner, outcome


def assert_verified(scenario, path) -> SampledPath:
    """A path keeps its ends, and no sample of it meets anything, however close one looks."""
    _assert_well_formed(scenario, path)
    sampled = sample_path(scenario, path)
    assert sampled.worst is None, sampled.worst
    assert sampled.smallest >= scenario.clearance
    return sampled


def assert_free(scenario, path, count=1000):
    """A path keeps its ends, and none of about `count` samples meets anything: the tightest."""
    _assert_well_formed(scenario, path)
    first, second = path[:-1], path[1:]
    each = max(4, count // len(first))
    index = np.repeat(np.arange(len(first)), each)
    s = np.tile(np.linspace(0.0, 1.0, each), len(first))
    rows = interpolate(scenario.robot, first[index], second[index], s)
    found = ClearanceTester(scenario).test(rows, np.zeros(len(rows)))
    assert not found.meetings, found.meetings[0]
    tightest = np.argsort(found.lower)[:1]
    (least,) = ClearanceTester(scenario).test(rows[tightest], np.array([np.inf])).upper
    assert least >= scenario.clearance
    return rows[tightest[0]]


def _assert_well_formed(scenario, path):
    np.testing.assert_allclose(path[0], scenario.start, atol=1e-12)
    np.testing.assert_allclose(path[-1], scenario.goal, atol=1e-12)
    assert np.isfinite(path).all()
    base = path[:, : scenario.dimension]
    assert ((base >= scenario.world.low) & (base <= scenario.world.high)).all()


def assert_exactly_free(scenario, configuration):
    """Whether a robot meets nothing, in 60-digit arithmetic on its bodies as placed."""
    for part in map(body_of, scenario.robot.bodies_at(configuration)):
        for obstacle in map(body_of, scenario.world.obstacles):
            assert exact.is_separated(part, obstacle)
        for arena in map(body_of, scenario.world.arenas):
            assert exact.is_contained(arena, part)


def changed(scenario, *, scale=1.0, clearance=0.0, arenas=None, obstacles=None, ends=None):
    """The scenario in another unit of length, or with other bodies or ends."""

    def scaled(bodies):
        return tuple(
            Ellipsoid(scale * b.centre, b.rotation, scale * b.semi_axes, b.name) for b in bodies
        )

    world, n = scenario.world, scenario.dimension
    start, goal = (end.copy() for end in ends or (scenario.start, scenario.goal))
    start[:n] *= scale
    goal[:n] *= scale
    return Scenario(
        name=scenario.name,
        world=World(
            scale * world.low,
            scale * world.high,
            scaled(world.obstacles if obstacles is None else obstacles),
            scaled(world.arenas if arenas is None else arenas),
        ),
        robot=RigidRobot(scaled(scenario.robot.parts)),
        start=start,
        goal=goal,
        clearance=clearance,
    )


def is_proved(space: CSpace, path) -> bool:
    """Whether every motion of a path is proved."""
    return bool(space.are_motions_valid(path[:-1], path[1:]).all())
