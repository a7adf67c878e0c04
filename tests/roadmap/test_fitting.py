"""Directions along which robots are narrowest, against dense widths and scipy."""

import numpy as np
import pytest
from scipy.optimize import minimize, minimize_scalar

from ellipsoid_planning.cspace.fitting import narrowest_directions, width
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from tests.oracles import sphere_grid
from tests.random_scenes import matrix, rotation, semi_axes

DENSE = 4001


def robot_of(rng, n, parts, kind="mild", ratio=4.0):
    return RigidRobot(
        tuple(
            Ellipsoid(
                rng.uniform(-1.0, 1.0, n) * (k > 0),
                rotation(rng, n),
                rng.uniform(0.3, 1.0) * semi_axes(rng, n, kind, ratio),
            )
            for k in range(parts)
        )
    )


def width_along(robot, u):
    """The distance of the two planes of normal u that the robot just fits between."""
    ahead = max(part.centre @ u + np.linalg.norm(part.matrix.T @ u) for part in robot.parts)
    behind = max(-part.centre @ u + np.linalg.norm(part.matrix.T @ u) for part in robot.parts)
    return ahead + behind


def planar(angle):
    return np.array([np.cos(angle), np.sin(angle)])


def least_widths(robot):
    """Angles in [0, π) of all local minima of a planar robot's width, and the widths there."""
    angles = np.linspace(0.0, np.pi, DENSE)[:-1]
    widths = np.array([width_along(robot, planar(t)) for t in angles])
    lowest = np.flatnonzero((widths < np.roll(widths, 1)) & (widths <= np.roll(widths, -1)))
    found = []
    for k in lowest:
        around = angles[k] + np.array([-1.0, 1.0]) * np.pi / (DENSE - 1)
        polished = minimize_scalar(
            lambda t: width_along(robot, planar(t)), bounds=around, options={"xatol": 1e-13}
        )
        best = polished if polished.fun < widths[k] else None
        found.append((polished.x, polished.fun) if best is not None else (angles[k], widths[k]))
    return np.array(found)


def assert_all_found(robot):
    expected = least_widths(robot)
    found = narrowest_directions(robot)
    values = np.array([width_along(robot, v) for v in found])
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, atol=1e-14)
    assert (np.diff(values) >= -1e-15).all()
    np.testing.assert_allclose(values, np.sort(expected[:, 1]), atol=1e-9)
    for angle, _ in expected:
        assert np.abs(found @ planar(angle)).max() >= 1.0 - 1e-8


@pytest.mark.parametrize("parts", [1, 2, 4])
@pytest.mark.parametrize(("kind", "ratio"), [("mild", 3.0), ("needle", 30.0)])
def test_all_local_minima_of_planar_robots_are_found(parts, kind, ratio):
    rng = np.random.default_rng(1)
    for _ in range(3):
        assert_all_found(robot_of(rng, 2, parts, kind, ratio))


@pytest.mark.parametrize("turn", [0.0, 1e-15, -1e-15, 1e-9, np.pi / 4, np.pi / 2, np.pi])
def test_axes_that_lie_along_the_frame_are_found_too(turn):
    """Minima where the half turn of directions begins and ends."""
    cross = RigidRobot(
        (
            Ellipsoid.from_semi_axes([0.5, 1.0], rotation=turn),
            Ellipsoid.from_semi_axes([0.1, 1.1], rotation=turn + 0.6),
        )
    )
    single = RigidRobot((Ellipsoid.from_semi_axes([0.4, 1.0], rotation=turn),))
    l_shape = RigidRobot(
        (
            Ellipsoid.from_semi_axes([0.2, 1.5], rotation=turn),
            Ellipsoid.from_semi_axes(
                [0.8, 0.2], position=[np.cos(turn), np.sin(turn)], rotation=turn
            ),
        )
    )
    for robot in (single, cross, l_shape):
        assert_all_found(robot)


def test_needles_as_thin_as_can_be():
    for ratio in (1e3, 1e6):
        for turn in (0.0, 1e-4, 0.3):
            needle = RigidRobot((Ellipsoid.from_semi_axes([1.0, 1 / ratio], rotation=turn),))
            (found,) = narrowest_directions(needle)
            assert width_along(needle, found) == pytest.approx(2 / ratio, abs=1e-9)


@pytest.mark.parametrize("n", [2, 3])
def test_balls_are_as_wide_along_every_direction(n):
    ball = RigidRobot((Ellipsoid.from_semi_axes(np.full(n, 0.7), position=np.ones(n)),))
    found = narrowest_directions(ball)
    assert len(found) >= 1
    np.testing.assert_allclose(width(ball, found), 1.4, rtol=1e-14)


def test_two_discs_side_by_side_are_narrowest_across():
    discs = RigidRobot(
        tuple(Ellipsoid.from_semi_axes([0.5, 0.5], position=[x, 0.3 * x]) for x in (-1.0, 1.0))
    )
    found = narrowest_directions(discs)
    across = np.array([-0.3, 1.0]) / np.hypot(0.3, 1.0)
    assert len(found) == 1
    assert abs(found[0] @ across) == pytest.approx(1.0, abs=1e-12)
    assert width_along(discs, found[0]) == pytest.approx(1.0, abs=1e-12)


def test_widths_are_those_of_dense_points():
    rng = np.random.default_rng(2)
    for n in (2, 3):
        robot = robot_of(rng, n, 3)
        grid = sphere_grid(4000 if n == 2 else 40000, n)
        points = np.vstack([p.centre + grid @ p.matrix.T for p in robot.parts])
        directions = sphere_grid(9, n)
        along = points @ directions.T
        np.testing.assert_allclose(
            width(robot, directions), np.ptp(along, axis=0), rtol=1e-3 if n == 3 else 1e-5
        )


@pytest.mark.parametrize("parts", [1, 2, 3])
def test_no_start_finds_a_spatial_robot_narrower(parts):
    rng = np.random.default_rng(3)
    for kind, ratio in (("mild", 3.0), ("blade", 20.0)):
        robot = robot_of(rng, 3, parts, kind, ratio)
        found = narrowest_directions(robot)
        least = min(
            minimize(
                lambda v, robot=robot: width_along(robot, v / np.linalg.norm(v)),
                start,
                method="Nelder-Mead",
                options={"xatol": 1e-11, "fatol": 1e-13, "maxiter": 4000},
            ).fun
            for start in rng.normal(size=(10, 3))
        )
        assert width_along(robot, found[0]) <= least * (1 + 1e-4)
        assert (np.abs(found @ found.T) - np.eye(len(found)) < 1.0 - 1e-9).all()


def test_each_direction_of_a_spatial_robot_is_a_local_minimum():
    rng = np.random.default_rng(4)
    for _ in range(3):
        robot = robot_of(rng, 3, 2)
        for v in narrowest_directions(robot):
            nearby = v + 10.0 ** rng.uniform(-6, -1, (300, 1)) * rng.normal(size=(300, 3))
            nearby /= np.linalg.norm(nearby, axis=1, keepdims=True)
            assert width(robot, nearby).min() >= width_along(robot, v) * (1 - 1e-3)


def test_an_ellipsoid_has_one_narrowest_direction():
    rng = np.random.default_rng(5)
    for _ in range(12):
        a = matrix(rng, 3, "blade", 8.0)
        axes = np.linalg.norm(a, axis=0)
        body = Ellipsoid(np.ones(3), a / axes * [1, 1, np.linalg.det(a / axes)], axes)
        found = narrowest_directions(RigidRobot((body,)))
        k = int(np.argmin(axes))
        assert len(found) == 1
        assert abs(found[0] @ a[:, k]) / axes[k] == pytest.approx(1.0, abs=1e-9)
