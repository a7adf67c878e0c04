"""The bundled scenarios of articulated robots: as described, free at both ends, and solved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_checks import check_endpoints
from tests.passages import plane, room


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
    "chain-18dof": Expected(obstacles=2, links=5, freedom=18, identical=True),
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


def test_every_way_of_the_chain_is_through_the_slit():
    """Start and goal lie on two sides of the mid-plane, in which there is no room but in the slit.

    Links cross the plane x = 0 where the obstacles leave room: in a strip about z = 0, whatever
    the y. Balls in the cave that touch no obstacle are hardly larger there than the slit is high.
    """
    scenario, height = load_scenario("chain-18dof"), 0.8
    thickness = 2.0 * np.min(scenario.robot.links[0].parts[0].semi_axes)
    assert thickness == pytest.approx(0.4)
    for end, side in ((scenario.start, -1.0), (scenario.goal, 1.0)):
        for body in scenario.robot.bodies_at(end):
            assert body.support(np.array([-side, 0.0, 0.0])) < -0.5
    step = 0.02
    points = plane((1, 0, 0), (0, 0, 0), 3.2, step)
    (cave,) = scenario.world.arenas
    within = cave.semi_axes[1] - np.linalg.norm(points, axis=1)
    clear = room(scenario.world, points)
    assert np.max(np.abs(points[clear > 1e-6][:, 2])) < 0.51
    most = np.max(np.minimum(clear, within))
    assert 0.5 * height - step < most
    assert most + 0.71 * step < 0.5
