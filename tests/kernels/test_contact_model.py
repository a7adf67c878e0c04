"""Gaps and gradients of the contact model against independent gaps and their finite differences."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from ellipsoid_planning.kernels import contact_model as model_kernel
from ellipsoid_planning.kernels import layout
from tests.close_quarters import (
    cornered,
    obstacle_gaps,
    placed,
    reach,
    smallest_gaps,
    stepped,
    steps_of,
    wall_rooms,
)
from tests.motion_oracle import Scene
from tests.oracles import Body, signed_gap_by_search
from tests.random_scenes import matrix, rotation, space_of, unit_vector

H = 1e-6


def memory():
    """What the kernel remembers between calls: nothing yet."""
    return np.full(256, -1, dtype=np.int64), np.full((256, 3), np.nan)


def modelled(scene, pose, within, *, clearance=0.0, turns=True, known=None):
    """Rows (k, 7) of the kernel's model, gap and gradient, the smallest gap first."""
    packed = space_of(scene, clearance).scene
    model = np.full((model_kernel.CAPACITY, model_kernel.MODEL + 6), np.nan)
    work = np.zeros(1, dtype=np.int64)
    inverse = 1.0 / reach(scene) if turns else 0.0
    before = pose.copy()
    count = model_kernel.contact_model(
        packed, layout.new_placed(packed), pose, within, inverse, model, work, *(known or memory())
    )
    np.testing.assert_array_equal(pose, before)
    rows = model[:count, :7]
    assert np.isfinite(rows).all()
    return rows[np.argsort(rows[:, 0])]


def differences(gaps, scene, pose, *, turns=True):
    """Gaps (k,) at a pose and their central differences (k, 6) along steps."""
    along = steps_of(scene.dimension, turns=turns)
    length = reach(scene)
    both = np.concatenate([H * along, -H * along, np.zeros((1, 6))])
    values = gaps(scene, stepped(pose, both, length)).reshape(len(both), -1)
    slopes = (values[: len(along)] - values[len(along) : -1]) / (2 * H)
    return values[-1], slopes.T @ along


def assert_rows_match(rows, gaps, gradients, *, gap=1e-9, slope=1e-6):
    order = np.argsort(gaps)
    assert len(rows) == len(gaps)
    np.testing.assert_allclose(rows[:, 0], gaps[order], atol=gap, rtol=0)
    np.testing.assert_allclose(rows[:, 1:], gradients[order], atol=slope, rtol=0)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_rows_of_obstacles_are_gaps_and_their_gradients(n, clearance):
    rng = np.random.default_rng(1)
    for _ in range(6):
        scene, pose = cornered(rng, n, list(10 ** rng.uniform(-3, 0, size=5)))
        gaps, gradients = differences(obstacle_gaps, scene, pose)
        near = gaps - clearance < 0.3
        rows = modelled(scene, pose, 0.3, clearance=clearance)
        assert near.sum() >= 2
        assert_rows_match(rows, gaps[near] - clearance, gradients[near])


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize(("kind", "ratio"), [("sphere", 1), ("needle", 1e2), ("needle", 1e4)])
def test_spheres_and_needles(n, kind, ratio):
    rng = np.random.default_rng(2)
    for _ in range(6):
        gaps = list(10 ** rng.uniform(-4, -0.5, size=4))
        scene, pose = cornered(rng, n, gaps, kind, ratio, parts=1)
        values, gradients = differences(obstacle_gaps, scene, pose)
        rows = modelled(scene, pose, 0.5)
        # The tip of a needle bends by the ratio: its central differences are that much worse.
        assert_rows_match(rows, values, gradients, gap=1e-8, slope=1e-5 * ratio)
        np.testing.assert_allclose(np.linalg.norm(rows[:, 1:4], axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize("n", [2, 3])
def test_shallow_contacts_have_negative_gaps_and_gradients_that_lead_out(n):
    rng = np.random.default_rng(3)
    for _ in range(6):
        scene, pose = cornered(rng, n, [-0.05, -0.01, 0.02], parts=1)
        values, gradients = differences(obstacle_gaps, scene, pose)
        rows = modelled(scene, pose, 0.5)
        assert_rows_match(rows, values, gradients, slope=1e-5)
        deepest = signed_gap_by_search(
            scene.obstacles[0],
            Body(
                pose[:n] + frame(pose, n) @ scene.parts[0].centre,
                frame(pose, n) @ scene.parts[0].matrix,
            ),
        )
        assert rows[:, 0].min() <= deepest + 1e-9


@pytest.mark.parametrize("n", [2, 3])
def test_deep_contacts_and_common_centres_give_finite_rows(n):
    rng = np.random.default_rng(4)
    part, body = (Body(np.zeros(n), matrix(rng, n)) for _ in range(2))
    for obstacle in (body, part, Body(1e-300 * np.ones(n), body.matrix)):
        scene = Scene(np.full(n, -9.0), np.full(n, 9.0), (obstacle,), (), (part,))
        rows = modelled(scene, np.array([0.0, 0, 0, 0, 0, 0, 1]), 0.5)
        assert len(rows) == 1
        assert rows[0, 0] < 0.0
        assert np.linalg.norm(rows[0, 1:4]) == pytest.approx(1.0)


def frame(pose, n):
    return Rotation.from_quat(pose[3:]).as_matrix()[:n, :n]


@pytest.mark.parametrize("n", [2, 3])
def test_a_planar_or_fixed_robot_has_no_gradient_where_it_cannot_go(n):
    rng = np.random.default_rng(5)
    scene, pose = cornered(rng, n, [0.1, 0.2, 0.01])
    kept = modelled(scene, pose, 0.5, turns=False)
    assert (kept[:, 4:] == 0.0).all()
    if n == 2:
        assert (modelled(scene, pose, 0.5)[:, 3:6] == 0.0).all()
    _, gradients = differences(obstacle_gaps, scene, pose, turns=False)
    gaps = obstacle_gaps(scene, pose[None]).ravel()
    near = gaps < 0.5
    assert_rows_match(kept, gaps[near], gradients[near])


def test_the_widest_gaps_are_left_out_when_there_are_too_many():
    rng = np.random.default_rng(6)
    scene, pose = cornered(rng, 3, list(rng.uniform(0.01, 0.4, size=50)), parts=1)
    rows = modelled(scene, pose, 0.5)
    assert len(rows) == model_kernel.CAPACITY
    nearest = np.sort(obstacle_gaps(scene, pose[None]).ravel())[: len(rows)]
    np.testing.assert_allclose(rows[:, 0], nearest, atol=1e-9)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize(("kind", "ratio"), [("mild", 3.0), ("needle", 30.0), ("disc", 100.0)])
def test_what_is_remembered_of_other_poses_does_not_change_gaps(n, kind, ratio):
    """Through bodies and out on their other sides, as centring jumps."""
    rng = np.random.default_rng(11)
    for _ in range(3):
        scene, pose = cornered(rng, n, list(rng.uniform(-0.3, 0.3, 4)), kind, ratio)
        plates = tuple(Body(b.centre, b.matrix * [0.02, 1, 1][:n]) for b in scene.obstacles)
        scene = scene._replace(obstacles=plates)
        known = memory()
        for size in (1e-3, 0.1, 1.0, 3.0):
            steps = size * rng.normal(size=(6, len(steps_of(n)))) @ steps_of(n)
            for moved in stepped(pose, steps, reach(scene)):
                gaps = obstacle_gaps(scene, moved[None]).ravel()
                rows = modelled(scene, moved, 0.5, known=known)
                apart = np.sort(gaps[(gaps > 0.0) & (gaps < 0.5)])
                assert len(rows) == np.sum(gaps < 0.5)
                np.testing.assert_allclose(rows[rows[:, 0] > 0.0, 0], apart, atol=1e-9)


# --------------------------------------------------------------------------- arenas


def at_walls(rng, n, gaps, part_ratio=2.0):
    """A robot of one part that is these gaps away from the wall of an arena each, and its pose."""
    part = Body(rng.uniform(-0.3, 0.3, n), matrix(rng, n, "mild", part_ratio, 0.8))
    turn, base = rotation(rng, n), rng.uniform(-1, 1, n)
    arenas = []
    for gap in gaps:
        a = matrix(rng, n, "mild", 1.5, 8.0)
        u = unit_vector(rng, n)
        wall = a @ (a.T @ u) / np.linalg.norm(a.T @ u)
        b = turn @ part.matrix
        tip = b @ (b.T @ u) / np.linalg.norm(b.T @ u)
        arenas.append(Body(base + turn @ part.centre + tip + gap * u - wall, a))
    scene = Scene(np.full(n, -9.0), np.full(n, 9.0), (), tuple(arenas), (part,))
    whole = np.eye(3)
    whole[:n, :n] = turn
    pose = np.concatenate([base, np.zeros(3 - n), Rotation.from_matrix(whole).as_quat()])
    return scene, pose


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rows_of_arenas_are_exact_at_contact(n, sign):
    rng = np.random.default_rng(7)
    for size in (1e-6, 1e-4, 1e-2):
        for _ in range(4):
            scene, pose = at_walls(rng, n, [sign * size, 2.0 * sign * size])
            gaps, gradients = differences(wall_rooms, scene, pose)
            rows = modelled(scene, pose, 10 * size)
            # Nothing is smaller than a twentieth of the part's size, so that gaps and gradients
            # are off by a few times the gap at most.
            order = np.argsort(gaps)
            near = [np.argmin(np.abs(rows[:, 0] - gap)) for gap in gaps[order]]
            np.testing.assert_allclose(rows[near, 0], gaps[order], atol=5 * size**2 + 1e-12)
            np.testing.assert_allclose(rows[near, 1:], gradients[order], atol=5 * size + 1e-5)


def nearest_places(scene, pose, count=4000):
    """Gaps (k,) and gradients (k, 6) where a planar part is locally nearest to a round wall."""
    (centres, matrices), arena = placed(scene, pose[None])[0], scene.arenas[0]
    radius = arena.matrix[0, 0]

    def away(v):
        point = centres[0] + matrices[0] @ np.array([np.cos(v), np.sin(v)]) - arena.centre
        return radius - float(np.linalg.norm(point))

    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    values = np.array([away(v) for v in angles])
    gaps, gradients = [], []
    for k in np.flatnonzero((values < np.roll(values, 1)) & (values <= np.roll(values, -1))):
        step = 2 * np.pi / count
        found = minimize_scalar(
            away, bounds=(angles[k] - step, angles[k] + step), options={"xatol": 1e-12}
        )
        v = np.array([np.cos(found.x), np.sin(found.x)])
        point = centres[0] + matrices[0] @ v
        inwards = -(point - arena.centre) / np.linalg.norm(point - arena.centre)
        lever = point - pose[:2]
        torque = (lever[0] * inwards[1] - lever[1] * inwards[0]) / reach(scene)
        gaps.append(float(found.fun))
        gradients.append([*inwards, 0.0, 0.0, 0.0, torque])
    return np.array(gaps), np.array(gradients)


def lying_in_a_bowl(n, gap, tilt=0.0, share=0.0):
    """A long part, both of whose ends are about `gap` from the round wall of an arena."""
    half, radius = 1.5, 3.0
    a = np.diag([half, 0.2, 0.3][:n])
    scene = Scene(
        np.full(n, -9.0),
        np.full(n, 9.0),
        (),
        (Body(np.zeros(n), np.diag([radius, radius, 6.0][:n])),),
        (Body(np.zeros(n), a),),
    )
    # Slid down until the nearer end is at the gap.
    low, high = 0.0, radius
    for _ in range(80):
        down = 0.5 * (low + high)
        pose = bowl_pose(down, tilt, share)
        if smallest_gaps(scene, pose[None])[0] > gap:
            low = down
        else:
            high = down
    return scene, pose


def bowl_pose(down, tilt, share):
    base = np.zeros(3)
    base[:2] = share, -down
    return np.concatenate([base, Rotation.from_rotvec([0, 0, tilt]).as_quat()])


@pytest.mark.parametrize("tilt", [0.0, 1e-3, -0.02, 0.2, np.pi])
def test_a_part_that_is_near_a_wall_at_both_ends_has_a_row_for_each(tilt):
    for gap in (1e-9, 1e-5, 1e-3, 1e-2):
        scene, pose = lying_in_a_bowl(2, gap, tilt)
        gaps, gradients = nearest_places(scene, pose)
        assert len(gaps) == 2
        rows = modelled(scene, pose, 1.0)
        assert rows[0, 0] == pytest.approx(gap, abs=1e-12)
        for expected, gradient in zip(gaps, gradients, strict=True):
            apart = np.abs(rows[:, 0] - expected) + np.linalg.norm(rows[:, 1:] - gradient, axis=1)
            # Known to first order, and the nearest place to rounding.
            assert apart.min() <= 1e-3 + 0.02 * expected


def test_a_part_in_space_is_near_a_wall_at_both_ends_too():
    scene, pose = lying_in_a_bowl(3, 1e-3)
    rows = modelled(scene, pose, 0.1)
    assert len(rows) == 2
    np.testing.assert_allclose(rows[:, 0], 1e-3, rtol=0.01)
    np.testing.assert_allclose(rows[0, 6], -rows[1, 6], rtol=1e-3)


@pytest.mark.parametrize("n", [2, 3])
def test_the_least_row_of_a_wall_is_its_nearest_place_however_long_the_part(n):
    rng = np.random.default_rng(8)
    for ratio in (1.0, 6.0, 50.0):
        for _ in range(8):
            scene, pose = at_walls(rng, n, [10 ** rng.uniform(-8, -3)], part_ratio=ratio)
            rows = modelled(scene, pose, 1.0)
            room = wall_rooms(scene, pose[None]).item()
            assert rows[0, 0] == pytest.approx(room, rel=1e-2, abs=1e-13)


# --------------------------------------------------------------------------- which pairs


@pytest.mark.parametrize("n", [2, 3])
def test_pairs_beyond_within_are_absent_and_far_ones_cost_nothing(n):
    rng = np.random.default_rng(9)
    scene, pose = cornered(rng, n, [0.05, 0.15, 0.4], parts=2)
    far = tuple(Body(pose[:n] + 40.0 * unit_vector(rng, n), matrix(rng, n)) for _ in range(300))
    crowded = scene._replace(obstacles=scene.obstacles + far)
    for within in (0.01, 0.1, 0.3, 1.0):
        rows = modelled(crowded, pose, within)
        gaps = np.sort(obstacle_gaps(scene, pose[None]).ravel())
        np.testing.assert_allclose(rows[:, 0], gaps[gaps < within], atol=1e-9)
    packed, work = space_of(crowded).scene, np.zeros(1, dtype=np.int64)
    model = np.empty((model_kernel.CAPACITY, model_kernel.MODEL + 6))
    model_kernel.contact_model(
        packed, layout.new_placed(packed), pose, 0.5, 1.0, model, work, *memory()
    )
    assert work[0] <= 6


def test_steps_move_poses_as_they_say_and_back():
    rng = np.random.default_rng(10)
    packed = np.empty(0)  # a rigid robot's steps depend on nothing else
    pose = np.append(rng.normal(size=3), rotation_quaternion(rng))
    for size in (1e-14, 1e-9, 1e-4, 1.0, 3.0):
        step = size * rng.normal(size=6)
        out, back = np.empty(7), np.empty(6)
        model_kernel.moved(packed, pose, step, 1 / 1.7, out)
        expected = stepped(pose, step[None], 1.7)[0]
        expected[3:] *= np.sign(expected[3:] @ out[3:])
        np.testing.assert_allclose(out, expected, atol=1e-14)
        model_kernel.difference(packed, pose, out, 1.7, back)
        shortest = Rotation.from_rotvec(step[3:] / 1.7).as_rotvec() * 1.7
        np.testing.assert_allclose(back, np.append(step[:3], shortest), atol=1e-14 + 1e-12 * size)


def rotation_quaternion(rng):
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)
