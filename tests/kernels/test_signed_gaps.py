"""Distances of needles and discs, and depths, against bounds that need no iteration."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rows import body_rows, placed_row
from ellipsoid_planning.kernels.layout import PLACED
from ellipsoid_planning.kernels.separation import AIM, CONVERGE, DECIDE, separation
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World

KINDS = ("needle", "disc", "round")


def random_body(rng, n, kind, spread):
    axes = 10.0 ** rng.uniform(-0.5, 0.5, n)
    thin = 10.0 ** rng.uniform(-6.0, -2.0)
    if kind == "needle":
        axes[1:] = thin
    elif kind == "disc":
        axes[-1] = thin
    if n == 2:
        return Ellipsoid.from_semi_axes(axes, rng.normal(size=n) * spread, rng.uniform(0.0, 6.0))
    turn = Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix()
    return Ellipsoid.from_semi_axes(axes, rng.normal(size=n) * spread, turn)


def gap_and_direction(first, second, required=math.inf, mode=CONVERGE):
    placed = np.empty((1, PLACED))
    placed[0] = placed_row(second)
    value, *direction, _ = separation(body_rows([first]), 0, placed, 0, 0.5, required, mode)
    return value, np.array(direction[: first.dimension])


def distance_of_support_points(first, second, u):
    """The distance of two points of the bodies: never less than the bodies' distance."""
    return float(np.linalg.norm(second.support_points(-u) - first.support_points(u)))


@pytest.mark.parametrize("n", [2, 3])
def test_distances_are_enclosed_to_a_millionth(n):
    rng = np.random.default_rng(n)
    apart = 0
    for _ in range(700):
        bodies = [random_body(rng, n, kind, 2.0) for kind in rng.choice(KINDS, 2)]
        value, u = gap_and_direction(*bodies)
        if value > 0.0:
            apart += 1
            assert value >= (1.0 - 1e-6) * distance_of_support_points(*bodies, u)
    assert apart > 450


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("mode", [DECIDE, AIM])
def test_a_distance_that_is_there_is_proved(n, mode):
    rng = np.random.default_rng(10 + n)
    for _ in range(200):
        bodies = [random_body(rng, n, kind, 3.0) for kind in rng.choice(KINDS, 2)]
        value, _ = gap_and_direction(*bodies)
        if value > 1e-3:
            assert (
                gap_and_direction(*bodies, required=0.9999 * value, mode=mode)[0] > 0.9999 * value
            )
            assert not gap_and_direction(*bodies, required=1.0001 * value, mode=mode)[0] > value * (
                1.0 + 1e-9
            )


def test_needles_keep_their_distance():
    """A blade beside a needle: the polish of the direction used to stop at two thirds of it."""
    needle = Ellipsoid.from_semi_axes([2.8, 5.6e-05], [1.4, 1.07], math.radians(21.0))
    blade = Ellipsoid.from_semi_axes([1.0, 3.5e-04], [-1.22, 0.435], math.radians(-150.5))
    value, u = gap_and_direction(needle, blade)
    assert value == pytest.approx(distance_of_support_points(needle, blade, u), rel=1e-7)


def depth_by_search(part, obstacle, rng):
    """The shallowest way apart, by a local search from many directions."""
    best = math.inf
    for start in rng.normal(size=(40, part.dimension)):
        best = min(best, minimize(_overlap, start, (part, obstacle), method="BFGS").fun)
    return best


def _overlap(u, part, obstacle):
    u = u / np.linalg.norm(u)
    return float(obstacle.support(u) + part.support(-u))


@pytest.mark.parametrize("n", [2, 3])
def test_depth_is_the_shallowest_way_out(n):
    rng = np.random.default_rng(20 + n)
    found = 0
    while found < 5:
        obstacle, part = (random_body(rng, n, kind, 0.3) for kind in ("round", rng.choice(KINDS)))
        robot = RigidRobot((part,), rotates=False)
        bounds = np.full(n, -9.0), np.full(n, 9.0)
        cspace = CSpace(World(*bounds, (obstacle,)), robot)
        clearance = cspace.clearance(np.zeros(n))
        if clearance < 0.0:
            found += 1
            assert -clearance == pytest.approx(depth_by_search(part, obstacle, rng), rel=1e-5)
            assert cspace.explain(np.zeros(n))[0].depth == pytest.approx(-clearance, rel=1e-6)


@pytest.mark.parametrize("n", [2, 3])
def test_clearance_outside_an_arena_is_how_far_the_part_sticks_out(n):
    rng = np.random.default_rng(30 + n)
    for _ in range(5):
        arena = random_body(rng, n, "round", 0.0)
        part = Ellipsoid.from_semi_axes(0.2 * random_body(rng, n, "round", 0.0).semi_axes)
        robot = RigidRobot((part,), rotates=False)
        world = World(np.full(n, -9.0), np.full(n, 9.0), (), (arena,))
        at = 1.2 * arena.surface_points(7)[3]
        cspace = CSpace(world, robot)
        moved = part.transform(np.eye(n), at)
        starts = rng.normal(size=(30, n))
        out = -min(minimize(_inside, u, (moved, arena), method="BFGS").fun for u in starts)
        assert cspace.clearance(at) == pytest.approx(-out, rel=1e-5)
        assert cspace.explain(at)[0].depth == pytest.approx(out, rel=1e-5)


def _inside(u, part, arena):
    u = u / np.linalg.norm(u)
    return float(arena.support(u) - part.support(u))
