"""Start, goal and arenas of articulated robots: what is wrong is said."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.scenario_checks import check_endpoints, check_fit
from ellipsoid_planning.scenario_files import parse_document
from ellipsoid_planning.world import World
from tests.articulated_texts import PLANAR, SPATIAL


def read(text):
    data, origin = parse_document(text, "file.yaml")
    return Scenario._from_document(data, origin)


class StubSpace:
    """A configuration space that reports one contact for every configuration."""

    def __init__(self, **contact):
        self._contact = SimpleNamespace(**contact)

    def explain(self, _configuration):
        return (self._contact,)


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        (
            {"kind": "self", "message": "part 'ear 1' hits part 'face' of the robot itself"},
            "part 'ear 1' hits part 'face' of the robot itself; move the start",
        ),
        (
            {"kind": "limits", "depth": 0.1, "message": "joint 'ear' is out of its limits"},
            "expected a free start, but joint 'ear' is out of its limits; move",
        ),
    ],
)
def test_contacts_are_told(contact, words):
    with pytest.raises(ScenarioError) as caught:
        check_endpoints(read(PLANAR), StubSpace(**contact))
    assert (caught.value.field, caught.value.line) == ("start", 21)
    assert words in caught.value.problem


@pytest.mark.parametrize("text", [PLANAR, SPATIAL])
def test_free_endpoints_pass(text):
    check_endpoints(read(text))


def test_a_robot_that_hits_itself_is_caught():
    text = PLANAR.replace("  joints:", "    - {name: rod}\n  joints:", 1)
    text = text.replace("child: ear", "child: rod").replace(
        "start:",
        "    - {name: end, type: fixed, parent: rod, child: ear}\nstart:",
    )
    text = text.replace("[-6, 2]", "[0, 0]")
    # A link joined by a fixed joint is as adjacent as the one it is fixed to; make it bend.
    text = text.replace("type: fixed", "type: continuous")
    with pytest.raises(ScenarioError, match=r"'face' hits part 'ear 1' of the robot itself"):
        check_endpoints(read(text))


def test_an_obstacle_in_a_moved_link_is_caught():
    scenario = read(PLANAR)
    ear = scenario.robot.bodies_at(scenario.start)[1]
    world = dataclasses.replace(scenario.world, obstacles=(ear.with_name("bush"),))
    with pytest.raises(ScenarioError, match="part 'ear 1' hits obstacle 'bush' by"):
        check_endpoints(dataclasses.replace(scenario, world=world))


def two_links(kind, base, turn=0.0):
    """A free or held robot of two links, the second of which is too long for a low arena."""
    joint = Joint.of(
        "joint",
        "one",
        "two",
        kind,
        [0.0, 0.0],
        [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]],
        lower=-1.0,
        upper=1.0,
    )
    links = (
        Link("one", (Ellipsoid.from_semi_axes([0.5, 0.5]),)),
        Link("two", (Ellipsoid.from_semi_axes([3.0, 0.5], name="bar"),)),
    )
    robot = ArticulatedRobot(links, (joint,), base)
    arena = Ellipsoid.from_semi_axes([5.0, 2.0], name="hall")
    ends = np.zeros(robot.configuration_size)
    return Scenario("two", World([-5, -5], [5, 5], arenas=(arena,)), robot, ends, ends)


@pytest.mark.parametrize("base", ["translating", "fixed"])
def test_links_that_never_turn_must_fit_as_they_stand(base):
    check_fit(two_links("prismatic", base))
    check_fit(two_links("revolute", base, turn=math.pi / 2))
    with pytest.raises(ScenarioError, match="part 'bar'") as caught:
        check_fit(two_links("prismatic", base, turn=math.pi / 2))
    assert caught.value.field == "robot.links[1].parts[0]"


def test_links_that_turn_must_fit_at_some_orientation():
    check_fit(two_links("prismatic", "free", turn=math.pi / 2))
    scenario = two_links("revolute", "fixed")
    arena = Ellipsoid.from_semi_axes([2.5, 2.5], name="hall")
    world = dataclasses.replace(scenario.world, arenas=(arena,))
    with pytest.raises(ScenarioError, match=r"too large by 0\.5 at every orientation") as caught:
        check_fit(dataclasses.replace(scenario, world=world))
    assert caught.value.field == "robot.links[1].parts[0]"
