"""The free-interval sampler against rejection sampling, with fixed seeds.

The judge of validity is the oracle, so that a region which sampler and checker both leave out
would show.  Levels of significance are 1e-4: with fixed seeds a failure is not bad luck.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from ellipsoid_planning.cspace import sampling as sampling_module
from tests import motion_oracle, random_scenes
from tests.motion_oracle import Scene
from tests.oracles import Body

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
KINDS = pytest.mark.parametrize("rotates", [True, False])
LEVEL = 1e-4


def scene_of(dimension: int, rotates: bool, arena: bool) -> Scene:
    """A bar among balls: free space has narrow places and depends on the orientation."""
    n = dimension
    one = np.eye(n)
    bar = Body(0.3 * one[0], np.diag([0.9, 0.15, 0.25][:n]))
    balls = tuple(
        Body(np.array(place, dtype=float)[:n], radius * one)
        for place, radius in (
            ((1.0, 0.6, 0.2), 0.7),
            ((-1.0, 0.8, -0.3), 0.5),
            ((0.2, -1.0, 0.1), 0.6),
            ((-1.2, -0.9, 0.6), 0.3),
        )
    )
    arenas = (Body(np.zeros(n), np.diag([2.6, 2.2, 2.4][:n])),) if arena else ()
    return Scene(np.full(n, -2.0), np.full(n, 2.0), balls, arenas, (bar,), rotates)


def drawn(scene: Scene, count: int, seed: int, uniform: bool, clearance: float = 0.0) -> np.ndarray:
    """Configurations (count, d) from the sampler; draws that gave up are repeated."""
    space = random_scenes.space_of(scene, clearance)
    sampler = sampling_module.FreeIntervalSampling(space, seed, uniform)
    rows = np.empty((count, space.robot.configuration_size))
    found = tries = 0
    while found < count:
        tries += 1
        assert tries < 20 * count
        found += sampler.sample(rows[found])
    return rows


def rejected(scene: Scene, count: int, seed: int) -> np.ndarray:
    """Configurations (count, d) by rejection, judged by the oracle."""
    rng = np.random.default_rng(seed)
    kept: list[np.ndarray] = []
    while sum(map(len, kept)) < count:
        rows = random_scenes.random_configurations(rng, scene, 2500, spread=2.0)
        rows = rows[motion_oracle.are_free(scene, rows)]
        if scene.arenas:
            rows = rows[inside(scene, rows)]
        kept.append(rows)
    return np.concatenate(kept)[:count]


def inside(scene: Scene, rows: np.ndarray) -> np.ndarray:
    """Whether the bar is in the arena, by a fine grid of the bar's boundary points."""
    from tests.oracles import sphere_grid

    grid = sphere_grid(200 if scene.dimension == 2 else 600, scene.dimension)
    fits = np.ones(len(rows), dtype=bool)
    for centres, matrices in motion_oracle.placed(scene, rows):
        points = centres[:, None] + grid @ np.swapaxes(matrices, 1, 2)
        for arena in scene.arenas:
            unit = (points - arena.centre) @ np.linalg.inv(arena.matrix).T
            fits &= (np.linalg.norm(unit, axis=2) <= 1).all(axis=1)
    return fits


def features(scene: Scene, rows: np.ndarray) -> np.ndarray:
    """Numbers (m, k) whose distributions are compared: positions, angles, mixtures of both."""
    n = scene.dimension
    columns = [rows[:, k] for k in range(n)]
    columns.append(np.linalg.norm(rows[:, :n] - 0.7, axis=1))
    if scene.rotates:
        turns = motion_oracle.rotations(rows, scene)
        columns += [turns[:, 0, 0], turns[:, 1, 0], turns[:, -1, -1]]
        columns.append((turns[:, :, 0] * rows[:, :n]).sum(axis=1))
    return np.column_stack(columns)


def cells(scene: Scene, rows: np.ndarray, per_axis: int) -> np.ndarray:
    """Cell index of each row: a grid of positions, times quadrants of the bar's direction."""
    n = scene.dimension
    grid = np.clip(((rows[:, :n] + 2) / 4 * per_axis).astype(int), 0, per_axis - 1)
    index = grid @ per_axis ** np.arange(n)
    if scene.rotates:
        bar = motion_oracle.rotations(rows, scene)[:, :, 0]
        index = index * 4 + 2 * (bar[:, 0] > 0) + (bar[:, 1] > 0)
    return np.asarray(index)


def p_values(scene: Scene, first: np.ndarray, second: np.ndarray) -> list[float]:
    """Two-sample tests of every feature, and a chi-squared test of the cells."""
    a, b = features(scene, first), features(scene, second)
    found = [float(stats.ks_2samp(a[:, k], b[:, k]).pvalue) for k in range(a.shape[1])]
    index = cells(scene, first, 5), cells(scene, second, 5)
    count = max(i.max() for i in index) + 1
    table = np.array([np.bincount(i, minlength=count) for i in index])
    order = table.sum(axis=0)
    often = order >= 20
    table = np.column_stack([table[:, often], table[:, ~often].sum(axis=1)])
    table = table[:, table.sum(axis=0) > 0]
    found.append(float(stats.chi2_contingency(table).pvalue))
    return found


@pytest.mark.statistical
@DIMENSIONS
@KINDS
@pytest.mark.parametrize("arena", [False, True])
def test_uniform_draws_equal_rejection_sampling(dimension: int, rotates: bool, arena: bool) -> None:
    scene = scene_of(dimension, rotates, arena)
    count = 5000
    values = p_values(scene, drawn(scene, count, 1, True), rejected(scene, count, 2))
    assert min(values) > LEVEL / len(values), values


@pytest.mark.statistical
@DIMENSIONS
def test_the_test_has_power(dimension: int) -> None:
    """Passage-favouring draws are not uniform, and the same tests see it."""
    scene = scene_of(dimension, True, False)
    # larger balls: more lines with short free parts
    balls = tuple(Body(ball.centre, 1.4 * ball.matrix) for ball in scene.obstacles)
    scene = scene._replace(obstacles=balls)
    count = 5000
    values = p_values(scene, drawn(scene, count, 3, False), rejected(scene, count, 4))
    assert min(values) < LEVEL / len(values)


@DIMENSIONS
@KINDS
@pytest.mark.parametrize("uniform", [True, False])
@pytest.mark.parametrize("clearance", [0.0, 0.1])
def test_no_draw_is_ever_invalid(
    dimension: int, rotates: bool, uniform: bool, clearance: float
) -> None:
    scene = scene_of(dimension, rotates, True)
    rows = drawn(scene, 800, 5, uniform, clearance)
    space = random_scenes.space_of(scene, clearance)
    assert space.are_valid(rows).all()
    assert motion_oracle.in_bounds(scene, rows).all()
    gaps = motion_oracle.obstacle_gaps(scene, rows)[0].min(axis=(1, 2))
    assert gaps.min() >= clearance - 1e-12
    assert motion_oracle.arena_rooms(scene, rows[:60])[0].min() >= clearance - 1e-9


@DIMENSIONS
@KINDS
def test_draws_near_a_state_are_near_and_valid(dimension: int, rotates: bool) -> None:
    scene = scene_of(dimension, rotates, True)
    space = random_scenes.space_of(scene)
    sampler = sampling_module.FreeIntervalSampling(space, 6, True)
    out = np.empty(space.robot.configuration_size)
    centres = drawn(scene, 40, 7, True)
    drawn_any = 0
    for centre in centres:
        for distance in (1e-3, 0.1, 1.0):
            for _ in range(5):
                if sampler.sample_near(centre, distance, out):
                    drawn_any += 1
                    assert space.is_valid(out)
                    assert space.distance(centre, out) <= distance * (1 + 1e-9) + 1e-12
    assert drawn_any > 300


@DIMENSIONS
def test_same_seed_same_draws(dimension: int) -> None:
    scene = scene_of(dimension, True, True)
    first, again, other = (drawn(scene, 50, seed, True) for seed in (8, 8, 9))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


@DIMENSIONS
def test_nothing_free_gives_nothing(dimension: int) -> None:
    one = np.eye(dimension)
    scene = scene_of(dimension, True, False)
    scene = scene._replace(obstacles=(Body(np.zeros(dimension), 9 * one),))
    sampler = sampling_module.FreeIntervalSampling(random_scenes.space_of(scene), 1, True)
    out = np.empty(3 if dimension == 2 else 7)
    assert not any(sampler.sample(out) for _ in range(20))
