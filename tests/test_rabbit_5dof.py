"""The rabbits of five degrees of freedom: why their ears have to move."""

from __future__ import annotations

import numpy as np
import pytest

from ellipsoid_planning.scenario import load_scenario
from tests.gates import extent, separations, shape
from tests.passages import plane, room

# Each gate: the wall's normal, the middle of its gate, and the two boulders beside it.
GATES = [
    ((1, 0), (-30, 12.12), ("west upper", "west middle")),
    ((0.96, -0.28), (-3.3936, -11.6352), ("centre middle", "centre lower")),
    ((1, 0), (30, 12.12), ("east upper", "east middle")),
]
DISC = 2.0
PLAY = 0.06
UP = (0.0, 0.0)


def named(scenario, names):
    return [body for body in scenario.world.obstacles if body.name in names]


def ears(configuration):
    return tuple(np.degrees(configuration[3:]))


def across(normal, middle, reach, step):
    """Places (k, 2) on a wall's axis, `step` apart, to `reach` beyond the gate's middle."""
    along = np.array([-normal[1], normal[0]])
    return np.array(middle) + np.arange(-reach, reach + step / 2, step)[:, None] * along


@pytest.mark.parametrize(("normal", "middle"), [gate[:2] for gate in GATES])
def test_every_path_passes_the_gate(normal, middle):
    """Start and goal lie on two sides of a line, in which only the gate has room for the disc."""
    scenario = load_scenario("rabbit-5dof-narrow")
    sides = [np.dot(normal, end[:2] - middle) for end in (scenario.start, scenario.goal)]
    assert sides[0] < 0.0 < sides[1]
    points = plane(normal, middle, 150.0, 0.02)
    free = room(scenario.world, points)
    roomy = free >= DISC - 0.02
    assert np.max(np.linalg.norm(points[roomy] - middle, axis=1)) < 0.2
    assert np.max(free) / DISC - 1.0 == pytest.approx(PLAY, abs=0.005)


@pytest.mark.parametrize(("normal", "middle", "boulders"), GATES)
@pytest.mark.parametrize("end", ["start", "goal"])
def test_spread_ears_pass_no_gate_at_any_heading(end, normal, middle, boulders):
    """No farther than 0.2 from a gate's middle has the face room; the ears have none there."""
    scenario = load_scenario("rabbit-5dof-narrow")
    bodies = shape(scenario.robot, ears(getattr(scenario, end)))
    turn, step = np.radians(2.0), 0.05
    places = across(normal, middle, 0.2, step)
    headings = np.arange(0.0, 2.0 * np.pi, turn)
    most = np.max(separations(bodies, named(scenario, boulders), headings, places))
    # Directions 1 degree apart miss no more than 0.01 of the depth.
    assert most + 0.5 * (extent(bodies) * turn + step) + 0.01 < -0.5


@pytest.mark.parametrize(("normal", "middle"), [gate[:2] for gate in GATES])
def test_ears_that_are_up_leave_all_the_play_there_is(normal, middle):
    scenario = load_scenario("rabbit-5dof-narrow")
    heading = np.arctan2(normal[1], normal[0])
    bodies = shape(scenario.robot, UP)
    found = separations(bodies, scenario.world.obstacles, np.array([heading]), np.array([middle]))
    assert found[0, 0] == pytest.approx(PLAY * DISC, abs=1e-3)


@pytest.mark.parametrize("end", ["start", "goal"])
def test_stump_between_the_ears_spreads_them(end):
    scenario = load_scenario("rabbit-5dof-narrow")
    x, y, heading = getattr(scenario, end)[:3]
    stumps = named(scenario, ("west stump", "east stump"))
    for angle in np.arange(0.0, 40.0, 2.0):
        bodies = shape(scenario.robot, (angle, -angle))
        depth = separations(bodies, stumps, np.array([heading]), np.array([[x, y]]))
        assert depth[0, 0] < -0.1
