"""Small scenarios with known paths, for the tests of this folder."""

import math
from types import SimpleNamespace

import numpy as np

from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World

body = Ellipsoid.from_semi_axes


def planar_scenario(clearance=0.0):
    """A two-ellipse robot, two obstacles, one arena."""
    robot = RigidRobot((body([5, 3], name="face"), body([3, 1.5], [-5, 3], math.radians(135))))
    obstacles = (
        body([15, 10], [-10, -20], math.radians(-60), name="pillar"),
        body([9, 6], [10, 24], 0.4),
    )
    world = World(np.array([-50, -40]), np.array([50, 40]), obstacles, (body([60, 45]),))
    return Scenario(
        "planar <test>",
        world,
        robot,
        np.array([-40.0, 0.0, 0.0]),
        np.array([40.0, 15.0, math.radians(30)]),
        clearance,
        description="Tests & pictures.",
    )


def spatial_scenario(arena=True, clearance=0.0):
    """A two-ellipsoid robot and two obstacles; nothing hides another from the camera."""
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    robot = RigidRobot((body([5, 3, 3], name="face"), body([3, 1.5, 1], [-5, 3, 0], turn)))
    obstacles = (
        body([8, 6, 9], [0, 0, -16], turn, name="cloud"),
        body([6, 9, 5], [2, 4, 18], name="cloud"),
    )
    arenas = (body([60, 45, 35]),) if arena else ()
    world = World(np.array([-48, -36, -28]), np.array([48, 36, 28]), obstacles, arenas)
    half = math.radians(120) / 2
    return Scenario(
        "spatial",
        world,
        robot,
        np.array([-40.0, 0, 0, 0, 0, 0, 1]),
        np.array([40.0, 5, 2, math.sin(half), 0, 0, math.cos(half)]),
        clearance,
    )


def solved(scenario):
    """A result with a path of two motions, free of collisions."""
    middle = 0.5 * (scenario.start + scenario.goal)
    if scenario.dimension == 3:
        middle[3:] /= np.linalg.norm(middle[3:])
    path = PathResult.from_configurations(
        scenario.robot,
        [scenario.start, middle, scenario.goal],
        min_clearance=0.25,
        certified=True,
    )
    return PlanResult(scenario, "HighwayRoadmap", "solved", seed=1, path=path)


def unsolved(scenario):
    """A result without a path."""
    return PlanResult(scenario, "RRT", "timeout")


def small_roadmap(scenario):
    """Nodes on a vertical grid (x, last axis) with horizontal edges."""
    columns, rows = np.meshgrid(np.linspace(-30, 30, 6), np.linspace(-10, 10, 5))
    configurations = np.tile(scenario.start, (columns.size, 1))
    configurations[:, 0] = columns.ravel()
    configurations[:, scenario.dimension - 1] = rows.ravel()
    first = np.arange(columns.size).reshape(columns.shape)[:, :-1].ravel()
    return SimpleNamespace(
        configurations=configurations,
        edges=np.column_stack([first, first + 1]),
        layers=np.zeros(columns.size, dtype=int),
    )
