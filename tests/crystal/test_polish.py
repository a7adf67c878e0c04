import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.diffraction.structure_factors import reflections_of
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors
from ellipsoid_planning.crystal.phasing.polish import neighbourhood, polish
from ellipsoid_planning.crystal.phasing.trace import Trace, trend
from ellipsoid_planning.errors import CrystalError

MODELS = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


def case(name):
    model = load_model(name)
    target = load_target(f"{name}-target", model)
    return model, target, FourierCost(model, simulate(model, target))


def near(model, target, steps, seed):
    rng = np.random.default_rng(seed)
    away = neighbourhood(model, steps) * rng.uniform(-1.0, 1.0, (200, len(target)))
    return next(one for one in target + away if model.is_free(one))


@pytest.mark.parametrize("name", MODELS)
def test_exact_magnitudes_lead_to_the_target(name):
    model, target, cost = case(name)
    for seed in range(3):
        # The plane's grid is three times as coarse as that of space.
        start = near(model, target, 0.2 if model.dimension == 2 else 0.4, seed)
        found = polish(cost, start)
        assert found.free and model.is_free(found.configuration)
        assert found.cost < 1e-9 * cost.norm
        assert cost.value(found.configuration) == pytest.approx(found.cost, abs=1e-9 * cost.norm)
        assert arrangement_errors(model, found.configuration, target).e_max_deg < 1e-5


def test_nothing_moves_farther_than_its_reach():
    model, target, cost = case("rabbit-p212121")
    start = near(model, target, 0.7, 1)
    reach = neighbourhood(model, 0.05)
    reach[4] = 0.0
    found = polish(cost, start, reach)
    assert np.all(np.abs(found.configuration - start) <= reach + 2e-12)
    assert found.cost < cost.value(start)


def test_what_collides_in_the_end_is_taken_back_to_a_free_arrangement():
    # Magnitudes of an arrangement that collides: the lowest cost is not to be had.
    model, target, _ = case("rabbit-plane")
    rng = np.random.default_rng(0)
    met = 0
    for away in rng.uniform(-0.3, 0.3, (60, 3)):
        wrong = target + away
        if model.is_free(wrong):
            continue
        cost = FourierCost(model, simulate(model, wrong))
        found = polish(cost, target)
        assert found.free and model.is_free(found.configuration)
        assert found.cost == pytest.approx(cost.value(found.configuration))
        assert found.cost <= cost.value(target)
        met += 1
    assert met > 3


def test_a_start_that_collides_is_said_to():
    model, target, cost = case("rabbit-plane")
    colliding = target + [0.0, 1.5, 0.0] @ np.eye(3)
    if model.is_free(colliding):
        colliding = target + [0.0, 0.0, -1.5] @ np.eye(3)
    assert not model.is_free(colliding)
    found = polish(cost, colliding, np.full(3, 1e-3))
    assert not found.free


@pytest.mark.parametrize("reach", [[1.0], [-1.0, 0.0, 0.0], [np.nan, 1.0, 1.0]])
def test_a_wrong_reach_is_refused(reach):
    _, target, cost = case("rabbit-plane")
    with pytest.raises(CrystalError, match="reach: expected 3 finite numbers"):
        polish(cost, target, reach)


@pytest.mark.parametrize("start", [[0.0, 0.0], [0.0, np.nan, 0.0]])
def test_a_wrong_start_is_refused(start):
    _, _, cost = case("rabbit-plane")
    with pytest.raises(CrystalError, match="3 "):
        polish(cost, start)


def test_a_trend_has_the_improvements_and_their_errors():
    model, target, _ = case("rabbit-plane")
    trace = Trace()
    for away, cost in ((0.3, 5.0), (0.4, 6.0), (0.2, 3.0), (0.2, 3.0), (0.1, 1.0)):
        trace.add(target + away, cost)
    found = trend(trace, model, target)
    assert found.steps.tolist() == [0, 2, 4]
    assert found.costs.tolist() == [5.0, 3.0, 1.0]
    expected = np.degrees([0.3, 0.2, 0.1])
    assert [one.mae_deg for one in found.errors] == pytest.approx(expected)
    assert found.to_dict()["errors"][2]["MAE_deg"] == pytest.approx(expected[2])
    assert trend(trace, model).errors == ()
    assert trend(Trace(), model, target).to_dict() == {"steps": [], "costs": [], "errors": []}


def test_near_the_pole_of_euler_angles_the_outer_ones_may_go_farther():
    model, *_ = case("rabbit-p212121")
    plain = neighbourhood(model, 1.0)
    pole = np.zeros(10)
    assert neighbourhood(model, 1.0, pole)[[3, 5]] == pytest.approx([np.pi, np.pi])
    tilted = pole + np.radians(30.0) * np.eye(10)[4]
    reach = neighbourhood(model, 1.0, tilted)
    assert reach[[3, 5]] == pytest.approx(2.0 * plain[[3, 5]])
    assert np.delete(reach, [3, 5]) == pytest.approx(np.delete(plain, [3, 5]))
    flat = load_model("rabbit-plane")
    assert neighbourhood(flat, 1.0, np.zeros(3)) == pytest.approx(neighbourhood(flat, 1.0))


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("count", [1, 2, 1000])
@pytest.mark.parametrize("name", ["rabbit-p1", "rabbit-p212121"])
def test_where_nothing_leads_down_it_stays(name, count, scaled):
    # The target itself; a point of symmetry; fewer reflections than coordinates.
    model = load_model(name)
    target = load_target(f"{name}-target", model)
    some = reflections_of(model).subset(np.arange(min(count, len(reflections_of(model)))))
    cost = FourierCost(model, simulate(model, target, some), scaled)
    polished = polish(cost, target)
    assert polished.free and np.array_equal(polished.configuration, target)
    for start in (np.zeros(len(target)), target + 0.1):
        assert polish(cost, start).cost <= cost.value(start)
