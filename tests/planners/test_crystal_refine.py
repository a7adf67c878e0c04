import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors
from ellipsoid_planning.crystal.phasing.polish import neighbourhood, polish
from ellipsoid_planning.errors import CrystalError, PlannerError
from planners.crystal import tree
from planners.crystal.parameters import Refinement
from planners.crystal.phasing import phase_candidates
from planners.crystal.refine import refine
from planners.crystal.tree import grow_tree


def case(name):
    model = load_model(name)
    target = load_target(f"{name}-target", model)
    return model, target, FourierCost(model, simulate(model, target))


def free_near(model, target, steps, seed):
    rng = np.random.default_rng(seed)
    away = neighbourhood(model, steps) * rng.uniform(-1.0, 1.0, (200, len(target)))
    return next(one for one in target + away if model.is_free(one))


def candidates(model, cost, best):
    free = model.grid.configurations(GridSearch(model).free(0, model.grid.base_poses))
    return free[np.argsort(cost.values(free), kind="stable")[:best]]


def test_candidates_that_collide_do_not_end_the_loop():
    # As with search.slack, and magnitudes that no arrangement has.
    model, target, cost = case("rabbit-p1")
    wrong = np.random.default_rng(1).uniform(0.5, 2.0, len(cost.magnitudes))
    given = replace(cost.magnitudes, values=wrong * cost.magnitudes.values)
    cost = FourierCost(model, given, scaled=True)
    near = target + neighbourhood(model) * np.random.default_rng(2).uniform(-1, 1, (60, 7))
    colliding = near[~model.are_free(near)][:3]
    fast = {"rounds": 1, "steps": 10}
    outcome = phase_candidates(cost, [*colliding, target], Refinement("both", 1e-6, **fast))
    assert not outcome.solved and outcome.best.refined.free and len(outcome.tried) == 8
    assert all(
        one.refined.free == model.is_free(one.refined.configuration) for one in outcome.tried
    )
    outcome = phase_candidates(cost, [*colliding, target], Refinement("rrt", 1e-6, **fast))
    assert [one.number for one in outcome.tried] == [3]
    with pytest.raises(CrystalError, match="free arrangement to start from"):
        phase_candidates(cost, colliding, Refinement("rrt", 1e-6, **fast))


@pytest.mark.parametrize("name", ["rabbit-plane", "rabbit-p1", "rabbit-p212121"])
def test_a_tree_is_free_repeats_and_ends_at_its_lowest_cost(name):
    model, target, cost = case(name)
    start = free_near(model, target, 0.5, 3)
    reach = neighbourhood(model, 1.0)
    first, again = (grow_tree(cost, start, reach, 120, 0.0, 5) for _ in range(2))
    other = grow_tree(cost, start, reach, 120, 0.0, 6)
    best, lowest, trace = first
    assert np.array_equal(best, again[0])
    assert np.array_equal(trace.configurations, again[2].configurations)
    assert not np.array_equal(trace.configurations, other[2].configurations)
    assert lowest == trace.costs.min() == cost.value(best) < cost.value(start)
    assert len(trace) == 121  # the root, and the steps
    assert np.all(model.are_free(trace.configurations))
    assert np.all(np.abs(trace.configurations - start) <= reach * (1.0 + 1e-12))


def test_a_tree_stops_at_its_threshold():
    model, target, cost = case("rabbit-p1")
    start = free_near(model, target, 0.5, 3)
    *_, trace = grow_tree(cost, start, neighbourhood(model, 1.0), 500, 0.9 * cost.value(start), 5)
    assert len(trace) < 500
    assert trace.costs[-1] <= 0.9 * cost.value(start)


def test_coordinates_without_reach_stay():
    model, target, cost = case("rabbit-p1")
    start = free_near(model, target, 0.5, 3)
    reach = neighbourhood(model, 1.0) * [1, 0, 1, 1, 0, 1, 1]
    *_, trace = grow_tree(cost, start, reach, 50, 0.0, 5)
    assert np.all(trace.configurations[:, [1, 4]] == start[[1, 4]])
    best, lowest, trace = grow_tree(cost, start, 0.0 * reach, 50, 0.0, 5)
    assert np.array_equal(best, start) and len(trace) == 1 and lowest == cost.value(start)


def test_nothing_of_a_tree_outlives_it(monkeypatch):
    model, target, cost = case("rabbit-plane")
    start = free_near(model, target, 0.3, 1)
    left = []

    def remembered(kind):
        def make(*arguments):
            made = kind(*arguments)
            left.append(weakref.ref(made))
            return made

        return make

    for name in ("LowCost", "FreeArrangements", "Box", "Budget"):
        monkeypatch.setattr(tree, name, remembered(getattr(tree, name)))
    grow_tree(cost, start, neighbourhood(model, 0.5), 20, 0.0, 1)
    gc.collect()
    assert len(left) == 4
    assert [one() for one in left] == [None] * 4


@pytest.mark.parametrize(("method", "error_deg"), [("polish", 1e-6), ("rrt", 2.0), ("both", 1e-6)])
def test_each_method_comes_nearer_to_the_target(method, error_deg):
    model, target, cost = case("rabbit-p1")
    start = free_near(model, target, 0.5, 3)
    found = refine(cost, start, Refinement(method=method, rounds=4, steps=100))
    assert found.free and found.cost < cost.value(start)
    assert found.cost == pytest.approx(cost.value(found.configuration), abs=1e-9 * cost.norm)
    assert arrangement_errors(model, found.configuration, target).mae_deg < error_deg
    assert np.array_equal(found.trace.configurations[0], start)
    assert (found.rounds == 0) == (method != "rrt")


def test_least_squares_goes_on_from_the_edge_of_its_reach():
    model = load_model("rabbit-p1")
    target = np.radians([13.19, 51.33, 28.71, 20.18, 6.47, 21.37, 27.79])
    start = np.radians([25.0, 55.0, 15.0, -5.0, -5.0, 25.0, 25.0])
    cost = FourierCost(model, simulate(model, target))
    assert polish(cost, start).cost > 1e-4 * cost.norm
    found = refine(cost, start, Refinement(method="polish"))
    assert found.free and found.cost < 1e-9 * cost.norm
    assert arrangement_errors(model, found.configuration, target).e_max_deg < 1e-5


def test_the_rrt_refuses_to_start_in_a_collision():
    _, target, cost = case("rabbit-plane")
    wrong = target + 1.5 * np.eye(3)[1]
    assert not cost.model.is_free(wrong)
    with pytest.raises(CrystalError, match="free arrangement to start from"):
        refine(cost, wrong, Refinement(method="rrt"))


@pytest.mark.parametrize("name", ["rabbit-plane", "rabbit-p1"])
def test_the_loop_over_candidates_solves_the_bundled_targets(name):
    model, target, cost = case(name)
    reports = []
    outcome = phase_candidates(
        cost, candidates(model, cost, 10), on_progress=lambda *what: reports.append(what)
    )
    assert outcome.solved and outcome.best.refined.free
    assert arrangement_errors(model, outcome.configuration, target).e_max_deg < 1e-5
    assert [report[0] for report in reports] == list(range(1, len(outcome.tried) + 1))
    assert outcome.to_dict()["best"] == outcome.best.number


def test_a_loop_that_fails_gives_its_best():
    model, _, cost = case("rabbit-plane")
    given = candidates(model, cost, 2)
    parameters = Refinement(method="rrt", threshold=1e-9, rounds=1, steps=20)
    outcome = phase_candidates(cost, given, parameters)
    assert not outcome.solved
    assert [one.number for one in outcome.tried] == [0, 1]
    assert outcome.best.refined.cost == min(one.refined.cost for one in outcome.tried)
    assert np.array_equal(outcome.configuration, outcome.best.refined.configuration)


def test_no_candidates_are_refused():
    _, _, cost = case("rabbit-plane")
    with pytest.raises(CrystalError, match="candidates as an array"):
        phase_candidates(cost, np.zeros((0, 3)))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"method": "magic"}, "method: expected polish, rrt, both"),
        ({"threshold": 0.0}, "threshold: expected a positive number"),
        ({"reach": -1.0}, "reach: expected a positive number"),
        ({"shrink": 1.5}, "shrink: expected at most 1"),
        ({"steps": 0}, "steps: expected an integer of 1 or more"),
        ({"rounds": True}, "rounds: expected an integer of 1 or more"),
        ({"seed": -1}, "seed: expected an integer from 0"),
    ],
)
def test_wrong_parameters_are_refused(values, message):
    with pytest.raises(PlannerError, match=message):
        Refinement(**values)
