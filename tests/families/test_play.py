"""The play of the passages is what is asked for: no less, and no more by any motion."""

import numpy as np
import pytest

from ellipsoid_planning.families.turns import configuration
from tests.families.oracle import (
    CASES,
    WALLS,
    across,
    best_nearby,
    exact_least_gap,
    scene,
    turns_of,
)

SEEDS = [None, 1, 2]


@pytest.mark.parametrize("clearance", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_the_gates_have_the_play(name, dimension, seed, clearance):
    scenario, gates = scene(name, clearance, dimension, seed)
    for around in gates:
        gate = around.gate
        assert gate.play == pytest.approx(clearance * gate.width, rel=1e-14)
        low, high = exact_least_gap(scenario, gate.configuration)
        assert low == pytest.approx(gate.play / 2, rel=1e-9, abs=1e-13)
        assert high == pytest.approx(gate.play / 2, rel=1e-9, abs=1e-11)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_the_width_is_that_of_the_main_part_across_the_passage(name, dimension):
    _, gates = scene(name, 1e-3, dimension, 5)
    for around in gates:
        lengths = np.sort(around.hull.semi_axes)
        semi_axis = lengths[-1] if name == "tight-arena" else lengths[0]
        assert around.gate.width == pytest.approx(2 * semi_axis, rel=1e-14)


@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_a_billionth_still_means_something(name, dimension):
    scenario, gates = scene(name, 1e-9, dimension, 4)
    for around in gates:
        low, high = exact_least_gap(scenario, around.gate.configuration)
        assert low == pytest.approx(around.gap, rel=1e-4)
        assert high == pytest.approx(around.gap, abs=1e-11)
        assert scenario.cspace().is_valid(around.gate.configuration)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "dimension"), CASES)
def test_no_pose_across_the_passage_has_more_room(name, dimension):
    """On its way the robot's centre crosses the plane of the gate, or it stands upright.

    Whatever pose it takes there, near the gate's or far from it, its least gap is at most the
    gate's.
    """
    _, gates = scene(name, 1e-2, dimension, 3)
    around = gates[0]
    basis, size = across(name, around.gate, around.hull)
    generator = np.random.default_rng(7)
    most = around.gap * (1 + 1e-6)
    for scale in (1e-4, 1e-2, 1e-1, 0.5):
        points = generator.normal(scale=scale, size=(100, size))
        shifts, turns = zip(*map(basis, points), strict=True)
        gaps = around.least_gaps(np.array(shifts), np.array(turns))
        assert gaps.max() <= most
    assert best_nearby(around, basis, np.zeros(size), 0.05) <= most
    assert best_nearby(around, basis, points[np.argmax(gaps)], 0.1) <= most


@pytest.mark.parametrize("clearance", [1e-1, 1e-3, 1e-6])
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "dimension"), WALLS)
def test_the_straight_way_through_the_gates_is_free(name, dimension, seed, clearance):
    scenario, gates = scene(name, clearance, dimension, seed)
    for around in gates:
        first, second = (around.gate.configuration.copy() for _ in range(2))
        first[:dimension] -= 3.0 * around.gate.travel
        second[:dimension] += 3.0 * around.gate.travel
        assert scenario.cspace().is_motion_valid(first, second)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_bend_is_free_along_its_circle(dimension, seed):
    """Turned about the arena's centre, the robot goes from gate to gate without hitting any."""
    scenario, gates = scene("bend", 1e-3, dimension, seed)
    centre = scenario.world.arenas[0].centre
    away = [around.hull.centre - centre for around in gates]
    last = gates[-1].gate
    angle = np.arccos(away[0] @ away[-1] / (away[0] @ away[0]))
    assert angle >= np.radians(75)
    axis = np.sign(away[0][0] * away[-1][1] - away[0][1] * away[-1][0])
    if dimension == 3:
        axis = np.cross(away[0], away[-1]) / np.linalg.norm(np.cross(away[0], away[-1]))
    steps = np.linspace(0.0, angle, 301)
    poses = np.array([_turned(gates[0].gate, centre, axis, step) for step in steps])
    assert np.all(scenario.cspace().are_motions_valid(poses[:-1], poses[1:]))
    assert poses[-1][:dimension] == pytest.approx(last.position, abs=1e-9)
    assert gates[0].scenario.robot.pose(poses[-1])[1] == pytest.approx(last.rotation, abs=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_robot_can_turn_in_the_tight_arena(dimension, seed):
    scenario, gates = scene("tight-arena", 1e-3, dimension, seed)
    around = gates[0]
    space, upright = scenario.cspace(), around.gate
    arena = scenario.world.arenas[0]
    axis = np.cross(arena.rotation[:, 0], around.hull.rotation[:, 0]) if dimension == 3 else 1.0
    assert space.is_valid(upright.configuration)
    angles = np.radians([-40, -10, 0, 10, 40])
    poses = [_turned(upright, around.hull.centre, axis, angle) for angle in angles]
    assert all(map(space.is_valid, poses))


def _turned(gate, pivot, axis, angle):
    """The gate's configuration, turned about a point by an angle about an axis."""
    turn = turns_of(np.atleast_2d(angle * axis), len(pivot))[0]
    return configuration(pivot + turn @ (gate.position - pivot), turn @ gate.rotation)
