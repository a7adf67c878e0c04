"""Tabulated safety functions as OMPL's validity checkers."""

import pytest

from ellipsoid_planning.safety import TableParameters, TabulatedSafety, store
from planners.core_planner import EllipsoidValidityChecker
from planners.setup import simple_setup
from planners.solve import plan
from planners.spaces import read_configuration, write_configuration
from planners.validity import TabulatedValidityChecker
from planners.verify import verify_result
from tests.planners import articulated_scenes, planner_scenes
from tests.planners.planner_scenes import random_states, space_information


@pytest.fixture(autouse=True)
def _cache(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "CACHE_FOLDER", tmp_path / "kernels")


def scenario_of(kind, clearance=0.0):
    scenes = planner_scenes if kind in planner_scenes.KINDS else articulated_scenes
    return scenes.scenario_of(kind, clearance)


@pytest.mark.parametrize("kind", planner_scenes.KINDS + articulated_scenes.ROBOTS)
def test_it_judges_as_the_exact_checker(kind):
    cspace = scenario_of(kind, clearance=0.05).cspace()
    si = space_information(cspace)
    safety = TabulatedSafety(cspace, TableParameters(memory=300_000), keep=False)
    checker, exact = TabulatedValidityChecker(si, safety), EllipsoidValidityChecker(si, cspace)
    states = random_states(si, 300)
    judged = [checker.isValid(state) for state in states]
    assert judged == [exact.isValid(state) for state in states]
    assert 20 < sum(judged) < 300
    valid = [state for state, one in zip(states, judged, strict=True) if one]
    answers = safety.answers([read_configuration(state, cspace) for state in valid])
    assert answers.mean() > 0.05


def test_malformed_states_are_invalid():
    scenario = scenario_of("snake")
    cspace = scenario.cspace()
    si = space_information(cspace)
    checker = TabulatedValidityChecker(si, TabulatedSafety(cspace, keep=False))
    state = si.allocState()
    for place, value, valid in ((2, 0.0, True), (2, 3.2, False), (4, 2.1, False)):
        spoilt = scenario.start.copy()
        spoilt[place] = value
        write_configuration(state, spoilt, cspace)
        assert checker.isValid(state) == valid


@pytest.mark.parametrize(("kind", "planner"), [("planar", "HighwayRoadmap"), ("planar", "PRM")])
def test_planners_work_with_it(kind, planner, tmp_path):
    result = plan(scenario_of(kind), planner, checker="tabulated", seed=1)
    assert result.solved and result.path.certified
    assert verify_result(result).passed
    assert len(list((tmp_path / "safety-tables").iterdir())) == 1


def test_it_comes_with_certified_motions():
    setup = simple_setup(scenario_of("snake"), "tabulated")
    si = setup.getSpaceInformation()
    assert isinstance(si.getStateValidityChecker(), TabulatedValidityChecker)
    assert type(si.getMotionValidator()).__name__ == "CertifiedMotionValidator"
    si.clearValidStateSamplerAllocator()
