"""The bundled scenarios of articulated robots: as described, free at both ends, and solved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_checks import check_endpoints


@dataclass(frozen=True)
class Expected:
    """What a scenario's description promises.

    Attributes:
        obstacles: their number.
        links: the number of links.
        freedom: degrees of freedom.
        identical: whether all links have the same shape.
    """

    obstacles: int
    links: int
    freedom: int
    identical: bool


SCENES = {
    "arm-6r": Expected(obstacles=8, links=7, freedom=6, identical=False),
    "rabbit-5dof-narrow": Expected(obstacles=11, links=3, freedom=5, identical=False),
    "rabbit-5dof-open": Expected(obstacles=5, links=3, freedom=5, identical=False),
    "snake-7dof-maze": Expected(obstacles=40, links=5, freedom=7, identical=True),
}
NAMES = sorted(SCENES)
OF_BASE = {
    ("free", 2): 3,
    ("free", 3): 6,
    ("translating", 2): 2,
    ("translating", 3): 3,
}
OF_JOINT = {"ball": 3}


def never():
    return False


def freedom(robot):
    """Degrees of freedom: a base's and one for each joint, three for a ball joint."""
    base = OF_BASE.get((robot.base, robot.dimension), 0)
    return base + sum(OF_JOINT.get(joint.type, 1) for joint in robot.moving_joints)


def shape(link):
    """What is the same for identical links, wherever their frames are: the parts' semi-axes."""
    return [tuple(part.semi_axes) for part in link.parts]


def test_these_scenarios_are_bundled():
    assert set(bundled_scenarios()) >= set(SCENES)


@pytest.mark.parametrize("name", NAMES)
def test_scenario_is_as_described_and_free_at_both_ends(name):
    scenario, expected = load_scenario(name), SCENES[name]
    assert scenario.name == name
    assert scenario.description
    assert len(scenario.world.obstacles) == expected.obstacles
    assert len(scenario.robot.links) == expected.links
    assert freedom(scenario.robot) == expected.freedom
    if expected.identical:
        first, *others = [shape(link) for link in scenario.robot.links]
        assert all(other == first for other in others)
    check_endpoints(scenario)


@pytest.mark.parametrize("name", NAMES)
def test_direct_motion_does_not_solve_it(name):
    scenario = load_scenario(name)
    assert not scenario.cspace().is_motion_valid(scenario.start, scenario.goal)


@pytest.mark.parametrize("name", NAMES)
def test_highway_roadmap_solves_and_proves_it(name):
    scenario = load_scenario(name)
    cspace = scenario.cspace()
    outcome = HighwayRoadmap(cspace).solve(scenario.start[None], scenario.goal[None], never)
    assert outcome.status == SOLVED
    np.testing.assert_allclose(outcome.path[[0, -1]], [scenario.start, scenario.goal], atol=1e-9)
    assert np.all(cspace.are_motions_valid(outcome.path[:-1], outcome.path[1:]))
