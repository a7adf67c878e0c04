"""Small problems for the plug-in's tests, and a dense check of paths that uses none of its code."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from planners.spaces import state_access, state_space
from tests.motion_oracle import Scene, clearances, in_bounds
from tests.oracles import body_of

Array = NDArray[np.float64]

KINDS = ("planar", "spatial", "planar translation", "spatial translation")


def scenario_of(kind: str, clearance: float = 0.0, blocked: bool = False) -> Scenario:
    """A wall with two gaps (none if ``blocked``) in an arena, and a robot of two parts."""
    n = 2 if kind.startswith("planar") else 3
    rotates = "translation" not in kind
    start, goal = np.zeros((2, n))
    start[0], goal[0] = -6.0, 6.0
    if rotates:
        turn = {2: ([0.0], [1.0]), 3: ([0.0, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8])}[n]
        start, goal = np.append(start, turn[0]), np.append(goal, turn[1])
    parts = (
        Ellipsoid.from_semi_axes([1.0, 0.5, 0.4][:n], name="body"),
        Ellipsoid.from_semi_axes([0.3, 0.6, 0.3][:n], [0.8, 0.4, 0.1][:n], name="fin"),
    )
    robot = RigidRobot(parts, rotates=rotates)
    world = World(np.full(n, -9.0), np.full(n, 9.0), _wall(n, blocked), _arenas(n))
    return Scenario(kind, world, robot, start, goal, clearance)


def _wall(n: int, blocked: bool) -> tuple[Ellipsoid, ...]:
    reach = 12.0 if n == 3 else 0.7
    pillars = [
        Ellipsoid.from_semi_axes([0.8, 2.2, reach][:n], [0.0, y, 0.0][:n], name=f"pillar at {y}")
        for y in (-6.5, 0.5, 6.5)
    ]
    if blocked:
        pillars.append(Ellipsoid.from_semi_axes([1.0, 14.0, 14.0][:n], name="wall"))
    return tuple(pillars)


def _arenas(n: int) -> tuple[Ellipsoid, ...]:
    return (Ellipsoid.from_semi_axes([12.0, 11.0, 10.0][:n], name="hall"),)


def arrays_of(scenario: Scenario) -> Scene:
    """The scenario as the dense oracle's arrays (robots here are not turned when fixed)."""
    world, robot = scenario.world, scenario.robot
    return Scene(
        low=world.low,
        high=world.high,
        obstacles=tuple(map(body_of, world.obstacles)),
        arenas=tuple(map(body_of, world.arenas)),
        parts=tuple(map(body_of, robot.parts)),
        rotates=robot.rotates,
    )


def least_clearance(scenario: Scenario, path: Array, count: int = 25) -> float:
    """The smallest distance at ``count`` states along every segment of OMPL's own interpolation.

    Fails if a state leaves the bounds.
    """
    cspace = scenario.cspace()
    access, space = state_access(cspace), state_space(cspace)
    si = ob.SpaceInformation(space)
    first, second, between = si.allocState(), si.allocState(), si.allocState()
    rows = [path[0].tolist()]
    for a, b in zip(path[:-1].tolist(), path[1:].tolist(), strict=True):
        access.write(first, a)
        access.write(second, b)
        for s in np.linspace(0.0, 1.0, count)[1:]:
            space.interpolate(first, second, float(s), between)
            rows.append(list(access.read(between)))
    scene = arrays_of(scenario)
    assert in_bounds(scene, np.array(rows)).all()
    return float(clearances(scene, np.array(rows)).min())


def random_states(si: ob.SpaceInformation, count: int) -> list[ob.State]:
    """``count`` states drawn uniformly from the whole space."""
    sampler = si.allocStateSampler()
    states = [si.allocState() for _ in range(count)]
    for state in states:
        sampler.sampleUniform(state)
    return states


def space_information(cspace: CSpace) -> ob.SpaceInformation:
    """A bare space information over the space of ``cspace``."""
    return ob.SpaceInformation(state_space(cspace))


def run_python(code: str, timeout: float = 900.0) -> subprocess.CompletedProcess[str]:
    """Run ``code`` in a process of its own, where a crash harms nobody."""
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)],
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )
