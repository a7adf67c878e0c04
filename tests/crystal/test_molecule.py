import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.packing.molecule import molecule_of
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import molecule as kernels
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


def free_configuration(model, rng):
    return np.array([rng.uniform(r.lower, r.upper) for r in model.grid.ranges])


def as_robot_configuration(model, q):
    """The scenario format's configuration of the same arrangement, for an orthogonal cell."""
    whole = model.molecule
    named = dict(zip([c.name for c in whole.coordinates], q, strict=True))
    n = model.dimension
    position = [named.get(name, 0.0) for name in "xyz"[:n]]
    if n == 2:
        base = [*position, named["yaw"]]
    else:
        turn = Rotation.from_euler("ZXZ", [named[k] for k in ("alpha", "beta", "gamma")])
        base = [*position, *turn.as_quat()]
    return np.array([*base, *(named[j.name] for j in whole.robot.moving_joints)])


@pytest.mark.parametrize("name", NAMES)
def test_parts_stand_where_the_articulated_robot_puts_them(name):
    model = load_model(name)
    rng = np.random.default_rng(3)
    for _ in range(20):
        q = free_configuration(model, rng)
        bodies = model.molecule.bodies(q)
        expected = model.molecule.robot.bodies_at(as_robot_configuration(model, q))
        centres, matrices = model.molecule.placed(q)
        n = model.dimension
        for k, (body, other) in enumerate(zip(bodies, expected, strict=True)):
            np.testing.assert_allclose(body.centre, other.centre, atol=1e-12)
            np.testing.assert_allclose(body.shape_matrix, other.shape_matrix, atol=1e-12)
            np.testing.assert_allclose(centres[k, :n], other.centre, atol=1e-12)
            a = matrices[k, :n, :n]
            np.testing.assert_allclose(a @ a.T, other.shape_matrix, atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_axes_of_motion_give_the_rates_of_centres(name):
    model = load_model(name)
    whole = model.molecule
    q = free_configuration(model, np.random.default_rng(5))
    frames = whole.frames(q)
    lines = np.empty((len(q), 6))
    kernels.motion_axes(whole.axes, frames, lines)
    step = 1e-6
    for k, coordinate in enumerate(whole.coordinates):
        change = np.zeros(len(q))
        change[k] = step
        after, before = whole.placed(q + change)[0], whole.placed(q - change)[0]
        for p, rate in enumerate((after - before) / (2 * step)):
            frame = int(whole.part_frames[p])
            while frame > k:
                frame = int(whole.parents[frame])
            centre = whole.placed(q)[0][p]
            moved = np.zeros(3)
            if frame == k:
                axis, point = lines[k, :3], lines[k, 3:]
                moved = np.cross(axis, centre - point) if coordinate.turns else axis
            np.testing.assert_allclose(rate, moved, atol=1e-8)


def test_shifts_go_along_the_axes_of_a_skew_cell():
    basis = np.array([[2.0, 1.0], [0.0, 1.5]])
    robot = ArticulatedRobot((Link("one", (Ellipsoid.from_semi_axes([1.0, 0.5]),)),), ())
    whole = molecule_of(robot, basis, shifts=(1, 0))
    assert [c.key for c in whole.coordinates] == ["x", "y", "yaw_deg"]
    centres, _ = whole.placed([0.5, 2.0, 0.3])
    along = basis / np.linalg.norm(basis, axis=0)
    np.testing.assert_allclose(centres[0, :2], 0.5 * along[:, 0] + 2.0 * along[:, 1])


def test_fixed_joints_carry_links_along():
    joints = (
        Joint.of("bend", "root", "arm", "revolute", [1, 0, 0], None, [0, 0, 1], -1, 1),
        Joint.of(
            "weld", "arm", "hand", "fixed", [0, 2, 0], Rotation.from_rotvec([0.4, 0, 0]).as_matrix()
        ),
        Joint.of("slide", "hand", "tip", "prismatic", [0, 0, 1], None, [0, 0, 2], -1, 1),
    )
    body = (Ellipsoid.from_semi_axes([1, 0.5, 0.3], [0.1, 0.2, 0.3]),)
    links = tuple(Link(name, body) for name in ("root", "arm", "hand", "tip"))
    robot = ArticulatedRobot(links, joints)
    whole = molecule_of(robot, np.eye(3))
    bodies = whole.bodies([0.2, 0.5, -0.3, 0.7, -0.4])
    turn = Rotation.from_euler("ZXZ", [0.2, 0.5, -0.3]).as_quat()
    expected = robot.bodies_at([0, 0, 0, *turn, 0.7, -0.4])
    for one, other in zip(bodies, expected, strict=True):
        np.testing.assert_allclose(one.centre, other.centre, atol=1e-12)
        np.testing.assert_allclose(one.shape_matrix, other.shape_matrix, atol=1e-12)


def test_a_ball_joint_is_refused_with_a_remedy():
    joint = Joint.of("hip", "root", "leg", "ball", [0, 0, 0])
    body = (Ellipsoid.from_semi_axes([1, 1, 1]),)
    robot = ArticulatedRobot((Link("root", body), Link("leg", body)), (joint,))
    with pytest.raises(CrystalError, match=r"'hip'.*three\s+revolute"):
        molecule_of(robot, np.eye(3))


@pytest.mark.parametrize("euler", ["ZX", "ZZX", "ABC", "XYY"])
def test_turns_that_are_no_euler_axes_are_refused(euler):
    robot = ArticulatedRobot((Link("one", (Ellipsoid.from_semi_axes([1, 1, 1]),)),), ())
    with pytest.raises(CrystalError, match="three Euler axes"):
        molecule_of(robot, np.eye(3), euler=euler)


@pytest.mark.parametrize("bad", [[0.0], [0.0] * 8, [math.nan] * 7])
def test_a_configuration_of_another_size_or_not_finite_is_refused(bad):
    with pytest.raises(CrystalError, match="7 finite numbers"):
        load_model("rabbit-p1").molecule.bodies(bad)
