"""Certified motions: never a false certificate, and no refusal of what is free by a margin."""

from __future__ import annotations

import numpy as np
import pytest

from tests import motion_oracle, random_scenes
from tests.oracles import Body
from tests.simple_motions import bar, one_part, pose, random_motion

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])

# Free motions may be refused below this clearance, in units of the scene (the package says 1e-12
# of the scene's size; the dense checks are no better than this).
TOLERANCE = 1e-9


# --------------------------------------------------------------------------- random motions


@DIMENSIONS
@pytest.mark.parametrize("rotates", [True, False])
@pytest.mark.parametrize("clearance", [0.0, 0.1])
def test_random_motions_against_dense_checks(
    dimension: int, rotates: bool, clearance: float
) -> None:
    rng = np.random.default_rng(1)
    certified = 0
    for k in range(40):
        scene = random_scenes.random_scene(
            rng,
            dimension,
            obstacles=4 if dimension == 2 else 12,
            arenas=0,
            parts=2,
            rotates=rotates,
        )
        space = random_scenes.space_of(scene, clearance)
        first, second = random_motion(rng, scene)
        valid = space.is_motion_valid(first, second)
        truth = motion_oracle.closest_obstacle(scene, first, second, count=61).gap - clearance
        certified += valid
        assert truth >= -1e-13 or not valid, (k, truth)
        assert valid or truth < TOLERANCE, (k, truth)
    assert 5 < certified < 36


@DIMENSIONS
def test_motion_clearance_is_a_lower_bound(dimension: int) -> None:
    rng = np.random.default_rng(14)
    proved = 0
    for k in range(25):
        scene = random_scenes.random_scene(rng, dimension, obstacles=4, arenas=0, parts=2)
        first, second = random_motion(rng, scene)
        _, samples = motion_oracle.motion_samples(scene, first, second, 21)
        truth = motion_oracle.clearances(scene, samples).min()
        space = random_scenes.space_of(scene)
        value = space.motion_clearance(first, second)
        assert (value > 0) == space.is_motion_valid(first, second), k
        if value > 0:
            proved += 1
            assert value <= truth + 1e-12, k
            required = random_scenes.space_of(scene, value * (1 - 1e-9))
            assert required.is_motion_valid(first, second), k
    assert proved > 5


@DIMENSIONS
def test_random_motions_in_an_arena(dimension: int) -> None:
    rng = np.random.default_rng(2)
    certified = 0
    for k in range(14):
        scene = random_scenes.random_scene(rng, dimension, obstacles=0, arenas=1, parts=1)
        scene = scene._replace(arenas=tuple(Body(b.centre, 0.6 * b.matrix) for b in scene.arenas))
        space = random_scenes.space_of(scene)
        first, second = random_motion(rng, scene)
        valid = space.is_motion_valid(first, second)
        truth = motion_oracle.closest_arena(scene, first, second, count=41).gap
        certified += valid
        assert truth >= -1e-13 or not valid, (k, truth)
        assert valid or truth < TOLERANCE, (k, truth)
    assert 1 < certified < 13


@DIMENSIONS
def test_batches_equal_single_motions_and_ends_are_checked(dimension: int) -> None:
    rng = np.random.default_rng(3)
    scene = random_scenes.random_scene(rng, dimension)
    space = random_scenes.space_of(scene)
    motions = [random_motion(rng, scene) for _ in range(300)]
    first, second = (np.array(ends) for ends in zip(*motions, strict=True))
    batch = space.are_motions_valid(first, second)
    single = [space.is_motion_valid(a, b) for a, b in motions]
    assert batch.tolist() == single
    ends = space.are_valid(first) & space.are_valid(second)
    assert not (batch & ~ends).any()
    assert 20 < batch.sum() < 280


@DIMENSIONS
def test_a_motion_to_itself_is_as_valid_as_the_state(dimension: int) -> None:
    rng = np.random.default_rng(4)
    scene = random_scenes.random_scene(rng, dimension)
    space = random_scenes.space_of(scene)
    for configuration in random_scenes.random_configurations(rng, scene, 60):
        motion = space.is_motion_valid(configuration, configuration)
        assert motion == space.is_valid(configuration)


# --------------------------------------------------------------------------- built by root finding


@DIMENSIONS
@pytest.mark.parametrize("target", [1e-4, 1e-9, -1e-12, -1e-9])
@pytest.mark.parametrize("clearance", [0.0, 0.05])
def test_obstacle_placed_to_a_least_gap(dimension: int, target: float, clearance: float) -> None:
    rng = np.random.default_rng(5)
    interior = 0
    for k in range(7):
        scene = random_scenes.random_scene(rng, dimension, obstacles=1, arenas=0, parts=1)
        first = random_scenes.random_configurations(rng, scene, 1, spread=3)[0]
        second = random_scenes.nearby_configuration(rng, scene, first, 2.0, 2.8)
        # beside the middle of the motion, for the least gap to lie within it now and then
        middle = 0.5 * (first + second)[:dimension]
        side = 4 * random_scenes.unit_vector(rng, dimension)
        move = (second - first)[:dimension]
        side -= (side @ move) / (move @ move) * move
        scene = scene._replace(obstacles=(Body(middle + side, scene.obstacles[0].matrix),))
        scene = motion_oracle.pushed(scene, first, second, clearance + target)
        found = motion_oracle.closest_obstacle(scene, first, second)
        interior += 0 < found.s < 1
        valid = random_scenes.space_of(scene, clearance).is_motion_valid(first, second)
        assert valid == (target > 0), (k, found)
    assert interior >= 2


@DIMENSIONS
@pytest.mark.parametrize("target", [1e-3, 1e-8, -1e-12, -1e-9])
def test_arena_placed_to_a_least_room(dimension: int, target: float) -> None:
    rng = np.random.default_rng(6)
    for k in range(4):
        scene = random_scenes.random_scene(rng, dimension, obstacles=0, arenas=1, parts=1)
        first = random_scenes.random_configurations(rng, scene, 1, spread=3)[0]
        second = random_scenes.nearby_configuration(rng, scene, first, 0.5, 2.8)
        arena = scene.arenas[0]
        scene = scene._replace(arenas=(Body(first[:dimension], 0.5 * arena.matrix),))
        scene = motion_oracle.pushed(scene, first, second, target)
        valid = random_scenes.space_of(scene).is_motion_valid(first, second)
        assert valid == (target > 0), k


@DIMENSIONS
@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-6, 1e-9, -1e-12, -1e-10, -1e-9, -1e-6])
@pytest.mark.parametrize("end", [np.pi / 2 + 0.3, 2.9])
def test_bar_turning_between_two_balls(dimension: int, gap: float, end: float) -> None:
    """The bar's tips pass two balls at exactly the gap, on the way, not at either end."""
    part = bar(dimension)
    place = np.eye(dimension)[1] * (2.0 + 1.0 + gap)
    balls = tuple(Body(sign * place, np.eye(dimension)) for sign in (1, -1))
    space = random_scenes.space_of(one_part(part, balls))
    origin = [0.0] * dimension
    for first, second in ((0.1, end), (end, 0.1), (-0.1, -end)):
        valid = space.is_motion_valid(pose(origin, first), pose(origin, second))
        assert valid == (gap > 0), (first, second)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-6, -1e-12, -1e-9])
def test_bar_turning_about_a_skew_axis(gap: float) -> None:
    """In space, the tip describes a cone past a ball that a random frame puts anywhere."""
    rng = np.random.default_rng(7)
    for k in range(12):
        axis = random_scenes.unit_vector(rng, 3)
        tip_frame = random_scenes.rotation(rng, 3)
        # the ball lies on the tip's line at half time: there the gap is least by symmetry
        half = rng.uniform(0.3, 1.4)
        turn = np.append(np.sin(half / 2) * axis, np.cos(half / 2))
        back = turn * np.array([-1, -1, -1, 1])
        part = Body(np.zeros(3), tip_frame * np.array([2.0, 0.3, 0.25]))
        u = tip_frame[:, 0]
        first = np.concatenate([np.zeros(3), back])
        second = np.concatenate([np.zeros(3), turn])
        scene = one_part(part, (Body((2.0 + 0.7 + gap) * u, 0.7 * np.eye(3)),))
        valid = random_scenes.space_of(scene).is_motion_valid(first, second)
        assert valid == (gap > 0), k


@DIMENSIONS
@pytest.mark.parametrize("room", [1e-3, 1e-5, 1e-6, 1e-9, -1e-12, -1e-9, -1e-6])
def test_bar_turning_in_arenas(dimension: int, room: float) -> None:
    """In a round arena the room is the same all along; in an oval one it is least half way."""
    origin = [0.0] * dimension
    for long in (2.0 + room, 4.0):
        axes = np.array([long, 2.0 + room, long])[:dimension]
        arena = Body(np.zeros(dimension), np.diag(axes))
        space = random_scenes.space_of(one_part(bar(dimension), arenas=(arena,)))
        for first, second in ((0.1, 2.0), (2.5, 0.4), (1.0, 1.2)):
            passes = long < 3 or first < np.pi / 2 < second or second < np.pi / 2 < first
            valid = space.is_motion_valid(pose(origin, first), pose(origin, second))
            if passes:
                assert valid == (room > 0), (long, first, second)


@pytest.mark.parametrize("room", [1e-3, 1e-5, -1e-12, -1e-9])
def test_sphere_sliding_along_an_arena(room: float) -> None:
    """A ball on a chord of a ball: the room is least at both ends or in neither place else."""
    arena = Body(np.zeros(3), 5 * np.eye(3))
    space = random_scenes.space_of(one_part(Body(np.zeros(3), np.eye(3)), arenas=(arena,)))
    reach = 4.0 - room
    across = np.sqrt(reach**2 - 1.5**2)
    first, second = pose([1.5, -across, 0], 0.3), pose([1.5, across, 0], 2.0)
    assert space.is_motion_valid(first, second) == (room > 0)
