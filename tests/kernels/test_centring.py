"""Centring against independent gaps: local maxima, steps across a direction, honest gaps."""

import numpy as np
import pytest

from ellipsoid_planning.kernels import centring
from tests.close_quarters import (
    cornered,
    reach,
    smallest_gaps,
    stepped,
    steps_of,
)
from tests.motion_oracle import Scene
from tests.oracles import Body
from tests.random_scenes import matrix, space_of

WITHIN = 0.5
STILL = np.zeros(6)


def centred(scene, pose, across=STILL, *, turns=True, enough=10.0, precision=1e-6, steps=400):
    """The pose (7,) that a robot is moved to, with the gap and the slope there."""
    packed = space_of(scene).scene
    moved = pose.copy()
    work = centring.new_workspace(packed)
    gap, slope = centring.centre(
        packed, moved, across, turns, WITHIN, enough, precision, steps, work
    )
    assert np.isfinite(moved).all()
    assert np.linalg.norm(moved[3:]) == pytest.approx(1.0, abs=1e-12)
    return moved, gap, slope


def pressed(rng, n, *, count=6, overlap=False, kind="mild", ratio=3.0):
    """A robot with bodies close by on all sides."""
    gaps = rng.uniform(-0.1 if overlap else 0.01, 0.3, count)
    return cornered(rng, n, list(gaps), kind=kind, ratio=ratio)


def step_across(rng, n, *, turning):
    """A unit direction (6,) that a robot can move along."""
    along = steps_of(n, turns=turning)
    across = rng.normal(size=len(along)) @ along
    return across / np.linalg.norm(across)


def gain(scene, pose, across, *, turns=True, seed=0):
    """By how much small steps across a direction can raise the smallest gap: a random search."""
    rng = np.random.default_rng(seed)
    along = steps_of(scene.dimension, turns=turns)
    length, best = reach(scene), smallest_gaps(scene, pose[None])[0]
    first, here = best, pose
    for size in 10.0 ** np.arange(-2.0, -6.5, -0.5):
        steps = size * rng.normal(size=(100, len(along))) @ along
        steps -= np.outer(steps @ across, across)
        poses = stepped(here, steps, length)
        gaps = smallest_gaps(scene, poses)
        if gaps.max() > best:
            best, here = gaps.max(), poses[np.argmax(gaps)]
    return best - first


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("turns", [True, False])
def test_nothing_near_leaves_more_room(n, turns):
    rng = np.random.default_rng(1)
    for _ in range(6):
        scene, pose = pressed(rng, n)
        found, gap, _ = centred(scene, pose, turns=turns)
        if gap >= WITHIN:
            continue
        assert gap >= smallest_gaps(scene, pose[None])[0] - 1e-12
        assert gain(scene, found, STILL, turns=turns) <= 2e-3 * abs(gap)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("turning", [True, False])
def test_nothing_near_and_across_the_direction_leaves_more_room(n, turning):
    rng = np.random.default_rng(2)
    for _ in range(6):
        scene, pose = pressed(rng, n)
        across = step_across(rng, n, turning=turning)
        found, gap, _ = centred(scene, pose, across)
        if gap >= WITHIN:
            continue
        assert gain(scene, found, across) <= 2e-3 * abs(gap)


@pytest.mark.parametrize("n", [2, 3])
def test_steps_stay_across_a_translation(n):
    rng = np.random.default_rng(3)
    for overlap in (False, True):
        scene, pose = pressed(rng, n, overlap=overlap)
        across = step_across(rng, n, turning=False)
        for precision in (1e-2, 1e-6):
            found, _, _ = centred(scene, pose, across, precision=precision)
            assert np.linalg.norm(found - pose) > 1e-3
            assert (found - pose)[:3] @ across[:3] == pytest.approx(0.0, abs=1e-13)


def test_planar_steps_stay_across_a_turning_translation():
    rng = np.random.default_rng(4)
    scene, pose = pressed(rng, 2)
    across = step_across(rng, 2, turning=True)
    found, _, _ = centred(scene, pose, across)
    turned = 2.0 * (np.arctan2(found[5], found[6]) - np.arctan2(pose[5], pose[6]))
    turned = np.remainder(turned + np.pi, 2 * np.pi) - np.pi
    step = np.append((found - pose)[:3], [0.0, 0.0, reach(scene) * turned])
    assert np.linalg.norm(step) > 1e-3
    assert step @ across == pytest.approx(0.0, abs=1e-9)


def test_a_robot_that_does_not_turn_keeps_its_orientation():
    scene, pose = pressed(np.random.default_rng(5), 3)
    found, _, _ = centred(scene, pose, turns=False)
    np.testing.assert_allclose(found[3:], pose[3:], atol=1e-15)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("overlap", [False, True])
@pytest.mark.parametrize("turns", [False, True])
def test_the_gap_is_not_above_the_true_gap(n, overlap, turns):
    rng = np.random.default_rng(6)
    for steps in (0, 1, 3, 400):
        for kind, ratio in (("mild", 3.0), ("needle", 1e3)):
            scene, pose = pressed(rng, n, overlap=overlap, kind=kind, ratio=ratio)
            found, gap, _ = centred(scene, pose, turns=turns, steps=steps)
            assert gap <= smallest_gaps(scene, found[None])[0] + 1e-9
            assert gap <= WITHIN


@pytest.mark.parametrize("n", [2, 3])
def test_a_robot_that_overlaps_gets_out_where_there_is_room(n):
    """Two walls and a robot between that is drawn into one of them, up to its middle."""
    walls = tuple(
        Body(np.array([0.0, y, 0.0])[:n], np.diag([6.0, 2.0, 6.0][:n])) for y in (-2.6, 2.6)
    )
    part = Body(np.zeros(n), np.diag([1.0, 0.5, 0.5][:n]))
    scene = Scene(np.full(n, -9.0), np.full(n, 9.0), walls, (), (part,))
    along = np.eye(6)[0]
    for y in (-0.3, -0.1, 0.05, 0.4):
        pose = np.array([0.0, y, 0.0, 0.0, 0.0, np.sin(0.1), np.cos(0.1)])
        found, gap, slope = centred(scene, pose, along)
        assert gap == pytest.approx(0.1, rel=1e-5)
        assert abs(found[1]) <= 1e-4
        assert slope == pytest.approx(0.0, abs=1e-3)


def test_the_slope_tells_how_the_centred_gap_grows_along_the_direction():
    """Between two round bodies the gap grows both ways from the narrowest place."""
    bodies = tuple(Body(np.array([0.0, y]), 2.0 * np.eye(2)) for y in (-2.6, 2.6))
    part = Body(np.zeros(2), np.diag([0.7, 0.5]))
    scene = Scene(np.full(2, -9.0), np.full(2, 9.0), bodies, (), (part,))
    along, h = np.eye(6)[0], 1e-3
    for x in (-0.5, -0.1, 0.2):
        start = np.array([x, 0.03, 0.0, 0.0, 0.0, 0.0, 1.0])
        _, _, slope = centred(scene, start, along)
        behind, ahead = (
            centred(scene, start + shift * np.eye(7)[0], along)[1] for shift in (-h, h)
        )
        assert slope == pytest.approx((ahead - behind) / (2 * h), rel=1e-3)


@pytest.mark.parametrize("n", [2, 3])
def test_it_stops_once_the_gap_is_enough(n):
    rng = np.random.default_rng(7)
    scene, pose = pressed(rng, n, overlap=True)
    packed = space_of(scene).scene
    counts, gaps = [], []
    least = smallest_gaps(scene, pose[None])[0]
    assert least < 0.0
    for enough in (-1.0, 0.5 * least, 10.0):
        work = centring.new_workspace(packed)
        gap, _ = centring.centre(packed, pose.copy(), STILL, True, WITHIN, enough, 1e-6, 200, work)
        gaps.append(gap)
        counts.append(int(work.pairs[0]))
    assert gaps[0] < gaps[1] < gaps[2]
    assert counts[0] < counts[1] < counts[2]


@pytest.mark.parametrize("n", [2, 3])
def test_a_robot_alone_stays_where_it_is(n):
    part = Body(np.zeros(n), matrix(np.random.default_rng(8), n))
    scene = Scene(np.full(n, -9.0), np.full(n, 9.0), (), (), (part,))
    pose = np.array([1.0, 2.0, 0.0, 0.0, 0.0, 0.6, 0.8])
    found, gap, slope = centred(scene, pose)
    np.testing.assert_array_equal(found, pose)
    assert (gap, slope) == (WITHIN, 0.0)


@pytest.mark.parametrize("n", [2, 3])
def test_a_part_is_centred_in_an_arena_that_it_nearly_fills(n):
    a = np.diag([1.0, 0.6, 0.8][:n])
    arena = Body(np.zeros(n), 1.05 * a)
    scene = Scene(np.full(n, -1.0), np.full(n, 1.0), (), (arena,), (Body(np.zeros(n), a),))
    for shift in (0.0, 0.02, -0.2):
        pose = np.array([shift, 0.5 * shift, 0.0, 0.0, 0.0, np.sin(0.02), np.cos(0.02)])
        found, gap, _ = centred(scene, pose, precision=1e-5)
        best = 0.05 * np.sort(np.diag(a))[0]
        true = smallest_gaps(scene, found[None])[0]
        assert true == pytest.approx(best, rel=0.02)
        # Walls are known to first order: by the gap over the least radius of their curvature.
        assert gap == pytest.approx(true, rel=0.1)


@pytest.mark.parametrize("n", [2, 3])
def test_bounds_hold_the_base(n):
    rng = np.random.default_rng(9)
    scene, pose = pressed(rng, n)
    around = scene._replace(low=pose[:n] - 0.01, high=pose[:n] + 0.01)
    found, _, _ = centred(around, pose)
    assert ((found[:n] >= around.low) & (found[:n] <= around.high)).all()


@pytest.mark.parametrize("scale", [1e-3, 1e6])
def test_the_unit_of_length_does_not_matter(scale):
    scene, pose = pressed(np.random.default_rng(10), 3)

    def scaled(bodies):
        return tuple(Body(scale * b.centre, scale * b.matrix) for b in bodies)

    other = scene._replace(
        low=scale * scene.low,
        high=scale * scene.high,
        obstacles=scaled(scene.obstacles),
        parts=scaled(scene.parts),
    )
    moved = pose.copy()
    moved[:3] *= scale
    packed = space_of(other).scene
    work = centring.new_workspace(packed)
    gap, _ = centring.centre(
        packed, moved, STILL, True, scale * WITHIN, 10.0 * scale, 1e-6, 400, work
    )
    assert gap / scale == pytest.approx(centred(scene, pose)[1], rel=1e-4)
