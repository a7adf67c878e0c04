"""Ranking: as the plain cost has it, whatever the chunks and the threads."""

import itertools

import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction import ranking
from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes, simulate
from ellipsoid_planning.crystal.diffraction.ranking import (
    QUANTUM,
    Ranker,
    chunks,
    merged,
    rank,
    rank_free,
    rank_listed,
)
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.errors import CrystalError
from tests.crystal.packings import one_body
from tests.crystal.test_structure_factors import drawers

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


def case(name, scaled=False):
    model = load_model(name)
    target = load_target(f"{name}-target", model)
    return GridSearch(model), FourierCost(model, simulate(model, target), scaled)


def some(model, count, seed=0):
    random = np.random.default_rng(seed)
    return np.unique(random.integers(model.grid.count, size=count))


def check_against_plain(search, cost, numbers):
    plain = cost.values(search.model.grid.configurations(numbers))
    found = rank(search, numbers, cost, len(numbers))
    places = np.searchsorted(numbers, found.numbers)
    assert np.max(np.abs(found.costs - plain[places])) < QUANTUM * cost.norm
    assert np.all(np.diff(found.costs) > 0.0)
    # Every other arrangement has the cost of one that was kept, and a higher number.
    left = np.setdiff1d(np.arange(len(numbers)), places)
    nearest = np.abs(plain[left][:, None] - found.costs).argmin(axis=1)
    assert np.all(np.abs(found.costs[nearest] - plain[left]) < 2.0 * QUANTUM * cost.norm)
    assert np.all(found.numbers[nearest] < numbers[left])
    assert np.array_equal(found.configurations, search.model.grid.configurations(found.numbers))
    for best in (1, 10):
        few = rank(search, numbers, cost, best)
        assert np.array_equal(few.numbers, found.numbers[:best])
        assert np.array_equal(few.costs, found.costs[:best]) and few.looked_at == len(numbers)


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("name", NAMES)
def test_it_is_the_order_of_the_plain_cost(name, scaled):
    search, cost = case(name, scaled)
    check_against_plain(search, cost, some(search.model, 3000))


def test_other_joints_shifts_and_molecules_that_stand_still():
    models = drawers()
    models.append(one_body("P21", "{lengths: [9, 9, 9]}", [1.0, 2.0, 1.0]))
    turning = "{orientation: {yaw_deg: {lower: 0, upper: 180, step: 4}}}"
    models.append(one_body("p1", "{lengths: [9, 9]}", [1.0, 2.0], turning))
    every = "{position: {y: {lower: 0, upper: 4, step: 1}}, orientation: {grid: 600-cell, "
    every += "resolution_deg: 40}}"
    models.append(one_body("P21", "{lengths: [9, 9, 9]}", [1.0, 2.0, 1.5], every, [0.5, 1.0, 0.2]))
    for model in models:
        target = model.grid.configurations([model.grid.count // 2])[0] + 0.1
        cost = FourierCost(model, simulate(model, target))
        check_against_plain(GridSearch(model), cost, np.arange(model.grid.count))


def test_chunks_threads_and_order_change_nothing():
    search, cost = case("rabbit-p1")
    ranker = Ranker(search, cost)
    numbers = search.free(0, 200)
    whole = ranker.rank(numbers, 10)
    for pieces in (2, 7):
        parts = [ranker.rank(part, 10) for part in np.array_split(numbers, pieces)]
        for order in (parts, parts[::-1]):
            again = merged(order, 10)
            assert np.array_equal(again.numbers, whole.numbers)
            assert np.array_equal(again.costs, whole.costs) and again.looked_at == len(numbers)
    shuffled = np.random.default_rng(0).permutation(numbers[:2000])
    assert np.array_equal(ranker.rank(shuffled).numbers, ranker.rank(numbers[:2000]).numbers)
    everything = [rank_free(search, cost, workers=workers) for workers in (1, 3)]
    assert np.array_equal(everything[0].numbers, everything[1].numbers)
    assert np.array_equal(everything[0].costs, everything[1].costs)
    assert everything[0].looked_at == 98_845


def test_a_target_on_the_grid_of_p1_comes_first():
    search = GridSearch(load_model("rabbit-p1"))
    numbers = search.free(0, search.model.grid.base_poses)
    for number in np.random.default_rng(1).choice(numbers, 5, replace=False):
        target = search.model.grid.configurations([number])[0]
        found = rank(search, numbers, FourierCost(search.model, simulate(search.model, target)))
        # Its homometric twin, with the ears exchanged, is as good.
        twin = target[[0, 1, 2, 5, 6, 3, 4]]
        best = found.configurations[0]
        assert found.costs[0] == 0.0
        assert np.allclose(best, target) or np.allclose(best, twin)
        assert found.costs[1] > 1.0


def test_a_target_on_the_grid_of_p212121_comes_first():
    search = GridSearch(load_model("rabbit-p212121"))
    numbers = search.free(36_000, 37_000)
    # Without a shift the inverted molecule has its homometric twin on the grid, too.
    numbers = numbers[numbers // search.model.grid.joint_count % 100 != 0]
    for number in numbers[[1, len(numbers) // 2]]:
        target = search.model.grid.configurations([number])[0]
        found = rank(search, numbers, FourierCost(search.model, simulate(search.model, target)))
        assert found.costs[0] == 0.0 and number == found.numbers[0]
        assert found.costs[1] > 1.0


def test_chunks_are_whole_turns_and_leave_nothing_out():
    search, cost = case("rabbit-p212121")
    ranker = Ranker(search, cost)
    ends = list(chunks(ranker))
    assert ends[0][0] == 0 and ends[-1][1] == search.model.grid.base_poses
    assert all(a[1] == b[0] and a[1] % ranker.shifts == 0 for a, b in itertools.pairwise(ends))
    assert ranker.shifts == 100


def test_without_tables_it_is_the_same(monkeypatch):
    search, cost = case("rabbit-p212121")
    numbers = np.random.default_rng(0).permutation(some(search.model, 3000))
    ranker = Ranker(search, cost)
    tables = ranker.rank(numbers)
    monkeypatch.setattr(ranking, "LARGEST_TABLE", 0)
    monkeypatch.setattr(ranking, "PLAIN_AT_ONCE", 1000)
    plain = ranker.rank(numbers)
    assert np.array_equal(plain.numbers, tables.numbers)
    assert np.max(np.abs(plain.costs - tables.costs)) <= 2.0 * QUANTUM * cost.norm
    assert np.array_equal(plain.configurations, tables.configurations)
    assert plain.looked_at == tables.looked_at == len(numbers)


def test_any_list_is_ranked():
    search, cost = case("rabbit-plane")
    listed = np.random.default_rng(0).uniform(0.0, 3.0, (50, 3))
    listed[7] = listed[31] = load_target("rabbit-plane-target", search.model)
    found = rank_listed(cost, listed, 5)
    assert found.numbers[0] == 7 and found.costs[0] == 0.0
    assert np.array_equal(found.numbers[1:], np.argsort(cost.values(listed))[2:6])
    assert np.array_equal(found.configurations, listed[found.numbers]) and found.looked_at == 50
    assert len(rank_listed(cost, listed[:3])) == 3
    assert len(rank_listed(cost, np.zeros((0, 3)))) == 0
    with pytest.raises(CrystalError, match="3 finite numbers"):
        rank_listed(cost, listed[:, :2])


def test_progress_is_told():
    search, cost = case("rabbit-plane")
    told = []
    found = rank_free(search, cost, best=3, on_progress=lambda *done: told.append(done))
    assert told[-1] == (search.model.grid.base_poses, search.model.grid.base_poses)
    assert len(found) == 3


def test_nothing_to_rank_is_an_empty_ranking():
    search, cost = case("rabbit-p1")
    empty = rank(search, np.zeros(0, np.int64), cost)
    assert len(empty) == 0 and empty.configurations.shape == (0, 7)
    one = rank(search, np.array([5]), cost)
    assert merged([empty, one]).numbers.tolist() == [5]


def test_nonsense_is_refused():
    search, cost = case("rabbit-plane")
    with pytest.raises(CrystalError, match="one and the same model"):
        Ranker(GridSearch(load_model("rabbit-plane")), cost)
    with pytest.raises(CrystalError, match="one arrangement or more, got 0"):
        rank(search, np.array([0]), cost, 0)
    for number in (-1, search.model.grid.count):
        with pytest.raises(CrystalError, match="numbers of arrangements from 0 to"):
            rank(search, np.array([number]), cost)
    with pytest.raises(CrystalError, match="got none"):
        merged([])


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("factor", [1e-80, 1e-12, 1e12, 1e80])
def test_a_target_with_a_scale_of_its_own_does_not_overflow(factor, scaled):
    model = load_model("rabbit-plane")
    given = simulate(model, load_target("rabbit-plane-target", model))
    target = Magnitudes(given.reflections, factor * given.values)
    cost = FourierCost(model, target, scaled)
    whole = model.grid.configurations(np.arange(model.grid.count))
    plain = cost.values(whole)
    for found in (
        rank(GridSearch(model), np.arange(model.grid.count), cost, 3),
        rank_listed(cost, whole, 3),
    ):
        # Where the target is enormous, all cost the same.
        assert np.allclose(found.costs, np.sort(plain)[:3], rtol=1e-9)
        assert np.allclose(plain[found.numbers], np.sort(plain)[:3], rtol=1e-9)
