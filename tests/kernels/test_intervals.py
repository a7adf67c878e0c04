"""Free intervals of sweep lines: valid throughout, and nothing free left out but a hair."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests import motion_oracle, random_scenes
from tests.motion_oracle import Scene
from tests.oracles import Body

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
HAIR = 1e-8  # how far inside or outside an end the answers must be clear


def line_configurations(configuration: np.ndarray, axis: int, values: np.ndarray) -> np.ndarray:
    """Copies (m, d) of a configuration with one coordinate replaced by each value."""
    rows = np.tile(configuration, (len(values), 1))
    rows[:, axis] = values
    return rows


def intervals_of(space: Any, configuration: np.ndarray, axis: int) -> np.ndarray:
    """The free intervals (k, 2) of the line through a configuration, checked for order."""
    n = space.dimension
    found = np.asarray(space.layer(configuration).free_intervals(configuration[:n], axis=axis))
    assert found.shape == (len(found), 2)
    assert (found[:, 0] <= found[:, 1]).all()
    assert (found[1:, 0] > found[:-1, 1]).all()
    return found


def membership(intervals: np.ndarray, values: np.ndarray, hair: float) -> np.ndarray:
    """1 well inside an interval, -1 well outside all of them, 0 within a hair of an end."""
    inside = np.zeros(len(values), dtype=bool)
    near = np.zeros(len(values), dtype=bool)
    for low, high in intervals:
        inside |= (values >= low) & (values <= high)
        near |= (np.abs(values - low) < hair) | (np.abs(values - high) < hair)
    return np.where(near, 0, np.where(inside, 1, -1))


@DIMENSIONS
@pytest.mark.parametrize("rotates", [True, False])
@pytest.mark.parametrize("clearance", [0.0, 0.2])
def test_against_dense_validity(dimension: int, rotates: bool, clearance: float) -> None:
    rng = np.random.default_rng(1)
    seen = np.zeros(3, dtype=int)
    for _ in range(3):
        scene = random_scenes.random_scene(
            rng, dimension, obstacles=8, arenas=1, parts=2, rotates=rotates
        )
        space = random_scenes.space_of(scene, clearance)
        for configuration in random_scenes.random_configurations(rng, scene, 4, spread=6):
            axis = int(rng.integers(dimension))
            intervals = intervals_of(space, configuration, axis)
            values = np.linspace(-8.5, 8.5, 61)
            rows = line_configurations(configuration, axis, values)
            truth = motion_oracle.clearances(scene, rows, far=0.5) - clearance
            truth = np.where(motion_oracle.in_bounds(scene, rows), truth, -1)
            where = membership(intervals, values, HAIR)
            seen += np.bincount(where + 1, minlength=3)
            assert (truth[where == 1] > -1e-12).all()
            # a clearance in an arena is kept by an inner ellipsoid, which leaves a little out
            rooms = motion_oracle.arena_rooms(scene, rows)[0].min(axis=(1, 2)) - clearance
            left_out = truth[(where == -1) & (rooms > 0.3 * clearance)]
            assert (left_out < 1e-8).all(), left_out.max()
    assert seen[0] > 50 and seen[2] > 50


@DIMENSIONS
@pytest.mark.parametrize("clearance", [0.0, 0.2])
def test_ends_are_tight_and_every_inside_point_is_valid(dimension: int, clearance: float) -> None:
    rng = np.random.default_rng(2)
    ends = 0
    for _ in range(6):
        scene = random_scenes.random_scene(rng, dimension, obstacles=8, arenas=2, parts=2)
        space = random_scenes.space_of(scene, clearance)
        for configuration in random_scenes.random_configurations(rng, scene, 20, spread=7):
            axis = int(rng.integers(dimension))
            for low, high in intervals_of(space, configuration, axis):
                inside = np.concatenate([[low, high], rng.uniform(low, high, size=6)])
                assert space.are_valid(line_configurations(configuration, axis, inside)).all()
                beyond = np.array([low - 1e-6, high + 1e-6])
                rows = line_configurations(configuration, axis, beyond)
                if clearance == 0:
                    gaps = [space.clearance(row) for row in rows]
                    outside = ~space.are_valid(rows)
                    # where the line grazes a body the gap grows by less than the step squared
                    assert (outside | (np.array(gaps) < 1e-7)).all()
                    ends += 2
    assert clearance > 0 or ends > 50


@DIMENSIONS
def test_a_line_through_one_ball(dimension: int) -> None:
    one = np.eye(dimension)
    scene = Scene(
        np.full(dimension, -5.0),
        np.full(dimension, 5.0),
        (Body(0.5 * one[0], one),),
        (),
        (Body(np.zeros(dimension), 0.5 * one),),
    )
    space = random_scenes.space_of(scene)
    configuration = np.zeros(3 if dimension == 2 else 7)
    configuration[-1] = 0.0 if dimension == 2 else 1.0
    along_x = intervals_of(space, configuration, 0)
    assert along_x == pytest.approx(np.array([[-5, -1], [2, 5]]), abs=1e-9)
    across = np.sqrt(1.5**2 - 0.5**2)
    along_y = intervals_of(space, configuration, 1)
    assert along_y == pytest.approx(np.array([[-5, -across], [across, 5]]), abs=1e-9)
    last = intervals_of(space, configuration, -1)
    assert last == pytest.approx(np.array([[-5, -across], [across, 5]]), abs=1e-9)


@DIMENSIONS
@pytest.mark.parametrize("gap", [1e-6, 1e-8, -1e-12, -1e-9])
def test_lines_that_graze_a_body(dimension: int, gap: float) -> None:
    """A graze by a hair splits the line only when it is a contact."""
    one = np.eye(dimension)
    scene = Scene(
        np.full(dimension, -5.0),
        np.full(dimension, 5.0),
        (Body(np.zeros(dimension), one),),
        (),
        (Body(np.zeros(dimension), 0.5 * one),),
    )
    space = random_scenes.space_of(scene)
    configuration = np.zeros(3 if dimension == 2 else 7)
    configuration[-1] = 0.0 if dimension == 2 else 1.0
    configuration[0] = 1.5 + gap
    found = intervals_of(space, configuration, 1)
    assert len(found) == (1 if gap > 0 else 2)
    if gap < 0:
        assert found[0, 1] < 0 < found[1, 0]
        half = np.sqrt(max(0.0, 1.5**2 - (1.5 + gap) ** 2))
        assert found[1, 0] >= half * (1 - 1e-6)


@DIMENSIONS
@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9, -1e-12, -1e-9])
def test_narrow_slots_are_found_and_closed_ones_are_not(dimension: int, width: float) -> None:
    """A ball between two balls: a slot of the given width along the line."""
    one = np.eye(dimension)
    reach = 1.0 + 0.5 + 0.5 * width
    balls = tuple(Body(sign * reach * one[0], one) for sign in (1, -1))
    scene = Scene(
        np.full(dimension, -5.0),
        np.full(dimension, 5.0),
        balls,
        (),
        (Body(np.zeros(dimension), 0.5 * one),),
    )
    space = random_scenes.space_of(scene)
    configuration = np.zeros(3 if dimension == 2 else 7)
    configuration[-1] = 0.0 if dimension == 2 else 1.0
    found = intervals_of(space, configuration, 0)
    slot = [(low, high) for low, high in found if abs(low + high) < 1e-3]
    assert len(slot) == (1 if width > 0 else 0)
    if slot:
        low, high = slot[0]
        assert high - low <= width * (1 + 1e-9)
        assert high - low >= width - 1e-9 * (1 + width) or width <= 1e-9


@DIMENSIONS
def test_outside_the_bounds_or_the_arena_nothing_is_free(dimension: int) -> None:
    rng = np.random.default_rng(3)
    scene = random_scenes.random_scene(rng, dimension, obstacles=2, arenas=1)
    space = random_scenes.space_of(scene)
    configuration = random_scenes.random_configurations(rng, scene, 1)[0]
    configuration[0] = 8.0 + 1e-6
    assert len(intervals_of(space, configuration, 1)) == 0
    snug = random_scenes.snug_scene(rng, dimension, room=0.1)
    space = random_scenes.space_of(snug)
    configuration = random_scenes.random_configurations(rng, snug, 1, spread=0.0)[0]
    configuration[0] = 0.9
    assert len(intervals_of(space, configuration, 1)) == 0


@DIMENSIONS
def test_arena_hardly_larger_than_the_robot(dimension: int) -> None:
    rng = np.random.default_rng(4)
    for room in (1e-2, 1e-4, 1e-6):
        scene = random_scenes.snug_scene(rng, dimension, room)
        space = random_scenes.space_of(scene)
        configuration = np.zeros(3 if dimension == 2 else 7)
        configuration[-1] = 0.0 if dimension == 2 else 1.0
        (found,) = intervals_of(space, configuration, 0)
        a = scene.parts[0].matrix
        reach = room / np.linalg.norm(np.linalg.solve(a, np.eye(dimension)[0]))
        assert found == pytest.approx([-reach, reach], abs=1e-9)
        assert np.abs(found).max() <= reach


def test_planar_equals_embedded() -> None:
    rng = np.random.default_rng(5)
    for _ in range(5):
        scene = random_scenes.random_scene(rng, 2, obstacles=8)
        planar = random_scenes.space_of(scene)
        deep = random_scenes.space_of(random_scenes.embedded_scene(scene))
        for configuration in random_scenes.random_configurations(rng, scene, 10):
            for axis in (0, 1):
                solid = random_scenes.embedded_configuration(configuration)
                flat, tall = (
                    intervals_of(planar, configuration, axis),
                    intervals_of(deep, solid, axis),
                )
                assert flat == pytest.approx(tall, abs=1e-5)


@DIMENSIONS
def test_many_obstacles_on_one_line(dimension: int) -> None:
    """A row of pearls: no gap between two of them may be lost or invented."""
    one = np.eye(dimension)
    count = 40
    centres = np.linspace(-39, 39, count)
    pearls = tuple(Body(x * one[0], 0.5 * one) for x in centres)
    scene = Scene(
        np.full(dimension, -50.0),
        np.full(dimension, 50.0),
        pearls,
        (),
        (Body(np.zeros(dimension), 0.1 * one),),
    )
    space = random_scenes.space_of(scene)
    configuration = np.zeros(3 if dimension == 2 else 7)
    configuration[-1] = 0.0 if dimension == 2 else 1.0
    found = intervals_of(space, configuration, 0)
    expected = np.column_stack([[-50, *(centres + 0.6)], [*(centres - 0.6), 50]])
    assert found == pytest.approx(expected, abs=1e-8)
