"""Validity, clearance and explanations of single configurations."""

from __future__ import annotations

import numpy as np
import pytest

from tests import exact, motion_oracle, oracles, random_scenes
from tests.motion_oracle import Scene
from tests.oracles import Body

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def at(dimension: int, position: np.ndarray) -> np.ndarray:
    """The configuration at a position, not turned."""
    return np.concatenate([position, [0.0] if dimension == 2 else [0.0, 0.0, 0.0, 1.0]])


def small_scene(obstacle: Body, part: Body, arenas: tuple[Body, ...] = ()) -> Scene:
    """One obstacle, one part, wide bounds."""
    n = len(obstacle.centre)
    return Scene(np.full(n, -50.0), np.full(n, 50.0), (obstacle,), arenas, (part,))


@DIMENSIONS
@pytest.mark.parametrize("rotates", [True, False])
@pytest.mark.parametrize("clearance", [0.0, 0.3])
def test_against_the_oracle(dimension: int, rotates: bool, clearance: float) -> None:
    rng = np.random.default_rng(1)
    valid = 0
    for _ in range(3):
        scene = random_scenes.random_scene(rng, dimension, arenas=2, rotates=rotates)
        space = random_scenes.space_of(scene, clearance)
        configurations = random_scenes.random_configurations(rng, scene, 80, spread=7.0)
        truth = motion_oracle.clearances(scene, configurations, far=0.5)
        inside = motion_oracle.in_bounds(scene, configurations)
        found = space.are_valid(configurations)
        for k, configuration in enumerate(configurations):
            assert found[k] == space.is_valid(configuration)
            assert found[k] == (not space.explain(configuration))
            if abs(truth[k] - clearance) > 1e-6:
                assert found[k] == (inside[k] and truth[k] > clearance), (k, truth[k])
        valid += int(found.sum())
    assert 8 < valid < 200


@DIMENSIONS
def test_clearance_is_a_tight_lower_bound(dimension: int) -> None:
    rng = np.random.default_rng(2)
    for _ in range(3):
        scene = random_scenes.random_scene(rng, dimension, obstacles=5, arenas=1)
        space = random_scenes.space_of(scene)
        configurations = random_scenes.random_configurations(rng, scene, 80, spread=6)
        truth = motion_oracle.clearances(scene, configurations)
        for configuration, distance in zip(configurations, truth, strict=True):
            value = space.clearance(configuration)
            if distance > 0:
                assert 0 < value <= distance + 1e-12
            else:
                assert value <= 0


@DIMENSIONS
def test_clearance_to_obstacles_is_the_distance(dimension: int) -> None:
    rng = np.random.default_rng(3)
    scene = random_scenes.random_scene(rng, dimension, arenas=0)
    space = random_scenes.space_of(scene)
    configurations = random_scenes.random_configurations(rng, scene, 60)
    truth = motion_oracle.clearances(scene, configurations)
    for configuration, distance in zip(configurations, truth, strict=True):
        if distance > 0:
            assert space.clearance(configuration) == pytest.approx(distance, rel=1e-6)


@DIMENSIONS
@pytest.mark.parametrize("excess", [2e-10, 1e-6, -1e-12, -1e-9])
@pytest.mark.parametrize("clearance", [0.0, 1e-3, 0.5])
def test_obstacle_at_the_required_distance(dimension: int, excess: float, clearance: float) -> None:
    rng = np.random.default_rng(4)
    for k in range(40):
        first, second = random_scenes.touching_pair(rng, dimension, clearance + excess)
        part = Body(0.3 * rng.normal(size=dimension), second.matrix)
        space = random_scenes.space_of(small_scene(first, part), clearance)
        configuration = at(dimension, second.centre - part.centre)
        assert space.is_valid(configuration) == (excess > 0), k
        assert (space.clearance(configuration) >= clearance) == (excess > 0) or excess > 0, k


@DIMENSIONS
@pytest.mark.parametrize("excess", [1e-8, 1e-6, -1e-9, -1e-6])
def test_clearance_of_a_stretched_body_off_its_axes(dimension: int, excess: float) -> None:
    """Growing semi-axes by the clearance is not offsetting: the difference shows off the axes."""
    axes = np.array([3.0, 0.2, 0.2])[:dimension]
    u = np.array([0.05, 1.0, 0.02])[:dimension]
    u /= np.linalg.norm(u)
    obstacle, point = Body(np.zeros(dimension), np.diag(axes)), 1e-3 * np.eye(dimension)
    for clearance in (0.1, 1.0):
        offset = random_scenes.touching_offset(obstacle.matrix, point, u, clearance + excess)
        space = random_scenes.space_of(
            small_scene(obstacle, Body(np.zeros(dimension), point)), clearance
        )
        assert space.is_valid(at(dimension, offset)) == (excess > 0)


@DIMENSIONS
@pytest.mark.parametrize("excess", [1e-6, 1e-8, -1e-8, -1e-6])
@pytest.mark.parametrize("clearance", [0.0, 0.1, 0.4])
def test_arena_at_the_required_distance(dimension: int, excess: float, clearance: float) -> None:
    """A ball in a stretched arena, off its axes: truth from the normal at the nearest point."""
    axes = np.array([6.0, 2.0, 3.0])[:dimension]
    rng = np.random.default_rng(5)
    ball = 0.5
    for k in range(25):
        u = random_scenes.unit_vector(rng, dimension)
        support = axes * u / np.linalg.norm(axes * u) * axes
        position = support - (ball + clearance + excess) * u
        arena = Body(np.zeros(dimension), np.diag(axes))
        part = Body(position, ball * np.eye(dimension))
        room = oracles.arena_clearance(arena, part)
        if abs(room - clearance - excess) > 1e-9:
            continue  # another boundary point is nearer
        far = Body(np.full(dimension, 40.0), np.eye(dimension))
        scene = small_scene(far, Body(np.zeros(dimension), part.matrix), (arena,))
        space = random_scenes.space_of(scene, clearance)
        assert space.is_valid(at(dimension, position)) == (excess > 0), k


@DIMENSIONS
def test_clearance_in_a_snug_arena(dimension: int) -> None:
    """Never more clearance than there is; most of it is known even where the part is snug."""
    rng = np.random.default_rng(13)
    for k in range(12):
        arena = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, "mild", 6, 3.0))
        part = Body(np.zeros(dimension), random_scenes.matrix(rng, dimension, "mild", 6))
        fill = rng.uniform(0.1, 0.9) / np.sqrt(oracles.containment_value(arena, part))
        part = Body(part.centre, part.matrix * fill)
        position = arena.matrix @ random_scenes.unit_vector(rng, dimension)
        while oracles.containment_value(arena, Body(position, part.matrix)) > 0.9:
            position = 0.8 * position
        room = oracles.arena_clearance(arena, Body(position, part.matrix))
        far = Body(np.full(dimension, 40.0), np.eye(dimension))
        scene = small_scene(far, part, (arena,))
        assert not random_scenes.space_of(scene, room * (1 + 1e-8)).is_valid(
            at(dimension, position)
        ), k
        assert random_scenes.space_of(scene, 0.85 * room).is_valid(at(dimension, position)), k
        value = random_scenes.space_of(scene._replace(obstacles=())).clearance(
            at(dimension, position)
        )
        assert 0.85 * room <= value <= room * (1 + 1e-8), k


@DIMENSIONS
def test_bounds_hold_the_base_position(dimension: int) -> None:
    rng = np.random.default_rng(6)
    scene = random_scenes.random_scene(rng, dimension, obstacles=0, arenas=0)
    space = random_scenes.space_of(scene)
    for axis in range(dimension):
        for side in (-1, 1):
            position = np.zeros(dimension)
            position[axis] = side * (8.0 - 1e-9)
            assert space.is_valid(at(dimension, position))
            position[axis] = side * (8.0 + 1e-9)
            assert not space.is_valid(at(dimension, position))
            (contact,) = space.explain(at(dimension, position))
            assert contact.kind == "bounds"


@DIMENSIONS
def test_explanations_name_the_bodies_and_the_depth(dimension: int) -> None:
    rng = np.random.default_rng(7)
    scene = random_scenes.random_scene(rng, dimension, arenas=1)
    space = random_scenes.space_of(scene)
    configurations = random_scenes.random_configurations(rng, scene, 60)
    gaps, _ = motion_oracle.obstacle_gaps(scene, configurations)
    rooms, _ = motion_oracle.arena_rooms(scene, configurations)
    for k, configuration in enumerate(configurations):
        contacts = space.explain(configuration)
        named = {(c.kind, c.part, c.body) for c in contacts if c.kind != "bounds"}
        parts = [part.name for part in space.robot.parts]
        expected = {
            ("obstacle", parts[i], space.world.obstacles[j].name)
            for i, j in zip(*np.nonzero(gaps[k] < 0), strict=True)
        } | {
            ("arena", parts[i], space.world.arenas[j].name)
            for i, j in zip(*np.nonzero(rooms[k] < 0), strict=True)
        }
        assert named == expected
        assert all(c.depth > 0 and c.message for c in contacts)


@DIMENSIONS
def test_explained_depth_of_an_obstacle(dimension: int) -> None:
    one = np.eye(dimension)
    space = random_scenes.space_of(
        small_scene(Body(np.zeros(dimension), one), Body(np.zeros(dimension), one))
    )
    (contact,) = space.explain(at(dimension, 1.75 * one[0]))
    assert contact.depth == pytest.approx(0.25, rel=1e-6)


@DIMENSIONS
def test_far_from_the_origin(dimension: int) -> None:
    """World coordinates of 1e6 cost ten digits of position, and no false answer."""
    rng = np.random.default_rng(8)
    for k in range(40):
        shift = rng.uniform(-1, 1, size=dimension) * 1e6
        depth = 10 ** rng.uniform(-12, -8)
        first, second = random_scenes.touching_pair(rng, dimension, -depth)
        obstacle = Body(first.centre + shift, first.matrix)
        part = Body(0.37 * rng.normal(size=dimension), second.matrix)
        scene = small_scene(obstacle, part)._replace(
            low=np.full(dimension, -2e6), high=np.full(dimension, 2e6)
        )
        space = random_scenes.space_of(scene)
        position = second.centre + shift - part.centre
        stored = [
            oracles.body_of(body) for body in (space.world.obstacles[0], space.robot.parts[0])
        ]
        offset = [
            a + b
            for a, b in zip(
                exact.on_line(position, 0 * position, 0.0, stored[0].centre),
                exact.decimals(stored[1].centre),
                strict=True,
            )
        ]
        valid = space.is_valid(at(dimension, position))
        assert not valid or exact.is_separated(stored[0], stored[1], offset), (k, depth)


@DIMENSIONS
@pytest.mark.parametrize("ratio", [1e3, 1e6])
def test_needles_and_discs(dimension: int, ratio: float) -> None:
    rng = np.random.default_rng(9)
    for k in range(60):
        kinds = tuple(rng.choice(["needle", "disc"], size=2))
        gap = rng.choice([1e-9, 1e-6, -1e-9, -1e-12])
        first, second = random_scenes.touching_pair(
            rng, dimension, gap, (kinds[0], kinds[1]), ratio
        )
        space = random_scenes.space_of(small_scene(first, Body(np.zeros(dimension), second.matrix)))
        # a sliver moved into another may have passed through it: ask the exact judge
        stored = oracles.body_of(space.world.obstacles[0]), oracles.body_of(space.robot.parts[0])
        truth = exact.separation(
            *stored, exact.on_line(second.centre, gap * second.centre, 0.0, first.centre)
        )
        valid = space.is_valid(at(dimension, second.centre))
        assert valid == (truth > 0) or 0 < truth < 100 * space.tolerance, (k, kinds, gap, truth)


def test_planar_equals_embedded() -> None:
    rng = np.random.default_rng(10)
    for _ in range(3):
        scene = random_scenes.random_scene(rng, 2)
        planar = random_scenes.space_of(scene)
        deep = random_scenes.space_of(random_scenes.embedded_scene(scene))
        for configuration in random_scenes.random_configurations(rng, scene, 100):
            solid = random_scenes.embedded_configuration(configuration)
            if abs(planar.clearance(configuration)) > 1e-5:
                assert planar.is_valid(configuration) == deep.is_valid(solid)


def test_quaternions_and_headings_are_taken_for_what_they_mean() -> None:
    rng = np.random.default_rng(11)
    for dimension in (2, 3):
        scene = random_scenes.random_scene(rng, dimension)
        space = random_scenes.space_of(scene)
        for configuration in random_scenes.random_configurations(rng, scene, 60):
            other = configuration.copy()
            if dimension == 3:
                other[3:] *= -1
            else:
                other[2] += 2 * np.pi * rng.integers(-2, 3)
            assert space.is_valid(other) == space.is_valid(configuration)
            assert space.clearance(other) == pytest.approx(space.clearance(configuration), abs=1e-9)


def test_many_obstacles() -> None:
    """Enough obstacles for a broad phase to matter: no pair may be lost in it."""
    rng = np.random.default_rng(12)
    for dimension in (2, 3):
        scene = random_scenes.random_scene(rng, dimension, obstacles=60, arenas=0, parts=2)
        small = tuple(Body(b.centre, 0.4 * b.matrix) for b in scene.obstacles)
        scene = scene._replace(obstacles=small)
        space = random_scenes.space_of(scene)
        configurations = random_scenes.random_configurations(rng, scene, 60)
        truth = motion_oracle.clearances(scene, configurations)
        for configuration, distance in zip(configurations, truth, strict=True):
            assert space.is_valid(configuration) == (distance > 0)
            if distance > 0:
                assert space.clearance(configuration) == pytest.approx(distance, rel=1e-6)
