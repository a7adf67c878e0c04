"""Nothing grows: set-ups, checks and plans by the thousand."""

import gc
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from resource import getpagesize

import pytest

from planners import bindings
from planners.fcl import FclValidityChecker
from planners.setup import simple_setup
from planners.solve import plan
from planners.spaces import state_access
from tests.planners import articulated_scenes
from tests.planners.planner_scenes import random_states, scenario_of

STATM = Path("/proc/self/statm")
pytestmark = pytest.mark.skipif(not STATM.exists(), reason="needs Linux's /proc to see memory")


def resident() -> int:
    """Bytes of memory that this process holds."""
    return int(STATM.read_text().split()[1]) * getpagesize()


def growth(action: Callable[[], object], times: int) -> float:
    """Bytes that each of ``times`` calls adds to the process, once warm."""
    for _ in range(max(times // 10, 3)):
        action()
    gc.collect()
    before = resident()
    for _ in range(times):
        action()
    gc.collect()
    return (resident() - before) / times


@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_setups_are_freed(checker):
    scenario = scenario_of("planar")
    cspace = scenario.cspace()
    assert growth(lambda: simple_setup(scenario, checker, cspace=cspace), 1000) < 500


@pytest.mark.parametrize("kind", ["planar", "spatial", "spatial translation"])
def test_checks_motions_and_samples_leave_nothing(kind):
    setup = simple_setup(scenario_of(kind), seed=1)
    si = setup.getSpaceInformation()
    states = random_states(si, 100)
    sampler, drawn = si.allocValidStateSampler(), si.allocState()

    def action() -> None:
        for first, second in pairwise(states):
            si.isValid(first)
            si.checkMotion(first, second)
        sampler.sample(drawn)

    assert growth(action, 200) < 1000


def test_fcl_checks_leave_nothing():
    setup = simple_setup(scenario_of("spatial"), "fcl", seed=1)
    si = setup.getSpaceInformation()
    states = random_states(si, 100)
    assert isinstance(si.getStateValidityChecker(), FclValidityChecker)
    assert growth(lambda: [si.isValid(state) for state in states], 100) < 2000


def test_reading_and_simplifying_paths_leaves_nothing():
    scenario = scenario_of("planar")
    setup = simple_setup(scenario, seed=1)
    si, access = setup.getSpaceInformation(), state_access(scenario.cspace())
    path = plan(scenario, "RRT", seed=1, simplify=False).path.configurations

    def action() -> None:
        bindings.simplified(si, path, access, bindings.stop_after(1.0))

    assert growth(action, 300) < 1000


@pytest.mark.parametrize("name", ["RRTConnect", "PRM"])
def test_whole_plans_leave_nothing(name):
    scenario = scenario_of("planar")
    assert growth(lambda: plan(scenario, name, seed=1), 150) < 10_000


@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_articulated_setups_are_freed(checker):
    scenario = articulated_scenes.scenario_of("mixed spatial")
    cspace = scenario.cspace()
    assert growth(lambda: simple_setup(scenario, checker, cspace=cspace), 500) < 1000


@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_articulated_states_leave_nothing(checker):
    scenario = articulated_scenes.scenario_of("mixed spatial")
    access = state_access(scenario.cspace())
    si = simple_setup(scenario, checker, seed=1).getSpaceInformation()
    states, copy = random_states(si, 100), si.allocState()

    def action() -> None:
        for first, second in pairwise(states):
            si.isValid(first)
            if checker == "plugin":
                si.checkMotion(first, second)
            access.write(copy, access.read(second))

    assert growth(action, 50) < 1000
