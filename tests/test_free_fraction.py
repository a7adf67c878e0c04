"""The measured free fraction against closed forms, rejection sampling, and itself."""

import math

import numpy as np
import pytest

from ellipsoid_planning.cspace.free_fraction import Budget, free_fraction, layer_fraction
from ellipsoid_planning.cspace.layer_sequence import whole_measure
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.free_motion import free_motion_volume
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.world import World
from tests.articulated_scenes import chain, scattered, slit, snake

FEW = Budget(lines=20_000)


def world_of(arena, *obstacles):
    half = arena.semi_axes.max()
    return World(arena.centre - half, arena.centre + half, obstacles, (arena,))


def ball(radius, *centre):
    return Ellipsoid.from_semi_axes([radius] * len(centre), centre)


def uniform(cspace, count, seed):
    """Configurations (count, d), uniform on the bounds, rotations and joint ranges."""
    rng, robot = np.random.default_rng(seed), cspace.robot
    n, rows = cspace.dimension, np.empty((count, cspace.robot.configuration_size))
    if robot.base_size:
        rows[:, :n] = rng.uniform(cspace.world.low, cspace.world.high, (count, n))
    if robot.rotates and n == 2:
        rows[:, 2] = rng.uniform(-math.pi, math.pi, count)
    elif robot.rotates:
        rows[:, 3:7] = quaternions(rng, count)
    for joint in getattr(robot, "moving_joints", ()):
        where = robot.joint_slices[joint.name]
        if joint.type == "ball":
            rows[:, where] = quaternions(rng, count)
        else:
            rows[:, where] = rng.uniform(joint.lower, joint.upper, (count, 1))
    return rows


def quaternions(rng, count):
    q = rng.normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def agrees(found, cspace, count=40_000, seed=5):
    """Whether rejection sampling gives the same fraction, within four of its standard errors."""
    share = float(np.mean(cspace.are_valid(uniform(cspace, count, seed))))
    spread = math.sqrt(max(share * (1.0 - share), 1.0 / count) / count + found.standard_error**2)
    assert abs(share - found.value) < 4.0 * spread, (share, found)
    return True


# --- closed forms ---------------------------------------------------------------------------------

CLOSED = {
    "balls": (ball(10.0, 0, 0, 0), [ball(1.0, 4, 0, 0), ball(2.0, -4, 0, 0)], ball(0.5, 0, 0, 0)),
    "discs": (ball(10.0, 0, 0), [ball(1.0, 4, 0), ball(2.0, -4, 0)], ball(0.5, 0, 0)),
    "ellipse": (
        Ellipsoid.from_semi_axes([12.0, 9.0]),
        [Ellipsoid.from_semi_axes([1.0, 2.0], [4.0, 0.0], 0.4), ball(1.5, -5, 1)],
        Ellipsoid.from_semi_axes([1.0, 0.6]),
    ),
    "ellipsoid": (
        Ellipsoid.from_semi_axes([12.0, 9.0, 10.0]),
        [Ellipsoid.from_semi_axes([1.0, 2.0, 1.5], [4.0, 0.0, 0.0]), ball(1.5, -5, 1, 0)],
        Ellipsoid.from_semi_axes([1.0, 0.6, 0.8]),
    ),
}


@pytest.mark.parametrize("case", CLOSED)
@pytest.mark.parametrize("rotates", [True, False])
@pytest.mark.statistical
def test_it_is_the_closed_form_where_that_is_exact(case, rotates):
    arena, obstacles, part = CLOSED[case]
    exact = free_motion_volume(arena, obstacles, part, rotates=rotates)
    assert exact.kind == "exact"
    cspace = CSpace(world_of(arena, *obstacles), RigidRobot((part,), rotates))
    found = free_fraction(cspace, 3, FEW)
    error = found.volume - exact.value
    assert abs(error) < 4.0 * found.fraction.standard_error * found.whole + 1e-9 * exact.value
    assert found.fraction.standard_error < 1e-3 * found.fraction.value


def test_where_the_robot_is_does_not_matter():
    arena, obstacles, part = CLOSED["ellipse"]
    exact = free_motion_volume(arena, obstacles, part)
    moved = part.transform(np.eye(2), np.array([3.0, 1.0]))
    half = np.full(2, 20.0)
    cspace = CSpace(World(-half, half, obstacles, (arena,)), RigidRobot((moved,)))
    found = free_fraction(cspace, 3, FEW)
    assert abs(found.volume - exact.value) < 4.0 * found.fraction.standard_error * found.whole


# --- rejection ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["rabbit-2d-narrow", "translation-2d", "rabbit-3d-cluttered", "translation-3d"]
)
@pytest.mark.statistical
def test_rejection_gives_the_same(name):
    cspace = load_scenario(name).cspace()
    found = free_fraction(cspace, 1, FEW)
    assert agrees(found.fraction, cspace)
    spread = math.sqrt(found.fraction.value * (1.0 - found.fraction.value) / 20_000)
    assert found.fraction.standard_error < 0.4 * spread


ARTICULATED = {
    "free snake": (snake(4), scattered(0, 15)),
    "translating snake": (snake(3, "translating", np.eye(2)), scattered(1, 15)),
    "chain": (chain(3), slit(0.1)),
    "fixed snake": (
        snake(4, "fixed"),
        World(np.full(2, -5.0), np.full(2, 5.0), (ball(1.0, 2, 2),)),
    ),
}


@pytest.mark.parametrize("case", ARTICULATED)
@pytest.mark.statistical
def test_articulated_robots(case):
    robot, world = ARTICULATED[case]
    cspace = CSpace(world, robot)
    found = free_fraction(cspace, 1, FEW)
    assert 0.0 < found.fraction.value < 1.0
    assert agrees(found.fraction, cspace)
    assert found.method == ("configurations" if case == "fixed snake" else "free intervals")


def test_with_a_clearance_less_is_free():
    arena, obstacles, part = CLOSED["balls"]
    world = world_of(arena, *obstacles)
    grown = free_motion_volume(ball(9.7, 0, 0, 0), [ball(1.3, 4, 0, 0), ball(2.3, -4, 0, 0)], part)
    found = free_fraction(CSpace(world, RigidRobot((part,)), 0.3), 2, FEW)
    assert abs(found.volume - grown.value) < 5.0 * found.fraction.standard_error * found.whole


# --- the interval ---------------------------------------------------------------------------------


@pytest.mark.statistical
def test_the_interval_holds_the_truth_as_often_as_it_says():
    arena, obstacles, part = CLOSED["ellipse"]
    exact = free_motion_volume(arena, obstacles, part).value
    cspace = CSpace(world_of(arena, *obstacles), RigidRobot((part,)))
    truth = exact / whole_measure(cspace)
    hits = 0
    for seed in range(100):
        found = free_fraction(cspace, seed, Budget(lines=2000), 0.9).fraction
        hits += found.low <= truth <= found.high
    assert 80 <= hits <= 99


def test_nothing_free_and_nothing_in_the_way():
    wall = ball(50.0, 0, 0)
    world = World(np.full(2, -5.0), np.full(2, 5.0), (wall,))
    robot = RigidRobot((ball(0.1, 0, 0),))
    nothing = free_fraction(CSpace(world, robot), 0, FEW).fraction
    assert (nothing.value, nothing.low) == (0.0, 0.0)
    assert 0.0 < nothing.high < 0.01
    empty = free_fraction(CSpace(World(world.low, world.high), robot), 0, FEW)
    assert (empty.fraction.low, empty.fraction.high, empty.method) == (1.0, 1.0, "exact")
    assert empty.volume == pytest.approx(100.0 * 2.0 * math.pi)


# --- budgets --------------------------------------------------------------------------------------


def test_the_same_seed_gives_the_same_numbers():
    cspace = load_scenario("rabbit-2d-open").cspace()
    first, second = (free_fraction(cspace, 7, Budget(lines=3000)) for _ in range(2))
    assert first.fraction == second.fraction
    assert np.array_equal(first.layers, second.layers)
    assert free_fraction(cspace, 8, Budget(lines=3000)).fraction != first.fraction


def test_budgets_end_the_work():
    cspace = load_scenario("rabbit-2d-open").cspace()
    assert 3000 <= free_fraction(cspace, 0, Budget(lines=3000)).fraction.lines < 5000
    wanted = free_fraction(cspace, 0, Budget(half_width=1e-3)).fraction
    assert wanted.half_width <= 1e-3
    assert 0 < free_fraction(cspace, 0, Budget(time_limit=1e-9)).fraction.lines < 3000
    calls = []

    def stop():
        calls.append(1)
        return len(calls) == 3

    stopped = free_fraction(cspace, 0, Budget(should_stop=stop))
    assert len(calls) == 3
    assert stopped.fraction.lines < 5000
    told = []
    free_fraction(cspace, 0, Budget(time_limit=0.3), on_progress=told.append)
    assert told and all(0.0 < estimate.value < 1.0 for estimate in told)


@pytest.mark.parametrize("wrong", [{"lines": 0}, {"half_width": -1.0}, {"time_limit": math.nan}])
def test_budgets_that_make_no_sense(wrong):
    with pytest.raises(GeometryError, match=next(iter(wrong)).replace("_", " ")):
        Budget(**wrong)


def test_a_confidence_that_makes_no_sense():
    with pytest.raises(GeometryError, match="between 0 and 1"):
        free_fraction(load_scenario("rabbit-2d-open").cspace(), confidence=1.0)


# --- layers ---------------------------------------------------------------------------------------


def test_layers_add_up_to_the_whole():
    cspace = load_scenario("rabbit-2d-narrow").cspace()
    headings = np.linspace(-math.pi, math.pi, 48, endpoint=False) + 0.01
    shares = [layer_fraction(cspace, [0, 0, a], 1, Budget(lines=1000)) for a in headings]
    mean = np.mean([one.fraction.value for one in shares])
    whole = free_fraction(cspace, 1, FEW)
    assert mean == pytest.approx(whole.fraction.value, rel=0.02)
    assert whole.layers.mean() == pytest.approx(whole.fraction.value, rel=1e-12)
    freest = layer_fraction(cspace, whole.freest, 1, Budget(lines=1000))
    assert freest.fraction.value > 0.95 * max(one.fraction.value for one in shares)


@pytest.mark.parametrize("case", ["free snake", "chain"])
def test_a_layer_of_joints(case):
    robot, world = ARTICULATED[case]
    cspace = CSpace(world, robot)
    straight = np.zeros(robot.configuration_size)
    if case == "chain":
        straight[6::4] = 1.0
    found = layer_fraction(cspace, straight, 1, FEW)
    rows = np.repeat(straight[None], 20_000, axis=0)
    n = cspace.dimension
    rows[:, :n] = uniform(cspace, len(rows), 4)[:, :n]
    share = float(np.mean(cspace.are_valid(rows)))
    spread = math.sqrt(share * (1.0 - share) / len(rows) + found.fraction.standard_error**2)
    assert abs(share - found.fraction.value) < 4.0 * spread


def test_a_layer_that_collides_with_itself_is_not_free():
    robot, world = ARTICULATED["free snake"]
    rolled = np.array([0.0, 0.0, 0.0, 2.3, 2.3, 2.3])
    found = layer_fraction(CSpace(world, robot), rolled, 1, FEW)
    assert found.fraction.value == 0.0


def test_a_fixed_base_has_no_layers():
    robot, world = ARTICULATED["fixed snake"]
    with pytest.raises(GeometryError, match="no layers"):
        layer_fraction(CSpace(world, robot), np.zeros(3))
