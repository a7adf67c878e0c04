"""The free-interval sampler behind OMPL's interface."""

import numpy as np
import pytest
from ompl import geometric as og

from planners.bindings import clear_sampler, ompl_output, set_seed, stop_after
from planners.sampler import FreeIntervalSampler, install_free_interval_sampler
from planners.setup import simple_setup
from planners.spaces import read_configuration, write_configuration
from tests.planners.planner_scenes import KINDS, scenario_of, space_information


@pytest.mark.parametrize("uniform", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_samples_are_valid_and_spread_out(kind, uniform):
    cspace = scenario_of(kind, clearance=0.1).cspace()
    si = space_information(cspace)
    sampler, state = FreeIntervalSampler(si, cspace, uniform, seed=4), si.allocState()
    drawn = [read_configuration(state, cspace) for _ in range(300) if sampler.sample(state)]
    assert len(drawn) > 100
    assert cspace.are_valid(np.array(drawn)).all()
    assert np.ptp(np.array(drawn)[:, : cspace.dimension], axis=0).min() > 3.0


@pytest.mark.parametrize("kind", KINDS)
def test_samples_near_a_state_are_valid_and_near(kind):
    scenario = scenario_of(kind)
    cspace = scenario.cspace()
    si = space_information(cspace)
    sampler = FreeIntervalSampler(si, cspace, seed=4)
    state, near = si.allocState(), si.allocState()
    write_configuration(near, scenario.start, cspace)
    hits = 0
    for _ in range(200):
        if sampler.sampleNear(state, near, 0.5):
            hits += 1
            assert cspace.is_valid(read_configuration(state, cspace))
            assert si.distance(state, near) <= 0.5 + 1e-12
    assert hits > 50
    assert np.array_equal(read_configuration(near, cspace), scenario.start)


def test_no_state_is_checked_while_sampling():
    cspace = scenario_of("spatial").cspace()
    si = space_information(cspace)

    def never(_: object) -> bool:
        raise AssertionError("a sampled state was checked")

    si.setStateValidityChecker(never)
    install_free_interval_sampler(si, cspace)
    state, sampler = si.allocState(), si.allocValidStateSampler()
    assert isinstance(sampler, FreeIntervalSampler)
    for _ in range(50):
        if sampler.sample(state):
            sampler.sampleNear(state, state, 0.3)
    clear_sampler(si)
    assert not isinstance(si.allocValidStateSampler(), FreeIntervalSampler)


def test_ompls_seed_governs_the_samplers():
    runs = []
    for _ in range(2):
        set_seed(7)
        cspace = scenario_of("planar").cspace()
        si = space_information(cspace)
        samplers = [FreeIntervalSampler(si, cspace) for _ in range(2)]
        state, rows = si.allocState(), []
        for _ in range(20):
            rows += [read_configuration(state, cspace) for s in samplers if s.sample(state)]
        runs.append(np.array(rows))
    assert np.array_equal(runs[0], runs[1])
    assert len(np.unique(runs[0], axis=0)) == len(runs[0])


@pytest.mark.parametrize("name", ["PRM", "PRMstar", "BKPIECE1"])
def test_roadmap_planners_draw_from_it(name, monkeypatch):
    drawn = []
    sample = FreeIntervalSampler.sample
    near = FreeIntervalSampler.sampleNear
    monkeypatch.setattr(
        FreeIntervalSampler, "sample", lambda self, s: drawn.append(1) or sample(self, s)
    )
    monkeypatch.setattr(
        FreeIntervalSampler,
        "sampleNear",
        lambda self, s, n, d: drawn.append(1) or near(self, s, n, d),
    )
    setup = simple_setup(scenario_of("planar", blocked=True), seed=2)
    setup.setPlanner(getattr(og, name)(setup.getSpaceInformation()))
    with ompl_output("silent"):
        setup.solve(stop_after(0.2))
    assert drawn
