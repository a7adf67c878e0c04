"""Certified motions: the corners of OMPL's interpolation, and other traps."""

from __future__ import annotations

import numpy as np
import pytest

from tests import motion_oracle, random_scenes
from tests.oracles import Body
from tests.simple_motions import one_part, pose, random_motion

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])

# --------------------------------------------------------------------------- OMPL's corners


@DIMENSIONS
def test_half_turn_ties_are_proved_both_ways_or_refused(dimension: int) -> None:
    origin = [0.0] * dimension
    side = np.eye(dimension)[1]
    for sign in (1, -1):
        # the part is off the base: one way round it meets the ball, the other way it does not
        part = Body(2 * np.eye(dimension)[0], 0.3 * np.eye(dimension))
        scene = one_part(part, (Body(sign * 2 * side, 0.5 * np.eye(dimension)),))
        space = random_scenes.space_of(scene)
        for start in (0.0, np.pi):
            first, second = pose(origin, start), pose(origin, np.pi - start)
            assert space.is_valid(first) and space.is_valid(second)
            assert not space.is_motion_valid(first, second), (sign, start)
            assert not space.is_motion_valid(second, first), (sign, start)
        away = one_part(part, (Body(9 * side, 0.5 * np.eye(dimension)),))
        motion = pose(origin, 0.3), pose(origin, 0.3 - np.pi * 0.999)
        assert random_scenes.space_of(away).is_motion_valid(*motion)


def test_nearly_half_turns_in_the_plane_go_ompls_way() -> None:
    part = Body(np.array([2.0, 0.0]), 0.3 * np.eye(2))
    blocked = {
        sign: random_scenes.space_of(
            one_part(part, (Body(np.array([0.0, 2.0 * sign]), 0.5 * np.eye(2)),))
        )
        for sign in (1, -1)
    }
    for excess in (1e-3, 1e-9, -1e-9, -1e-3):
        first, second = np.array([0, 0, 0.0]), np.array([0, 0, np.pi + excess])
        second[2] -= 2 * np.pi * (second[2] > np.pi)
        upwards = second[2] > 0
        assert not blocked[1 if upwards else -1].is_motion_valid(first, second)
        if abs(excess) > 1e-6:
            assert blocked[-1 if upwards else 1].is_motion_valid(first, second)


def test_headings_across_pi_take_the_short_way() -> None:
    part = Body(np.array([2.0, 0.0]), 0.3 * np.eye(2))
    first, second = np.array([0, 0, 3.0]), np.array([0, 0, -3.0])
    short = one_part(part, (Body(np.array([-2.0, 0.0]), 0.1 * np.eye(2)),))
    long = one_part(part, (Body(np.array([2.0, 0.0]), 0.1 * np.eye(2)),))
    for a, b in ((first, second), (second, first)):
        assert not random_scenes.space_of(short).is_motion_valid(a, b)
        assert random_scenes.space_of(long).is_motion_valid(a, b)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, -1e-12, -1e-9])
def test_headings_across_pi_by_a_hair(gap: float) -> None:
    part = Body(np.zeros(2), np.diag([2.0, 0.3]))
    ball = Body(np.array([-(2.0 + 1.0 + gap), 0.0]), np.eye(2))
    space = random_scenes.space_of(one_part(part, (ball,)))
    for first, second in ((3.0, -3.0), (-2.9, 3.1), (np.pi, -3.0), (3.0, -np.pi)):
        valid = space.is_motion_valid(np.array([0, 0, first]), np.array([0, 0, second]))
        assert valid == (gap > 0), (first, second)


@pytest.mark.parametrize("angle", [1e-5, 5e-5, 8.9e-5, 8.95e-5, 1e-4, 2e-4])
@pytest.mark.parametrize("rising", [True, False])
def test_tiny_turns_in_space_jump(angle: float, rising: bool) -> None:
    """Below about 9e-5 rad OMPL keeps the first orientation to the end: so must the proof.

    A needle moves along itself and reaches a ball near the end only.  By then the interpolated
    one has risen clear of it (or has not yet); the one that keeps its first orientation meets it.
    """
    thickness = 0.3 * 20 * angle
    needle = Body(np.zeros(3), np.diag([20.0, thickness, thickness]))
    turns = (0.0, angle) if rising else (angle, 0.0)
    first, second = (
        pose([x, 0, 0], turn, (0, -1, 0)) for x, turn in zip((-5, 0), turns, strict=True)
    )
    height = -0.15 * thickness - 1 if rising else 19 * angle + 1
    scene = one_part(needle, (Body(np.array([19.0, 0.0, height]), np.eye(3)),))
    truth = motion_oracle.closest_obstacle(scene, first, second, count=2001).gap
    assert (truth < -1e-6 * angle) == (angle < 8.94e-5)
    valid = random_scenes.space_of(scene).is_motion_valid(first, second)
    if angle < 8.94e-5:
        assert not valid
    elif angle > 1.01e-4:
        assert valid


@pytest.mark.parametrize("angle", [1e-6, 5e-5, 8.9e-5, 9e-5, 1e-4])
def test_tiny_turns_that_are_free_whatever_happens_are_certified(angle: float) -> None:
    rng = np.random.default_rng(8)
    for _ in range(30):
        scene = random_scenes.random_scene(rng, 3, obstacles=2, arenas=1, parts=2)
        space = random_scenes.space_of(scene)
        first = random_scenes.random_configurations(rng, scene, 1, spread=5)[0]
        second = random_scenes.nearby_configuration(rng, scene, first, 0.5, angle)
        truth = motion_oracle.closest_obstacle(scene, first, second, count=61).gap
        rooms = motion_oracle.clearances(scene, np.array([first, second])).min()
        if truth > 2e-3 and rooms > 0.5:
            assert space.is_motion_valid(first, second)


def ompl_interpolation(first: np.ndarray, second: np.ndarray, s: float) -> np.ndarray:
    """What OMPL itself makes of two rotating configurations, if it is there."""
    base = pytest.importorskip("ompl.base")
    spaces = pytest.importorskip("planners.spaces")
    planar = len(first) == 3
    space = base.SE2StateSpace() if planar else base.SE3StateSpace()
    information = base.SpaceInformation(space)
    write = spaces.write_se2 if planar else spaces.write_se3
    states = [information.allocState() for _ in range(3)]
    for state, values in zip(states, (first, second), strict=False):
        write(state, values.tolist())
    space.interpolate(states[0], states[1], s, states[2])
    return np.array((spaces.read_se2 if planar else spaces.read_se3)(states[2]))


def test_interpolation_is_ompls() -> None:
    """The oracle's interpolation, the package's, and OMPL's own give one configuration."""
    rng = np.random.default_rng(9)
    for dimension in (2, 3):
        scene = random_scenes.random_scene(rng, dimension)
        space = random_scenes.space_of(scene)
        for turn in (1e-6, 5e-5, 8.94e-5, 8.95e-5, 1e-4, 1e-2, 1.0, 3.1):
            first = random_scenes.random_configurations(rng, scene, 1)[0]
            second = random_scenes.nearby_configuration(rng, scene, first, 1.0, turn)
            for s in (0.0, 0.3, 0.999, 1.0):
                ours = motion_oracle.interpolate(scene, first, second, np.array([s]))[0]
                found = np.asarray(space.interpolate(first, second, s))
                assert found == pytest.approx(ours, abs=1e-7 * turn + 1e-14)
                theirs = ompl_interpolation(first, second, s)
                assert theirs == pytest.approx(ours, abs=1e-7 * turn + 1e-14)


# --------------------------------------------------------------------------- other traps


@DIMENSIONS
def test_no_tunnelling_through_thin_obstacles(dimension: int) -> None:
    wall = Body(np.zeros(dimension), np.diag([1e-6, 3.0, 3.0][:dimension]))
    wire = Body(np.zeros(dimension), np.diag([1e-6, 3.0, 1e-6][:dimension]))
    speck = Body(np.zeros(dimension), 1e-7 * np.eye(dimension))
    small = Body(np.zeros(dimension), 1e-3 * np.eye(dimension))
    for obstacle in (wall, wire, speck):
        space = random_scenes.space_of(one_part(small, (obstacle,)))
        for shift in (0.0, 0.1, 0.37):
            first = pose([-9 + shift, 0, 0][:dimension], 0.0)
            second = pose([9 + 2 * shift, 0, 0][:dimension], 2.0)
            assert space.is_valid(first) and space.is_valid(second)
            assert not space.is_motion_valid(first, second)


@DIMENSIONS
def test_a_far_part_sweeps_what_it_passes(dimension: int) -> None:
    """A part far off the base crosses a speck in mid-turn, though both ends are far away."""
    part = Body(10 * np.eye(dimension)[0], 0.01 * np.eye(dimension))
    origin = [0.0] * dimension
    for angle in (0.4, 1.0, 2.0, 2.9):
        where = 10 * np.array([np.cos(angle), np.sin(angle), 0.0])[:dimension]
        speck = Body(where, 1e-3 * np.eye(dimension))
        space = random_scenes.space_of(one_part(part, (speck,)))
        assert not space.is_motion_valid(pose(origin, 0.0), pose(origin, 3.0))
        beside = Body(where * 1.02, 1e-3 * np.eye(dimension))
        space = random_scenes.space_of(one_part(part, (beside,)))
        assert space.is_motion_valid(pose(origin, 0.0), pose(origin, 3.0))


@DIMENSIONS
@pytest.mark.parametrize("gap", [1e-6, -1e-12, -1e-9])
def test_pure_translation_past_a_body(dimension: int, gap: float) -> None:
    """The least gap is half way; both bodies are turned ellipsoids, touching along a normal."""
    rng = np.random.default_rng(10)
    for rotates in (True, False):
        for k in range(20):
            obstacle, part = random_scenes.touching_pair(rng, dimension, gap)
            u = random_scenes.unit_vector(rng, dimension)
            offset = random_scenes.touching_offset(obstacle.matrix, part.matrix, u, gap)
            across = rng.normal(size=dimension)
            across -= (across @ u) * u
            middle = obstacle.centre + offset
            scene = one_part(Body(np.zeros(dimension), part.matrix), (obstacle,))
            scene = scene._replace(rotates=rotates)
            ends = [middle - 1.3 * across, middle + 0.7 * across]
            if rotates:
                ends = [np.append(end, [0.0] if dimension == 2 else [0, 0, 0, 1.0]) for end in ends]
            valid = random_scenes.space_of(scene).is_motion_valid(*ends)
            assert valid == (gap > 0), (rotates, k)


def test_planar_motions_equal_embedded_ones() -> None:
    rng = np.random.default_rng(11)
    agreed = 0
    for _ in range(6):
        scene = random_scenes.random_scene(rng, 2, obstacles=4)
        planar = random_scenes.space_of(scene)
        deep = random_scenes.space_of(random_scenes.embedded_scene(scene))
        for _ in range(40):
            first, second = random_motion(rng, scene)
            ends = [random_scenes.embedded_configuration(q) for q in (first, second)]
            valid = planar.is_motion_valid(first, second)
            if abs(first[2] - second[2]) > 1e-3 or first[2] == second[2]:
                agreed += valid == deep.is_motion_valid(*ends)
            else:
                agreed += 1
    assert agreed >= 238


def test_quaternion_signs_do_not_matter() -> None:
    rng = np.random.default_rng(12)
    scene = random_scenes.random_scene(rng, 3, obstacles=4)
    space = random_scenes.space_of(scene)
    for _ in range(100):
        first, second = random_motion(rng, scene)
        other = second.copy()
        other[3:] *= -1
        assert space.is_motion_valid(first, other) == space.is_motion_valid(first, second)


@DIMENSIONS
def test_needle_robots(dimension: int) -> None:
    rng = np.random.default_rng(13)
    for ratio in (1e3, 1e6):
        for k in range(10):
            scene = random_scenes.random_scene(rng, dimension, obstacles=2, arenas=0, parts=1)
            needle = Body(
                0.2 * rng.normal(size=dimension),
                random_scenes.matrix(rng, dimension, "needle", ratio, 2.0),
            )
            scene = scene._replace(parts=(needle,))
            first, second = random_motion(rng, scene)
            valid = random_scenes.space_of(scene).is_motion_valid(first, second)
            truth = motion_oracle.closest_obstacle(scene, first, second, count=201).gap
            assert truth > -1e-9 or not valid, (ratio, k, truth)
            assert valid or truth < 1e-5, (ratio, k, truth)
