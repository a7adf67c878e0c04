"""Start and goal, and robots that are too large for their arena."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_checks import check_endpoints, check_fit
from ellipsoid_planning.world import World


class StubSpace:
    """A configuration space that reports the given contacts for every configuration."""

    def __init__(self, *contacts):
        self._contacts = contacts

    def explain(self, _configuration):
        return self._contacts


def contact(kind, part="face", body="rock", depth=0.25):
    verb = {"obstacle": "hits", "arena": "leaves"}.get(kind, "is out of bounds of")
    text = f"part {part!r} {verb} {kind} {body!r} by {depth}"
    return SimpleNamespace(kind=kind, part=part, body=body, depth=depth, message=text)


def arena_scenario(part_axes, arena_axes, clearance=0.0, rotates=True, turn=None):
    n = len(part_axes)
    part = Ellipsoid.from_semi_axes(part_axes, np.ones(n), name="face")
    arena = Ellipsoid.from_semi_axes(arena_axes, np.full(n, 2.0), name="hall")
    world = World([-5.0] * n, [5.0] * n, arenas=(arena,))
    robot = RigidRobot((part,), rotates=rotates, orientation=turn)
    start = np.zeros(robot.configuration_size)
    start[-1] = 1.0
    return Scenario("fit", world, robot, start, start, clearance)


def test_contacts_are_told_with_file_field_line_and_depth():
    scenario = load_scenario("rabbit-2d-open")
    space = StubSpace(contact("obstacle"), contact("arena", body="hall"), contact("bounds"))
    with pytest.raises(ScenarioError) as caught:
        check_endpoints(scenario, space)
    error = caught.value
    assert error.field == "start"
    assert error.line is not None
    assert str(error.file).endswith("rabbit-2d-open.yaml")
    for words in (
        "'face' hits obstacle 'rock' by 0.25",
        "'face' leaves arena 'hall' by 0.25",
        "out of bounds",
        "move the start",
    ):
        assert words in error.problem


def test_many_contacts_are_summed_up():
    space = StubSpace(*[contact("obstacle")] * 5)
    with pytest.raises(ScenarioError, match="2 more"):
        check_endpoints(load_scenario("rabbit-2d-open"), space)


def test_free_endpoints_pass():
    check_endpoints(load_scenario("rabbit-2d-open"), StubSpace())


@pytest.mark.parametrize(
    ("part", "arena", "words"),
    [
        ([1.0, 3.0], [2.5, 4.0], None),
        ([3.0, 1.0], [2.5, 4.0], None),
        ([3.0, 2.6], [2.5, 4.0], "smaller semi-axis of part 'face' is 2.6"),
        ([1.0, 4.5], [2.5, 4.0], "too large by 0.5"),
        ([1.0, 2.0, 3.0], [3.0, 2.0, 1.0], None),
        ([1.0, 2.5, 3.0], [3.0, 2.0, 1.0], "middle semi-axis of part 'face' is 2.5"),
    ],
)
def test_turning_robots_must_fit_at_some_orientation(part, arena, words):
    scenario = arena_scenario(part, arena)
    if words is None:
        return check_fit(scenario)
    with pytest.raises(ScenarioError, match=words) as caught:
        check_fit(scenario)
    assert caught.value.field == "robot.parts[0]"
    return None


def test_the_clearance_counts():
    check_fit(arena_scenario([1.0, 2.0], [2.5, 4.0], clearance=1.5))
    with pytest.raises(ScenarioError, match=r"with the clearance 1\.6"):
        check_fit(arena_scenario([1.0, 2.0], [2.5, 4.0], clearance=1.6))


def test_translating_robots_must_fit_as_they_stand():
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    check_fit(arena_scenario([1.0, 3.0], [2.5, 4.0], rotates=False))
    with pytest.raises(ScenarioError, match=r"exceeds the arena's 2\.5 by 0\.5"):
        check_fit(arena_scenario([1.0, 3.0], [2.5, 4.0], rotates=False, turn=quarter))


@pytest.mark.parametrize("name", sorted(bundled_scenarios()))
def test_bundled_endpoints_are_free(name):
    scenario = load_scenario(name)
    check_endpoints(scenario)


def test_a_moved_start_is_caught_with_its_depth():
    scenario = load_scenario("rabbit-2d-open")
    bush = scenario.world.obstacles[2]
    moved = dataclasses.replace(scenario, start=[*bush.centre, 0.0])
    with pytest.raises(ScenarioError, match=r"part 'face' hits obstacle 'bush' by"):
        check_endpoints(moved)


@pytest.mark.parametrize("name", ["rabbit-2d-open", "rabbit-3d-open"])
def test_open_endpoints_are_free_by_the_slow_definition(name):
    scenario = load_scenario(name)
    directions = unit_directions(scenario.dimension, 4000)
    for configuration in (scenario.start, scenario.goal):
        for part in scenario.robot.bodies_at(configuration):
            for obstacle in scenario.world.obstacles:
                gaps = -obstacle.support(-directions) - part.support(directions)
                assert np.max(gaps) > 0.5
            for arena in scenario.world.arenas:
                assert np.min(arena.support(directions) - part.support(directions)) > 0.5
